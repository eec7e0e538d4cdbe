//! A pass over a linearised record: a Kalman filter on the states, with columns carried along.
//!
//! Initial states are columns, so that the covariance of the states starts at zero and grows with the
//! noise of the rates only. Without such noise the innovations are the residuals of a simulation.

use gyrocal_estimation::batch::Gram;
use gyrocal_statistics::math::ln;
use nalgebra::DMatrix;

use crate::dynamics::Linearised;
use crate::functions::Sizes;
use crate::lines::Line;

/// Variances of the noise of a record.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Variances {
    /// Of each output.
    pub(crate) outputs: Vec<f64>,
    /// Spectral density of the noise of each driven rate.
    pub(crate) inputs: Vec<f64>,
    /// Further variance of each state in each step, while a fit is on its way.
    pub(crate) loose: Option<Vec<f64>>,
}

/// One output of one row.
#[derive(Clone, Debug)]
pub(crate) struct Seen {
    pub(crate) row: usize,
    pub(crate) output: usize,
    /// Variance of the innovation.
    pub(crate) variance: f64,
    /// Gain of the states.
    pub(crate) gain: Vec<f64>,
    /// Innovation and its derivatives by the columns.
    pub(crate) innovation: Vec<f64>,
}

/// What the backward passes need.
#[derive(Clone, Debug, Default)]
pub(crate) struct Kept {
    /// Outputs in the order of the filter.
    pub(crate) seen: Vec<Seen>,
    /// For each row the deviation of the states before its outputs, and its derivatives by the columns.
    pub(crate) deviations: Vec<f64>,
    /// For each row the covariance of the states before its outputs.
    pub(crate) covariances: Vec<f64>,
}

/// Result of a pass.
#[derive(Clone, Debug)]
pub(crate) struct Reduced {
    /// Sums of products of whitened innovations and their derivatives.
    pub(crate) gram: DMatrix<f64>,
    /// Number of output values.
    pub(crate) values: usize,
    /// Sum of the logarithms of the variances of the innovations.
    pub(crate) log_variance: f64,
    pub(crate) kept: Kept,
    /// Whitened innovations of the trajectory: row, output, value.
    pub(crate) whitened: Vec<(usize, usize, f64)>,
}

/// What a pass keeps beside the Gram matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keep {
    Nothing,
    /// Whitened innovations.
    Innovations,
    /// All that backward passes need.
    All,
}

/// The filter in progress.
struct Filter<'a> {
    lin: &'a Linearised,
    noise: &'a Variances,
    lines: &'a [Line],
    /// For each line the column of its parameter among the derivatives.
    places: Vec<usize>,
    sizes: Sizes,
    /// Deviation and columns, a row for each state.
    deviations: Vec<f64>,
    covariance: Vec<f64>,
    memory: Vec<f64>,
}

/// Eliminates the states of a record.
pub(crate) fn reduce(
    lin: &Linearised,
    noise: &Variances,
    lines: &[Line],
    keep: Keep,
) -> Option<Reduced> {
    let sizes = lin.sizes?;
    let (n, y) = (sizes.states, sizes.outputs);
    let width = 1 + lines.len();
    let mut filter = Filter::new(lin, noise, lines, sizes)?;
    let mut gram = Gram::new(lines.len());
    let mut reduced = Reduced {
        gram: DMatrix::zeros(0, 0),
        values: 0,
        log_variance: 0.0,
        kept: Kept::default(),
        whitened: Vec::new(),
    };
    let mut innovation = vec![0.0; width];
    let mut whitened = vec![0.0; width];
    let mut gain = vec![0.0; n];
    let rows = lin.residuals.len() / y.max(1);
    for row in 0..rows {
        if keep == Keep::All {
            let kept = &mut reduced.kept;
            kept.deviations.extend_from_slice(&filter.deviations);
            kept.covariances.extend_from_slice(&filter.covariance);
        }
        for output in 0..y {
            if lin.residuals[row * y + output].is_nan() {
                continue;
            }
            let variance = filter.update(row, output, &mut innovation, &mut gain);
            if !(variance > 0.0 && variance.is_finite()) {
                return None;
            }
            let scale = variance.sqrt().recip();
            for (target, value) in whitened.iter_mut().zip(&innovation) {
                *target = scale * value;
            }
            gram.add(&whitened);
            reduced.values += 1;
            reduced.log_variance += ln(variance);
            match keep {
                Keep::Nothing => {}
                Keep::Innovations => reduced.whitened.push((row, output, whitened[0])),
                Keep::All => reduced.kept.seen.push(Seen {
                    row,
                    output,
                    variance,
                    gain: gain.clone(),
                    innovation: innovation.clone(),
                }),
            }
        }
        if row + 1 < rows {
            filter.predict(row);
        }
    }
    reduced.gram = gram.finish();
    reduced
        .gram
        .iter()
        .all(|value| value.is_finite())
        .then_some(reduced)
}

impl<'a> Filter<'a> {
    fn new(
        lin: &'a Linearised,
        noise: &'a Variances,
        lines: &'a [Line],
        sizes: Sizes,
    ) -> Option<Self> {
        let place = |line: &Line| match line.parameter() {
            Some(parameter) => lin.parameters.binary_search(&parameter).ok(),
            None => Some(0),
        };
        let places = lines.iter().map(place).collect::<Option<_>>()?;
        let (n, width) = (sizes.states, 1 + lines.len());
        let mut deviations = vec![0.0; n * width];
        for (column, line) in lines.iter().enumerate() {
            if let Line::Start(state) = line {
                deviations[state * width + column + 1] = 1.0;
            }
        }
        Some(Self {
            lin,
            noise,
            lines,
            places,
            sizes,
            memory: vec![0.0; n * width.max(n)],
            deviations,
            covariance: vec![0.0; n * n],
        })
    }

