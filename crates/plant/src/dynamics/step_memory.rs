//! Memory of a step with derivatives.

use crate::functions::{RatesAt, Sizes};
use crate::late::LateInput;

impl RatesAt {
    /// Sets the derivatives by a dead time, from those by what makes the input late.
    pub(super) fn set_by_time(&mut self, late: &LateInput, parameters: usize) {
        for by in self.by_parameters.chunks_exact_mut(parameters) {
            by[late.delay.time] = by[late.delay.constant] * late.by_time;
        }
    }
}

/// Memory of a step with derivatives by states, parameters and noises.
pub(super) struct StepMemory {
    pub(super) states: Vec<f64>,
    pub(super) stage: Vec<f64>,
    pub(super) rates: RatesAt,
    pub(super) by_all: Vec<f64>,
    pub(super) moved: Vec<f64>,
    pub(super) slope: Vec<f64>,
    pub(super) sum: Vec<f64>,
}

impl StepMemory {
    pub(super) fn new(sizes: Sizes, wanted: usize) -> Self {
        let n = sizes.states;
        let all = vec![0.0; n * (n + wanted + sizes.noises)];
        Self {
            states: vec![0.0; n],
            stage: vec![0.0; n],
            rates: RatesAt::new(sizes),
            by_all: all.clone(),
            moved: all.clone(),
            slope: all.clone(),
            sum: all,
        }
    }

    /// Derivatives of the rates along the moved derivatives of the states.
    pub(super) fn set_slope(&mut self, sizes: Sizes, wanted: &[usize]) {
        let (n, w) = (sizes.states, sizes.noises);
        let p = wanted.len();
        let columns = n + p + w;
        for i in 0..n {
            let slope = &mut self.slope[i * columns..(i + 1) * columns];
            slope[..n].fill(0.0);
            let by = &self.rates.by_parameters[i * sizes.parameters..(i + 1) * sizes.parameters];
            for (slope, index) in slope[n..n + p].iter_mut().zip(wanted) {
                *slope = by[*index];
            }
            slope[n + p..].copy_from_slice(&self.rates.by_noises[i * w..(i + 1) * w]);
            for j in 0..n {
                let by = self.rates.by_states[i * n + j];
                if by != 0.0 {
                    let moved = &self.moved[j * columns..(j + 1) * columns];
                    for (slope, moved) in slope.iter_mut().zip(moved) {
                        *slope += by * moved;
                    }
                }
            }
        }
    }
}
