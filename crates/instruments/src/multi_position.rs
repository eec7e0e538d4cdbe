//! The multi-position test (tumble test): the drift law fitted to gyro outputs at rest in many attitudes, or in few.
//!
//! [`prepare`] reduces a log to rates and specific force at its stops. [`multi_position_test`] fits those terms of the
//! nominal drift law of each gyro that the positions determine, extends it by terms of the catalogue in a forward search,
//! and measures the extension by cross-validation. Estimates, their intervals and the significance of a term are
//! integrated over the noise that may be between stops ([`NoiseBetweenStops`]).

mod alternatives;
mod between_stops;
mod cross_validation;
mod laws;
mod level_fits;
mod levels;
mod log_biases;
mod positions;
mod prepare;
mod regression;
mod report;
mod result;
mod saturated_turns;
mod search;
mod signs;
mod stop_parts;
mod terms;
mod tridiagonal;

use gyrocal::generated::catalogue::RATES;
use gyrocal_statistics::chi_square_tail;

pub use alternatives::Alternative;
pub use between_stops::NoiseBetweenStops;
pub use cross_validation::{CrossValidation, FEWEST_STOPS_OF_GAIN};
pub use log_biases::LogBiases;
pub use positions::{Instrument, Positions};
pub use prepare::{PreparedTest, SensorReport, StopReport, prepare, prepare_logs};
pub use report::{CoefficientReport, Finding, GyroReport, LawReport, MultiPositionReport};
pub use result::TumbleResult;
pub use saturated_turns::SaturatedTurn;
pub use terms::Term;

use crate::error::{InstrumentError, Unfit};
use alternatives::alternatives;
use between_stops::{BetweenStops, LawEstimate};
use cross_validation::cross_validate;
use laws::{is_new, nominal_law, refuse_one_position};
use log_biases::{differing_biases, residuals, with_biases};
use regression::{WeightedStops, chi_square};
use search::{SearchStep, search};

/// Settings of a multi-position test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MultiPositionSettings {
    /// Probability of a finding in data without effects (family-wise error rate).
    pub false_alarm_probability: f64,
    /// Number of successive stops that the cross-validation holds out together; more where blocks would be more than
    /// twelve.
    pub left_out: usize,
}

impl Default for MultiPositionSettings {
    fn default() -> Self {
        Self {
            false_alarm_probability: 0.01,
            left_out: 4,
        }
    }
}

/// The test at work: the stops, and the noise that may be between them.
struct Test<'a> {
    positions: &'a Positions,
    all: Vec<usize>,
    data: [WeightedStops; 3],
    between: BetweenStops,
}

/// Fits the terms that the positions determine, searches for missing ones, and validates the extended laws.
///
/// The time grows with the third power of the number of stops.
///
/// # Errors
///
/// [`Unfit::TooShort`] with fewer than two stops; [`Unfit::Undetermined`] if all stops are in one
/// position; [`Unfit::Saturated`] of a gyro whose output does not change at a stop.
pub fn multi_position_test(
    positions: &Positions,
    settings: &MultiPositionSettings,
) -> Result<MultiPositionReport, InstrumentError> {
    positions.refuse_still_gyros()?;
    refuse_one_position(positions)?;
    let stops = positions.time_s.len();
    let all: Vec<usize> = (0..stops).collect();
    let data = core::array::from_fn(|gyro| WeightedStops::of(positions, gyro, &all));
    let nominal: Vec<Vec<Term>> = data.iter().map(nominal_law).collect();
    let test = Test {
        between: BetweenStops::of(positions, &nominal),
        positions,
        all,
        data,
    };
    let between = &test.between;
    let probability = settings.false_alarm_probability;
    let mut laws = nominal.clone();
    let mut steps = search(between, &test.data, &mut laws, probability);
    let cross_validation = match steps.is_empty() {
        true => None,
        false => {
            let both = [&nominal[..], &laws];
            cross_validate(positions, between, both, settings.left_out, probability)
        }
    };
    let mut not_confirmed = Vec::new();
    if cross_validation
        .as_ref()
        .is_some_and(CrossValidation::is_loss)
    {
        let names = steps.iter().map(|step| step.term.id(step.gyro).to_owned());
        not_confirmed = names.collect();
        steps.clear();
        laws.clone_from(&nominal);
    }
    let mut gyros = Vec::new();
    let mut estimates = Vec::new();
    for gyro in 0..3 {
        let (report, law) = test.gyro_report(gyro, &nominal, &laws)?;
        gyros.push(report);
        estimates.push(law);
    }
    let findings = steps
        .iter()
        .filter_map(|step| test.finding(step, &laws, &gyros[step.gyro]));
    Ok(MultiPositionReport {
        stops,
        freedom_of_noise: between.freedom(stops, &nominal),
        biases_of_further_logs: between.biases,
        log_biases: differing_biases(between, &laws, &estimates, probability),
        findings: findings.collect(),
        not_confirmed,
        cross_validation,
        gyros,
    })
}

