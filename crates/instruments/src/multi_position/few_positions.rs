//! Multi-position tests of few stops: two, six, twelve.
//!
//! Few stops hardly tell their own scatter, so that laws and terms are integrated over it
//! ([`super::between_stops`]), and the law is the one that the positions determine.

use gyrocal::generated::catalogue::RATES;
use gyrocal_statistics::{chi_square_tail, p_of_least};
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use super::between_stops::{BetweenStops, NoiseBetweenStops, TermEvidence};
use super::log_biases::with_biases;
use super::positions::Positions;
use super::regression::{Fit, WeightedStops};
use super::report::CoefficientReport;
use super::terms::Term;
use super::undetermined;
use crate::error::{InstrumentError, Unfit};

/// Largest decrease of the log-likelihood, integrated over the noise between stops, of an alternative: 97 of 100 hidden
/// terms are within it.
const LARGEST_DEFICIT: f64 = 3.0;

/// Degrees of freedom of the noise between stops, in all gyros together, below which no term is tested: two of each. The
/// share of false terms was measured from there on.
const LEAST_FREEDOM: usize = 6;

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
    /// Degrees of freedom of all gyros that tell the noise between stops beside a term of each. Of less than six no term
    /// is tested.
    pub freedom_of_noise: usize,
    /// Logs after the first that have a bias of their own in each law, which then has the bias in the first log. Zero where
    /// logs have too few stops for that: the scatter of the stops has the change of the bias too.
    pub biases_of_further_logs: usize,
    /// Significant terms beyond the nominal laws, in the order of their significance.
    pub findings: Vec<FewPositionFinding>,
}

impl FewPositionReport {
    /// Whether the stops tell the noise between them, so that a term is tested.
    #[must_use]
    pub fn tells_noise(&self) -> bool {
        self.freedom_of_noise >= LEAST_FREEDOM
    }
}

/// Law of one gyro.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FewPositionLaw {
    /// Name of the gyro.
    pub gyro: String,
    /// Coefficients of the determined terms of the nominal law, and of the significant ones beyond it. Their standard
    /// deviations are those of the noise within and between stops: intervals of 1.96 of them hold 95 %. Where no degrees
    /// of freedom are left they are those without scatter of the stops.
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
    /// Noise between stops, over which the coefficients are integrated.
    pub noise: NoiseBetweenStops,
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
    positions.refuse_still_gyros()?;
    refuse_one_position(positions)?;
    let all: Vec<usize> = (0..stops).collect();
    let data: Vec<WeightedStops> = (0..3)
        .map(|gyro| WeightedStops::of(positions, gyro, &all))
        .collect();
    let mut laws: Vec<Vec<Term>> = data.iter().map(nominal_law).collect();
    let between = BetweenStops::of(positions, &laws);
    let freedom_of_noise = between.freedom(stops, &laws);
    let mut found: Vec<(usize, Term, f64)> = Vec::new();
    let is_tested = freedom_of_noise >= LEAST_FREEDOM;
    // Each term takes one.
    while is_tested && between.freedom(stops, &laws) > 0 {
        let Some((gyro, term, p_value)) = most_significant(&between, &data, &laws) else {
            break;
        };
        if p_value > false_alarm_probability {
            break;
        }
        laws[gyro].push(term);
        found.push((gyro, term, p_value));
    }
    let gyros: Vec<FewPositionLaw> = data
        .iter()
        .map(|data| law_report(data, &laws, &between, positions))
        .collect::<Result<_, _>>()?;
    let findings = found.iter().filter_map(|(gyro, term, p_value)| {
        let place = laws[*gyro].iter().position(|other| other == term)?;
        let coefficient = gyros[*gyro].coefficients.get(place)?;
        Some(FewPositionFinding {
            effect: coefficient.name.clone(),
            estimate: coefficient.estimate,
            sigma: coefficient.sigma,
            unit: coefficient.unit.clone(),
            p_value: *p_value,
            alternatives: alternatives(&data[*gyro], &laws, *term, &between),
        })
    });
    Ok(FewPositionReport {
        stops,
        freedom_of_noise,
        biases_of_further_logs: between.biases,
        findings: findings.collect(),
        gyros,
    })
}

