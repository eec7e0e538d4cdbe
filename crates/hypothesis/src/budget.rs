//! Budget of the work of a search.
//!
//! A record that contradicts the model in more ways than the catalogue has names for makes every fit
//! long, and every round of a search finds something. A search may therefore do only so much work, in
//! passes over the record, and says what it had found when it ended.

use core::cell::Cell;

use crate::model::FittedModel;

/// Work of a search over that of one pass with all its signatures. A whole diagnosis of a sound record takes
/// less than six passes. The search of one with causes of a hundred standard deviations beside walks would
/// take sixty in the median. A hostile record is to take at most twenty times the work of a sound one, which
/// `cargo figures truth` measures.
const PASSES: u64 = 44;

/// Work before a search that counts for nothing: that of the first fits of nearly every record. What is more
/// shortens the search, by `LONGEST_BEFORE` at most: it is long where no model fits.
const FREE_BEFORE: u64 = 4;
const LONGEST_BEFORE: u64 = 24;

/// Work after the end of a search within which what stands in the sets is still fitted.
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

    /// Sets the end: `before` was the work done before the pass of the first stage, of which `fitted` is the
    /// model, and `on_record` so much of it on this record.
    pub(crate) fn start<F: FittedModel>(&self, (before, on_record): (u64, u64), fitted: &F) {
        let now = fitted.work();
        let pass = now.saturating_sub(before);
        self.pass.set(pass);
        if pass > 0 {
            self.end.set(now.saturating_add(own(pass, on_record)));
        }
    }

    /// Whether nothing more may be looked for. The search is then cut.
    pub(crate) fn is_spent<F: FittedModel>(&self, fitted: &F) -> bool {
        let is_spent = fitted.work() > self.end.get();
        self.is_cut.set(self.is_cut.get() || is_spent);
        is_spent
    }

    /// The same of a selection of effects, which then ends before it is complete.
    pub(crate) fn ends_selection<F: FittedModel>(&self, fitted: &F) -> bool {
        let is_spent = self.is_spent(fitted);
        let has_ended = self.has_ended_selection.get() || is_spent;
        self.has_ended_selection.set(has_ended);
        is_spent
    }

    /// Whether a selection of effects was ended: there may be more to be named.
    pub(crate) fn has_ended_selection(&self) -> bool {
        self.has_ended_selection.get()
    }

    /// Whether not even what stands in the sets may be fitted.
    pub(crate) fn is_exhausted<F: FittedModel>(&self, fitted: &F) -> bool {
        let grace = GRACE.saturating_mul(self.pass.get());
        fitted.work() > self.end.get().saturating_add(grace)
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
    use super::{FREE_BEFORE, LONGEST_BEFORE, PASSES, own};

    #[test]
    fn long_fits_before_a_search_shorten_it_to_a_limit() {
        let pass = 1000;
        assert_eq!(own(pass, 0), PASSES * pass);
        assert_eq!(own(pass, FREE_BEFORE * pass), PASSES * pass);
        assert_eq!(own(pass, (FREE_BEFORE + 5) * pass), (PASSES - 5) * pass);
        let shortest = (PASSES - LONGEST_BEFORE) * pass;
        assert_eq!(own(pass, u64::MAX), shortest);
    }
}