impl Test<'_> {
    fn gyro_report(
        &self,
        gyro: usize,
        nominal: &[Vec<Term>],
        laws: &[Vec<Term>],
    ) -> Result<(GyroReport, LawEstimate), InstrumentError> {
        let (data, law) = (&self.data[gyro], &laws[gyro]);
        // Biases of further logs may take a term up.
        let is_open = |term: &Term| {
            let of_logs = || self.between.terms(gyro, laws, &[*term])[0].is_some();
            is_new(data, law, *term) && (self.between.biases == 0 || of_logs())
        };
        let others = Term::NOMINAL.into_iter().chain(Term::catalogue(gyro));
        let others = others.filter(|term| !law.contains(term));
        let undetermined = others.filter(|term| !is_open(term));
        let undetermined = undetermined.map(|term| term.id(gyro).to_owned()).collect();
        let (of_nominal, _) = self.law_report(gyro, nominal)?;
        let (extended, estimate) = self.law_report(gyro, laws)?;
        let report = GyroReport {
            gyro: RATES[gyro].id.to_owned(),
            nominal: of_nominal,
            extended,
            undetermined,
        };
        Ok((report, estimate))
    }

    fn law_report(
        &self,
        gyro: usize,
        laws: &[Vec<Term>],
    ) -> Result<(LawReport, LawEstimate), InstrumentError> {
        let (data, law) = (&self.data[gyro], &laws[gyro]);
        let columns = with_biases(data, &self.all, law, self.positions);
        let columns = columns.columns(0, law.len() + self.between.biases);
        let least = chi_square(&columns.clone_owned(), &data.rates);
        let chi_square = least.ok_or_else(|| undetermined(data, law))?;
        let estimate = self.between.law(gyro, laws);
        let estimate = estimate.ok_or_else(|| undetermined(data, law))?;
        let covariance = &estimate.covariance;
        let coefficients = law.iter().enumerate().map(|(i, term)| CoefficientReport {
            name: term.id(gyro).to_owned(),
            estimate: estimate.estimates[i],
            sigma: covariance[(i, i)].sqrt(),
            unit: term.unit(gyro).to_owned(),
        });
        let freedom = data.len() - columns.ncols();
        let p_value = || chi_square_tail(chi_square, freedom as f64).unwrap_or(f64::NAN);
        let of_law = |i: usize| (0..law.len()).map(move |j| (i, j));
        let covariance = (0..law.len()).map(|i| of_law(i).map(|at| covariance[at]).collect());
        let left = residuals(self.positions, data, &self.all, law, &estimate.estimates);
        let report = LawReport {
            coefficients: coefficients.collect(),
            covariance: covariance.collect(),
            chi_square,
            degrees_of_freedom: freedom,
            p_value: (freedom > 0).then(p_value),
            noise: estimate.noise,
            residuals_deg_per_h: left.as_slice().to_vec(),
        };
        Ok((report, estimate))
    }

    fn finding(&self, step: &SearchStep, laws: &[Vec<Term>], gyro: &GyroReport) -> Option<Finding> {
        let data = &self.data[step.gyro];
        let name = step.term.id(step.gyro);
        let coefficients = &gyro.extended.coefficients;
        let of = |name: &str| coefficients.iter().find(|one| one.name == name);
        let coefficient = of(name)?;
        let along = of(Term::Nominal(1).id(step.gyro)).map(|along| along.estimate);
        let (members, nearest) = alternatives(data, laws, step.term, &self.between);
        let equivalents = step.term.equivalents(step.gyro).into_iter();
        Some(Finding {
            gyro: step.gyro,
            term: step.term,
            effect: coefficient.name.clone(),
            estimate: coefficient.estimate,
            sigma: coefficient.sigma,
            unit: coefficient.unit.clone(),
            regressor: data
                .column(step.term)
                .component_mul(&data.sigma)
                .as_slice()
                .to_vec(),
            p_value: step.p_value,
            alternatives: members,
            nearest_ruled_out: nearest,
            equivalents: equivalents.map(str::to_owned).collect(),
            misalignment_needed_rad: match step.term {
                Term::Cross(_) => along.map(|along| (coefficient.estimate / along).abs()),
                _ => None,
            },
        })
    }
}

fn undetermined(data: &WeightedStops, terms: &[Term]) -> InstrumentError {
    let names: Vec<&str> = terms.iter().map(|term| term.id(data.gyro)).collect();
    InstrumentError::unfit(
        Unfit::Undetermined,
        format!("stops that do not determine {} together", names.join(", ")),
        "each axis up, down and in between",
        "stop in more attitudes",
    )
}
