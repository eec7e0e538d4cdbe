//! Foundations of the diagnosis: the noise audit, and the signatures of effects.

mod noise;
mod signatures;

use crate::harness::{Context, Error, Figure, in_turn};

/// All figures of the part.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    in_turn(context, &[signatures::figures, noise::figures])
}
