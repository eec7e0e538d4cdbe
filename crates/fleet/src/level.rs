//! One coefficient over the units: mean, spread, outliers.

use gyrocal_statistics::{p_of_least, student_two_sided_p};

use crate::answer::{OutlierUnit, WithInterval};
use crate::course::Estimate;
use crate::random_effects::{RandomEffects, Units};

/// Fewest other units that one can lie outside of.
const LEAST_OTHERS: usize = 4;

/// Estimates of named units.
#[derive(Clone, Debug)]
pub(crate) struct Levels {
    /// Places of the units in the fleet.
    pub(crate) places: Vec<usize>,
    pub(crate) values: Vec<f64>,
    pub(crate) variances: Vec<f64>,
}

/// Mean and spread.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MeanAndSpread {
    pub(crate) mean: Option<WithInterval>,
    pub(crate) spread: Option<WithInterval>,
}

impl Levels {
    /// Of the units that have an estimate.
    pub(crate) fn of(estimates: &[Option<Estimate>]) -> Self {
        let mut levels = Self {
            places: Vec::new(),
            values: Vec::new(),
            variances: Vec::new(),
        };
        for (place, estimate) in estimates.iter().enumerate() {
            if let Some(estimate) = estimate {
                levels.places.push(place);
                levels.values.push(estimate.value);
                levels.variances.push(estimate.variance);
            }
        }
        levels
    }

    pub(crate) fn without(&self, index: usize) -> Self {
        let mut rest = self.clone();
        rest.places.remove(index);
        rest.values.remove(index);
        rest.variances.remove(index);
        rest
    }

    pub(crate) fn units(&self, columns: Vec<Vec<f64>>) -> Units<'_> {
        Units {
            values: &self.values,
            variances: &self.variances,
            columns,
        }
    }

    /// With columns of groups that differ.
    pub(crate) fn mean_and_spread(&self, columns: Vec<Vec<f64>>) -> MeanAndSpread {
        let units = self.units(columns);
        let Some(fit) = units.fit() else {
            return MeanAndSpread::default();
        };
        let with = |estimate, interval: Option<[f64; 2]>| {
            interval.map(|interval| WithInterval { estimate, interval })
        };
        MeanAndSpread {
            mean: with(fit.beta[0], fit.interval(0)),
            spread: with(fit.spread, units.spread_interval()),
        }
    }

    /// Takes units outside of all others away, the farthest first, as long as the farthest is too far for
    /// the largest of all.
    pub(crate) fn take_outliers(&mut self, names: &[&str], probability: f64) -> Vec<OutlierUnit> {
        let mut outliers = Vec::new();
        while self.values.len() > LEAST_OTHERS {
            let Some((index, t, p_value)) = self.farthest() else {
                break;
            };
            if p_value > probability {
                break;
            }
            outliers.push(OutlierUnit {
                unit: names[self.places[index]].to_owned(),
                estimate: self.values[index],
                t,
                p_value,
            });
            *self = self.without(index);
        }
        outliers
    }

    /// The unit farthest from the others by Student's statistic, with its p-value for all units together.
    fn farthest(&self) -> Option<(usize, f64, f64)> {
        let count = self.values.len();
        let all = self.units(Vec::new()).fit()?;
        // The farthest from all is the farthest from the others, or nearly so: it alone is tested.
        let squares = (0..count).map(|index| {
            let distance = self.values[index] - all.beta[0];
            distance * distance / (all.spread * all.spread + self.variances[index])
        });
        let (index, _) = squares.enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let others = self.without(index);
        let fit = others.units(Vec::new()).fit()?;
        let t = self.distance(index, &fit);
        let p_value = student_two_sided_p(t, fit.degrees_of_freedom)?;
        Some((index, t, p_of_least(p_value, count as f64)))
    }

    fn distance(&self, index: usize, others: &RandomEffects) -> f64 {
        let error = others.standard_error(0);
        let variance = others.spread.powi(2) + self.variances[index] + error * error;
        (self.values[index] - others.beta[0]) / variance.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_far_from_the_others_is_told_and_left_out() {
        let mut values: Vec<f64> = (0..20).map(|index| f64::from(index % 5) - 2.0).collect();
        values.push(30.0);
        let estimates: Vec<Option<Estimate>> = values
            .iter()
            .map(|value| {
                Some(Estimate {
                    value: *value,
                    variance: 0.01,
                })
            })
            .collect();
        let names: Vec<String> = (0..21).map(|index| format!("unit-{index}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let mut levels = Levels::of(&estimates);
        let outliers = levels.take_outliers(&names, 0.01);
        assert_eq!(outliers.len(), 1);
        assert_eq!(outliers[0].unit, "unit-20");
        // The others have mean 0 and variance 2·20/19: without the outlier.
        let found = levels.mean_and_spread(Vec::new());
        assert!(found.mean.is_some_and(|mean| mean.estimate.abs() < 1e-9));
        let expected = (40.0_f64 / 19.0 - 0.01).sqrt();
        assert!(
            found
                .spread
                .is_some_and(|spread| (spread.estimate - expected).abs() < 1e-9)
        );
    }
}
