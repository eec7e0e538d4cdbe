mod candidates;
mod saved;

use gyrocal_scalar::Real;

use crate::calendar::Calendar;
use crate::evidence::{Budget, Evidence};
use crate::jumps::{JumpScores, Jumps};
use crate::scores::Scores;
use crate::signatures::Signatures;
use crate::step::Step;
use crate::table::{Course, Driven, Entry};

pub use candidates::Candidate;
pub use saved::Counters;

/// Settings of a watch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings<T, const E: usize, const M: usize> {
    /// Steps of a block: an onset begins with each.
    pub block_steps: u32,
    /// Steps between two onsets of jumps.
    pub span_steps: u32,
    /// Precision of the sizes of each effect.
    pub precision: [T; E],
    /// Precision of the sizes of jumps of each moving state.
    pub jump_precision: [T; M],
    /// False alarms of the effects.
    pub budget: Budget<T>,
    /// False alarms of jumps.
    pub jump_budget: Budget<T>,
}

/// The onsets in which the evidence is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grid {
    /// Those of blocks.
    Effects,
    /// Those of jumps.
    Jumps,
}

/// A watch over `E` effects and jumps of `M` moving states, beside a filter of `N` states and `Y`
/// outputs; `O` and `K` are the onsets that live at a time.
#[derive(Clone, Debug)]
pub struct Watch<
    T,
    const M: usize,
    const Y: usize,
    const N: usize,
    const D: usize,
    const E: usize,
    const O: usize,
    const K: usize,
    const L: usize,