/// The most significant term beyond the laws, with the probability of as large a one in any test of a law without it.
fn most_significant(
    between: &BetweenStops,
    data: &[WeightedStops],
    laws: &[Vec<Term>],
) -> Option<(usize, Term, f64)> {
    let tests: usize = (0..3).map(|gyro| Term::catalogue(gyro).len()).sum();
    let of_gyro = |data: &WeightedStops| {
        let terms = open_terms(data, &laws[data.gyro], Term::catalogue(data.gyro));
        let evidence = between.terms(data.gyro, laws, &terms);
        let gyro = data.gyro;
        let pairs = terms.into_iter().zip(evidence);
        pairs.filter_map(move |(term, evidence)| Some((gyro, term, evidence?.p_value)))
    };
    let best = data
        .iter()
        .flat_map(of_gyro)
        .min_by(|a, b| a.2.total_cmp(&b.2));
    best.map(|(gyro, term, p_value)| (gyro, term, p_of_least(p_value, tests as f64)))
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
    // It is the attitudes that determine a term, however well each stop is measured.
    let column = |term: Term| data.column(term).component_mul(&data.sigma);
    let own = column(term);
    if law.is_empty() {
        return own.norm() > 0.0;
    }
    if law.len() >= data.len() {
        return false;
    }
    let columns: Vec<DVector<f64>> = law.iter().map(|term| column(*term)).collect();
    let span = DMatrix::from_columns(&columns).qr().q();
    let rest = &own - &span * span.tr_mul(&own);
    // A ramp is as long as the test; other terms are held against a g.
    let whole = match term {
        Term::Ramp => own.norm(),
        _ => column(Term::Nominal(0)).norm(),
    };
    rest.norm() > SMALLEST_SHARE * whole
}

/// Of these terms, those that the stops determine beside a law.
fn open_terms(
    data: &WeightedStops,
    law: &[Term],
    terms: impl IntoIterator<Item = Term>,
) -> Vec<Term> {
    let terms = terms.into_iter();
    terms
        .filter(|term| !law.contains(term) && is_new(data, law, *term))
        .collect()
}

fn law_report(
    data: &WeightedStops,
    laws: &[Vec<Term>],
    between: &BetweenStops,
    positions: &Positions,
) -> Result<FewPositionLaw, InstrumentError> {
    let law = &laws[data.gyro];
    let columns = match between.biases {
        0 => data.columns(law),
        _ => with_biases(data, law, positions),
    };
    // The fit may use every stop.
    let fit = Fit::exact(&columns, &data.rates).ok_or_else(|| undetermined(data, law))?;
    let integrated = between
        .law(data.gyro, laws)
        .ok_or_else(|| undetermined(data, law))?;
    let freedom = data.len() - columns.ncols();
    let p_value =
        (freedom > 0).then(|| chi_square_tail(fit.chi_square, freedom as f64).unwrap_or(f64::NAN));
    let covariance = &integrated.covariance;
    let coefficients = law.iter().enumerate().map(|(i, term)| CoefficientReport {
        name: term.id(data.gyro).to_owned(),
        estimate: integrated.estimates[i],
        sigma: covariance[(i, i)].sqrt(),
        unit: term.unit(data.gyro).to_owned(),
    });
    let of_gyro = Term::NOMINAL.into_iter().chain(Term::catalogue(data.gyro));
    // Biases of further logs may take a term up.
    let is_open = |term: &Term| {
        is_new(data, law, *term)
            && (between.biases == 0 || between.terms(data.gyro, laws, &[*term])[0].is_some())
    };
    let open = of_gyro.filter(|term| !law.contains(term) && !is_open(term));
    Ok(FewPositionLaw {
        gyro: RATES[data.gyro].id.to_owned(),
        coefficients: coefficients.collect(),
        covariance: covariance
            .row_iter()
            .map(|row| row.iter().copied().collect())
            .collect(),
        undetermined: open.map(|term| term.id(data.gyro).to_owned()).collect(),
        chi_square: fit.chi_square,
        degrees_of_freedom: freedom,
        p_value,
        noise: integrated.noise,
    })
}

/// Terms that explain the stops as well in the place of one.
fn alternatives(
    data: &WeightedStops,
    laws: &[Vec<Term>],
    term: Term,
    between: &BetweenStops,
) -> Vec<String> {
    let mut without = laws.to_vec();
    without[data.gyro].retain(|other| *other != term);
    let free = Term::NOMINAL.into_iter().chain(Term::catalogue(data.gyro));
    let mut terms = open_terms(data, &without[data.gyro], free);
    terms.retain(|other| *other != term);
    terms.insert(0, term);
    let evidence = between.terms(data.gyro, &without, &terms);
    let likelihood = |one: &Option<_>| one.as_ref().map(|one: &TermEvidence| one.log_likelihood);
    let own = evidence
        .first()
        .and_then(likelihood)
        .unwrap_or(f64::NEG_INFINITY);
    let pairs = terms.iter().zip(&evidence).skip(1);
    pairs
        .filter(|(_, one)| likelihood(one).is_some_and(|other| own - other <= LARGEST_DEFICIT))
        .map(|(other, _)| other.id(data.gyro).to_owned())
        .collect()
}
