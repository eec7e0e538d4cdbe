//! Foundations of the diagnosis: the noise audit, and the signatures of effects.

mod noise;
mod signatures;

use crate::harness::{Context, Error, Figure};

/// All figures of the part.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = signatures::figures(context.is_small())?;
    figures.extend(noise::figures(context)?);
    Ok(figures)
}
