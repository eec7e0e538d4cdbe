//! Functions that a cause outside of the catalogue may follow: of covariates and regressors, their products,
//! their past and time.

use std::sync::Arc;

use gyrocal_statistics::followed_with_play;
use gyrocal_statistics::math::exp;

use crate::pattern::ChannelIndex;
use crate::rows::Rows;

/// Knots of functions of a covariate and of time.
const KNOTS: usize = 7;

/// Half-widths of dead zones and plays over half the range of a covariate.
const WIDTHS: [f64; 3] = [0.08, 0.2, 0.45];

/// Lags, h.
const LAGS_H: [f64; 3] = [0.5, 2.0, 8.0];

/// A family of functions: values of each in time, and how their amplitudes are correlated.
pub(crate) struct Family {
    pub(crate) functions: Vec<Arc<[f64]>>,
    pub(crate) is_smooth: bool,
}

/// Times at which functions are sampled: at the rows, or in the middle of the steps.
pub(crate) struct Sampling {
    time_s: Vec<f64>,
    in_steps: bool,
}

impl Sampling {
    pub(crate) fn rows(rows: &Rows) -> Self {
        Self {
            time_s: (0..rows.len()).map(|row| rows.since_first_s(row)).collect(),
            in_steps: false,
        }
    }

    pub(crate) fn steps(rows: &Rows) -> Self {
        let middle = |step: usize| 0.5 * (rows.since_first_s(step) + rows.since_first_s(step + 1));
        Self {
            time_s: (0..rows.len().saturating_sub(1)).map(middle).collect(),
            in_steps: true,
        }
    }

    /// Whether a channel is sampled so: rates act in steps, outputs are at rows.
    pub(crate) fn is_that_of(&self, channel: ChannelIndex) -> bool {
        self.in_steps == matches!(channel, ChannelIndex::Rate(_))
    }

    /// A series over the rows at these times.
    fn of(&self, values: &[f64]) -> Vec<f64> {
        if self.in_steps {
            values
                .windows(2)
                .map(|pair| 0.5 * (pair[0] + pair[1]))
                .collect()
        } else {
            values.to_vec()
        }
    }
}

/// All families of functions.
pub(crate) fn families(rows: &Rows, sampling: &Sampling) -> Vec<Family> {
    let mut families = Vec::new();
    if sampling.time_s.len() < 2 {
        return families;
    }
    let covariates = rows.covariates.iter();
    let moving: Vec<Vec<f64>> = covariates
        .filter(|covariate| range(&covariate.values) >= covariate.least_range)
        .map(|covariate| sampling.of(&covariate.values))
        .collect();
    let regressors = rows.regressors.iter();
    let regressors: Vec<Vec<f64>> = regressors
        .filter(|values| range(values) > 0.0)
        .map(|values| sampling.of(values))
        .collect();
    let smooth = |functions| Family {
        functions,
        is_smooth: true,
    };
    let independent = |functions| Family {
        functions,
        is_smooth: false,
    };
    let times = hats(&sampling.time_s);
    for values in moving.iter().chain(&regressors) {
        families.push(smooth(hats(values)));
    }
    for values in &moving {
        families.push(smooth(
            times.iter().map(|time| product(time, values)).collect(),
        ));
        families.push(independent(switches(values)));
        families.push(independent(memory(&sampling.time_s, values)));
    }
    if moving.len() > 1 {
        families.push(independent(products(&moving)));
    }
    for values in &regressors {
        let with = moving.iter().map(|other| product(values, other));
        families.push(independent(
            with.chain(memory(&sampling.time_s, values)).collect(),
        ));
    }
    families.retain(|family| !family.functions.is_empty());
    families
}

fn ends(values: &[f64]) -> [f64; 2] {
    let finite = values.iter().filter(|value| value.is_finite());
    finite.fold(
        [f64::INFINITY, f64::NEG_INFINITY],
        |[least, most], value| [least.min(*value), most.max(*value)],
    )
}

