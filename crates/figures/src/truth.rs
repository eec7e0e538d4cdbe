//! Truth of the diagnosis outside of the population that its constants were tuned on.

mod causes;
mod hostile;
mod noise;
mod outside;
mod setup;
mod shapes;
mod together;

use clap::ValueEnum;

use crate::error::Error;
use crate::figure::Figure;

/// How much is measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    /// The small version: a few records.
    pub(crate) small: bool,
    /// Most records of a cell of the full version.
    pub(crate) most: Option<u64>,
}

impl Extent {
    /// Number of records of a cell, from those of the full and of the small version.
    pub(crate) fn records(self, full: u64, small: u64) -> u64 {
        if self.small {
            small
        } else {
            self.most.map_or(full, |most| most.min(full))
        }
    }
}

/// A part of the topic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Part {
    /// Gross errors of the set-up.
    Setup,
    /// Work on records that no model fits.
    Hostile,
    /// Onsets and time constants.
    Shapes,
    /// One cause of the catalogue.
    Causes,
    /// Noise other than declared.
    Noise,
    /// A cause of the catalogue beside random walks.
    Together,
    /// Causes outside of the catalogue.
    Outside,
}

/// All figures of the topic, or of some parts of it.
pub(crate) fn figures(extent: Extent, parts: &[Part]) -> Result<Vec<Figure>, Error> {
    let small = extent.small;
    let mut figures = Vec::new();
    for part in Part::value_variants() {
        if !(parts.is_empty() || parts.contains(part)) {
            continue;
        }
        figures.extend(match part {
            Part::Setup => setup::figures(small)?,
            Part::Hostile => hostile::figures(small)?,
            Part::Shapes => shapes::figures(extent)?,
            Part::Causes => causes::figures(extent)?,
            Part::Noise => noise::figures(extent)?,
            Part::Together => together::figures(extent)?,
            Part::Outside => outside::figures(extent)?,
        });
    }
    Ok(figures)
}
