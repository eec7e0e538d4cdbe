//! Budget of the work of a search.
//!
//! A record that contradicts the model in more ways than the catalogue has names for makes every fit
//! long, and every round of a search finds something. A search may therefore do only so much work, in
//! passes over the record, and says what it had found when it ended. Work is in the unit of
//! [`FittedModel::work`](crate::FittedModel::work).

use core::cell::Cell;

use gyrocal_inference::stop;

/// Work of a search over that of one pass with all its signatures. A whole diagnosis of a sound record takes
/// less than six passes. The search of one with causes of a hundred standard deviations beside walks would
/// take sixty in the median. A hostile record is to take at most twenty times the work of a sound one, which
/// `cargo figures diagnosis` measures.
const PASSES: u64 = 44;

/// Work before a search that counts for nothing: that of the first fits of nearly every record. What is more
/// shortens the search, by `LONGEST_BEFORE` at most: it is long where no model fits.
const FREE_BEFORE: u64 = 4;
const LONGEST_BEFORE: u64 = 24;

/// Work after the end of a search within which what stands in the sets is still fitted, and one effect is
/// tried in the place of two.
const GRACE: u64 = 8;

/// What a search may still do.
#[derive(Clone, Debug)]
pub(crate) struct Budget {
    /// Work at which it is spent, in the unit of [`FittedModel::work`].
    end: Cell<u64>,
    is_cut: Cell<bool>,
    /// Whether it has ended a selection of effects.
    has_ended_selection: Cell<bool>,
    /// Work of one pass with all signatures.
    pass: Cell<u64>,
}

impl Budget {
    pub(crate) fn unlimited() -> Self {
        Self {
            end: Cell::new(u64::MAX),
            is_cut: Cell::new(false),
            has_ended_selection: Cell::new(false),
            pass: Cell::new(0),
        }
    }

    /// Sets the end, the pass of the first stage being done: `before` was the work until then, `on_record` so
    /// much of it on this record, and `now` is the work with that pass.
    pub(crate) fn start(&self, (before, on_record): (u64, u64), now: u64) {
        let pass = now.saturating_sub(before);
        self.pass.set(pass);
        if pass > 0 {
            self.end.set(now.saturating_add(own(pass, on_record)));
        }
    }

    /// Whether nothing more may be looked for after this `work`, or in a job that was stopped. The search is then
    /// cut.
    pub(crate) fn is_spent(&self, work: u64) -> bool {
        let is_spent = work > self.end.get() || stop::is_asked();
        self.is_cut.set(self.is_cut.get() || is_spent);
        is_spent
    }

    /// The same of a selection of effects, which then ends before it is complete.
    pub(crate) fn ends_selection(&self, work: u64) -> bool {
        let is_spent = self.is_spent(work);
        let has_ended = self.has_ended_selection.get() || is_spent;
        self.has_ended_selection.set(has_ended);
        is_spent
    }

    /// Whether a selection of effects was ended: there may be more to be named.
    pub(crate) fn has_ended_selection(&self) -> bool {
        self.has_ended_selection.get()
    }

    /// Whether not even what stands in the sets may be fitted, nor one effect in the place of two.
    pub(crate) fn is_exhausted(&self, work: u64) -> bool {
        let grace = GRACE.saturating_mul(self.pass.get());
        work > self.end.get().saturating_add(grace) || stop::is_asked()
    }

    /// Work of one pass with all signatures.
    pub(crate) fn pass(&self) -> u64 {
        self.pass.get()
    }

    /// Whether the budget has ended something.
    pub(crate) fn is_cut(&self) -> bool {
        self.is_cut.get()
    }
}

/// Work that a search may do after one pass with all signatures, of which `pass` is the work; `on_record` was
/// done before it.
fn own(pass: u64, on_record: u64) -> u64 {
    let counted = on_record.saturating_sub(FREE_BEFORE.saturating_mul(pass));
    let shortened = counted.min(LONGEST_BEFORE.saturating_mul(pass));
    PASSES.saturating_mul(pass).saturating_sub(shortened)
}

#[cfg(test)]
mod tests {
    use gyrocal_inference::Stop;

    use super::{Budget, FREE_BEFORE, GRACE, LONGEST_BEFORE, PASSES, own};

    #[test]
    fn long_fits_before_a_search_shorten_it_to_a_limit() {
        let pass = 1000;
        assert_eq!(own(pass, 0), PASSES * pass);
        assert_eq!(own(pass, FREE_BEFORE * pass), PASSES * pass);
        assert_eq!(own(pass, (FREE_BEFORE + 5) * pass), (PASSES - 5) * pass);
        let shortest = (PASSES - LONGEST_BEFORE) * pass;
        assert_eq!(own(pass, u64::MAX), shortest);
    }

    /// A budget after a first pass of `PASS`, and the work at its end.
    fn started() -> (Budget, u64) {
        let budget = Budget::unlimited();
        budget.start((200, 200), 200 + PASS);
        (budget, 200 + PASS + PASSES * PASS)
    }

    const PASS: u64 = 100;

    #[test]
    fn a_search_without_a_budget_has_no_end() {
        let budget = Budget::unlimited();
        assert!(!budget.is_spent(u64::MAX) && !budget.is_exhausted(u64::MAX));
        // A model that counts no work has none.
        budget.start((0, 0), 0);
        assert!(!budget.is_spent(u64::MAX) && !budget.is_cut());
    }

    #[test]
    fn a_search_of_a_stopped_job_has_spent_all() {
        let budget = Budget::unlimited();
        let stop = Stop::default();
        stop.over(|| {
            assert!(!budget.is_spent(0) && !budget.is_exhausted(0));
            stop.ask();
            assert!(budget.is_spent(0) && budget.is_exhausted(0) && budget.is_cut());
        });
    }

    #[test]
    fn a_comparison_that_is_ended_cuts_the_search_and_no_selection() {
        let (budget, end) = started();
        assert!(!budget.is_spent(end) && !budget.is_cut());
        assert!(budget.is_spent(end + 1) && budget.is_cut());
        assert!(!budget.has_ended_selection());
        assert!(!budget.ends_selection(end) && !budget.has_ended_selection());
        assert!(budget.ends_selection(end + 1) && budget.has_ended_selection());
        // It stays so whatever is asked later.
        assert!(!budget.ends_selection(end) && budget.has_ended_selection());
    }

    #[test]
    fn sets_are_fitted_for_some_passes_after_the_end() {
        let (budget, end) = started();
        let last = end + GRACE * PASS;
        assert!(!budget.is_exhausted(last) && budget.is_exhausted(last + 1));
        // To ask is no cut.
        assert!(!budget.is_cut());
    }
}
