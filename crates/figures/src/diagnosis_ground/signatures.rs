//! Signatures of all effects against finite differences of the nonlinear simulation.
//!
//! The simulator adds a hidden effect with either sign, and half the difference of the two records is
//! the change of the outputs by a unit of it. As a further column it passes the filter about the same
//! trajectory as the signature from the generated derivatives: with the same whitening the two must
//! be equal.

use gyrocal::effect::{Effect, EffectKind, Role};
use gyrocal::generated::catalogue::{EFFECTS, PARAMETERS, SHAPES};
use gyrocal_calibration::{FittedPlatform, NoiseModel, Options, Run};
use gyrocal_evaluation::{InjectedEffect, SignatureColumns};
use gyrocal_hypothesis::{Column, ModelExtension};
use gyrocal_record::Record;
use gyrocal_truth::{Population, Scenario, Temperature, simulate};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::harness::{Context, Error, Figure};

/// Seed of the population, and how many scenarios of it are compared.
const POPULATION: u64 = 8;
const SCENARIOS: u64 = 12;
const FEW: u64 = 2;

/// Largest difference of a signature to a finite difference, relative to its norm.
const TARGET: f64 = 1e-3;

/// The same of the rate of change of the temperature. Its slope over forty minutes loses 0.012 of a wave of six
/// hours, the fastest. At both ends of a record it is up to ten minutes off the row, where it errs by up to 0.17:
/// about 0.01 over three days. The records have no gaps.
const TARGET_OF_SLOPE: f64 = 0.02;

/// Change of the outputs: the second order of a central difference cancels, the third is 1e-9 of it,
/// and the simulator's error of 1e-12 rad is 1e-7 of it.
const MOVED_G: f64 = 3e-5;

/// Drift coefficients: the first columns, nuisance parameters of every fit.
const COEFFICIENTS: usize = gyrocal::Platform::PARAMETERS;

/// A signature with the coefficients projected out is compared if at least this part of it is left:
/// below, it is not observable.
const LEAST_PART: f64 = 1e-3;

/// One signature compared with its finite difference.
struct Compared {
    /// Id of the effect, with the size and the onset or the time constant.
    name: String,
    /// Whether it is of the rate of change of the temperature, which is estimated as a slope over many rows.
    is_of_slope: bool,
    /// Norm of the difference over that of the finite difference, both whitened.
    error: f64,
    /// The same with the nine coefficients projected out; `None` if next to nothing is left.
    projected: Option<f64>,
}

/// A size of an effect, and the column that is its signature.
struct Probe {
    effect: &'static Effect,
    /// Number among the sizes of the effect.
    size: usize,
    /// Onset or time constant.
    shape: Option<f64>,
    column: usize,
    /// Unit of the column over that of the size.
    unit: f64,
}

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let scenarios = context.size.records(SCENARIOS, FEW);
    let of = |number| {
        compare(&Scenario {
            duration_s: 3.0 * 86_400.0,
            temperature: Some(Temperature::default()),
            magnetic_field_gauss: Some([0.01, 0.2, -0.45]),
            ..Population::new(POPULATION).scenario(number)
        })
    };
    let each: Result<Vec<Vec<Compared>>, Error> = (0..scenarios).into_par_iter().map(of).collect();
    let (slopes, all): (Vec<Compared>, Vec<Compared>) =
        each?.into_iter().flatten().partition(|one| one.is_of_slope);
    let worst = |name: &str, target: f64, of: &[Compared], error: fn(&Compared) -> Option<f64>| {
        let errors = of.iter().filter_map(|one| Some((error(one)?, &*one.name)));
        let errors: Vec<(f64, &str)> = errors.collect();
        let worst = errors.iter().max_by(|a, b| a.0.total_cmp(&b.0));
        let (error, of) = worst.copied().unwrap_or((f64::NAN, "none"));
        let told = format!("{error:.1e} ({of})");
        let figure = Figure::told(name, &format!("<= {target}"), told, error <= target);
        let seeds = format!("population {POPULATION}, 0 to {}", scenarios - 1);
        figure.over(errors.len(), seeds)
    };
    let own = |one: &Compared| Some(one.error);
    let name = "signatures against the simulation: worst difference over norm, whitened";
    let left = "the same with the nine coefficients projected out, where a thousandth is left";
    let slope = "signatures of the rate of a logged temperature: the same difference";
    Ok(vec![
        worst(name, TARGET, &all, own),
        Figure {
            // Not asked for: what is left of a signature is smaller than the signature.
            target: String::new(),
            holds: None,
            ..worst(left, TARGET, &all, |one| one.projected)
        },
        worst(slope, TARGET_OF_SLOPE, &slopes, own),
    ])
}

