//! The oscillator, its effects, and a least-squares fit of it.

use gyrocal_hypothesis::{
    Column, Covariate, FittedModel, ModelExtension, Plant, RateNoise, RateNoiseFit, Singular,
    StateJump, Stopped, WeightInputs,
};
use gyrocal_scalar::Element;
use gyrocal_scalar::effect::{
    Channel, Continuation, Effect, EffectKind, EffectParameter, Enters, Equivalence, Role,
};
use nalgebra::{Cholesky, DMatrix, DVector};

pub(crate) const ROWS: usize = 400;
pub(crate) const STEP_S: f64 = 60.0;
/// Unit of time of the equation, s.
const TIME_S: f64 = 600.0;
pub(crate) const NOISE: f64 = 1e-3;
/// Damping, stiffness and constant force of the simulated oscillator; then what is hidden in it.
pub(crate) const TRUTH: [f64; 6] = [0.05, 4.0, 0.1, 0.0, 0.0, 0.0];
const INITIAL: [f64; 2] = [1.0, 0.0];
const FORCE: usize = 2;
pub(crate) const CUBIC: usize = 3;
pub(crate) const STEP: usize = 4;

const fn element(name: &'static str) -> Element {
    Element {
        name,
        id: name,
        unit: "1",
        doc: "",
    }
}

const fn parameter(name: &'static str, role: Role, weight: Option<usize>) -> EffectParameter {
    EffectParameter {
        name,
        unit: "1",
        role,
        scale: 1.0,
        weight,
    }
}

const fn effect(
    id: &'static str,
    kind: EffectKind,
    parameters: &'static [EffectParameter],
) -> Effect {
    Effect {
        id,
        family: id,
        name: id,
        reference: "",
        formula: id,
        kind,
        enters: Enters::Rates(&[0]),
        parameters,
        typical_size: 0.1,
        is_nominal: false,
        default_search: true,
        needs: &[],
        equivalents: &[],
        equivalence: Equivalence {
            reason: "",
            experiment: "",
        },
        near_twins: &[],
        nested: &[],
        continuation: Continuation::Stays,
        separated_by: &[],
    }
}

static PARAMETERS: [Element; 6] = [
    element("damping"),
    element("stiffness"),
    element("force"),
    element("cubic"),
    element("step"),
    element("decay"),
];
static SHAPES: [Element; 2] = [element("onset_s"), element("time_constant_h")];
static EFFECTS: [Effect; 3] = [
    effect(
        "spring.cubic",
        EffectKind::Constant,
        &[parameter("size", Role::Parameter(CUBIC), None)],
    ),
    effect(
        "force.step",
        EffectKind::Step,
        &[
            parameter("size", Role::Parameter(STEP), Some(0)),
            parameter("onset_s", Role::Onset(Some(0)), None),
        ],
    ),
    effect(
        "force.decay",
        EffectKind::Exponential,
        &[
            parameter("size", Role::Parameter(5), Some(1)),
            parameter("time_constant_h", Role::TimeConstant(1), None),
        ],
    ),
];
static RATES: [Channel; 1] = [Channel {
    id: "force",
    name: "force",
    unit: "1",
    label: "",
    constant: FORCE,
}];
static OUTPUTS: [Channel; 1] = [Channel {
    id: "displacement",
    name: "displacement",
    unit: "1",
    label: "",
    constant: FORCE,
}];

pub(crate) static DUFFING: Plant = Plant {
    effects: &EFFECTS,
    parameters: &PARAMETERS,
    nominal_parameters: 3,
    shapes: &SHAPES,
    rates: &RATES,
    rate_states: &[1],
    outputs: &OUTPUTS,
    moving_states: 2,
    weight_count: 2,
    weights,
    natural_periods_s: &[],
};

fn weights(inputs: &WeightInputs<'_>, weights: &mut [f64]) {
    let after = (inputs.time_s - inputs.shapes[0]) / inputs.interval_s + 0.5;
    weights[0] = after.clamp(0.0, 1.0);
    weights[1] = (-inputs.time_s / (3600.0 * inputs.shapes[1])).exp();
}

