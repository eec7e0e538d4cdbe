//! Blocked cross-validation of the extended laws.

use nalgebra::DVector;
use serde::Serialize;

use super::positions::Positions;
use super::regression::{Fit, WeightedStops};
use super::search::{SearchSettings, search, terms_of};
use super::terms::Term;

/// Gain of the extended over the nominal laws at held-out stops.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CrossValidation {
    /// Number of successive stops held out together.
    pub left_out: usize,
    /// Number of such blocks.
    pub blocks: usize,
    /// Difference of the predictive log scores, extended less nominal, summed over all stops and gyros.
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
    /// `true` if the gain is no larger than its standard error: none at all, or none that held-out stops
    /// show.
    #[must_use]
    pub fn shows_no_gain(&self) -> bool {
        self.cross_validated_log_score_nats <= self.standard_error_nats
    }
}

/// Holds out one block of stops after the other, searches and fits without it, and predicts it. `None`
/// if the remaining stops do not determine the laws.
#[must_use]
pub fn cross_validate(
    positions: &Positions,
    left_out: usize,
    settings: &SearchSettings,
) -> Option<CrossValidation> {
    let stops = positions.time_s.len();
    let all: Vec<usize> = (0..stops).collect();
    let mut scores = Vec::new();
    let mut squares = [[0.0; 2]; 3];
    let mut found = std::collections::BTreeMap::new();
    for block in all.chunks(left_out) {
        let rest: Vec<usize> = all
            .iter()
            .copied()
            .filter(|stop| !block.contains(stop))
            .collect();
        let steps = search(positions, &rest, settings);
        for step in &steps {
            *found.entry(step.term.id(step.gyro).to_owned()).or_insert(0) += 1;
        }
        let mut score = 0.0;
        for (gyro, squares) in squares.iter_mut().enumerate() {
            let laws = [Term::NOMINAL.to_vec(), terms_of(&steps, gyro)];
            for (which, law) in laws.iter().enumerate() {
                let used = WeightedStops::of(positions, gyro, &rest).with_excess_of(law);
                let unused = WeightedStops::of(positions, gyro, block).like(&used);
                let fit = used.fit(law)?;
                let sign = if which == 0 { -1.0 } else { 1.0 };
                score += sign * predict(&fit, law, &unused, &mut squares[which]);
            }
        }
        scores.push(score);
    }
    let blocks = scores.len() as f64;
    let total: f64 = scores.iter().sum();
    let scatter = scores
        .iter()
        .map(|score| (score - total / blocks).powi(2))
        .sum::<f64>();
    let rms = |which: usize| squares.map(|squares| (squares[which] / stops as f64).sqrt());
    let noise = |gyro: usize| {
        let variances = positions
            .sigma_deg_per_h
            .iter()
            .map(|sigma| sigma[gyro].powi(2));
        (variances.sum::<f64>() / stops as f64).sqrt()
    };
    Some(CrossValidation {
        left_out,
        blocks: scores.len(),
        cross_validated_log_score_nats: total,
        standard_error_nats: (scatter * blocks / (blocks - 1.0)).sqrt(),
        rms_before_deg_per_h: rms(0),
        rms_after_deg_per_h: rms(1),
        noise_deg_per_h: [noise(0), noise(1), noise(2)],
        found_in_blocks: found.into_iter().collect(),
    })
}

/// Predictive log score of the held-out stops; adds the squares of their errors \[(deg/h)²\].
fn predict(fit: &Fit, law: &[Term], unused: &WeightedStops, squares: &mut f64) -> f64 {
    let columns = unused.columns(law);
    (0..unused.len())
        .map(|stop| {
            let row: DVector<f64> = columns.row(stop).transpose();
            let prediction = fit.predict(&row, unused.rates[stop]);
            *squares += (prediction.error * unused.sigma[stop]).powi(2);
            // From the density of the whitened rate to that of the rate.
            prediction.log_score - unused.sigma[stop].ln()
        })
        .sum()
}
