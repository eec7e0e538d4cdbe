//! The batch calibration: consistency over a population, exactness, and cost.

mod attitudes;
mod cost;
mod exactness;
mod paper;
mod population;
mod site;

use crate::error::Error;
use crate::figure::Figure;

/// All figures of the topic.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    // Memory first, while nothing else has been asked of the allocator.
    let mut figures = cost::figures(small)?;
    figures.extend(population::figures(small)?);
    figures.extend(paper::figures(small)?);
    figures.extend(site::figures()?);
    figures.extend(exactness::figures()?);
    figures.extend(attitudes::figures()?);
    Ok(figures)
}

/// Names of the coefficients.
fn names() -> [&'static str; 9] {
    gyrocal_truth::Coefficients::NONE
        .named()
        .map(|(name, _, _)| name)
}
