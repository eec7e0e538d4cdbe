//! Which unknowns a joint calibration has, and in which order.

use gyrocal::generated::platform::drift_index;
use gyrocal_record::Bench;

use crate::PARAMETERS;
use crate::settings::level;
use crate::solve::Unknown;

/// Indices of the constant drifts among the coefficients.
pub(crate) const BIASES: [usize; 3] = [
    drift_index::GYRO_X_BIAS,
    drift_index::GYRO_Y_BIAS,
    drift_index::GYRO_Z_BIAS,
];

/// The coefficients come first; then, for each run, what its turn-on adds to the constant
/// drifts, if turn-ons differ.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub(crate) unknowns: Vec<Unknown>,
    /// Index of the first turn-on of each run.
    pub(crate) turn_ons: Vec<Option<usize>>,
}

impl Layout {
    /// For runs on these benches; the first one's prior holds for all.
    pub(crate) fn new(benches: &[&Bench]) -> Self {
        let estimated = |sigma| Unknown {
            prior: 0.0,
            sigma,
            considered: false,
        };
        let turn_on = benches
            .first()
            .map_or([0.0; 3], |bench| bench.prior.turn_on_sigma_deg_per_h);
        let differ = benches.len() > 1 && turn_on.iter().any(|sigma| *sigma > 0.0);
        let mut prior = benches.first().map_or([1.0; PARAMETERS], |bench| {
            level(bench).drift_sigma.to_array()
        });
        if differ {
            // The prior of the mean over turn-ons; `level` gives that of one turn-on.
            if let Some(bench) = benches.first() {
                for (axis, index) in BIASES.into_iter().enumerate() {
                    prior[index] = bench.prior.bias_sigma_deg_per_h[axis];
                }
            }
        }
        let mut unknowns: Vec<Unknown> = prior.into_iter().map(estimated).collect();
        let mut turn_ons = vec![None; benches.len()];
        if differ {
            for first in &mut turn_ons {
                *first = Some(unknowns.len());
                // A gyro that does not change keeps its place with a sigma that is next to none.
                unknowns.extend(turn_on.map(|sigma| estimated(sigma.max(SAME_DEG_PER_H))));
            }
        }
        Self { unknowns, turn_ons }
    }

    /// For each parameter of the model in a run, the unknowns whose sum it is.
    pub(crate) fn sums(&self, run: usize) -> Vec<Vec<usize>> {
        let mut sums: Vec<Vec<usize>> = (0..PARAMETERS).map(|index| vec![index]).collect();
        if let Some(first) = self.turn_ons[run] {
            for (axis, bias) in BIASES.into_iter().enumerate() {
                sums[bias].push(first + axis);
            }
        }
        sums
    }
}

/// Turn-on sigma of a gyro whose turn-ons are declared equal while others differ.
const SAME_DEG_PER_H: f64 = 1e-9;
