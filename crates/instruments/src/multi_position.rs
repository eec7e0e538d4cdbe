//! The multi-position test (tumble test): the drift law fitted to gyro outputs at rest in many attitudes.
//!
//! [`prepare`] reduces a log to rates and specific force at its stops. [`multi_position_test`] fits the
//! nominal drift law of each gyro, extends it by terms of the catalogue in a forward search whose
//! p-values come from permutations, and measures the extension by cross-validation and on negative
//! controls.

mod alternatives;
mod between_stops;
mod cross_validation;
mod few_positions;
mod levels;
mod log_biases;
mod negative_controls;
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

use gyrocal::generated::catalogue::RATES;
use gyrocal_statistics::{chi_square_tail, f_tail};

pub use alternatives::Alternative;
pub use between_stops::NoiseBetweenStops;
pub use cross_validation::{CrossValidation, cross_validate};
pub use few_positions::{FewPositionFinding, FewPositionLaw, FewPositionReport, few_position_test};
pub use log_biases::LogBiases;
pub use negative_controls::{NegativeControls, negative_controls};
pub use positions::{Instrument, Positions};
pub use prepare::{PreparedTest, SensorReport, StopReport, prepare, prepare_logs};
pub use report::{CoefficientReport, FTest, Finding, GyroReport, LawReport, MultiPositionReport};
pub use result::TumbleResult;
pub use saturated_turns::SaturatedTurn;
pub use search::{LEAST_FALSE_ALARM, SearchSettings, SearchStep, search};
pub use terms::Term;

use crate::error::{InstrumentError, Unfit};
use log_biases::{log_biases, with_one_bias};
use regression::WeightedStops;
use search::terms_of;

/// Settings of a multi-position test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MultiPositionSettings {
    /// Settings of the search.
    pub search: SearchSettings,
    /// Number of successive stops that the cross-validation holds out together.
    pub left_out: usize,
    /// Number of shuffled data sets among the negative controls.
    pub shuffles: usize,
    /// Probability that a finding and its alternatives contain the true term.
    pub coverage: f64,
}

impl Default for MultiPositionSettings {
    fn default() -> Self {
        Self {
            search: SearchSettings::default(),
            left_out: 4,
            shuffles: 100,
            coverage: 0.95,
        }
    }
}

/// Stops beyond the number of terms that the scatter of stops is estimated from.
const SPARE: usize = 3;

/// Fewest stops of [`multi_position_test`]; [`few_position_test`] is for fewer.
#[must_use]
pub fn fewest_stops() -> usize {
    Term::NOMINAL.len() + Term::catalogue(0).len() + SPARE
}

/// Fits the drift laws, searches for missing terms, and validates the extended laws.
///
/// # Errors
///
/// [`Unfit::TooShort`] if the stops are fewer than the catalogue needs; [`Unfit::Undetermined`]
/// if their attitudes do not determine the nominal law.
pub fn multi_position_test(
    positions: &Positions,
    settings: &MultiPositionSettings,
) -> Result<MultiPositionReport, InstrumentError> {
    let stops = positions.time_s.len();
    let fewest = fewest_stops();
    if stops < fewest {
        return Err(InstrumentError::unfit(
            Unfit::TooShort,
            format!("{stops} static stops"),
            format!(
                "at least {fewest} for the {} terms of the catalogue",
                fewest - SPARE
            ),
            "stop in more attitudes",
        ));
    }
    positions.refuse_still_gyros()?;
    let all: Vec<usize> = (0..stops).collect();
    let biases = differing_biases(positions, settings.search.false_alarm_probability);
    let positions = &with_one_bias(positions, &biases);
    let mut steps = search(positions, &all, &settings.search);
    let cross_validation = match steps.is_empty() {
        true => None,
        false => cross_validate(positions, settings.left_out, &settings.search),
    };
    let mut not_confirmed = Vec::new();
    if cross_validation
        .as_ref()
        .is_some_and(CrossValidation::shows_no_gain)
    {
        let names = steps.iter().map(|step| step.term.id(step.gyro).to_owned());
        not_confirmed = names.collect();
        steps.clear();
    }
    let mut gyros = Vec::new();
    for gyro in 0..3 {
        gyros.push(gyro_report(
            &WeightedStops::of(positions, gyro, &all),
            &steps,
        )?);
    }
    let findings = steps
        .iter()
        .filter_map(|step| {
            let data = WeightedStops::of(positions, step.gyro, &all);
            finding(&data, step, &steps, &gyros[step.gyro], settings)
        })
        .collect();
    let controls = negative_controls(positions, &steps, settings.shuffles, &settings.search);
    Ok(MultiPositionReport {
        stops,
        gyros,
        log_biases: biases.into_iter().map(|(_, found)| found).collect(),
        findings,
        not_confirmed,
        cross_validation,
        controls,
    })
}

