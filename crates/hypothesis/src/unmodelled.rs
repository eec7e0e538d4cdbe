//! The search for unmodelled terms.

use crate::curve;
use crate::line;
use crate::model::{FittedModel, StateJump};
use crate::pattern::Unmodelled;
use crate::rows::Rows;

/// The most significant line or curve, if it `stands` against the named effects. Curves, which cost
/// more, are tested if asked for or if a line stands: a covariate has the natural periods.
pub(crate) fn strongest<F: FittedModel>(
    fitted: &F,
    rows: &Rows,
    jumps: &[Option<StateJump>],
    curves: bool,
    stands: impl Fn(&Unmodelled) -> bool,
) -> Result<Option<Unmodelled>, F::Error> {
    let line = line::strongest(fitted, rows, jumps)?.filter(&stands);
    let curve = if curves || line.is_some() {
        curve::strongest(fitted, rows)?.filter(&stands)
    } else {
        None
    };
    let found = [line, curve].into_iter().flatten();
    Ok(found.min_by(|a, b| a.ln_probability.total_cmp(&b.ln_probability)))
}