/// Displacement at each row: classical Runge-Kutta, forces of time held over a step.
pub(crate) fn simulate(
    parameters: &[f64],
    extension: &ModelExtension,
    amplitudes: &[f64],
) -> Vec<f64> {
    let shapes = extension.all_shapes(&DUFFING);
    let columns = extension.columns.columns();
    let mut state = INITIAL;
    for (column, amplitude) in columns.iter().zip(amplitudes) {
        if let Column::InitialState { state: index, .. } = column {
            state[*index] += amplitude;
        }
    }
    let mut displacement = vec![state[0]];
    for row in 0..ROWS - 1 {
        let mut of_time = [0.0; 2];
        weights(
            &WeightInputs {
                time_s: (row as f64 + 0.5) * STEP_S,
                interval_s: STEP_S,
                regressors: &[],
                covariates: &[],
                shapes: &shapes,
            },
            &mut of_time,
        );
        let mut force = parameters[FORCE] + parameters[4] * of_time[0] + parameters[5] * of_time[1];
        for (column, amplitude) in columns.iter().zip(amplitudes) {
            match column {
                Column::Step { row: at, .. } if row >= *at => force += amplitude,
                Column::TimeProfile { steps, .. } => force += amplitude * steps[row],
                _ => {}
            }
        }
        let rates = |[x, v]: [f64; 2]| {
            let restoring = parameters[1] * x + parameters[CUBIC] * x * x * x;
            [v / TIME_S, (force - parameters[0] * v - restoring) / TIME_S]
        };
        let moved = |by: [f64; 2], share: f64| [0, 1].map(|i| state[i] + share * STEP_S * by[i]);
        let k1 = rates(state);
        let k2 = rates(moved(k1, 0.5));
        let k3 = rates(moved(k2, 0.5));
        let k4 = rates(moved(k3, 1.0));
        state = [0, 1].map(|i| state[i] + STEP_S / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        displacement.push(state[0]);
    }
    let outputs = columns.iter().zip(amplitudes);
    for (column, amplitude) in outputs {
        if let Column::Output { change, .. } = column {
            for (value, change) in displacement.iter_mut().zip(change.iter()) {
                *value += amplitude * change;
            }
        }
    }
    displacement
}

/// Changes parameters or amplitudes by a number.
type Change<'a> = dyn Fn(&mut [f64], &mut [f64], f64) + 'a;

/// A least-squares fit of the oscillator; the measured displacement has white noise.
#[derive(Clone)]
pub(crate) struct FittedDuffing {
    measured: Vec<f64>,
    extension: ModelExtension,
    values: Vec<f64>,
    covariance: DMatrix<f64>,
    cost: f64,
}

#[derive(Debug, PartialEq)]
pub(crate) struct NotObservable;

impl From<Singular> for NotObservable {
    fn from(_: Singular) -> Self {
        Self
    }
}

impl From<Stopped> for NotObservable {
    fn from(_: Stopped) -> Self {
        Self
    }
}

impl FittedDuffing {
    pub(crate) fn fit(
        measured: &[f64],
        extension: &ModelExtension,
        values: Vec<f64>,
    ) -> Result<Self, Singular> {
        let mut fit = Self {
            measured: measured.to_vec(),
            extension: extension.clone(),
            covariance: DMatrix::zeros(0, 0),
            cost: f64::INFINITY,
            values,
        };
        for _ in 0..8 {
            let columns = fit.own_columns();
            let innovations = fit.innovations();
            let information = columns.transpose() * &columns;
            let cholesky = Cholesky::new(information).ok_or(Singular)?;
            let change = cholesky.solve(&(columns.transpose() * &innovations));
            for (value, change) in fit.values.iter_mut().zip(change.iter()) {
                *value -= change;
            }
            fit.covariance = cholesky.inverse();
        }
        fit.cost = fit.innovations().norm_squared();
        Ok(fit)
    }

    /// All parameters of the plant, and the amplitudes of the extension's columns.
    fn parameters(&self) -> (Vec<f64>, Vec<f64>) {
        let mut all = vec![0.0; PARAMETERS.len()];
        all[..3].copy_from_slice(&self.values[..3]);
        let own = self.extension.parameters.iter();
        for ((parameter, _), value) in own.zip(&self.values[3..]) {
            all[*parameter] = *value;
        }
        let amplitudes = self.values[3 + self.extension.parameters.len()..].to_vec();
        (all, amplitudes)
    }

    fn innovations(&self) -> DVector<f64> {
        let (parameters, amplitudes) = self.parameters();
        let predicted = simulate(&parameters, &self.extension, &amplitudes);
        let pairs = self.measured.iter().zip(predicted);
        DVector::from_iterator(ROWS, pairs.map(|(measured, p)| (measured - p) / NOISE))
    }

    /// Derivatives of the innovations by parameters, then by the extension's columns, then `further`.
    fn derivatives(&self, parameters: &[usize], further: &[Column]) -> DMatrix<f64> {
        let (values, mut amplitudes) = self.parameters();
        let mut extension = self.extension.clone();
        let own = amplitudes.len();
        extension
            .columns
            .extend(further.iter().cloned(), f64::INFINITY);
        amplitudes.resize(own + further.len(), 0.0);
        let difference = |change: &Change<'_>| {
            let [above, below] = [1e-5, -1e-5].map(|by| {
                let (mut values, mut amplitudes) = (values.clone(), amplitudes.clone());
                change(&mut values, &mut amplitudes, by);
                simulate(&values, &extension, &amplitudes)
            });
            let pairs = above.into_iter().zip(below);
            DVector::from_iterator(ROWS, pairs.map(|(a, b)| (b - a) / (2e-5 * NOISE)))
        };
        let of_parameters = parameters
            .iter()
            .map(|index| difference(&|values, _, by| values[*index] += by));
        let of_columns = (0..own + further.len())
            .map(|index| difference(&|_, amplitudes, by| amplitudes[index] += by));
        let all: Vec<DVector<f64>> = of_parameters.chain(of_columns).collect();
        DMatrix::from_columns(&all)
    }

    fn own_parameters(&self) -> Vec<usize> {
        let own = self.extension.parameters.iter();
        (0..3).chain(own.map(|(parameter, _)| *parameter)).collect()
    }

    fn own_columns(&self) -> DMatrix<f64> {
        self.derivatives(&self.own_parameters(), &[])
    }

    fn gram(&self, parameters: &[usize], further: &[Column]) -> DMatrix<f64> {
        let columns = self.derivatives(parameters, further).insert_column(0, 0.0);
        let mut all = columns;
        all.set_column(0, &self.innovations());
        all.transpose() * all
    }
}

