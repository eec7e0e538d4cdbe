//! Multi-position tests of few stops: two, six, twelve.
//!
//! Too few stops tell their own scatter, so that terms are judged by the standard errors of the stops,
//! and the law is the one that the positions determine.

use gyrocal::generated::catalogue::RATES;
use gyrocal_statistics::{chi_square_tail, two_sided_p};
use serde::Serialize;

use super::positions::Positions;
use super::regression::{Fit, WeightedStops};
use super::report::CoefficientReport;
use super::terms::Term;
use crate::error::{InstrumentError, Unfit};

/// Least p-value of residuals that the standard errors of the stops explain.
const EXPLAINED: f64 = 0.01;

/// Largest decrease of the log-likelihood of an alternative: half of the 95 % quantile of chi-square with
/// one degree of freedom.
const LARGEST_DEFICIT: f64 = 1.92;

/// A term whose column the law leaves less than this share of is not distinguishable from the law.
const SMALLEST_SHARE: f64 = 0.03;

/// Result of a test with few stops.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FewPositionReport {
    /// Number of stops.
    pub stops: usize,
    /// The law of each gyro.
    pub gyros: Vec<FewPositionLaw>,
    /// Significant terms beyond the nominal laws, in the order of their significance.
    pub findings: Vec<FewPositionFinding>,
}

/// Law of one gyro.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FewPositionLaw {
    /// Name of the gyro.
    pub gyro: String,
    /// Coefficients of the determined terms of the nominal law, and of the significant ones beyond it.
    pub coefficients: Vec<CoefficientReport>,
    /// Covariance of the coefficients in their order.
    pub covariance: Vec<Vec<f64>>,
    /// Terms of the catalogue that the positions do not determine in addition to the law.
    pub undetermined: Vec<String>,
    /// Sum of squares of the residuals over the standard errors of the stops.
    pub chi_square: f64,
    /// Degrees of freedom.
    pub degrees_of_freedom: usize,
    /// Probability of a larger `chi_square`; `None` without degrees of freedom.
    pub p_value: Option<f64>,
    /// Factor of the standard deviations for scatter beyond the standard errors; 1 without any.
    pub inflation: f64,
}

/// A significant term beyond the nominal law.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FewPositionFinding {
    /// Name of the term.
    pub effect: String,
    /// Its coefficient.
    pub estimate: f64,
    /// Its standard deviation.
    pub sigma: f64,
    /// Unit of `estimate` and `sigma`.
    pub unit: String,
    /// Probability of as large a term in any of the tests of a law without it.
    pub p_value: f64,
    /// Terms that explain the stops as well in its place.
    pub alternatives: Vec<String>,
}

/// Fits the terms that the positions determine, and adds significant ones.
///
/// # Errors
///
/// [`Unfit::TooShort`] with fewer than two stops; [`Unfit::Undetermined`] if all stops are in one
/// position.
pub fn few_position_test(
    positions: &Positions,
    false_alarm_probability: f64,
) -> Result<FewPositionReport, InstrumentError> {
    let stops = positions.time_s.len();
    refuse_one_position(positions)?;
    let all: Vec<usize> = (0..stops).collect();
    let data: Vec<WeightedStops> = (0..3)
        .map(|gyro| WeightedStops::of(positions, gyro, &all))
        .collect();
    let mut laws: Vec<Vec<Term>> = data.iter().map(nominal_law).collect();
    let tests: usize = (0..3).map(|gyro| Term::catalogue(gyro).len()).sum();
    let mut found: Vec<(usize, Term, f64)> = Vec::new();
    loop {
        let best = data
            .iter()
            .zip(&laws)
            .flat_map(|(data, law)| candidates(data, law))
            .max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()));
        let Some((gyro, term, normal)) = best else {
            break;
        };
        let p_value = gyrocal_statistics::p_of_least(two_sided_p(normal), tests as f64);
        if p_value > false_alarm_probability {
            break;
        }
        laws[gyro].push(term);
        found.push((gyro, term, p_value));
    }
    let findings = found
        .iter()
        .filter_map(|(gyro, term, p_value)| finding(&data[*gyro], &laws[*gyro], *term, *p_value))
        .collect();
    let gyros = data
        .iter()
        .zip(&laws)
        .map(|(data, law)| law_report(data, law));
    Ok(FewPositionReport {
        stops,
        gyros: gyros.collect::<Result<_, _>>()?,
        findings,
    })
}

fn refuse_one_position(positions: &Positions) -> Result<(), InstrumentError> {
    /// Smaller turns hardly change a term in specific force.
    const SMALLEST_TURN_G: f64 = 0.2;
    let stops = positions.time_s.len();
    let Some(first) = positions.force_g.first() else {
        return Err(too_few(stops));
    };
    if stops < 2 {
        return Err(too_few(stops));
    }
    let apart = |force: &[f64; 3]| {
        let squares = (0..3).map(|axis| (force[axis] - first[axis]).powi(2));
        squares.sum::<f64>().sqrt()
    };
    if positions
        .force_g
        .iter()
        .any(|force| apart(force) > SMALLEST_TURN_G)
    {
        return Ok(());
    }
    Err(InstrumentError::unfit(
        Unfit::Undetermined,
        format!("{stops} stops, all in one position"),
        "at least two positions",
        "turn the instrument between stops: over by 180 degrees about a horizontal axis, or to each \
         axis up and down; `import strapdown` evaluates a log in one position",
    ))
}

