//! Sizes of the watch and of its filter.

pub(crate) const STATES: usize = 12;
pub(crate) const COLUMNS: usize = 6;
pub(crate) const EFFECTS: usize = 18;
pub(crate) const ONSETS: usize = 10;
pub(crate) const JUMPS: usize = 12;
