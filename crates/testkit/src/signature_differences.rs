//! Signatures of effects against finite differences of the nonlinear simulation.
//!
//! The simulator adds a hidden effect with either sign, and half the difference of the two records is
//! the change of the outputs by a unit of it. As a further column it passes the filter about the same
//! trajectory as the signature from the generated derivatives: with the same whitening the two must
//! be equal.

use gyrocal::effect::{Effect, EffectKind, Role};
use gyrocal::generated::catalogue::{EFFECTS, PARAMETERS, RATES, SHAPES};
use gyrocal_calibration::{BIASES, FittedPlatform, NoiseModel, Options, Run};
use gyrocal_hypothesis::{Column, ModelExtension};
use gyrocal_record::Record;
use gyrocal_truth::{Hidden, Scenario, simulate};
use nalgebra::{DMatrix, DVector};

/// Failure of a comparison.
pub type Error = Box<dyn std::error::Error + Send + Sync>;

/// Change of the outputs: the second order of a central difference cancels, the third is 1e-9 of it,
/// and the simulator's error of 1e-12 rad is 1e-7 of it.
const MOVED_G: f64 = 3e-5;

/// Drift coefficients: the first columns, nuisance parameters of every fit.
const COEFFICIENTS: usize = gyrocal::Platform::PARAMETERS;

/// A signature with the coefficients projected out is compared if at least this part of it is left:
/// below, it is not observable.
const LEAST_PART: f64 = 1e-3;

/// One signature compared with its finite difference.
#[derive(Clone, Debug)]
pub struct Compared {
    /// Id of the parameter, with onset, time constant or axis.
    pub name: String,
    /// Whether it is of the rate of change of the temperature, which is estimated as a slope over many rows.
    pub is_of_slope: bool,
    /// Norm of the difference over that of the finite difference, both whitened.
    pub error: f64,
    /// The same with the nine coefficients projected out; `None` if next to nothing is left.
    pub projected: Option<f64>,
}

/// A parameter with a signature, and the hidden effect of the simulator that it stands for.
struct Probe {
    name: String,
    effect: &'static str,
    parameter: String,
    /// Fixed parameters: onsets and time constants.
    held: Vec<(&'static str, f64)>,
    /// Initial size, in the unit of the simulator.
    size: f64,
    /// Unit of the column over the unit of the simulator.
    unit: f64,
    signature: Signature,
}

/// Column of a signature.
enum Signature {
    Parameter(usize),
    Further(Column),
}

/// All signatures of the catalogue over the record of a scenario without noise.
pub fn compare(scenario: &Scenario) -> Result<Vec<Compared>, Error> {
    let quiet = Scenario {
        accel_noise_g: 0.0,
        gyro_noise_deg_per_h: 0.0,
        ..scenario.clone()
    };
    let record = simulate(&quiet)?.record;
    let bench = scenario.bench();
    let run = Run {
        record: &record,
        bench: &bench,
    };
    let nominal = FittedPlatform::nominal(&run, &Options::default(), &NoiseModel::default())?;
    let shaped = ModelExtension {
        shapes: (0..SHAPES.len())
            .map(|index| held_shape(index, &record))
            .collect(),
        ..nominal.extension().clone()
    };
    let fitted = nominal.refitted(&shaped)?;
    let probes = probes(&record)?;
    let mut further = Vec::new();
    let mut signatures = Vec::new();
    for probe in &probes {
        signatures.push(match &probe.signature {
            Signature::Parameter(place) => *place,
            Signature::Further(column) => {
                further.push(column.clone());
                PARAMETERS.len() + further.len() - 1
            }
        });
    }
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
        let (a, b) = (signatures[index], first + index);
        let part = left[(b, b)] / gram[(b, b)];
        Compared {
            name: probe.name.clone(),
            is_of_slope: is_of_slope(probe.effect),
            error: relative(&gram, a, b),
            projected: (part > LEAST_PART * LEAST_PART).then(|| relative(&left, a, b)),
        }
    });
    Ok(compared.collect())
}

fn is_of_slope(id: &str) -> bool {
    let mut own = EFFECTS.iter().filter(|effect| effect.id == id);
    own.any(|effect| effect.formula.contains("temperature_rate_k_per_h"))
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
    EFFECTS
        .iter()
        .filter_map(Effect::shape)
        .find(|own| own.role.shape_index() == Some(index))
        .map_or(1.0, |own| held_value(own.role, record))
}

/// Every parameter of the catalogue, and the columns that stand for steps, warm-ups, attitude jumps
/// and the initial attitude in a search.
fn probes(record: &Record) -> Result<Vec<Probe>, Error> {
    let mut probes = parameter_probes(record)?;
    let time_constants_h = [1.0, 0.5 * record.duration_s() / 3600.0];
    for gyro in 0..RATES.len() {
        for effect in EFFECTS.iter().filter(|effect| effect.rate() == Some(gyro)) {
            match effect.kind {
                EffectKind::Step => probes
                    .extend(probed_rows(record).map(|row| step_probe(record, gyro, effect, row))),
                EffectKind::Exponential => {
                    probes.extend(time_constants_h.map(|h| warm_up_probe(record, gyro, effect, h)))
                }
                _ => {}
            }
        }
    }
    for axis in 0..3 {
        probes.extend(attitude_probes(record, axis)?);
    }
    Ok(probes)
}

