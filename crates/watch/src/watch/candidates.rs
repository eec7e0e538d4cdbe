//! The effects that an alarm may come from.

use gyrocal_scalar::Real;

use super::Watch;
use crate::evidence::least_of_set;

/// An effect with its best onset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate<T> {
    /// Index among the effects; beyond them, among the moving states that jump.
    pub effect: usize,
    /// S² / I: twice the logarithm of the likelihood ratio.
    pub deviance: T,
    /// Estimate of the size.
    pub estimate: T,
    /// Its standard deviation, from the declared noise.
    pub sigma: T,
    /// Steps since the onset.
    pub steps_since: u32,
    /// Slot of the onset.
    pub slot: usize,
}

impl<
    T: Real,
    const M: usize,
    const Y: usize,
    const N: usize,
    const D: usize,
    const E: usize,
    const O: usize,
    const K: usize,
    const L: usize,
> Watch<T, M, Y, N, D, E, O, K, L>
{
    /// The effect with its best onset, jumps following the effects; `None` while nothing is known
    /// of it.
    #[must_use]
    pub fn candidate(&self, effect: usize) -> Option<Candidate<T>> {
        let mut best: Option<Candidate<T>> = None;
        let mut take = |slot, steps_since, score: T, information: T| {
            if !information.is_positive() {
                return;
            }
            let deviance = score * score / information;
            if best.is_none_or(|best| deviance > best.deviance) {
                best = Some(Candidate {
                    effect,
                    deviance,
                    estimate: score / information,
                    sigma: T::from_f64(1.0) / information.sqrt(),
                    steps_since,
                    slot,
                });
            }
        };
        if effect < E {
            for slot in 0..O {
                let live = self
                    .weights
                    .get(slot)
                    .is_some_and(|weight| *weight > T::ZERO);
                let (true, Some(age)) = (live, self.age(slot)) else {
                    continue;
                };
                if let Some(cell) = self.signatures.cell(slot, effect) {
                    let steps = (age + 1).saturating_mul(self.settings.block_steps) + self.step;
                    let score = self.scores.score(slot, effect);
                    take(slot, steps, score, cell.information);
                }
            }
        } else {
            for slot in 0..K {
                let spans = (self.span as usize + K - slot) % K;
                let steps = spans as u32 * self.settings.span_steps + self.span_step;
                let cell = self.jumps.cell(slot);
                let information = cell.and_then(|cell| cell.information.get(effect - E));
                let scores = self.jump_scores.scores(slot);
                if let (Some(information), Some(score)) = (information, scores.get(effect - E)) {
                    take(slot, steps, *score, *information);
                }
            }
        }
        best
    }

    /// Calls `each` with the candidates whose deviance is at least [`least_of_set`]: the effects that
    /// cannot be told apart.
    pub fn candidates(&self, width: T, mut each: impl FnMut(Candidate<T>)) {
        let mut largest = T::ZERO;
        for effect in 0..E + M {
            if let Some(candidate) = self.candidate(effect) {
                largest = largest.max(candidate.deviance);
            }
        }
        let least = least_of_set(largest, width);
        for effect in 0..E + M {
            if let Some(candidate) = self.candidate(effect)
                && candidate.deviance >= least
            {
                each(candidate);
            }
        }
    }

    /// What a unit of a candidate has left in the filter by now: state minus estimate. A jump leaves
    /// it in the moving states.
    #[must_use]
    pub fn deviation(&self, candidate: &Candidate<T>) -> Option<[T; N]> {
        if candidate.effect < E {
            let age = self.age(candidate.slot)? + 1;
            return self
                .signatures
                .deviation_now(candidate.slot, candidate.effect, age);
        }
        let cell = self.jumps.cell(candidate.slot)?;
        let jump = cell.deviation.get(candidate.effect - E)?;
        let mut deviation = [T::ZERO; N];
        for (place, value) in deviation.iter_mut().zip(jump) {
            *place = *value;
        }
        Some(deviation)
    }
}
