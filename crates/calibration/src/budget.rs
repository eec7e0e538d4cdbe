//! Uncertainty budget of a calibration, as the GUM asks (JCGM 100:2008): contributions by their sources,
//! combined in the sum of their squares, with effective degrees of freedom and a coverage factor.
//!
//! A contribution is the sensitivity of the estimate to a quantity times the standard uncertainty of the
//! quantity, as equation (8) of the module on variances has them. Innovations beyond the declared noise are
//! a remainder that no source explains. Errors of the site make innovations larger as well: what its
//! declared uncertainties explain is no part of the remainder.

use gyrocal::{Anchored, Surveyed};
use gyrocal_inference::stop;
use gyrocal_statistics::student_probability;

use crate::batch::calibrate_with_variances;
use crate::check::check_record;
use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::fit::FitStatistics;
use crate::options::Options;
use crate::result::Calibration;
use crate::run::Run;
use crate::variances::{UncertaintySource, Variances};

/// Degrees of freedom of a standard uncertainty that is known to about a half of itself: equation G.3 of
/// the GUM, 1/2 (Δu/u)⁻². Their coverage factor is 4.3: so far off a mean over models is one whose weight
/// is 5 %, √((1 − w)/w) of their scatter.
const DOUBTFUL_DEGREES: f64 = 2.0;

/// Probability of the expanded uncertainty's interval.
const COVERAGE: f64 = 0.95;

/// The uncertainty of each coefficient by its sources.
#[derive(Clone, Debug, PartialEq)]
pub struct UncertaintyBudget {
    /// One for each coefficient, in the order of [`Calibration::coefficients`].
    pub coefficients: Vec<CoefficientBudget>,
    /// Mean normalised innovation squared of a value, the site adjusted within its declared uncertainties; 1
    /// is expected.
    pub nis_of_value: f64,
    /// Number of records, each a turn-on.
    pub records: usize,
    /// Number of accelerometer values used.
    pub values: usize,
}

/// The uncertainty of one coefficient.
#[derive(Clone, Debug, PartialEq)]
pub struct CoefficientBudget {
    /// Id of the coefficient.
    pub id: &'static str,
    /// The term of the drift law by its letter in IEEE Std 517.
    pub meaning: &'static str,
    /// The estimate, in `unit`.
    pub estimate: f64,
    /// Unit of the estimate and of the contributions.
    pub unit: &'static str,
    /// Contributions, those of zero included.
    pub contributions: Vec<Contribution>,
    /// Combined standard uncertainty: root of the sum of the squares.
    pub combined: f64,
    /// Effective degrees of freedom by Welch and Satterthwaite; infinite if nothing limits them.
    pub degrees_of_freedom: f64,
    /// Coverage factor of a 95 % interval: the quantile of Student's distribution.
    pub coverage_factor: f64,
}

impl CoefficientBudget {
    /// Expanded uncertainty: half the width of the 95 % interval.
    #[must_use]
    pub fn expanded(&self) -> f64 {
        self.coverage_factor * self.combined
    }

    /// Contribution of all quantities that a source holds of, in the unit of the coefficient.
    #[must_use]
    pub fn part(&self, holds: impl Fn(UncertaintySource) -> bool) -> f64 {
        let lines = self.contributions.iter().filter(|line| holds(line.source));
        lines.map(|line| line.standard.powi(2)).sum::<f64>().sqrt()
    }

    /// Combines the contributions anew.
    fn combine(&mut self) {
        let lines = &self.contributions;
        let squares = lines.iter().map(|line| line.standard.powi(2));
        self.combined = squares.sum::<f64>().sqrt();
        let limits = lines.iter().map(|line| {
            let share = line.standard / self.combined;
            share.powi(4) / line.degrees_of_freedom
        });
        self.degrees_of_freedom = limits.filter(|it| it.is_finite()).sum::<f64>().recip();
        self.coverage_factor = coverage_factor(self.degrees_of_freedom);
    }
}

