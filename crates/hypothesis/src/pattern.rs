//! Types of unmodelled terms: spectral lines, and curves over a covariate that no polynomial of the
//! catalogue follows.

use gyrocal_scalar::effect::Channel;
use gyrocal_statistics::{chi_square_equivalent, ln_chi_square_tail};

use crate::plant::Plant;
use crate::rows::Rows;
use gyrocal_inference::Column;

/// Harmonics of a natural period at which effects together look like a line.
const HARMONICS: u32 = 3;

/// A channel of a plant, by its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChannelIndex {
    /// Rate channel.
    Rate(usize),
    /// Output channel.
    Output(usize),
}

impl ChannelIndex {
    /// All channels of a plant.
    pub(crate) fn all(plant: &Plant) -> Vec<Self> {
        let rates = (0..plant.rates.len()).map(Self::Rate);
        rates
            .chain((0..plant.outputs.len()).map(Self::Output))
            .collect()
    }

    /// Its description.
    #[must_use]
    pub fn describe(self, plant: &Plant) -> &'static Channel {
        match self {
            Self::Rate(index) => &plant.rates[index],
            Self::Output(index) => &plant.outputs[index],
        }
    }
}

/// Form of an unmodelled term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pattern {
    /// A sine.
    Line {
        /// Its period, h.
        period_h: f64,
    },
    /// A function of a covariate.
    Curve {
        /// Index of the covariate.
        covariate: usize,
        /// Its name.
        name: &'static str,
    },
}

/// A term that no effect of the catalogue explains.
#[derive(Clone, Debug, PartialEq)]
pub struct Unmodelled {
    /// Its channel.
    pub channel: ChannelIndex,
    /// Description of the channel.
    pub describes: &'static Channel,
    /// Its form.
    pub pattern: Pattern,
    /// Amplitude of a line, root mean square of a curve, in the channel's unit.
    pub size: f64,
    /// Chi-square without it.
    pub statistic: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: usize,
    /// Natural logarithm of the p-value over all that was searched.
    pub ln_probability: f64,
    /// Columns that it adds to a model.
    pub(crate) columns: Vec<Column>,
}

impl Unmodelled {
    pub(crate) fn new(
        plant: &Plant,
        (channel, pattern): (ChannelIndex, Pattern),
        size: f64,
        (statistic, degrees_of_freedom): (f64, usize),
        ln_tests: f64,
        columns: Vec<Column>,
    ) -> Self {
        let tail = ln_chi_square_tail(statistic, degrees_of_freedom as f64);
        Self {
            channel,
            describes: channel.describe(plant),
            pattern,
            size,
            statistic,
            degrees_of_freedom,
            ln_probability: (tail + ln_tests).min(0.0),
            columns,
        }
    }

    /// Value of chi-square with one degree of freedom that is as rare.
    pub(crate) fn equivalent(&self) -> f64 {
        chi_square_equivalent(self.ln_probability)
    }

    /// Whether it is a line at a natural period of the plant or a harmonic of it, within the
    /// resolution of the record.
    pub(crate) fn has_natural_period(&self, plant: &Plant, rows: &Rows) -> bool {
        let Pattern::Line { period_h } = self.pattern else {
            return false;
        };
        if rows.len() < 2 {
            return false;
        }
        let half_resolution_per_h = 1800.0 / rows.duration_s();
        let mut periods_h = plant
            .natural_periods_s
            .iter()
            .map(|period_s| period_s / 3600.0);
        periods_h.any(|natural_h| {
            (1..=HARMONICS).any(|harmonic| {
                (f64::from(harmonic) / natural_h - 1.0 / period_h).abs() < half_resolution_per_h
            })
        })
    }
}