impl FittedModel for FittedDuffing {
    type Error = NotObservable;

    fn plant(&self) -> &'static Plant {
        &DUFFING
    }

    fn extension(&self) -> &ModelExtension {
        &self.extension
    }

    fn covariates(&self) -> Vec<Covariate> {
        let (parameters, amplitudes) = self.parameters();
        vec![Covariate {
            name: "displacement",
            least_range: 0.1,
            values: simulate(&parameters, &self.extension, &amplitudes),
        }]
    }

    fn values(&self) -> &[f64] {
        &self.values
    }

    fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }

    fn prior_sigma(&self) -> Vec<f64> {
        vec![f64::INFINITY; self.values.len()]
    }

    fn cost(&self) -> f64 {
        self.cost
    }

    fn refitted(&self, extension: &ModelExtension) -> Result<Self, NotObservable> {
        let (parameters, _) = self.parameters();
        let mut values = parameters[..3].to_vec();
        values.extend(
            extension
                .parameters
                .iter()
                .map(|(index, _)| parameters[*index]),
        );
        values.resize(values.len() + extension.columns.columns().len(), 0.0);
        Ok(Self::fit(&self.measured, extension, values)?)
    }

    fn rate_noise(&self) -> RateNoise {
        RateNoise {
            white: vec![1.0],
            walk: vec![0.0],
        }
    }

    // No noise drives the oscillator.
    fn walk_intervals(&self) -> Result<Vec<Option<[f64; 2]>>, NotObservable> {
        Ok(Vec::new())
    }

    fn fit_rate_noise(&self, _: &[usize], _: &[usize]) -> Result<RateNoiseFit, NotObservable> {
        Ok(RateNoiseFit {
            noise: self.rate_noise(),
            log_likelihood: -0.5 * self.cost(),
            white_sigma: vec![0.0],
            walk_sigma: vec![f64::INFINITY],
        })
    }

    fn with_rate_noise(&self, _: &RateNoise) -> Result<Self, NotObservable> {
        Ok(self.clone())
    }

    fn signatures_gram(&self, further: &[Column]) -> Result<DMatrix<f64>, NotObservable> {
        let all: Vec<usize> = (0..PARAMETERS.len()).collect();
        Ok(self.gram(&all, further))
    }

    fn conditional_gram(&self, further: &[Column]) -> Result<DMatrix<f64>, NotObservable> {
        Ok(self.gram(&self.own_parameters(), further))
    }

    fn state_jumps(&self) -> Result<Vec<Option<StateJump>>, NotObservable> {
        Ok(vec![None; ROWS])
    }
}