/// One line of a budget.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    /// Its source.
    pub source: UncertaintySource,
    /// Standard uncertainty of the quantity, in `quantity_unit`.
    pub quantity_standard: f64,
    /// Unit of the quantity.
    pub quantity_unit: &'static str,
    /// Derivative of the coefficient by the quantity; of several quantities of one source the root of the
    /// sum of squares. 1 of a source that is known by its contribution.
    pub sensitivity: f64,
    /// Contribution to the standard uncertainty of the coefficient, in its unit.
    pub standard: f64,
    /// Degrees of freedom of that uncertainty; infinite of one that counts as exact.
    pub degrees_of_freedom: f64,
}

/// A coefficient as a fit estimates it.
pub(crate) struct Estimate {
    pub(crate) id: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) meaning: &'static str,
    pub(crate) value: f64,
    /// Degrees of freedom of the noise that its uncertainty rests on.
    pub(crate) noise_degrees: f64,
}

/// A model that a record leaves open, with its estimates of the coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelEstimate {
    /// Its share of the likelihood of all models.
    pub weight: f64,
    /// Estimates of the coefficients with their standard deviations.
    pub coefficients: Vec<[f64; 2]>,
}

impl UncertaintyBudget {
    pub(crate) fn new(
        estimates: [Estimate; PARAMETERS],
        variances: &Variances,
        fit: &FitStatistics,
        records: usize,
    ) -> Self {
        let squares = fit.nis_sum() - variances.squares_by_considered;
        let nis_of_value = squares / fit.values() as f64;
        let [_, high] = fit.nis_band();
        let beyond = match squares > high * fit.rows() as f64 {
            true => (nis_of_value - 1.0).max(0.0),
            false => 0.0,
        };
        let budget = |(index, of): (usize, Estimate)| {
            let noise = variances.noise[index].sqrt();
            let known = |source: UncertaintySource, standard, degrees_of_freedom| Contribution {
                source,
                quantity_standard: standard,
                quantity_unit: source.unit(of.unit),
                sensitivity: 1.0,
                standard,
                degrees_of_freedom,
            };
            let mut contributions = vec![known(UncertaintySource::Noise, noise, of.noise_degrees)];
            contributions.extend(variances.inputs.iter().map(|input| Contribution {
                source: input.source,
                quantity_standard: input.standard,
                quantity_unit: input.source.unit(of.unit),
                sensitivity: input.sensitivity[index],
                standard: (input.sensitivity[index] * input.standard).abs(),
                degrees_of_freedom: f64::INFINITY,
            }));
            contributions.push(known(UncertaintySource::Model, 0.0, DOUBTFUL_DEGREES));
            contributions.push(known(
                UncertaintySource::Remainder,
                beyond.sqrt() * noise,
                DOUBTFUL_DEGREES,
            ));
            let mut one = CoefficientBudget {
                id: of.id,
                meaning: of.meaning,
                estimate: of.value,
                unit: of.unit,
                contributions,
                combined: 0.0,
                degrees_of_freedom: f64::INFINITY,
                coverage_factor: 0.0,
            };
            one.combine();
            one
        };
        Self {
            coefficients: estimates.into_iter().enumerate().map(budget).collect(),
            nis_of_value,
            records,
            values: fit.values(),
        }
    }

    /// The budget of the mean over models that the record leaves open, from that of one of them. The scatter
    /// of their estimates is the contribution of the choice. Other contributions have the shares of the one
    /// model, and together the mean variance of all.
    #[must_use]
    pub fn over_models(mut self, models: &[ModelEstimate]) -> Self {
        let total: f64 = models.iter().map(|model| model.weight).sum();
        if models.len() < 2 || total <= 0.0 {
            return self;
        }
        for (index, one) in self.coefficients.iter_mut().enumerate() {
            let of = |square: &dyn Fn([f64; 2]) -> f64| -> f64 {
                let values = models.iter().filter_map(|model| {
                    let found = model.coefficients.get(index)?;
                    Some(model.weight / total * square(*found))
                });
                values.sum()
            };
            let mean = of(&|[estimate, _]| estimate);
            let within = of(&|[_, sigma]| sigma * sigma);
            let scatter = of(&|[estimate, _]| (estimate - mean).powi(2)).sqrt();
            let is_within = |source| {
                !matches!(
                    source,
                    UncertaintySource::Model | UncertaintySource::Remainder
                )
            };
            let scale = within.sqrt() / one.part(is_within);
            for line in &mut one.contributions {
                if line.source == UncertaintySource::Model {
                    (line.standard, line.quantity_standard) = (scatter, scatter);
                    continue;
                }
                line.standard *= scale;
                // What is known by its contribution has no sensitivity that could change.
                match line.source {
                    UncertaintySource::Noise | UncertaintySource::Remainder => {
                        line.quantity_standard = line.standard;
                    }
                    _ => line.sensitivity *= scale,
                }
            }
            one.estimate = mean;
            one.combine();
        }
        self
    }
}

