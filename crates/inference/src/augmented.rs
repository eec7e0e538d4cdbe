//! Noise beyond that of a linearised record: random walks of parameters, noise of the rates, correlated noise of
//! outputs. Walks and correlated noises are further states.

use gyrocal_estimation::EstimationError;
use gyrocal_scalar::Scalar;

use crate::error::PassError;
use crate::record::{Layout, LinearisedRecord, LinearisedRows, Start, StepOf};

/// A parameter that changes as a random walk along the record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walk {
    /// Index of the parameter.
    pub parameter: usize,
    /// Variance of its change, unit squared over seconds.
    pub density: f64,
}

/// The random walks of a pass.
#[derive(Clone, Copy, Debug, Default)]
pub struct Walks<'a> {
    /// The parameters that walk.
    pub walks: &'a [Walk],
    /// Change of each of them since the first row at each row of the trajectory, by rows; empty if
    /// all are zero.
    pub changes: &'a [f64],
}

impl Walks<'_> {
    /// The change of a walk at a row.
    pub(crate) fn change(&self, row: usize, walk: usize) -> f64 {
        let place = row * self.walks.len() + walk;
        self.changes.get(place).copied().unwrap_or(0.0)
    }
}

/// Process noise of a state: its rate has white noise, which is added at the end of each step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Process {
    /// Index of the state.
    pub state: usize,
    /// Variance of its change, unit squared over seconds.
    pub density: f64,
}

/// Noise of an output beside its white noise, with the correlation e^(-t/τ) (Gauss-Markov process of first
/// order), stationary from the first row of each record on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlated {
    /// Index of the output.
    pub output: usize,
    /// Correlation time τ, s.
    pub time_s: f64,
    /// Its variance, unit squared.
    pub variance: f64,
}

/// Noise beyond that of a record. Factors of a pass are of the record's own noises, then of these in this order.
#[derive(Clone, Copy, Debug, Default)]
pub struct FurtherNoise<'a> {
    /// Parameters that walk at random about their values.
    pub walks: Walks<'a>,
    /// Process noise of states.
    pub process: &'a [Process],
    /// Correlated noise of outputs.
    pub correlated: &'a [Correlated],
}

impl FurtherNoise<'_> {
    /// Numbers of states and of noises that it adds.
    pub(crate) fn sizes(&self) -> (usize, usize) {
        let states = self.walks.walks.len() + self.correlated.len();
        (states, states + self.process.len())
    }
}

/// Share of the variance of a walk over a step that its integral over the step has.
const INTEGRAL: f64 = 1.0 / 3.0;

/// Covariance of a walk over a step with its integral, over its variance.
const WITH_INTEGRAL: f64 = 0.5;

/// A linearised record with a state more for each walk and then for each correlated noise, after the others.
///
/// Over a step of constant effect a walk adds the change of the parameter and its integral (Bar-Shalom, Li,
/// Kirubarajan, *Estimation with Applications to Tracking and Navigation*, 2001, section 6.2.2). A step whose
/// states do not depend on those before leads to another record: correlated noise begins anew there, and no
/// process noise leads to it.
pub(crate) struct Augmented<'a> {
    of: &'a dyn LinearisedRecord,
    noise: FurtherNoise<'a>,
    layout: Layout,
    /// Place of the parameter of each walk.
    places: Vec<usize>,
}

impl<'a> Augmented<'a> {
    pub(crate) fn new(
        of: &'a dyn LinearisedRecord,
        noise: FurtherNoise<'a>,
    ) -> Result<Self, EstimationError> {
        let own = of.layout();
        let walks = noise.walks.walks;
        let places: Option<Vec<usize>> =
            walks.iter().map(|walk| own.place(walk.parameter)).collect();
        let changes = noise.walks.changes.len();
        let is_size = |size: f64| size > 0.0 && size.is_finite();
        let is_process = |one: &Process| one.state < own.states && is_size(one.density);
        let is_correlated = |one: &Correlated| {
            one.output < own.outputs && is_size(one.time_s) && is_size(one.variance)
        };
        let places = places
            .filter(|_| walks.iter().all(|walk| is_size(walk.density)))
            .filter(|_| changes == 0 || changes == walks.len() * of.rows())
            .filter(|_| noise.process.iter().all(is_process))
            .filter(|_| noise.correlated.iter().all(is_correlated))
            .ok_or(EstimationError::InvalidArgument {
                expected: "walks of parameters of the record with one change a row, and noise of its states and \
                           outputs, all of positive size",
            })?;
        let (states, noises) = noise.sizes();
        Ok(Self {
            of,
            noise,
            layout: Layout {
                states: own.states + states,
                noises: own.noises + noises,
                ..own
            },
            places,
        })
    }

    /// Sets `to` to these rows with the further states.
    fn extend(&self, own: &LinearisedRows, to: &mut LinearisedRows) {
        to.clear(own.first);
        to.step_s.extend_from_slice(&own.step_s);
        to.residuals.extend_from_slice(&own.residuals);
        to.variances.extend_from_slice(&own.variances);
        to.out_by_parameters
            .extend_from_slice(&own.out_by_parameters);
        let n = own.layout.states;
        let of_outputs = own.layout.of_outputs;
        for place in 0..own.residuals.len() {
            to.out_by_states
                .extend_from_slice(&own.out_by_states[place * n..(place + 1) * n]);
            let direct = &own.out_by_parameters[place * of_outputs..][..of_outputs];
            let by_walks = self
                .places
                .iter()
                .map(|place| direct.get(*place).unwrap_or(&0.0));
            to.out_by_states.extend(by_walks);
            let output = place % own.layout.outputs;
            let by_noise = self.noise.correlated.iter();
            to.out_by_states
                .extend(by_noise.map(|one| f64::from(u8::from(one.output == output))));
        }
        for index in 0..own.step_s.len() {
            self.extend_step(own, index, to);
        }
        debug_assert_eq!(to.defects.len(), to.step_s.len() * self.layout.states);
    }

