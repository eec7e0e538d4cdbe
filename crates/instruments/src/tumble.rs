//! The multi-position drift test: the drift law fitted to gyro outputs at rest in many attitudes.

mod basis;
mod controls;
mod gain;
mod prepare;
mod regression;
mod rivals;
mod search;

use gyrocal::EARTH_RATE_RAD_PER_S;
use gyrocal_statistics::{chi_square_tail, f_tail};
use serde::Serialize;

pub use basis::Term;
pub use controls::{Controls, controls};
pub use gain::{Gain, gain};
pub use prepare::{Prepared, SensorReport, prepare};
pub use rivals::Rival;
pub use search::{LEAST_FALSE_ALARM, SearchSettings, Step, search};

use crate::average::Stop;
use crate::error::{MeasuredError, Unfit};
use crate::norms::AccelCalibration;
use regression::Whitened;
use search::terms_of;

/// Gyro rates and specific force at stops.
#[derive(Debug, Clone, PartialEq)]
pub struct Positions {
    /// Time of each stop.
    pub time_s: Vec<f64>,
    /// Output of each gyro about its own input axis, less what is known of Earth rate.
    pub rate_deg_per_h: Vec<[f64; 3]>,
    /// Standard errors of these.
    pub sigma_deg_per_h: Vec<[f64; 3]>,
    /// Specific force along the axes of the accelerometers.
    pub force_g: Vec<[f64; 3]>,
}

/// What is known of the sensors and the site.
#[derive(Debug, Clone, PartialEq)]
pub struct Instrument {
    /// The accelerometers' calibration, unless the log is in g already.
    pub accel: Option<AccelCalibration>,
    /// Outputs of the gyros in one rad/s.
    pub outputs_per_rad_per_s: [f64; 3],
    /// Latitude, if Earth rate is to be taken off.
    pub latitude_deg: Option<f64>,
}

impl Positions {
    /// Takes the means of stops to physical units.
    ///
    /// Attitude from gravity alone leaves the heading open. Of Earth rate the vertical part is
    /// known then, Ω sin φ along specific force, and is taken off; the horizontal part, Ω cos φ
    /// in a direction that is not known, counts as an error of each stop with the variance that
    /// a random heading gives: (Ω cos φ)² (1 - a²) / 2 for a gyro with specific force a along
    /// its input axis.
    #[must_use]
    pub fn new(stops: &[Stop], instrument: &Instrument) -> Self {
        let deg_per_h = instrument
            .outputs_per_rad_per_s
            .map(|outputs| per_hour(1.0 / outputs));
        let force = |stop: &Stop| match &instrument.accel {
            Some(calibration) => calibration.force_g(stop.accel),
            None => stop.accel,
        };
        let force_g: Vec<[f64; 3]> = stops.iter().map(force).collect();
        let (vertical, horizontal) = match instrument.latitude_deg {
            Some(latitude_deg) => {
                let earth_deg_per_h = per_hour(EARTH_RATE_RAD_PER_S);
                let (sine, cosine) = latitude_deg.to_radians().sin_cos();
                (earth_deg_per_h * sine, earth_deg_per_h * cosine)
            }
            None => (0.0, 0.0),
        };
        let rate = |(stop, force_g): (&Stop, &[f64; 3])| {
            core::array::from_fn(|gyro| {
                stop.gyro[gyro] * deg_per_h[gyro] - vertical * force_g[gyro]
            })
        };
        let sigma = |(stop, force_g): (&Stop, &[f64; 3])| {
            core::array::from_fn(|gyro| {
                let across = (1.0 - force_g[gyro].powi(2)).max(0.0);
                let noise = stop.gyro_sigma[gyro] * deg_per_h[gyro];
                (noise.powi(2) + 0.5 * across * horizontal.powi(2)).sqrt()
            })
        };
        Self {
            time_s: stops.iter().map(|stop| stop.time_s).collect(),
            rate_deg_per_h: stops.iter().zip(&force_g).map(rate).collect(),
            sigma_deg_per_h: stops.iter().zip(&force_g).map(sigma).collect(),
            force_g,
        }
    }
}

fn per_hour(rad_per_s: f64) -> f64 {
    rad_per_s.to_degrees() * 3600.0
}