/// A batch calibration of some runs of one platform, with its budget.
///
/// # Errors
///
/// As [`crate::calibrate_runs`].
pub fn calibrate_with_budget(
    runs: &[Run<'_>],
    options: &Options,
) -> Result<(Calibration, UncertaintyBudget), CalibrationError> {
    for (index, run) in runs.iter().enumerate() {
        check_record(run.record).map_err(|error| error.of_record(index, runs.len()))?;
    }
    let found = calibrate_with_variances(&Anchored(Surveyed), runs, options);
    let (calibration, variances) = stop::finished(found)?;
    // Each run has three angles of its own.
    let unknowns = PARAMETERS + 3 * runs.len();
    let values = calibration.fit.values();
    let noise_degrees = values.saturating_sub(unknowns).max(1) as f64;
    let estimates = calibration.coefficients().map(|one| Estimate {
        id: one.id,
        unit: one.unit,
        meaning: one.meaning,
        value: one.estimate,
        noise_degrees,
    });
    let budget = UncertaintyBudget::new(estimates, &variances, &calibration.fit, runs.len());
    Ok((calibration, budget))
}

/// The factor k with a probability of 95 % between −k and k, by bisection.
fn coverage_factor(degrees_of_freedom: f64) -> f64 {
    // The quantile of one degree of freedom is 12.7.
    let (mut low, mut high) = (1.0, 100.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let below = student_probability(middle, degrees_of_freedom).unwrap_or(1.0);
        match below < 0.5 + 0.5 * COVERAGE {
            true => low = middle,
            false => high = middle,
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coverage_factors_are_those_of_table_g_2_of_the_gum() {
        for (degrees, factor) in [(1.0, 12.71), (2.0, 4.30), (10.0, 2.23), (100.0, 1.984)] {
            // The table has two or three decimals.
            assert!(
                (coverage_factor(degrees) - factor).abs() < 0.006,
                "{degrees}"
            );
        }
        assert!((coverage_factor(f64::INFINITY) - 1.96).abs() < 1e-3);
    }

    #[test]
    fn degrees_of_freedom_are_those_of_welch_and_satterthwaite() {
        let line = |standard, degrees_of_freedom| Contribution {
            source: UncertaintySource::Noise,
            quantity_standard: standard,
            quantity_unit: "1",
            sensitivity: 1.0,
            standard,
            degrees_of_freedom,
        };
        // Example G.4.1 of the GUM: relative components 0.25, 0.57, 0.82 with 9, 4, 14 degrees give 19.
        let lines = vec![line(0.25, 9.0), line(0.57, 4.0), line(0.82, 14.0)];
        let mut budget = CoefficientBudget {
            id: "c",
            meaning: "",
            estimate: 0.0,
            unit: "1",
            contributions: lines,
            combined: 0.0,
            degrees_of_freedom: 0.0,
            coverage_factor: 0.0,
        };
        budget.combine();
        assert!((budget.combined - 1.03).abs() < 0.005);
        // The example cuts 19.0 to 19; its inputs have two digits.
        assert!(
            (budget.degrees_of_freedom - 19.0).abs() < 0.3,
            "{}",
            budget.degrees_of_freedom
        );
    }
}
