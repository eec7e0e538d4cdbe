//! Truth of the diagnosis outside of the population that its constants were tuned on.

mod causes;
mod coverage;
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

/// Sampling intervals of the records of a cell in turn, s: those of means of one to four minutes, which
/// tell as much of slow effects as raw samples.
const INTERVALS_S: [f64; 3] = [60.0, 120.0, 240.0];

/// Sampling interval of the record of a seed, s.
fn interval_s(seed: u64) -> f64 {
    INTERVALS_S[(seed % INTERVALS_S.len() as u64) as usize]
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
    /// Random walks of the gyros.
    Walks,
    /// Flicker of the gyros.
    Flicker,
    /// Noise other than declared, without a cause.
    Clean,
    /// A cause of the catalogue beside random walks.
    Together,
    /// Causes outside of the catalogue.
    Outside,
}

impl Part {
    /// Its name on the command line and its heading on the page.
    pub(crate) fn name(self) -> String {
        let value = self.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// The names of all parts, in their order.
    pub(crate) fn names() -> Vec<String> {
        Self::value_variants()
            .iter()
            .map(|part| part.name())
            .collect()
    }

    fn figures(self, extent: Extent) -> Result<Vec<Figure>, Error> {
        match self {
            Self::Setup => setup::figures(extent.small),
            Self::Hostile => hostile::figures(extent.small),
            Self::Shapes => shapes::figures(extent),
            Self::Causes => causes::figures(extent),
            Self::Walks => noise::of_walks(extent),
            Self::Flicker => noise::of_flicker(extent),
            Self::Clean => noise::of_clean(extent),
            Self::Together => together::figures(extent),
            Self::Outside => outside::figures(extent),
        }
    }
}

/// All figures of the topic, or of some parts of it. `measured` has those of each part as soon as they are
/// there: the full version takes hours.
pub(crate) fn figures(
    extent: Extent,
    parts: &[Part],
    measured: impl Fn(Part, &[Figure]) -> Result<(), Error>,
) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for part in Part::value_variants() {
        if !(parts.is_empty() || parts.contains(part)) {
            continue;
        }
        let of_part = part.figures(extent)?;
        measured(*part, &of_part)?;
        figures.extend(of_part);
    }
    Ok(figures)
}
