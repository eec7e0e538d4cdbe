//! The generator against others: time and instructions of emitted functions, time of emission, edges
//! of operations, random graphs.

mod emission;
mod operations;
mod race;

use crate::error::Error;
use crate::figure::Figure;

/// All figures of the topic. With `small`, nothing that builds packages or installs generators.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let mut figures = vec![
        Figure::note("processor", gyrocal_testkit::timing::processor()),
        emission::figure()?,
    ];
    if small {
        let reason = "full version only".to_owned();
        figures.push(Figure::note("competitors, operations and graphs", reason));
        return Ok(figures);
    }
    figures.extend(race::figures()?);
    figures.extend(operations::figures()?);
    Ok(figures)
}
