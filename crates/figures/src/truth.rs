//! Truth of the diagnosis outside of the population that its constants were tuned on.

mod hostile;
mod noise;
mod outside;
mod setup;
mod shapes;

use crate::error::Error;
use crate::figure::Figure;

/// All figures of the topic.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let mut figures = setup::figures(small)?;
    figures.extend(hostile::figures(small)?);
    figures.extend(shapes::figures(small)?);
    figures.extend(noise::figures(small)?);
    figures.extend(outside::figures(small)?);
    Ok(figures)
}