/// How the laws are judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TumbleSettings {
    /// How findings are tested.
    pub search: SearchSettings,
    /// Stops in a row that are left out together when the gain is measured.
    pub left_out: usize,
    /// Shuffled data sets of the control.
    pub shuffles: usize,
    /// Probability that a set of rivals holds the true term.
    pub coverage: f64,
}

impl Default for TumbleSettings {
    fn default() -> Self {
        Self {
            search: SearchSettings::default(),
            left_out: 4,
            shuffles: 100,
            coverage: 0.95,
        }
    }
}

/// What a multi-position test says of the gyros.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TumbleReport {
    /// Number of stops.
    pub stops: usize,
    /// Each gyro's laws.
    pub gyros: Vec<GyroReport>,
    /// What the nominal law leaves out, in the order in which it was found.
    pub findings: Vec<Finding>,
    /// What the extension is worth; `None` without findings, or with too few stops.
    pub gain: Option<Gain>,
    /// What was found where nothing should be.
    pub controls: Controls,
}

/// The laws of one gyro.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GyroReport {
    /// Its name.
    pub gyro: String,
    /// The nominal law.
    pub nominal: LawReport,
    /// The law with what was found.
    pub extended: LawReport,
    /// The nominal law against all terms of the catalogue.
    pub nominal_against_catalogue: FTest,
    /// The extended law against all terms of the catalogue.
    pub extended_against_catalogue: FTest,
    /// Terms of the catalogue that the attitudes of the stops do not determine beside the others.
    pub undetermined: Vec<String>,
}

/// One law, fitted.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LawReport {
    /// Its coefficients.
    pub coefficients: Vec<CoefficientReport>,
    /// Sum of squares of residuals over standard errors.
    pub chi_square: f64,
    /// Degrees of freedom.
    pub degrees_of_freedom: f64,
    /// Probability of a larger sum if the law is right and the standard errors are.
    pub p_value: f64,
    /// Scatter of the stops beyond their standard errors that the law leaves.
    pub excess_deg_per_h: f64,
    /// Residual of each stop \[deg/h\].
    pub residuals_deg_per_h: Vec<f64>,
}

/// A coefficient of a law.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CoefficientReport {
    /// Its name.
    pub name: String,
    /// The estimate.
    pub estimate: f64,
    /// Standard deviation, with the excess scatter.
    pub sigma: f64,
    /// Unit of both.
    pub unit: String,
}

/// An F test of a law against a larger one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FTest {
    /// The statistic.
    pub f: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: [f64; 2],
    /// Probability of a larger one if the smaller law is right.
    pub p_value: f64,
}

/// A term that the nominal law leaves out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// Its name.
    pub effect: String,
    /// Its coefficient in the extended law.
    pub estimate: f64,
    /// Standard deviation of it.
    pub sigma: f64,
    /// Unit of both.
    pub unit: String,
    /// What the coefficient multiplies at each stop.
    pub regressor: Vec<f64>,
    /// F statistic when it was found.
    pub f: f64,
    /// Probability of as large a statistic by chance anywhere in the search.
    pub p_value: f64,
    /// Terms that explain the stops as well within the coverage.
    pub rivals: Vec<Rival>,
    /// The nearest term that is ruled out.
    pub nearest_ruled_out: Option<Rival>,
    /// Largest deficit of a rival.
    pub deficit_limit: f64,
    /// Terms that no record can tell from it.
    pub equivalents: Vec<String>,
    /// By how much accelerometer axes would have to be turned for the along-axis term to look
    /// like this cross-axis one \[rad\].
    pub misalignment_needed_rad: Option<f64>,
}

/// Fits, searches, tests and controls.
///
/// # Errors
///
/// [`Unfit::TooShort`] if the stops are fewer than the catalogue needs; [`Unfit::Undetermined`]
/// if their attitudes do not determine the nominal law.
pub fn tumble(
    positions: &Positions,
    settings: &TumbleSettings,
) -> Result<TumbleReport, MeasuredError> {
    let stops = positions.time_s.len();
    let largest = Term::NOMINAL.len() + Term::catalogue(0).len();
    let fewest = largest + 3;
    if stops < fewest {
        return Err(MeasuredError::unfit(
            Unfit::TooShort,
            format!("{stops} static stops"),
            format!("at least {fewest} for the {largest} terms of the catalogue"),
            "stop in more attitudes",
        ));
    }
    let all: Vec<usize> = (0..stops).collect();
    let steps = search(positions, &all, &settings.search);
    let mut gyros = Vec::new();
    for gyro in 0..3 {
        gyros.push(gyro_report(&Whitened::of(positions, gyro, &all), &steps)?);
    }
    let findings = steps
        .iter()
        .filter_map(|step| {
            let data = Whitened::of(positions, step.gyro, &all);
            finding(&data, step, &steps, &gyros[step.gyro], settings)
        })
        .collect();
    let gain = match steps.is_empty() {
        true => None,
        false => gain(positions, settings.left_out, &settings.search),
    };
    let controls = controls(positions, &steps, settings.shuffles, &settings.search);
    Ok(TumbleReport {
        stops,
        gyros,
        findings,
        gain,
        controls,
    })
}

