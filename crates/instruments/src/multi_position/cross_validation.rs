//! Blocked cross-validation of the extended laws.

use std::collections::BTreeMap;

use serde::Serialize;

use super::between_stops::BetweenStops;
use super::log_biases::residuals;
use super::positions::Positions;
use super::regression::WeightedStops;
use super::search::search;
use super::terms::Term;

/// Fewest stops of which some are held out: the others have to determine laws with any terms of the catalogue.
pub const FEWEST_STOPS_OF_GAIN: usize = 14;

/// Most blocks: the covariances of the stops without each are factored anew.
const MOST_BLOCKS: usize = 12;

/// Gain of the extended over the nominal laws at held-out stops.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CrossValidation {
    /// Number of successive stops held out together.
    pub left_out: usize,
    /// Number of such blocks.
    pub blocks: usize,
    /// Difference of the predictive log scores, extended less nominal, summed over all stops and gyros and integrated
    /// over the noise between stops.
    pub cross_validated_log_score_nats: f64,
    /// Its standard error, from the scatter between blocks.
    pub standard_error_nats: f64,
    /// Rms prediction error of each gyro with the nominal law \[deg/h\].
    pub rms_before_deg_per_h: [f64; 3],
    /// The same with the extended law.
    pub rms_after_deg_per_h: [f64; 3],
    /// Rms standard error of the stops.
    pub noise_deg_per_h: [f64; 3],
    /// For each term, the number of blocks without which it was found.
    pub found_in_blocks: Vec<(String, usize)>,
}

impl CrossValidation {
    /// `true` if the extended laws predict held-out stops worse than the nominal ones. A gain below its standard error is
    /// none: of few blocks one may have it all.
    #[must_use]
    pub fn is_loss(&self) -> bool {
        self.cross_validated_log_score_nats < 0.0
    }
}

/// Holds out one block of stops after the other, searches and fits without it, and predicts it. Of the nominal laws, and
/// of those that a search in all stops found. `None` if the remaining stops do not determine the laws.
pub(super) fn cross_validate(
    positions: &Positions,
    between: &BetweenStops,
    [nominal, found]: [&[Vec<Term>]; 2],
    left_out: usize,
    false_alarm_probability: f64,
) -> Option<CrossValidation> {
    let stops = positions.time_s.len();
    if stops < FEWEST_STOPS_OF_GAIN {
        return None;
    }
    let left_out = left_out.max(stops.div_ceil(MOST_BLOCKS));
    let all: Vec<usize> = (0..stops).collect();
    let grid = between.likely(&[nominal, found])?;
    let of_all = between.without(&[], &grid);
    let mut scores = Vec::new();
    let mut squares = [[0.0; 3]; 2];
    let mut again = BTreeMap::new();
    for block in all.chunks(left_out) {
        let rest = all.iter().copied().filter(|stop| !block.contains(stop));
        let rest: Vec<usize> = rest.collect();
        let of_rest = between.without(block, &grid);
        let data: [_; 3] = core::array::from_fn(|gyro| WeightedStops::of(positions, gyro, &rest));
        let mut extended = nominal.to_vec();
        for step in search(&of_rest, &data, &mut extended, false_alarm_probability) {
            *again.entry(step.term.id(step.gyro).to_owned()).or_insert(0) += 1;
        }
        // The density of the block given the rest is that of all stops over that of the rest.
        let score = |laws| Some(of_all.log_evidence(laws)? - of_rest.log_evidence(laws)?);
        scores.push(score(&extended)? - score(nominal)?);
        for (laws, squares) in [nominal, &extended[..]].into_iter().zip(&mut squares) {
            for (gyro, sum) in squares.iter_mut().enumerate() {
                let law = of_rest.law(gyro, laws)?;
                let unused = WeightedStops::of(positions, gyro, block);
                let errors = residuals(positions, &unused, block, &laws[gyro], &law.estimates);
                *sum += errors.norm_squared();
            }
        }
    }
    let blocks = scores.len() as f64;
    let total: f64 = scores.iter().sum();
    let scatter = scores
        .iter()
        .map(|score| (score - total / blocks).powi(2))
        .sum::<f64>();
    let [rms_before_deg_per_h, rms_after_deg_per_h] =
        squares.map(|gyros| gyros.map(|sum| (sum / stops as f64).sqrt()));
    Some(CrossValidation {
        left_out,
        blocks: scores.len(),
        cross_validated_log_score_nats: total,
        standard_error_nats: (scatter * blocks / (blocks - 1.0)).sqrt(),
        rms_before_deg_per_h,
        rms_after_deg_per_h,
        noise_deg_per_h: core::array::from_fn(|gyro| positions.rms_sigma_deg_per_h(gyro)),
        found_in_blocks: again.into_iter().collect(),
    })
}
