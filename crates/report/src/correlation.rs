//! Autocorrelations.

use crate::axis::{Axis, Span};
use crate::canvas::{Canvas, Stroke};
use crate::check;
use crate::error::Error;
use crate::number::{count, percent};
use crate::page::{Grid, Key, page};
use crate::panel::{Panel, Surround};
use crate::picture::Picture;
use crate::style::{BLUE, GREY, HAIR, SKY, THIN};
use crate::trace::Frame;

/// Autocorrelations of some channels as stems, with the band that white noise stays in.
#[derive(Clone, Debug, PartialEq)]
pub struct Correlation {
    /// What is seen.
    pub title: String,
    /// More words, or none.
    pub subtitle: String,
    /// One panel each, one above the other.
    pub channels: Vec<CorrelationPanel>,
    /// Probability that white noise stays inside the bands at one lag: 0.95.
    pub confidence: f64,
}

/// The autocorrelation of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct CorrelationPanel {
    /// Its name: `x`.
    pub name: String,
    /// Correlation at lags of 1, 2, 3, … samples; nan where there is none.
    pub correlation: Vec<f64>,
    /// Half of the band of white noise.
    pub band: f64,
    /// Number of samples.
    pub samples: usize,
}

const BAND_OPACITY: f64 = 0.35;

impl Picture for Correlation {
    fn to_svg(&self) -> Result<String, Error> {
        check::some("the list of channels", &self.channels)?;
        for channel in &self.channels {
            let what = || format!("correlations of {}", channel.name);
            check::not_infinite(what, &channel.correlation)?;
            check::positive("the band of white noise", channel.band)?;
        }
        let grid = Grid::new(1, self.channels.len(), 120.0);
        let band = format!("white noise at one lag, {}", percent(self.confidence));
        let keys = [
            Key::line(Stroke::solid(BLUE, 2.0), "autocorrelation"),
            Key::area(SKY, BAND_OPACITY, band),
        ];
        page(
            &self.title,
            &self.subtitle,
            &keys,
            grid.height(),
            |canvas, body| self.panels(canvas, grid, body),
        )
    }
}

impl Correlation {
    fn panels(&self, canvas: &mut Canvas<'_>, grid: Grid, body: Frame) -> Result<(), Error> {
        let most = self.channels.iter().map(|c| c.correlation.len()).max();
        let lags = most.unwrap_or(0).max(1) as f64;
        let values = self.channels.iter().flat_map(|channel| {
            let band = [-2.0 * channel.band, 2.0 * channel.band];
            channel.correlation.iter().copied().chain(band)
        });
        let ordinate = Span::of(values).unwrap_or(Span::symmetric(1.0));
        for (index, channel) in self.channels.iter().enumerate() {
            let panel = Panel {
                frame: grid.frame(body, index),
                x: Axis::linear(
                    Span {
                        lo: 0.0,
                        hi: lags + 0.5,
                    },
                    "lag [samples]",
                    "",
                    12,
                ),
                y: Axis::linear(ordinate.padded(0.06), "correlation", "", 4),
            };
            let surround = Surround {
                name: &channel.name,
                note: &channel.note(),
                abscissa: grid.shows_abscissa(index),
                ordinate_title: true,
            };
            panel.surround(canvas, surround)?;
            panel.stripe(canvas, -channel.band, channel.band, SKY, BAND_OPACITY)?;
            panel.level(canvas, 0.0, Stroke::solid(GREY, HAIR))?;
            if channel.correlation.iter().all(|value| value.is_nan()) {
                panel.empty(canvas)?;
            }
            self.stems(canvas, &panel, channel)?;
        }
        Ok(())
    }

    fn stems(
        &self,
        canvas: &mut Canvas<'_>,
        panel: &Panel,
        channel: &CorrelationPanel,
    ) -> Result<(), Error> {
        let apart = panel.frame.width() / channel.correlation.len().max(1) as f64;
        for (index, &value) in channel.correlation.iter().enumerate() {
            if value.is_nan() {
                continue;
            }
            let lag = index as f64 + 1.0;
            let (foot, tip) = (panel.place(lag, 0.0), panel.place(lag, value));
            canvas.line(&[foot, tip], Stroke::solid(BLUE, THIN.min(0.8 * apart)))?;
            // Dots that would touch say nothing.
            if apart > 5.0 {
                canvas.disc(tip, 2.0, BLUE, 1.0)?;
            }
        }
        Ok(())
    }
}

impl CorrelationPanel {
    fn note(&self) -> String {
        let there = self.correlation.iter().filter(|value| !value.is_nan());
        let outside = there.clone().filter(|value| value.abs() > self.band);
        format!(
            "{} of {} lags outside; n = {}",
            outside.count(),
            there.count(),
            count(self.samples)
        )
    }
}