/// All signatures of the catalogue over the record of a scenario without noise.
fn compare(scenario: &Scenario) -> Result<Vec<Compared>, Error> {
    let quiet = Scenario {
        accel_noise_g: 0.0,
        gyro_noise_deg_per_h: 0.0,
        ..scenario.clone()
    };
    let record = simulate(&quiet)?.record;
    let bench = scenario.bench();
    let (record, bench) = (&record, &bench);
    let run = Run { record, bench };
    let nominal = FittedPlatform::nominal(&run, &Options::default(), &NoiseModel::default())?;
    let shapes = (0..SHAPES.len()).map(|index| held_shape(index, record));
    let shaped = ModelExtension {
        shapes: shapes.collect(),
        ..nominal.extension().clone()
    };
    let fitted = nominal.refitted(&shaped)?;
    let mut columns = SignatureColumns::default();
    let probes = probes(record, &mut columns)?;
    let mut further = columns.further;
    let first = PARAMETERS.len() + further.len();
    for probe in &probes {
        let change_g = change_g(&quiet, probe)?;
        further.extend((0..3).map(|axis| Column::Output {
            output: axis,
            change: change_g.iter().map(|row| row[axis]).collect(),
        }));
    }
    let reduced = fitted.signatures(&further, |_| ())?;
    // Column 0 is the residual.
    let gram = reduced.gram.remove_row(0).remove_column(0);
    // The three readings of a probe change together.
    let together = DMatrix::from_fn(gram.nrows(), first + probes.len(), |column, place| {
        let at = column.checked_sub(first).map_or(column, |n| first + n / 3);
        f64::from(u8::from(at == place))
    });
    let gram = together.tr_mul(&gram) * together;
    let left = project(&gram, &fitted.prior_sigma())?;
    let compared = probes.iter().enumerate().map(|(index, probe)| {
        let (a, b) = (probe.column, first + index);
        let part = left[(b, b)] / gram[(b, b)];
        Compared {
            name: probe.name(),
            is_of_slope: probe.effect.formula.contains("temperature_rate_k_per_h"),
            error: relative(&gram, a, b),
            projected: (part > LEAST_PART * LEAST_PART).then(|| relative(&left, a, b)),
        }
    });
    Ok(compared.collect())
}

/// Norm of the difference of two columns over that of the second.
fn relative(gram: &DMatrix<f64>, a: usize, b: usize) -> f64 {
    let squares = gram[(a, a)] - 2.0 * gram[(a, b)] + gram[(b, b)];
    (squares.max(0.0) / gram[(b, b)]).sqrt()
}

/// Products of columns with the nine coefficients projected out as a fit with their priors does.
fn project(gram: &DMatrix<f64>, prior_sigma: &[f64]) -> Result<DMatrix<f64>, Error> {
    let weights = prior_sigma[..COEFFICIENTS]
        .iter()
        .map(|sigma| sigma.powi(-2));
    let mut inner = gram.view((0, 0), (COEFFICIENTS, COEFFICIENTS)).into_owned();
    inner += DMatrix::from_diagonal(&DVector::from_iterator(COEFFICIENTS, weights));
    let cross = gram.rows(0, COEFFICIENTS).into_owned();
    let cholesky = inner.cholesky().ok_or("the coefficients are dependent")?;
    Ok(gram - cross.transpose() * cholesky.solve(&cross))
}

/// Value at which an onset, within a step, or a time constant of the catalogue is held.
fn held_value(role: Role, record: &Record) -> f64 {
    match role {
        Role::TimeConstant(_) => record.duration_s() / 3600.0 / 6.0,
        _ => {
            let row = record.len() / 3;
            0.7 * record.time_s[row] + 0.3 * record.time_s[row + 1] - record.time_s[0]
        }
    }
}

