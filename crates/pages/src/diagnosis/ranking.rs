//! Effects by test statistic.

use gyrocal_document::{Item, Section};

use super::section as titled;
use crate::ranked::Ranked;

/// `None` if nothing was searched.
pub(crate) fn section(ranked: Option<&Ranked>) -> Option<Section> {
    Some(titled(
        "ranking",
        "Ranking",
        "Each effect of the catalogue was tested against the nominal model. An effect beyond the dashed \
         threshold is significant; those that resemble a stronger one are explained by it.",
        vec![Item::Bars(ranked?.bars())],
    ))
}