    /// Whether states have any noise.
    fn is_noisy(&self) -> bool {
        self.sizes.noises > 0 || self.noise.loose.is_some()
    }

    /// Updates with an output; gives the variance of its innovation.
    fn update(
        &mut self,
        row: usize,
        output: usize,
        innovation: &mut [f64],
        gain: &mut [f64],
    ) -> f64 {
        let (n, y) = (self.sizes.states, self.sizes.outputs);
        let p = self.lin.parameters.len();
        let width = innovation.len();
        let place = row * y + output;
        let by_states = &self.lin.out_by_states[place * n..(place + 1) * n];
        let by_parameters = &self.lin.out_by_parameters[place * p..(place + 1) * p];
        innovation[0] = self.lin.residuals[place];
        let lines = self.lines.iter().zip(&self.places);
        for (value, (line, place)) in innovation[1..].iter_mut().zip(lines) {
            *value = match line {
                Line::Start(_) | Line::Jump(..) => 0.0,
                Line::Parameter(_) => -by_parameters[*place],
                Line::Profile(_, steps) => {
                    let by = by_parameters[*place];
                    if by == 0.0 {
                        0.0
                    } else {
                        -by * steps.get(row).or(steps.last()).copied().unwrap_or(0.0)
                    }
                }
                Line::Output(own, change) if *own == output => {
                    -change.get(row).copied().unwrap_or(0.0)
                }
                Line::Output(..) => 0.0,
            };
        }
        for (by, deviations) in by_states.iter().zip(self.deviations.chunks_exact(width)) {
            if *by != 0.0 {
                for (value, deviation) in innovation.iter_mut().zip(deviations) {
                    *value -= by * deviation;
                }
            }
        }
        let mut variance = self.noise.outputs[output];
        if !self.is_noisy() {
            gain.fill(0.0);
            return variance;
        }
        let along = |row: &[f64]| -> f64 { row.iter().zip(by_states).map(|(a, b)| a * b).sum() };
        let cross: Vec<f64> = self.covariance.chunks_exact(n).map(along).collect();
        variance += along(&cross);
        for i in 0..n {
            gain[i] = cross[i] / variance;
            let deviations = &mut self.deviations[i * width..(i + 1) * width];
            for (deviation, value) in deviations.iter_mut().zip(&*innovation) {
                *deviation += gain[i] * value;
            }
            let row = &mut self.covariance[i * n..(i + 1) * n];
            for (own, cross) in row.iter_mut().zip(&cross) {
                *own -= gain[i] * cross;
            }
        }
        variance
    }

    /// Predicts to the next row.
    fn predict(&mut self, row: usize) {
        let (n, w) = (self.sizes.states, self.sizes.noises);
        let p = self.lin.parameters.len();
        let width = 1 + self.lines.len();
        let by_states = &self.lin.by_states[row * n * n..(row + 1) * n * n];
        let by_parameters = &self.lin.by_parameters[row * n * p..(row + 1) * n * p];
        product(by_states, &self.deviations, width, &mut self.memory);
        self.deviations.copy_from_slice(&self.memory[..n * width]);
        for i in 0..n {
            let deviations = &mut self.deviations[i * width..(i + 1) * width];
            deviations[0] -= self.lin.defects[row * n + i];
            let own = &by_parameters[i * p..(i + 1) * p];
            let lines = self.lines.iter().zip(&self.places);
            for (value, (line, place)) in deviations[1..].iter_mut().zip(lines) {
                match line {
                    Line::Start(_) | Line::Output(..) => {}
                    Line::Parameter(_) => *value += own[*place],
                    Line::Profile(_, steps) => {
                        *value += own[*place] * steps.get(row).copied().unwrap_or(0.0);
                    }
                    Line::Jump(step, state) => {
                        *value += f64::from(u8::from(*step == row && *state == i));
                    }
                }
            }
        }
        if !self.is_noisy() {
            return;
        }
        // Φ P Φᵀ, by rows of a symmetric matrix.
        product(by_states, &self.covariance, n, &mut self.memory);
        let by_noises = &self.lin.by_noises[row * n * w..(row + 1) * n * w];
        let step_s = self.lin.step_s[row];
        for i in 0..n {
            for j in 0..=i {
                let moved = (0..n).map(|k| self.memory[i * n + k] * by_states[j * n + k]);
                let driven = (0..w).map(|k| {
                    by_noises[i * w + k] * by_noises[j * w + k] * self.noise.inputs[k] / step_s
                });
                let mut sum = moved.sum::<f64>() + driven.sum::<f64>();
                if let Some(loose) = self.noise.loose.as_ref().filter(|_| i == j) {
                    sum += loose[i];
                }
                self.covariance[i * n + j] = sum;
                self.covariance[j * n + i] = sum;
            }
        }
    }
}

/// Product of a square matrix with one of as many rows, both by rows.
fn product(left: &[f64], right: &[f64], width: usize, to: &mut [f64]) {
    let n = right.len() / width;
    for i in 0..n {
        let target = &mut to[i * width..(i + 1) * width];
        target.fill(0.0);
        for j in 0..n {
            let by = left[i * n + j];
            if by != 0.0 {
                for (value, right) in target.iter_mut().zip(&right[j * width..(j + 1) * width]) {
                    *value += by * right;
                }
            }
        }
    }
}
