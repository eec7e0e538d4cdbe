//! The records of each unit reduced to a level and a change with time.
//!
//! A coefficient of a unit repeats from record to record within a repeatability σ that is the same in all
//! units, beyond the errors of its estimates: the Q of [`crate::random_effects`], summed over the units,
//! each about its own level and slope.

use crate::random_effects::{Units, spread_of};

/// A coefficient in one record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    /// Years since the fleet's mean date; `None` without a date.
    pub(crate) years: Option<f64>,
    pub(crate) value: f64,
    pub(crate) variance: f64,
}

/// An estimate with its variance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Estimate {
    pub(crate) value: f64,
    pub(crate) variance: f64,
}

/// A coefficient of every unit.
#[derive(Clone, Debug)]
pub(crate) struct Courses {
    /// Repeatability with its 95 % interval; `None` if no unit has records to spare.
    pub(crate) repeatability: Option<(f64, [f64; 2])>,
    /// Level of each unit at the mean date of its records.
    pub(crate) levels: Vec<Estimate>,
    /// Change in a year, of units with records at two dates or more; empty if no unit has one to spare.
    pub(crate) slopes: Vec<Option<Estimate>>,
}

/// The records of one unit with a design: a level, and a slope.
struct Own {
    values: Vec<f64>,
    variances: Vec<f64>,
    /// Years about their mean; `None` without a slope.
    years: Option<Vec<f64>>,
}

impl Own {
    fn new(points: &[Point], with_slope: bool) -> Self {
        let years: Option<Vec<f64>> = points.iter().map(|point| point.years).collect();
        let mean = |years: &[f64]| years.iter().sum::<f64>() / years.len() as f64;
        let years = years.filter(|_| with_slope).map(|years| {
            let mean = mean(&years);
            years.iter().map(|year| year - mean).collect::<Vec<f64>>()
        });
        Self {
            values: points.iter().map(|point| point.value).collect(),
            variances: points.iter().map(|point| point.variance).collect(),
            years: years.filter(|years| years.iter().any(|year| year.abs() > LEAST_YEARS)),
        }
    }

    fn units(&self) -> Units<'_> {
        Units {
            values: &self.values,
            variances: &self.variances,
            columns: self.years.iter().cloned().collect(),
        }
    }

    fn degrees_of_freedom(&self) -> usize {
        let unknowns = 1 + usize::from(self.years.is_some());
        self.values.len().saturating_sub(unknowns)
    }
}

/// Dates nearer than a second are the same.
const LEAST_YEARS: f64 = 3e-8;

/// Reduces the records of all units, none of which is without a record.
pub(crate) fn courses(units: &[Vec<Point>]) -> Option<Courses> {
    let of = |with_slope| -> Vec<Own> {
        let units = units.iter();
        units.map(|points| Own::new(points, with_slope)).collect()
    };
    let degrees = |all: &[Own]| all.iter().map(Own::degrees_of_freedom).sum::<usize>();
    let mut own = of(true);
    // Slopes that leave nothing to tell the repeatability from are not estimated.
    if degrees(&own) == 0 {
        own = of(false);
    }
    let count = degrees(&own);
    let guess = own.iter().map(|own| own.units().largest_variance());
    let guess = guess.fold(0.0, f64::max);
    let q = |tau_squared: f64| -> Option<f64> {
        let spare = own.iter().filter(|own| own.degrees_of_freedom() > 0);
        spare.map(|own| own.units().q(tau_squared)).sum()
    };
    let repeatability = match count {
        0 => None,
        _ => Some(spread_of(count as f64, guess, q)?),
    };
    let tau_squared = repeatability.map_or(0.0, |(sigma, _)| sigma * sigma);
    let mut found = Courses {
        repeatability,
        levels: Vec::with_capacity(units.len()),
        slopes: Vec::new(),
    };
    for own in &own {
        let (beta, covariance) = own.units().at(tau_squared)?;
        let estimate = |index: usize| Estimate {
            value: beta[index],
            variance: covariance[(index, index)],
        };
        found.levels.push(estimate(0));
        found.slopes.push((beta.len() > 1).then(|| estimate(1)));
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(values: &[(f64, f64)]) -> Vec<Point> {
        let point = |(years, value): &(f64, f64)| Point {
            years: Some(*years),
            value: *value,
            variance: 1e-10,
        };
        values.iter().map(point).collect()
    }

    #[test]
    fn a_unit_on_a_line_has_its_slope_and_the_others_its_repeatability() {
        let units = [
            points(&[(0.0, 1.0), (1.0, 3.0), (2.0, 5.0)]),
            // About the line 0: residuals of (0, 3, 0) from a line are (−1, 2, −1): Q = 6/σ².
            points(&[(0.0, 0.0), (1.0, 3.0), (2.0, 0.0)]),
            points(&[(0.5, 7.0)]),
        ];
        let found = courses(&units).unwrap();
        // Two degrees of freedom: σ² = 6/2.
        let (sigma, [low, high]) = found.repeatability.unwrap();
        assert!((sigma - 3.0_f64.sqrt()).abs() < 1e-6, "{sigma}");
        assert!(low < sigma && sigma < high);
        let [first, second, third] = &found.slopes[..] else {
            panic!("three units")
        };
        assert!((first.unwrap().value - 2.0).abs() < 1e-9);
        assert!(second.unwrap().value.abs() < 1e-9);
        assert!(third.is_none());
        // One record: its level has the repeatability in its variance.
        assert!((found.levels[2].variance - 3.0).abs() < 1e-6);
    }

    #[test]
    fn two_records_a_unit_tell_the_repeatability_and_no_slope() {
        let units = [
            points(&[(0.0, 1.0), (1.0, 2.0)]),
            points(&[(0.0, 5.0), (1.0, 4.0)]),
        ];
        let found = courses(&units).unwrap();
        // Q = (0.5 + 0.5)/σ² with two degrees of freedom.
        assert!((found.repeatability.unwrap().0 - 0.5_f64.sqrt()).abs() < 1e-6);
        assert!(found.slopes.iter().all(Option::is_none));
        let single = courses(&[points(&[(0.0, 1.0)]), points(&[(0.0, 2.0)])]).unwrap();
        assert!(single.repeatability.is_none());
    }
}