fn too_few(stops: usize) -> InstrumentError {
    InstrumentError::unfit(
        Unfit::TooShort,
        format!("{stops} static stop(s)"),
        "at least two positions",
        "stop in two, six or twelve positions, or give several logs of one position each",
    )
}

/// The terms of the nominal law that the stops determine, one after the other.
fn nominal_law(data: &WeightedStops) -> Vec<Term> {
    let mut law: Vec<Term> = Vec::new();
    for term in Term::NOMINAL {
        if is_new(data, &law, term) {
            law.push(term);
        }
    }
    law
}

/// `true` if the stops determine a term in addition to a law.
fn is_new(data: &WeightedStops, law: &[Term], term: Term) -> bool {
    let column = data.column(term);
    if law.is_empty() {
        return column.norm() > 0.0;
    }
    if law.len() >= data.len() {
        return false;
    }
    let span = data.columns(law).qr().q();
    let rest = &column - &span * (span.transpose() * &column);
    rest.norm() > SMALLEST_SHARE * data.column(Term::Nominal(0)).norm()
}

/// Terms beyond a law that the stops determine, in standard deviations.
fn candidates(data: &WeightedStops, law: &[Term]) -> Vec<(usize, Term, f64)> {
    Term::catalogue(data.gyro)
        .into_iter()
        .filter(|term| !law.contains(term) && is_new(data, law, *term))
        .filter_map(|term| {
            let mut with = law.to_vec();
            with.push(term);
            let fit = fit(data, &with)?;
            let place = with.len() - 1;
            let sigma = fit.cofactors[(place, place)].sqrt();
            Some((data.gyro, term, fit.estimates[place] / sigma))
        })
        .collect()
}

/// A fit that may use every stop.
fn fit(data: &WeightedStops, terms: &[Term]) -> Option<Fit> {
    Fit::exact(&data.columns(terms), &data.rates)
}

fn law_report(data: &WeightedStops, law: &[Term]) -> Result<FewPositionLaw, InstrumentError> {
    let fit = fit(data, law).ok_or_else(|| too_few(data.len()))?;
    let freedom = data.len() - law.len();
    let p_value =
        (freedom > 0).then(|| chi_square_tail(fit.chi_square, freedom as f64).unwrap_or(f64::NAN));
    let inflation = match p_value {
        Some(p) if p < EXPLAINED => (fit.chi_square / freedom as f64).sqrt(),
        _ => 1.0,
    };
    let scale = inflation * inflation;
    let coefficients = law.iter().enumerate().map(|(i, term)| CoefficientReport {
        name: term.id(data.gyro).to_owned(),
        estimate: fit.estimates[i],
        sigma: inflation * fit.cofactors[(i, i)].sqrt(),
        unit: term.unit(data.gyro).to_owned(),
    });
    let undetermined = Term::NOMINAL
        .into_iter()
        .chain(Term::catalogue(data.gyro))
        .filter(|term| !law.contains(term) && !is_new(data, law, *term));
    Ok(FewPositionLaw {
        gyro: RATES[data.gyro].id.to_owned(),
        coefficients: coefficients.collect(),
        covariance: (0..law.len())
            .map(|row| {
                fit.cofactors
                    .row(row)
                    .iter()
                    .map(|value| scale * value)
                    .collect()
            })
            .collect(),
        undetermined: undetermined
            .map(|term| term.id(data.gyro).to_owned())
            .collect(),
        chi_square: fit.chi_square,
        degrees_of_freedom: freedom,
        p_value,
        inflation,
    })
}

fn finding(
    data: &WeightedStops,
    law: &[Term],
    term: Term,
    p_value: f64,
) -> Option<FewPositionFinding> {
    let place = law.iter().position(|other| *other == term)?;
    let report = law_report(data, law).ok()?;
    let coefficient = report.coefficients.get(place)?;
    let without: Vec<Term> = law.iter().copied().filter(|other| *other != term).collect();
    let free = Term::NOMINAL.into_iter().chain(Term::catalogue(data.gyro));
    let alternatives = free
        .filter(|other| !law.contains(other) && is_new(data, &without, *other))
        .filter(|other| {
            let mut with = without.clone();
            with.push(*other);
            fit(data, &with)
                .is_some_and(|fit| 0.5 * (fit.chi_square - report.chi_square) <= LARGEST_DEFICIT)
        });
    Some(FewPositionFinding {
        effect: coefficient.name.clone(),
        estimate: coefficient.estimate,
        sigma: coefficient.sigma,
        unit: coefficient.unit.clone(),
        p_value,
        alternatives: alternatives
            .map(|other| other.id(data.gyro).to_owned())
            .collect(),
    })
}
