//! Gains of single accelerometers.

use gyrocal_record::AXES;
use nalgebra::{Matrix3, Vector3};

use crate::finding::SetupFinding;
use crate::kind::SetupKind;
use crate::samples::{Complete, Samples};
use crate::text::number;

/// A gain that is off by less is left to the fine diagnosis.
const LEAST_ERROR: f64 = 0.01;

/// The gains must make the magnitude this much more constant.
const BETTER: f64 = 10.0;

/// One axis alone is told if it is nearly as good as all three.
const AS_GOOD: f64 = 2.0;

/// Three gains fit almost anything: all of them must be near one.
const PLAUSIBLE: core::ops::RangeInclusive<f64> = 0.7..=1.4;

/// Standard deviation of a squared gain about one, for gains that the record does not show.
const PRIOR_SIGMA: f64 = 3.0;

/// Fewest complete rows.
const LEAST_ROWS: usize = 30;

/// Gains that make the magnitude constant, and the median residual of its square with them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gains {
    /// What each accelerometer reads of 1 g.
    gains: [f64; 3],
    residual_g2: f64,
}

/// An accelerometer whose gain is wrong. The gains are corrected.
pub(crate) fn find(samples: &mut Samples<'_>) -> Vec<SetupFinding> {
    let Some(found) = one_axis(samples).or_else(|| three_axes(samples)) else {
        return Vec::new();
    };
    let mut findings = Vec::new();
    for (axis, gain) in found.gains.into_iter().enumerate() {
        if (gain - 1.0).abs() < LEAST_ERROR {
            continue;
        }
        let unit = if (gain / 9.806_65 - 1.0).abs() < LEAST_ERROR {
            " Its unit seems to be m/s^2."
        } else {
            ""
        };
        let description = format!(
            "Accelerometer {} reads {} times the force along its axis.{unit} It is corrected; \
             calibrate its scale.",
            AXES[axis],
            number(gain)
        );
        let evidence = format!(
            "with this gain the squared magnitude is constant within {} (median), without it \
             within {}",
            number(found.residual_g2),
            number(residual(samples, &samples.complete(), [1.0; 3])),
        );
        findings.push(SetupFinding::new(SetupKind::Scale, description, evidence));
    }
    if !findings.is_empty() {
        for row in &mut samples.accel_g {
            *row = core::array::from_fn(|axis| row[axis] / found.gains[axis]);
        }
        samples.look_again();
    }
    findings
}

/// The gain of a single axis, if it explains the magnitudes.
pub(crate) fn one_axis(samples: &Samples<'_>) -> Option<Gains> {
    let complete = samples.complete();
    let fitted = (0..3).filter_map(|axis| {
        let others = |s: &Complete| -> f64 {
            let squares = (0..3).filter(|other| *other != axis);
            squares.map(|other| s.force_g[other].powi(2)).sum()
        };
        fit(samples, &complete, |weights| {
            let (mut numerator, mut denominator) = (0.0, 0.0);
            for (sample, weight) in complete.iter().zip(weights) {
                let square = sample.force_g[axis].powi(2);
                numerator += weight * square * (samples.rest_g.powi(2) - others(sample));
                denominator += weight * square * square;
            }
            let mut squares = [1.0; 3];
            squares[axis] = numerator / denominator;
            Some(squares)
        })
    });
    let best = fitted.min_by(|a, b| a.residual_g2.total_cmp(&b.residual_g2))?;
    let all = joint(samples, &complete);
    let is_enough = all.is_none_or(|all| best.residual_g2 <= AS_GOOD * all.residual_g2);
    explains(samples, &complete, &best)
        .then_some(best)
        .filter(|_| is_enough)
}

/// The gains of all axes, if they explain the magnitudes.
fn three_axes(samples: &Samples<'_>) -> Option<Gains> {
    let complete = samples.complete();
    let all = joint(samples, &complete)?;
    // A gain that all have in common is gravity's.
    let [x, y, z] = all.gains;
    let common = (x + y + z) / 3.0;
    let differ = all
        .gains
        .iter()
        .any(|gain| (gain / common - 1.0).abs() > LEAST_ERROR);
    let plausible = all.gains.iter().all(|gain| PLAUSIBLE.contains(gain));
    (differ && plausible && explains(samples, &complete, &all)).then_some(all)
}

fn explains(samples: &Samples<'_>, complete: &[Complete], gains: &Gains) -> bool {
    let off = gains
        .gains
        .iter()
        .any(|gain| (gain - 1.0).abs() > LEAST_ERROR);
    let common = common_gain(samples, complete);
    let before =
        residual(samples, complete, [1.0; 3]).min(residual(samples, complete, [common; 3]));
    off && complete.len() >= LEAST_ROWS && BETTER * gains.residual_g2 < before
}

/// The gain that all axes may have in common, of the median magnitude.
fn common_gain(samples: &Samples<'_>, complete: &[Complete]) -> f64 {
    let norms: Vec<f64> = complete
        .iter()
        .map(|sample| crate::vector::norm(sample.force_g))
        .collect();
    gyrocal_statistics::median(&norms) / samples.rest_g
}

fn joint(samples: &Samples<'_>, complete: &[Complete]) -> Option<Gains> {
    fit(samples, complete, |weights| {
        let total: f64 = weights.iter().sum();
        // The prior counts as one row of a thousand.
        let ridge = 1e-3 * total / (PRIOR_SIGMA * PRIOR_SIGMA);
        let mut matrix = Matrix3::identity() * ridge;
        let mut right = Vector3::repeat(ridge);
        for (sample, weight) in complete.iter().zip(weights) {
            let squares = Vector3::from(sample.force_g.map(|g| g * g));
            matrix += squares * squares.transpose() * *weight;
            right += squares * (weight * samples.rest_g * samples.rest_g);
        }
        let solved = matrix.cholesky()?.solve(&right);
        Some([solved[0], solved[1], solved[2]])
    })
}

/// Solves twice: the second time without the rows that the first leaves far off.
fn fit(
    samples: &Samples<'_>,
    complete: &[Complete],
    solve: impl Fn(&[f64]) -> Option<[f64; 3]>,
) -> Option<Gains> {
    /// Multiple of the median residual beyond which a row counts for nothing.
    const FAR: f64 = 8.0;
    let mut weights = vec![1.0; complete.len()];
    let mut gains = [1.0; 3];
    for _ in 0..3 {
        let squares = solve(&weights)?;
        if !squares
            .iter()
            .all(|square| *square > 0.0 && square.is_finite())
        {
            return None;
        }
        gains = squares.map(|square| square.sqrt().recip());
        let limit = FAR * residual(samples, complete, gains);
        for (sample, weight) in complete.iter().zip(&mut weights) {
            let far = off(samples, sample, gains) > limit;
            *weight = if far { 0.0 } else { 1.0 };
        }
    }
    Some(Gains {
        gains,
        residual_g2: residual(samples, complete, gains),
    })
}

fn off(samples: &Samples<'_>, sample: &Complete, gains: [f64; 3]) -> f64 {
    let squares = (0..3).map(|axis| (sample.force_g[axis] / gains[axis]).powi(2));
    (squares.sum::<f64>() - samples.rest_g * samples.rest_g).abs()
}

/// Median distance of the squared magnitude from that at rest.
fn residual(samples: &Samples<'_>, complete: &[Complete], gains: [f64; 3]) -> f64 {
    let mut all: Vec<f64> = complete.iter().map(|s| off(samples, s, gains)).collect();
    gyrocal_statistics::upper_median(&mut all).unwrap_or(0.0)
}