/// The gyros whose biases differ between logs, with a family-wise false alarm of `probability`.
fn differing_biases(positions: &Positions, probability: f64) -> Vec<(usize, LogBiases)> {
    let all: Vec<usize> = (0..positions.time_s.len()).collect();
    let gyros = (0..3).filter_map(|gyro| {
        let data = WeightedStops::of(positions, gyro, &all);
        let (law, _) = determined_terms(&data);
        let found = log_biases(positions, &data, &law, RATES[gyro].id)?;
        (3.0 * found.test.p_value <= probability).then_some((gyro, found))
    });
    gyros.collect()
}

fn gyro_report(data: &WeightedStops, steps: &[SearchStep]) -> Result<GyroReport, InstrumentError> {
    let extended = terms_of(steps, data.gyro);
    let (everything, undetermined) = determined_terms(data);
    Ok(GyroReport {
        gyro: RATES[data.gyro].id.to_owned(),
        nominal: law_report(data, &Term::NOMINAL)?,
        nominal_against_catalogue: f_test(data, &Term::NOMINAL, &everything)?,
        extended_against_catalogue: f_test(data, &extended, &everything)?,
        extended: law_report(data, &extended)?,
        undetermined: undetermined
            .into_iter()
            .map(|term| term.id(data.gyro).to_owned())
            .collect(),
    })
}

/// The nominal law with all terms of the catalogue that the stops determine in addition, and the terms
/// that they do not determine.
fn determined_terms(data: &WeightedStops) -> (Vec<Term>, Vec<Term>) {
    let mut determined = Term::NOMINAL.to_vec();
    let mut undetermined = Vec::new();
    for term in Term::catalogue(data.gyro) {
        determined.push(term);
        if data.fit(&determined).is_none() {
            undetermined.extend(determined.pop());
        }
    }
    (determined, undetermined)
}

fn law_report(data: &WeightedStops, terms: &[Term]) -> Result<LawReport, InstrumentError> {
    let with_standard_errors = data.fit(terms).ok_or_else(|| undetermined(data, terms))?;
    let data = &data.with_excess_of(terms);
    let fit = data.fit(terms).ok_or_else(|| undetermined(data, terms))?;
    let coefficients = terms.iter().enumerate().map(|(i, term)| CoefficientReport {
        name: term.id(data.gyro).to_owned(),
        estimate: fit.estimates[i],
        sigma: fit.cofactors[(i, i)].sqrt(),
        unit: term.unit(data.gyro).to_owned(),
    });
    let chi_square = with_standard_errors.chi_square;
    let p_value = chi_square_tail(chi_square, fit.freedom).unwrap_or(f64::NAN);
    Ok(LawReport {
        coefficients: coefficients.collect(),
        chi_square,
        degrees_of_freedom: fit.freedom,
        p_value,
        excess_deg_per_h: data.excess_deg_per_h,
        residuals_deg_per_h: fit.residuals.component_mul(&data.sigma).as_slice().to_vec(),
    })
}

fn f_test(data: &WeightedStops, law: &[Term], larger: &[Term]) -> Result<FTest, InstrumentError> {
    // Both laws are fitted with the excess scatter of the larger one.
    let data = &data.with_excess_of(larger);
    let small = data.fit(law).ok_or_else(|| undetermined(data, law))?;
    let large = data.fit(larger).ok_or_else(|| undetermined(data, larger))?;
    let added = small.freedom - large.freedom;
    let f = (small.chi_square - large.chi_square) / added / large.scale();
    Ok(FTest {
        f,
        degrees_of_freedom: [added, large.freedom],
        p_value: f_tail(f, [added, large.freedom]).unwrap_or(f64::NAN),
    })
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

fn finding(
    data: &WeightedStops,
    step: &SearchStep,
    steps: &[SearchStep],
    gyro: &GyroReport,
    settings: &MultiPositionSettings,
) -> Option<Finding> {
    let law = terms_of(steps, data.gyro);
    let place = law.iter().position(|term| *term == step.term)?;
    let coefficient = gyro.extended.coefficients.get(place)?;
    let seed = settings.search.seed;
    let data = &data.with_excess_of(&law);
    let found = alternatives::alternatives(data, &law, step.term, settings.coverage, seed)?;
    let along = gyro.extended.coefficients.get(1)?.estimate;
    Some(Finding {
        gyro: data.gyro,
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
        f: step.f,
        p_value: step.p_value,
        alternatives: found.members,
        nearest_ruled_out: found.nearest,
        deficit_limit: found.limit,
        equivalents: step
            .term
            .equivalents(data.gyro)
            .into_iter()
            .map(str::to_owned)
            .collect(),
        misalignment_needed_rad: match step.term {
            Term::Cross(_) => Some((coefficient.estimate / along).abs()),
            _ => None,
        },
    })
}