/// Rows of onsets: early, in the middle, and late.
fn probed_rows(record: &Record) -> [usize; 3] {
    let rows = record.len();
    [rows / 10, rows / 2, 9 * rows / 10]
}

fn since_first_s(record: &Record, row: usize) -> f64 {
    record.time_s[row] - record.time_s[0]
}

/// Every parameter of the catalogue, onsets and time constants held.
fn parameter_probes(record: &Record) -> Result<Vec<Probe>, Error> {
    let mut probes = Vec::new();
    for effect in EFFECTS.iter().filter(|effect| effect.has_term()) {
        let own = effect.shape().into_iter();
        let held: Vec<(&str, f64)> = own
            .map(|own| (own.name, held_value(own.role, record)))
            .collect();
        for parameter in effect.sizes() {
            let Role::Parameter(place) = parameter.role else {
                return Err("an effect without its parameter".into());
            };
            probes.push(Probe {
                name: PARAMETERS[place].id.to_owned(),
                effect: effect.id,
                parameter: parameter.name.to_owned(),
                held: held.clone(),
                size: effect.typical_size,
                unit: 1.0,
                signature: Signature::Parameter(place),
            });
        }
    }
    Ok(probes)
}

fn step_probe(record: &Record, gyro: usize, effect: &'static Effect, row: usize) -> Probe {
    let onset_s = since_first_s(record, row);
    Probe {
        name: format!("{} at {onset_s} s", effect.id),
        effect: effect.id,
        parameter: "size".to_owned(),
        held: vec![("onset_s", onset_s)],
        size: 0.01,
        unit: 1.0,
        signature: Signature::Further(Column::Step {
            parameter: BIASES[gyro],
            row,
        }),
    }
}

fn warm_up_probe(
    record: &Record,
    gyro: usize,
    effect: &'static Effect,
    time_constant_h: f64,
) -> Probe {
    let share = |pair: &[f64]| {
        let middle_s = 0.5 * (pair[0] + pair[1]) - record.time_s[0];
        (-middle_s / (3600.0 * time_constant_h)).exp()
    };
    Probe {
        name: format!("{} of {time_constant_h} h", effect.id),
        effect: effect.id,
        parameter: "size".to_owned(),
        held: vec![("time_constant_h", time_constant_h)],
        size: 0.01,
        unit: 1.0,
        signature: Signature::Further(Column::TimeProfile {
            parameter: BIASES[gyro],
            steps: record.time_s.windows(2).map(share).collect(),
        }),
    }
}

/// The initial attitude and attitude jumps about one axis.
fn attitude_probes(record: &Record, axis: usize) -> Result<Vec<Probe>, Error> {
    let rotation = |kind, held, signature, at: String| -> Result<Probe, Error> {
        let mut effects = EFFECTS.iter().filter(|effect| effect.kind == kind);
        let effect = effects.next().ok_or("a catalogue without states")?;
        let angle = effect.sizes().nth(axis).ok_or("an attitude of two axes")?;
        Ok(Probe {
            name: format!("{} about {}{at}", effect.id, angle.name),
            effect: effect.id,
            // The simulator names an angle with its unit.
            parameter: format!("{}_{}", angle.name, angle.unit),
            held,
            size: 0.05,
            unit: angle.scale,
            signature: Signature::Further(signature),
        })
    };
    let initial = rotation(
        EffectKind::InitialState,
        Vec::new(),
        Column::InitialState {
            row: 0,
            state: axis,
        },
        String::new(),
    );
    let jumps = probed_rows(record).map(|row| {
        // The column has the rotation at the end of the step; a jump at any time within the step
        // differs by the motion of the platform in the rest of it.
        let onset_s = since_first_s(record, row + 1);
        rotation(
            EffectKind::StateJump,
            vec![("onset_s", onset_s)],
            Column::StateJump { row, state: axis },
            format!(" at {onset_s} s"),
        )
    });
    core::iter::once(initial).chain(jumps).collect()
}

/// Change of the readings by a unit of the column.
fn change_g(quiet: &Scenario, probe: &Probe) -> Result<Vec<[f64; 3]>, Error> {
    let readings_g = |size: f64| -> Result<Vec<[f64; 3]>, Error> {
        let mut parameters: Vec<(&str, f64)> = probe.held.clone();
        parameters.push((&probe.parameter, size));
        let hidden = vec![Hidden::new(probe.effect, &parameters)?];
        let hiding = Scenario {
            hidden,
            ..quiet.clone()
        };
        Ok(simulate(&hiding)?.record.accel_g)
    };
    let difference_g = |size: f64| -> Result<Vec<[f64; 3]>, Error> {
        let (above, below) = (readings_g(size)?, readings_g(-size)?);
        let pairs = above.iter().zip(&below);
        Ok(pairs
            .map(|(a, b)| core::array::from_fn(|axis| 0.5 * (a[axis] - b[axis])))
            .collect())
    };
    let moved_g = |change: &[[f64; 3]]| {
        let values = change.iter().flatten().filter(|value| !value.is_nan());
        values.fold(0.0_f64, |most, value| most.max(value.abs()))
    };
    let coarse = moved_g(&difference_g(probe.size)?);
    if coarse == 0.0 {
        return Err(format!("{} moves no reading", probe.name).into());
    }
    let size = probe.size * MOVED_G / coarse;
    let per_unit = 1.0 / (size * probe.unit);
    let mut change = difference_g(size)?;
    for value in change.iter_mut().flatten() {
        *value *= per_unit;
    }
    Ok(change)
}
