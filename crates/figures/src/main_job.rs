//! The main job: records of other simulators, populations of our own, the comparison with the
//! paper's filter, and what a build costs.

mod builds;
mod comparison;
mod population;
mod runs;
mod sealed;

use crate::figure::Figure;

/// Why a figure could not be measured.
pub(crate) type Error = Box<dyn std::error::Error + Send + Sync>;

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
