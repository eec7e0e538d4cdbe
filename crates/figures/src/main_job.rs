//! The main job: records of another simulator, populations of simulated records, the comparison with
//! the paper's filter, and the cost of a build.

mod builds;
mod comparison;
mod population;
mod runs;
mod sealed;

use crate::error::Error;
use crate::figure::Figure;

/// All figures of the topic.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let mut figures = sealed::figures()?;
    figures.extend(comparison::figures()?);
    figures.extend(population::figures(small)?);
    if !small {
        figures.extend(builds::figures()?);
    }
    Ok(figures)
}
