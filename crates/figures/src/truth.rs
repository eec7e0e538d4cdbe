//! Truth of the diagnosis outside of the population that its constants were tuned on.

pub(crate) mod causes;
mod drawn;
pub(crate) mod hostile;
mod judged;
pub(crate) mod noise;
pub(crate) mod outside;
pub(crate) mod setup;
pub(crate) mod shapes;
pub(crate) mod together;

use crate::harness::{Context, Size};

/// How much is measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    /// The small version: a few records.
    pub(crate) small: bool,
    /// Most records of a cell of the full version.
    pub(crate) most: Option<u64>,
}

impl Extent {
    pub(crate) fn of(context: &Context) -> Self {
        Self {
            small: context.is_small(),
            most: match context.size {
                Size::Most(most) => Some(most),
                _ => None,
            },
        }
    }

    /// Number of records of a cell, from those of the full and of the small version.
    pub(crate) fn records(self, full: u64, small: u64) -> u64 {
        if self.small {
            small
        } else {
            self.most.map_or(full, |most| most.min(full))
        }
    }
}