fn gyro_report(data: &Whitened, steps: &[Step]) -> Result<GyroReport, MeasuredError> {
    let extended = terms_of(steps, data.gyro);
    let (everything, undetermined) = determined_terms(data);
    Ok(GyroReport {
        gyro: format!("gyro_{}", basis::AXES[data.gyro]),
        nominal: law_report(data, &Term::NOMINAL)?,
        nominal_against_catalogue: f_test(data, &Term::NOMINAL, &everything)?,
        extended_against_catalogue: f_test(data, &extended, &everything)?,
        extended: law_report(data, &extended)?,
        undetermined: undetermined
            .into_iter()
            .map(|term| term.id(data.gyro))
            .collect(),
    })
}

/// The nominal law with the terms of the catalogue that the stops determine beside it, and those
/// that they do not.
fn determined_terms(data: &Whitened) -> (Vec<Term>, Vec<Term>) {
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

fn law_report(data: &Whitened, terms: &[Term]) -> Result<LawReport, MeasuredError> {
    let with_standard_errors = data.fit(terms).ok_or_else(|| undetermined(data, terms))?;
    let data = &data.with_excess_of(terms);
    let fit = data.fit(terms).ok_or_else(|| undetermined(data, terms))?;
    let coefficients = terms.iter().enumerate().map(|(i, term)| CoefficientReport {
        name: term.id(data.gyro),
        estimate: fit.estimates[i],
        sigma: fit.cofactors[(i, i)].sqrt(),
        unit: term.unit(data.gyro).to_owned(),
    });
    let chi_square = with_standard_errors.chi_square;
    let chance = chi_square_tail(chi_square, fit.freedom).unwrap_or(f64::NAN);
    Ok(LawReport {
        coefficients: coefficients.collect(),
        chi_square,
        degrees_of_freedom: fit.freedom,
        p_value: chance,
        excess_deg_per_h: data.excess_deg_per_h,
        residuals_deg_per_h: fit.residuals.component_mul(&data.sigma).as_slice().to_vec(),
    })
}

fn f_test(data: &Whitened, law: &[Term], larger: &[Term]) -> Result<FTest, MeasuredError> {
    // The weights of both are those that the larger law leaves.
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

fn undetermined(data: &Whitened, terms: &[Term]) -> MeasuredError {
    let names: Vec<String> = terms.iter().map(|term| term.id(data.gyro)).collect();
    MeasuredError::unfit(
        Unfit::Undetermined,
        format!("stops that do not determine {} together", names.join(", ")),
        "each axis up, down and in between",
        "stop in more attitudes",
    )
}

fn finding(
    data: &Whitened,
    step: &Step,
    steps: &[Step],
    gyro: &GyroReport,
    settings: &TumbleSettings,
) -> Option<Finding> {
    let law = terms_of(steps, data.gyro);
    let place = law.iter().position(|term| *term == step.term)?;
    let coefficient = gyro.extended.coefficients.get(place)?;
    let seed = settings.search.seed;
    let data = &data.with_excess_of(&law);
    let rivals = rivals::rivals(data, &law, step.term, settings.coverage, seed)?;
    let along = gyro.extended.coefficients.get(1)?.estimate;
    Some(Finding {
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
        rivals: rivals.members,
        nearest_ruled_out: rivals.nearest,
        deficit_limit: rivals.limit,
        equivalents: step.term.equivalents(data.gyro),
        misalignment_needed_rad: match step.term {
            Term::Cross(_) => Some((coefficient.estimate / along).abs()),
            _ => None,
        },
    })
}