fn range(values: &[f64]) -> f64 {
    let [least, most] = ends(values);
    most - least
}

fn product(one: &[f64], other: &[f64]) -> Arc<[f64]> {
    one.iter()
        .zip(other)
        .map(|(one, other)| one * other)
        .collect()
}

/// Piecewise linear functions of a variable, from its least to its largest value.
fn hats(values: &[f64]) -> Vec<Arc<[f64]>> {
    let [least, most] = ends(values);
    let spacing = (most - least) / (KNOTS - 1) as f64;
    let hat =
        |knot: usize, value: f64| (1.0 - ((value - least) / spacing - knot as f64).abs()).max(0.0);
    (0..KNOTS)
        .map(|knot| values.iter().map(|value| hat(knot, *value)).collect())
        .collect()
}

/// Functions that switch about zero, of a variable that changes its sign: the sign, the magnitude, dead
/// zones.
fn switches(values: &[f64]) -> Vec<Arc<[f64]>> {
    let [least, most] = ends(values);
    if least >= 0.0 || most <= 0.0 {
        return Vec::new();
    }
    let half = 0.5 * (most - least);
    let of = |function: &dyn Fn(f64) -> f64| values.iter().map(|value| function(*value)).collect();
    let mut all: Vec<Arc<[f64]>> = vec![of(&f64::signum), of(&f64::abs)];
    for width in WIDTHS {
        let width = width * half;
        all.push(of(&|value| value - value.clamp(-width, width)));
    }
    all
}

/// Functions of the past of a variable: its direction, what a play lags behind, what a low-pass lags
/// behind.
fn memory(time_s: &[f64], values: &[f64]) -> Vec<Arc<[f64]>> {
    let half = 0.5 * range(values);
    let plays = WIDTHS.map(|width| followed_with_play(values, width * half));
    // The narrowest play tells the direction.
    let first = direction(values, &plays[0]);
    let mut all = vec![first];
    all.extend(plays.iter().map(|play| difference(values, play)));
    all.extend(LAGS_H.map(|lag_h| difference(values, &low_pass(time_s, values, lag_h))));
    all
}

fn difference(values: &[f64], other: &[f64]) -> Arc<[f64]> {
    values
        .iter()
        .zip(other)
        .map(|(one, other)| one - other)
        .collect()
}

/// Sign of the difference; zero where there is none.
fn direction(values: &[f64], other: &[f64]) -> Arc<[f64]> {
    let differences = difference(values, other);
    let sign = |value: &f64| if *value == 0.0 { 0.0 } else { value.signum() };
    differences.iter().map(sign).collect()
}

/// A first-order low-pass of a series.
fn low_pass(time_s: &[f64], values: &[f64], lag_h: f64) -> Vec<f64> {
    let mut state = values.first().copied().unwrap_or(0.0);
    let mut before = time_s.first().copied().unwrap_or(0.0);
    let pairs = time_s.iter().zip(values);
    pairs
        .map(|(time, value)| {
            let kept = exp(-(time - before) / 3600.0 / lag_h);
            before = *time;
            state = value + kept * (state - value);
            state
        })
        .collect()
}

/// Products of two and of three covariates.
fn products(values: &[Vec<f64>]) -> Vec<Arc<[f64]>> {
    let mut all = Vec::new();
    for i in 0..values.len() {
        for j in i..values.len() {
            let two = product(&values[i], &values[j]);
            all.extend((j..values.len()).map(|k| product(&two, &values[k])));
            all.push(two);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hats_add_up_to_one_and_bend_at_their_knots() {
        let values = [-1.0, 0.2, 3.0];
        let hats = hats(&values);
        for place in 0..values.len() {
            let sum: f64 = hats.iter().map(|hat| hat[place]).sum();
            assert!((sum - 1.0).abs() < 1e-12);
        }
    }
}