/// The same of a shape of the model.
fn held_shape(index: usize, record: &Record) -> f64 {
    let mut shapes = EFFECTS.iter().filter_map(Effect::shape);
    let own = shapes.find(|own| own.role.shape_index() == Some(index));
    own.map_or(1.0, |own| held_value(own.role, record))
}

/// Every parameter of the catalogue, onsets and time constants held, and the columns that stand for steps, warm-ups,
/// attitude jumps and the initial attitude in a search: early, in the middle, and late.
fn probes(record: &Record, columns: &mut SignatureColumns) -> Result<Vec<Probe>, Error> {
    let mut probes = Vec::new();
    let since_first_s = |row: usize| record.time_s[row] - record.time_s[0];
    let rows = [record.len() / 10, record.len() / 2, 9 * record.len() / 10];
    for effect in EFFECTS.iter().filter(|effect| effect.has_term()) {
        let shape = effect.shape().map(|own| held_value(own.role, record));
        for (size, parameter) in effect.sizes().enumerate() {
            let Role::Parameter(column) = parameter.role else {
                return Err("an effect without its parameter".into());
            };
            probes.push(Probe {
                effect,
                size,
                shape,
                column,
                unit: 1.0,
            });
        }
    }
    for effect in &EFFECTS {
        let shapes = match effect.kind {
            EffectKind::Step => rows.map(|row| Some(since_first_s(row))).to_vec(),
            // The column has the rotation at the end of the step; a jump at any time within the step
            // differs by the motion of the platform in the rest of it.
            EffectKind::StateJump => rows.map(|row| Some(since_first_s(row + 1))).to_vec(),
            EffectKind::Exponential => [1.0, 0.5 * record.duration_s() / 3600.0].map(Some).to_vec(),
            EffectKind::InitialState => vec![None],
            _ => continue,
        };
        for shape in shapes {
            let signature = columns.signature(effect, record, shape);
            let signature = signature.ok_or("an effect without a signature")?;
            let columns = signature.columns.into_iter().enumerate();
            probes.extend(columns.map(|(size, column)| Probe {
                effect,
                size,
                shape,
                column,
                unit: signature.scale,
            }));
        }
    }
    Ok(probes)
}

impl Probe {
    fn name(&self) -> String {
        let size = self.effect.sizes().nth(self.size);
        let size = size.map_or("", |size| size.name);
        let shape = self.shape.map(|shape| format!(" at {shape:.4}"));
        let shape = shape.unwrap_or_default();
        format!("{} {size}{shape}", self.effect.id)
    }
}

/// Change of the readings by a unit of the column.
fn change_g(quiet: &Scenario, probe: &Probe) -> Result<Vec<[f64; 3]>, Error> {
    let readings_g = |size: f64| -> Result<Vec<[f64; 3]>, Error> {
        let mut sizes = vec![0.0; probe.effect.sizes().count()];
        sizes[probe.size] = size;
        let injected = InjectedEffect {
            effect: probe.effect,
            sizes,
            shape: probe.shape,
        };
        let mut hiding = quiet.clone();
        hiding.hidden = vec![injected.to_hidden()?];
        Ok(simulate(&hiding)?.record.accel_g)
    };
    let difference_g = |size: f64| -> Result<Vec<[f64; 3]>, Error> {
        let (above, below) = (readings_g(size)?, readings_g(-size)?);
        let half = |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|axis| 0.5 * (a[axis] - b[axis]));
        Ok(above.iter().zip(&below).map(half).collect())
    };
    let moved_g = |change: &[[f64; 3]]| {
        let values = change.iter().flatten().filter(|value| !value.is_nan());
        values.fold(0.0_f64, |most, value| most.max(value.abs()))
    };
    let coarse = moved_g(&difference_g(probe.effect.typical_size)?);
    if coarse == 0.0 {
        return Err(format!("{} moves no reading", probe.name()).into());
    }
    let size = probe.effect.typical_size * MOVED_G / coarse;
    let per_unit = 1.0 / (size * probe.unit);
    let mut change = difference_g(size)?;
    for value in change.iter_mut().flatten() {
        *value *= per_unit;
    }
    Ok(change)
}