    fn extend_step(&self, own: &LinearisedRows, index: usize, to: &mut LinearisedRows) {
        let step = own.step(index);
        let (n, p) = (own.layout.states, own.layout.parameters.len());
        let (walks, correlated) = (self.places.len(), self.noise.correlated);
        let begins = n > 0 && step.by_states.iter().all(|by| *by == 0.0);
        let effect = |walk: usize, state: usize| step.by_parameters[state * p + self.places[walk]];
        for state in 0..n {
            to.by_states
                .extend_from_slice(&step.by_states[state * n..(state + 1) * n]);
            to.by_states
                .extend((0..walks).map(|walk| effect(walk, state)));
            to.by_states
                .extend(core::iter::repeat_n(0.0, correlated.len()));
        }
        let kept: Vec<f64> = correlated
            .iter()
            .map(|one| match begins {
                true => 0.0,
                false => Scalar::exp(-step.step_s / one.time_s),
            })
            .collect();
        for place in 0..walks + correlated.len() {
            let stays = place.checked_sub(walks).map_or(1.0, |one| kept[one]);
            let row =
                (0..self.layout.states).map(|state| if state == n + place { stays } else { 0.0 });
            to.by_states.extend(row);
        }
        to.by_parameters.extend_from_slice(step.by_parameters);
        to.by_parameters
            .extend(core::iter::repeat_n(0.0, (walks + correlated.len()) * p));
        to.defects.extend_from_slice(step.defects);
        let row = own.first + index;
        let changes = &self.noise.walks;
        to.defects.extend(
            (0..walks).map(|walk| changes.change(row + 1, walk) - changes.change(row, walk)),
        );
        to.defects
            .extend(core::iter::repeat_n(0.0, correlated.len()));
        let (triangle, more) = (own.layout.triangle(), self.layout.triangle());
        for share in step.shares.chunks_exact(triangle.max(1)) {
            to.shares.extend_from_slice(share);
            to.shares.extend(core::iter::repeat_n(0.0, more - triangle));
        }
        for (walk, Walk { density, .. }) in self.noise.walks.walks.iter().enumerate() {
            self.extend_by_walk(&step, n, walk, density * step.step_s, &mut to.shares);
        }
        for one in self.noise.process {
            let variance = if begins {
                0.0
            } else {
                one.density * step.step_s
            };
            self.extend_by_state(one.state, variance, &mut to.shares);
        }
        for (place, one) in correlated.iter().enumerate() {
            let variance = one.variance * (1.0 - kept[place] * kept[place]);
            self.extend_by_state(n + walks + place, variance, &mut to.shares);
        }
    }

    /// The covariance that a walk of this variance adds.
    fn extend_by_walk(
        &self,
        step: &StepOf<'_>,
        n: usize,
        walk: usize,
        variance: f64,
        shares: &mut Vec<f64>,
    ) {
        let p = self.layout.parameters.len();
        let effect = |state: usize| step.by_parameters[state * p + self.places[walk]];
        for i in 0..n {
            let integral = INTEGRAL * variance * effect(i);
            shares.extend((0..=i).map(|j| integral * effect(j)));
        }
        for further in 0..self.layout.states - n {
            let is_own = f64::from(u8::from(further == walk));
            let with_states = is_own * WITH_INTEGRAL * variance;
            shares.extend((0..n).map(|state| with_states * effect(state)));
            let others = (0..=further).map(|one| if one == walk { is_own * variance } else { 0.0 });
            shares.extend(others);
        }
    }

    /// The covariance that noise of one state adds.
    fn extend_by_state(&self, state: usize, variance: f64, shares: &mut Vec<f64>) {
        let before = shares.len();
        shares.resize(before + self.layout.triangle(), 0.0);
        shares[before + state * (state + 3) / 2] = variance;
    }
}

impl LinearisedRecord for Augmented<'_> {
    fn layout(&self) -> Layout {
        self.layout.clone()
    }

    fn rows(&self) -> usize {
        self.of.rows()
    }

    fn start(&self) -> Result<Start, EstimationError> {
        let own = self.of.start()?;
        let (n, size) = (own.deviation.len(), self.layout.states);
        let correlated = self.noise.correlated;
        let mut start = Start {
            cost: own.cost,
            ..Start::known(size)
        };
        start.deviation[..n].copy_from_slice(&own.deviation);
        for (row, own) in start
            .covariance
            .chunks_exact_mut(size)
            .zip(own.covariance.chunks_exact(n))
        {
            row[..n].copy_from_slice(own);
        }
        let first = (size, self.layout.noises);
        let first = (first.0 - correlated.len(), first.1 - correlated.len());
        let further = correlated.iter().enumerate();
        start.noises = further
            .map(|(place, one)| (first.0 + place, first.1 + place, one.variance))
            .collect();
        Ok(start)
    }

    fn visit(
        &self,
        rows: usize,
        take: &mut dyn FnMut(&LinearisedRows) -> Result<(), PassError>,
    ) -> Result<(), PassError> {
        let mut extended = LinearisedRows::new(self.layout.clone());
        self.of.visit(rows, &mut |own| {
            self.extend(own, &mut extended);
            take(&extended)
        })
    }
}
