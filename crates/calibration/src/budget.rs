//! Uncertainty budget of a calibration, as the GUM asks (JCGM 100:2008): contributions by their sources,
//! combined in the sum of their squares, with effective degrees of freedom and a coverage factor.
//!
//! The covariance (7) of the [crate documentation](crate) is the sum of what the noise leaves and of what
//! each considered quantity of the site adds. The part of the declared attitude at the first row is the
//! difference to the covariance with that attitude exact. Innovations beyond the declared noise are a
//! remainder that no source explains.

use gyrocal::trajectory::angles_rad;
use gyrocal_record::Bench;
use gyrocal_statistics::student_probability;

use crate::calibrate::calibrate_runs;
use crate::error::CalibrationError;
use crate::layout::SiteQuantity;
use crate::options::Options;
use crate::result::{Calibration, CoefficientEstimate};
use crate::run::Run;

/// Sigma that stands for an exact angle, as a share of the declared one.
const EXACT: f64 = 1e-3;

/// Degrees of freedom of a standard uncertainty that is known to about a half of itself: equation G.3 of
/// the GUM, 1/2 (Δu/u)⁻².
const DOUBTFUL_DEGREES: f64 = 2.0;

/// Probability of the expanded uncertainty's interval.
const COVERAGE: f64 = 0.95;

/// The uncertainty of each coefficient by its sources.
#[derive(Clone, Debug, PartialEq)]
pub struct UncertaintyBudget {
    /// One for each coefficient, in the order of [`Calibration::coefficients`].
    pub coefficients: Vec<CoefficientBudget>,
    /// Mean normalised innovation squared of a value; 1 is expected.
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
    /// Unit of the estimate and of the uncertainties.
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
}

/// One line of a budget.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contribution {
    /// Its source.
    pub source: UncertaintySource,
    /// Its standard uncertainty of the coefficient.
    pub standard: f64,
    /// Degrees of freedom of that uncertainty; infinite of one that counts as exact.
    pub degrees_of_freedom: f64,
}

/// Source of uncertainty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum UncertaintySource {
    /// Noise of accelerometers and gyros, with the prior of the coefficients.
    Noise,
    /// The declared attitude at the first row.
    Attitude,
    /// A considered quantity of the site.
    Site(SiteQuantity),
    /// Choice of the model: the shift by effects that may be in it or not, as a rectangular distribution.
    Model,
    /// Innovations larger than the declared noise makes them.
    Remainder,
}

impl UncertaintySource {
    /// The source in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Noise => "noise of the sensors",
            Self::Attitude => "attitude at the first row",
            Self::Site(SiteQuantity::Gravity) => "gravity",
            Self::Site(SiteQuantity::Latitude) => "latitude",
            Self::Site(SiteQuantity::EarthRate) => "Earth rate",
            Self::Model => "choice of the model",
            Self::Remainder => "unexplained remainder",
        }
    }

    /// Whether it was evaluated by statistics of the record (type A of the GUM); else by declared values
    /// and judgement (type B).
    #[must_use]
    pub fn is_type_a(self) -> bool {
        self == Self::Noise
    }
}