> {
    signatures: Signatures<T, N, D, E, O, L>,
    scores: Scores<T, N, D, E, O>,
    jumps: Jumps<T, M, K>,
    jump_scores: JumpScores<T, M, K>,
    settings: Settings<T, E, M>,
    /// Weight of the onset in each slot; zero for none.
    weights: [T; O],
    jump_weights: [T; K],
    thresholds: [T; 2],
    /// Number of the block that is gathered, of its steps, and the next cell to take.
    block: u32,
    step: u32,
    slot: usize,
    effect: usize,
    cells_per_step: u32,
    /// The same of jumps.
    span: u32,
    span_step: u32,
    jump_slot: usize,
    sums: [T; 2],
    statistics: [T; 2],
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
    const CALENDAR: Calendar = Calendar::of_slots(O);

    /// A watch that has not started, for `static` memory.
    #[must_use]
    pub const fn unset(columns: [Driven; D], entries: [Entry; E]) -> Self {
        const { assert!(O >= 2 && K >= 1) };
        let budget = Budget {
            alpha: T::ZERO,
            onsets_per_year: T::ZERO,
            for_ever: false,
        };
        Self {
            signatures: Signatures::new(columns, entries),
            scores: Scores::new(),
            jumps: Jumps::new(),
            jump_scores: JumpScores::new(),
            settings: Settings {
                block_steps: 0,
                span_steps: 0,
                precision: [T::ZERO; E],
                jump_precision: [T::ZERO; M],
                budget,
                jump_budget: budget,
            },
            weights: [T::ZERO; O],
            jump_weights: [T::ZERO; K],
            thresholds: [T::ZERO; 2],
            block: 0,
            step: 0,
            slot: O,
            effect: 0,
            cells_per_step: 0,
            span: 0,
            span_step: 0,
            jump_slot: K,
            sums: [T::ZERO; 2],
            statistics: [T::ZERO; 2],
        }
    }

    /// Starts in place, with the courses of the effects over the first block. Returns false, and has
    /// not started, if a setting is not positive.
    #[must_use]
    pub fn start(&mut self, settings: &Settings<T, E, M>, courses: &[Course<T>; E]) -> bool {
        let mut numbers = settings.precision.iter().chain(&settings.jump_precision);
        let budgets = [settings.budget, settings.jump_budget];
        let right = numbers.all(|precision| precision.is_positive())
            && settings.block_steps > 1
            && settings.span_steps > 0
            && budgets
                .iter()
                .all(|budget| budget.alpha.is_positive() && budget.onsets_per_year.is_positive());
        if !right {
            return false;
        }
        self.settings = *settings;
        self.thresholds = [
            settings.budget.threshold(Self::CALENDAR.weight(O - 1)),
            settings.jump_budget.threshold(T::from_f64(1.0)),
        ];
        // The cells are taken in the first nine tenths of a block.
        let steps = (settings.block_steps - settings.block_steps / 10).max(1);
        self.cells_per_step = ((O * E) as u32).div_ceil(steps);
        self.block = 0;
        self.span = 0;
        self.restart(courses);
        true
    }

    /// Drops all onsets and goes on with new ones, as after an alarm. The probability of another false
    /// alarm is what the onsets from now on have a share in.
    pub fn restart(&mut self, courses: &[Course<T>; E]) {
        self.signatures.reset();
        self.scores.reset();
        self.signatures.begin(courses);
        self.jumps.reset();
        self.jump_scores.reset();
        self.weights = [T::ZERO; O];
        self.jump_weights = [T::ZERO; K];
        (self.step, self.span_step) = (0, 0);
        (self.slot, self.effect, self.jump_slot) = (O, 0, K);
        self.sums = [T::ZERO; 2];
        self.statistics = [T::ZERO; 2];
        self.begin_onset();
        self.begin_jump();
    }

    /// An onset begins with the block that is gathered.
    fn begin_onset(&mut self) {
        let slot = Self::CALENDAR.slot(self.block);
        self.signatures.restart(slot);
        self.scores.restart(slot);
        if let Some(weight) = self.weights.get_mut(slot) {
            *weight = Self::CALENDAR.weight::<T>(slot) * self.settings.budget.weight(self.block)
                / T::from_u32(E as u32);
        }
    }

    fn begin_jump(&mut self) {
        let slot = self.span as usize % K;
        self.jumps.restart(slot);
        self.jump_scores.restart(slot);
        if let Some(weight) = self.jump_weights.get_mut(slot) {
            *weight = self.settings.jump_budget.weight(self.span) / T::from_u32(M as u32);
        }
    }

    /// Takes a step of the filter, with its whitened innovation, clipped as in the filter; zero where
    /// nothing was measured. An answer is an alarm: the evidence has passed its threshold.
    #[inline(always)]
    pub fn step(&mut self, step: &Step<'_, T, M, Y, N>, innovation: &[T; Y]) -> Option<Grid> {
        let whitened = self.signatures.advance(step);
        self.scores.add(&whitened, innovation);
        let shown = self.jumps.advance(step);
        self.jump_scores.add(&shown, innovation);
        self.step = self.step.saturating_add(1);
        let mut alarm = None;
        for _ in 0..self.cells_per_step {
            if self.take_cell() {
                alarm = Some(Grid::Effects);
            }
        }
        if self.take_jumps() {
            alarm = Some(Grid::Jumps);
        }
        self.span_step += 1;
        if self.span_step >= self.settings.span_steps {
            self.end_span();
        }
        alarm
    }

    /// True after the last step of a block: [`Self::end_block`] is due.
    #[inline]
    #[must_use]
    pub fn block_is_over(&self) -> bool {
        self.step >= self.settings.block_steps
    }

    /// Steps to the end of the block.
    #[inline]
    #[must_use]
    pub fn steps_to_go(&self) -> u32 {
        self.settings.block_steps.saturating_sub(self.step)
    }

    /// Ends a block, with the courses of the effects over the next one. They must not depend on
    /// samples that are still to come.
    pub fn end_block(&mut self, next: &[Course<T>; E]) {
        self.signatures.end_block(next);
        self.scores.end_block();
        self.block = self.block.wrapping_add(1);
        self.step = 0;
        self.begin_onset();
        (self.slot, self.effect) = (0, 0);
        if let Some(sum) = self.sums.first_mut() {
            *sum = T::ZERO;
        }
    }

    fn end_span(&mut self) {
        self.jumps.end_span();
        self.jump_scores.end_span();
        self.span = self.span.wrapping_add(1);
        self.span_step = 0;
        self.begin_jump();
        self.jump_slot = 0;
        let [_, sum] = &mut self.sums;
        *sum = T::ZERO;
    }

    /// Age in blocks, at the beginning of the complete block, of the onset in a slot.
    #[inline(always)]
    fn age(&self, slot: usize) -> Option<u32> {
        let onset = Self::CALENDAR.latest(slot, self.block)?;
        self.block.checked_sub(onset)?.checked_sub(1)
    }

    /// Takes the next cell through the complete block; true for an alarm.
    #[inline(always)]
    fn take_cell(&mut self) -> bool {
        let (slot, effect) = (self.slot, self.effect);
        let Some(weight) = self.weights.get(slot).copied() else {
            return false;
        };
        self.effect += 1;
        if self.effect >= E {
            self.effect = 0;
            self.slot += 1;
        }
        if weight.is_positive()
            && let Some(age) = self.age(slot)
            && let Some(direction) = self.signatures.direction(slot, effect, age)
            && let Some(precision) = self.settings.precision.get(effect).copied()
        {
            let score = self.scores.update(slot, effect, &direction);
            self.signatures.update(slot, effect, age, &direction);
            let cell = self.signatures.cell(slot, effect);
            let information = cell.map_or(T::ZERO, |cell| cell.information);
            let value = Evidence { precision }.value(score, information);
            let [sum, _] = &mut self.sums;
            *sum = weight.mul_add(value, *sum);
        }
        if self.slot < O {
            return false;
        }
        self.statistics[0] = self.sums[0];
        self.statistics[0] >= self.thresholds[0]
    }

    /// Takes a share of the jumps through the complete span; true for an alarm.
    #[inline(always)]
    fn take_jumps(&mut self) -> bool {
        if self.jump_slot >= K {
            return false;
        }
        let newest = self.span as usize % K;
        let share = (K as u32).div_ceil(self.settings.span_steps.max(1));
        for _ in 0..share {
            let slot = self.jump_slot;
            let Some(weight) = self.jump_weights.get(slot).copied() else {
                break;
            };
            self.jump_slot += 1;
            if slot == newest || !weight.is_positive() {
                continue;
            }
            let scores = &mut self.jump_scores;
            self.jumps.update(slot, |jump, before| {
                scores.update(slot, jump, before);
            });
            let (scores, cell) = (self.jump_scores.scores(slot), self.jumps.cell(slot));
            let information = cell.map_or([T::ZERO; M], |cell| cell.information);
            for jump in 0..M {
                let precision = self.settings.jump_precision[jump];
                let value = Evidence { precision }.value(scores[jump], information[jump]);
                self.sums[1] = weight.mul_add(value, self.sums[1]);
            }
        }
        if self.jump_slot < K {
            return false;
        }
        self.statistics[1] = self.sums[1];
        self.statistics[1] >= self.thresholds[1]
    }

    /// Statistic of the effects and of jumps, over their thresholds.
    #[must_use]
    pub fn statistics(&self) -> [T; 2] {
        let [effects, jumps] = self.statistics;
        let [threshold, jump_threshold] = self.thresholds;
        [effects / threshold, jumps / jump_threshold]
    }
}
