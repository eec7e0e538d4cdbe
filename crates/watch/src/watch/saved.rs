//! State of a watch as numbers and counters, to save and to restore it.

use gyrocal_scalar::Real;

use super::Watch;

/// Counters of a watch: [`Watch::counters`].
pub type Counters = [u32; 8];

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
    /// Numbers of its state.
    pub const NUMBERS: usize = 2 * (N * N + 2 * N * D + L + D * D + 1)
        + 4 * E
        + O * E * (N + 2)
        + 2 * (N + D)
        + 4 * M * M
        + K * M * (M + 2)
        + 2 * M
        + O
        + K
        + 4;

    /// Calls `put` with the numbers of its state, [`Self::NUMBERS`] in all.
    pub fn save(&self, put: &mut dyn FnMut(T)) {
        self.signatures.numbers(put);
        for slice in self.scores.numbers() {
            slice.iter().for_each(|number| put(*number));
        }
        self.jumps.numbers(put);
        for slice in self.jump_scores.numbers() {
            slice.iter().for_each(|number| put(*number));
        }
        let rest = [
            &self.weights[..],
            &self.jump_weights,
            &self.sums,
            &self.statistics,
        ];
        rest.into_iter().flatten().for_each(|number| put(*number));
    }

    /// Where it stands in its blocks and spans, and which of each pair is gathered.
    #[must_use]
    pub fn counters(&self) -> Counters {
        let second = [
            self.signatures.is_second(),
            self.scores.is_second(),
            self.jumps.is_second(),
            self.jump_scores.is_second(),
        ];
        let mut flags = 0;
        for (bit, flag) in second.into_iter().enumerate() {
            flags |= u32::from(flag) << bit;
        }
        [
            self.block,
            self.step,
            self.slot as u32,
            self.effect as u32,
            self.span,
            self.span_step,
            self.jump_slot as u32,
            flags,
        ]
    }

    /// True after a start.
    #[must_use]
    pub fn has_started(&self) -> bool {
        self.settings.block_steps > 0
    }

    /// True if a watch that has started with the same settings can stand there.
    #[must_use]
    pub fn can_stand_at(&self, counters: &Counters) -> bool {
        let [_, step, slot, effect, _, span_step, jump_slot, flags] = *counters;
        step <= self.settings.block_steps
            && slot as usize <= O
            && (effect as usize) < E.max(1)
            && span_step <= self.settings.span_steps
            && jump_slot as usize <= K
            && flags < 16
    }

    /// Takes the state of [`Self::save`] and [`Self::counters`] back, in a watch that has started with the
    /// same settings; `next` gives the numbers in their order. The steps that follow have the bits that
    /// they would have had. Settings, and with them the thresholds, are not part of the state; the onsets
    /// that have begun are, so what is left of the probability of a false alarm is, too.
    pub fn restore(&mut self, counters: &Counters, next: &mut dyn FnMut() -> T) {
        let mut take = |place: &mut T| *place = next();
        self.signatures.numbers_mut(&mut take);
        for slice in self.scores.numbers_mut() {
            slice.iter_mut().for_each(&mut take);
        }
        self.jumps.numbers_mut(&mut take);
        for slice in self.jump_scores.numbers_mut() {
            slice.iter_mut().for_each(&mut take);
        }
        let rest = [
            &mut self.weights[..],
            &mut self.jump_weights,
            &mut self.sums,
            &mut self.statistics,
        ];
        rest.into_iter().flatten().for_each(&mut take);
        let [block, step, slot, effect, span, span_step, jump_slot, flags] = *counters;
        (self.block, self.step) = (block, step);
        (self.slot, self.effect) = (slot as usize, effect as usize);
        (self.span, self.span_step) = (span, span_step);
        self.jump_slot = jump_slot as usize;
        let flag = |bit: u32| flags >> bit & 1 == 1;
        *self.signatures.second() = flag(0);
        *self.scores.second() = flag(1);
        *self.jumps.second() = flag(2);
        *self.jump_scores.second() = flag(3);
    }
}
