//! Parameters that change as random walks: further states of a linearised record.

use gyrocal_estimation::EstimationError;

use crate::record::{Layout, LinearisedRecord, LinearisedRows, Start};

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

/// Share of the variance of a walk over a step that its integral over the step has.
const INTEGRAL: f64 = 1.0 / 3.0;

/// Covariance of a walk over a step with its integral, over its variance.
const WITH_INTEGRAL: f64 = 0.5;

/// A linearised record with a state more for each walk, after the others; each has a noise, after the others.
///
/// Over a step of constant effect a walk adds the change of the parameter and its integral (Bar-Shalom, Li,
/// Kirubarajan, *Estimation with Applications to Tracking and Navigation*, 2001, section 6.2.2).
pub(crate) struct WithWalks<'a> {
    of: &'a dyn LinearisedRecord,
    walks: Walks<'a>,
    layout: Layout,
    /// Place of the parameter of each walk.
    places: Vec<usize>,
}

impl<'a> WithWalks<'a> {
    pub(crate) fn new(
        of: &'a dyn LinearisedRecord,
        walks: Walks<'a>,
    ) -> Result<Self, EstimationError> {
        let own = of.layout();
        let places: Option<Vec<usize>> = walks
            .walks
            .iter()
            .map(|walk| own.place(walk.parameter))
            .collect();
        let (count, changes) = (walks.walks.len(), walks.changes.len());
        let is_good = |walk: &Walk| walk.density > 0.0 && walk.density.is_finite();
        let places = places
            .filter(|_| walks.walks.iter().all(is_good))
            .filter(|_| changes == 0 || changes == count * of.rows())
            .ok_or(EstimationError::InvalidArgument {
                expected: "walks of parameters of the record with a positive density and one change a row",
            })?;
        Ok(Self {
            of,
            walks,
            layout: Layout {
                states: own.states + count,
                noises: own.noises + count,
                ..own
            },
            places,
        })
    }

    /// Sets `to` to these rows with the walks.
    fn extend(&self, own: &LinearisedRows, to: &mut LinearisedRows) {
        to.clear(own.first);
        to.step_s.extend_from_slice(&own.step_s);
        to.residuals.extend_from_slice(&own.residuals);
        to.variances.extend_from_slice(&own.variances);
        to.out_by_parameters
            .extend_from_slice(&own.out_by_parameters);
        let (n, count) = (own.layout.states, self.places.len());
        let of_outputs = own.layout.of_outputs;
        for (output, by_states) in own.out_by_states.chunks_exact(n).enumerate() {
            to.out_by_states.extend_from_slice(by_states);
            let direct = &own.out_by_parameters[output * of_outputs..][..of_outputs];
            let by_walks = self
                .places
                .iter()
                .map(|place| direct.get(*place).unwrap_or(&0.0));
            to.out_by_states.extend(by_walks);
        }
        for index in 0..own.step_s.len() {
            self.extend_step(own, index, to);
        }
        debug_assert_eq!(to.defects.len(), to.step_s.len() * (n + count));
    }

    fn extend_step(&self, own: &LinearisedRows, index: usize, to: &mut LinearisedRows) {
        let step = own.step(index);
        let (n, p, count) = (
            own.layout.states,
            own.layout.parameters.len(),
            self.places.len(),
        );
        let effect = |walk: usize, state: usize| step.by_parameters[state * p + self.places[walk]];
        for state in 0..n {
            to.by_states
                .extend_from_slice(&step.by_states[state * n..(state + 1) * n]);
            to.by_states
                .extend((0..count).map(|walk| effect(walk, state)));
        }
        for walk in 0..count {
            let stays = (0..n + count).map(|state| f64::from(u8::from(state == n + walk)));
            to.by_states.extend(stays);
        }
        to.by_parameters.extend_from_slice(step.by_parameters);
        to.by_parameters
            .extend(core::iter::repeat_n(0.0, count * p));
        to.defects.extend_from_slice(step.defects);
        let row = own.first + index;
        let change = |walk| self.walks.change(row + 1, walk) - self.walks.change(row, walk);
        to.defects.extend((0..count).map(change));
        let (triangle, more) = (own.layout.triangle(), self.layout.triangle());
        for share in step.shares.chunks_exact(triangle.max(1)) {
            to.shares.extend_from_slice(share);
            to.shares.extend(core::iter::repeat_n(0.0, more - triangle));
        }
        for (walk, Walk { density, .. }) in self.walks.walks.iter().enumerate() {
            let variance = density * step.step_s;
            for i in 0..n {
                let integral = INTEGRAL * variance * effect(walk, i);
                to.shares
                    .extend((0..=i).map(|j| integral * effect(walk, j)));
            }
            for other in 0..count {
                let is_own = f64::from(u8::from(other == walk));
                let with_states = is_own * WITH_INTEGRAL * variance;
                to.shares
                    .extend((0..n).map(|state| with_states * effect(walk, state)));
                let of_walks =
                    (0..=other).map(|one| if one == walk { is_own * variance } else { 0.0 });
                to.shares.extend(of_walks);
            }
        }
    }
}

impl LinearisedRecord for WithWalks<'_> {
    fn layout(&self) -> Layout {
        self.layout.clone()
    }

    fn rows(&self) -> usize {
        self.of.rows()
    }

    fn start(&self) -> Result<Start, EstimationError> {
        let own = self.of.start()?;
        let (n, size) = (own.deviation.len(), self.layout.states);
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
        Ok(start)
    }

    fn visit(
        &self,
        rows: usize,
        take: &mut dyn FnMut(&LinearisedRows) -> Result<(), EstimationError>,
    ) -> Result<(), EstimationError> {
        let mut extended = LinearisedRows::new(self.layout.clone());
        self.of.visit(rows, &mut |own| {
            self.extend(own, &mut extended);
            take(&extended)
        })
    }
}
