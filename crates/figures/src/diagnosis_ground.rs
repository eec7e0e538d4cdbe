//! Foundations of the diagnosis: the noise audit, and the signatures of effects.

mod audit;
mod records;
mod signatures;
mod whole;

use gyrocal_evaluation::Campaign;

use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;

/// All figures of the topic.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let mut figures = signatures::figures(small)?;
    figures.extend(audit::figures(small)?);
    figures.extend(whole::figures(small)?);
    Ok(figures)
}

fn campaign(cell: &str, seeds: core::ops::Range<u64>, small: bool) -> Result<Campaign, Error> {
    resumable::campaign("diagnosis-ground", cell, seeds, small)
}
