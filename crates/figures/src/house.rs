//! The structure of the tree, and the cost of a build and of the gate.

mod builds;
mod structure;

use gyrocal_testkit::workspace;

use crate::error::Error;
use crate::figure::Figure;
use crate::harness::Context;

/// All figures of the part; the small ones without builds.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let root = workspace();
    let mut figures = structure::figures(&root)?.to_vec();
    if !context.is_small() {
        figures.extend(builds::figures(&root)?);
    }
    Ok(figures)
}