/// The budget of a batch calibration of some runs. `model_shift` is what effects that may be in the model
/// or not change of each coefficient.
///
/// # Errors
///
/// As of [`calibrate_runs`], which is run once more with exact attitudes if attitudes are declared.
pub fn uncertainty_budget(
    runs: &[Run<'_>],
    calibration: &Calibration,
    options: &Options,
    model_shift: Option<&[f64]>,
) -> Result<UncertaintyBudget, CalibrationError> {
    let exact = with_exact_attitudes(runs, calibration, options)?;
    let (fit, values) = (&calibration.fit, calibration.fit.values());
    let nis_of_value = fit.nis_sum() / values as f64;
    let beyond = match fit.consistency() {
        crate::fit::Consistency::Overconfident => (nis_of_value - 1.0).max(0.0),
        _ => 0.0,
    };
    let coefficients = calibration.coefficients();
    // Each run has three angles of its own.
    let unknowns = coefficients.len() + 3 * runs.len();
    let noise_degrees = values.saturating_sub(unknowns).max(1) as f64;
    let budget = |index: usize| {
        let coefficient = &coefficients[index];
        let site: Vec<Contribution> = calibration
            .site_sensitivities
            .iter()
            .map(|one| Contribution {
                source: UncertaintySource::Site(one.quantity),
                standard: (one.bias_per_unit[index] * one.declared_sigma.unwrap_or(0.0)).abs(),
                degrees_of_freedom: f64::INFINITY,
            })
            .collect();
        let of_site: f64 = site.iter().map(|line| line.standard.powi(2)).sum();
        let without_site = calibration.covariance[index][index] - of_site;
        let with_exact = exact.as_ref().map_or(without_site, |exact| {
            exact.covariance[index][index] - of_site_of(exact, index)
        });
        let noise = with_exact.clamp(0.0, without_site.max(0.0));
        let line = |source, variance: f64, degrees_of_freedom| Contribution {
            source,
            standard: variance.max(0.0).sqrt(),
            degrees_of_freedom,
        };
        let mut contributions = vec![
            line(UncertaintySource::Noise, noise, noise_degrees),
            line(
                UncertaintySource::Attitude,
                without_site - noise,
                f64::INFINITY,
            ),
        ];
        contributions.extend(site);
        let shift = model_shift.and_then(|shift| shift.get(index).copied());
        let third = shift.unwrap_or(0.0).powi(2) / 3.0;
        contributions.push(line(UncertaintySource::Model, third, DOUBTFUL_DEGREES));
        let remainder = beyond * noise;
        contributions.push(line(
            UncertaintySource::Remainder,
            remainder,
            DOUBTFUL_DEGREES,
        ));
        combined(coefficient, contributions)
    };
    Ok(UncertaintyBudget {
        coefficients: (0..coefficients.len()).map(budget).collect(),
        nis_of_value,
        records: runs.len(),
        values,
    })
}

/// Variance of a coefficient by the declared uncertainties of the site.
fn of_site_of(calibration: &Calibration, index: usize) -> f64 {
    let lines = calibration.site_sensitivities.iter();
    lines
        .map(|one| (one.bias_per_unit[index] * one.declared_sigma.unwrap_or(0.0)).powi(2))
        .sum()
}

/// The calibration of the same runs with exact attitudes, which are those of the fit; `None` if no attitude is declared.
fn with_exact_attitudes(
    runs: &[Run<'_>],
    calibration: &Calibration,
    options: &Options,
) -> Result<Option<Calibration>, CalibrationError> {
    if runs
        .iter()
        .all(|run| run.bench.initial_angles_deg.is_none())
    {
        return Ok(None);
    }
    let benches: Vec<Bench> = runs
        .iter()
        .zip(&calibration.runs)
        .map(|(run, found)| Bench {
            initial_angles_deg: run
                .bench
                .initial_angles_deg
                .map(|_| angles_rad(&found.first_platform_c_enu).map(f64::to_degrees)),
            initial_angles_sigma_deg: run.bench.initial_angles_sigma_deg.map(|it| it * EXACT),
            ..run.bench.clone()
        })
        .collect();
    let pairs = runs.iter().zip(&benches);
    let exact: Vec<Run<'_>> = pairs
        .map(|(run, bench)| Run {
            record: run.record,
            bench,
        })
        .collect();
    let options = Options {
        noise: false,
        ..*options
    };
    calibrate_runs(&exact, &options, |_| ()).map(Some)
}

fn combined(of: &CoefficientEstimate, contributions: Vec<Contribution>) -> CoefficientBudget {
    let squares = contributions.iter().map(|line| line.standard.powi(2));
    let combined = squares.sum::<f64>().sqrt();
    let limits = contributions.iter().map(|line| {
        let share = line.standard / combined;
        share.powi(4) / line.degrees_of_freedom
    });
    let degrees_of_freedom = limits.filter(|it| it.is_finite()).sum::<f64>().recip();
    CoefficientBudget {
        id: of.id,
        meaning: of.meaning,
        estimate: of.estimate,
        unit: of.unit,
        contributions,
        combined,
        degrees_of_freedom,
        coverage_factor: coverage_factor(degrees_of_freedom),
    }
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
            standard,
            degrees_of_freedom,
        };
        // Example G.4.1 of the GUM: relative components 0.25, 0.57, 0.82 with 9, 4, 14 degrees give 19.
        let lines = vec![line(0.25, 9.0), line(0.57, 4.0), line(0.82, 14.0)];
        let of = CoefficientEstimate {
            id: "c",
            unit: "1",
            meaning: "",
            estimate: 0.0,
            sigma: 1.0,
            determined: true,
        };
        let budget = combined(&of, lines);
        assert!((budget.combined - 1.03).abs() < 0.005);
        // The example cuts 19.0 to 19; its inputs have two digits.
        assert!(
            (budget.degrees_of_freedom - 19.0).abs() < 0.3,
            "{}",
            budget.degrees_of_freedom
        );
    }
}
