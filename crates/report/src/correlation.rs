//! Autocorrelations.

use crate::axes::{Axes, Labels};
use crate::axis::Axis;
use crate::canvas::{Canvas, LineStyle};
use crate::check;
use crate::error::Error;
use crate::figure::{Legend, figure, model_legend};
use crate::geometry::Rect;
use crate::layout::Layout;
use crate::number::{count, percent};
use crate::page::Tint;
use crate::picture::Picture;
use crate::span::Span;
use crate::style::{BAND_OPACITY, GREY, THIN, colour};

/// Autocorrelations of some channels as stems, with the confidence band of white noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Correlation {
    /// Main statement of the picture.
    pub title: String,
    /// Further description; may be empty.
    pub subtitle: String,
    /// The channels, one panel each, from top to bottom.
    pub channels: Vec<CorrelationChannel>,
    /// Probability that white noise stays inside the band at one lag: 0.95.
    pub confidence: f64,
}

/// The autocorrelation of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct CorrelationChannel {
    /// Name of the channel: `x`.
    pub name: String,
    /// Correlation at lags of 1, 2, 3, … samples; nan for a missing one.
    pub correlation: Vec<f64>,
    /// Half-width of the band of white noise.
    pub band: f64,
    /// Number of samples.
    pub samples: usize,
    /// The model that it is of.
    pub tint: Tint,
}

impl Picture for Correlation {
    fn to_svg(&self) -> Result<String, Error> {
        check::non_empty("the list of channels", &self.channels)?;
        for channel in &self.channels {
            let what = || format!("correlations of {}", channel.name);
            check::not_infinite(what, &channel.correlation)?;
            check::positive("the band of white noise", channel.band)?;
        }
        let layout = Layout::new(1, self.channels.len(), 120.0);
        let band = format!("white noise, {} at each lag", percent(self.confidence));
        let tints = self.channels.iter().map(|channel| channel.tint);
        let mut legend = model_legend(tints, "autocorrelation");
        legend.push(Legend::area(GREY, BAND_OPACITY, band));
        Ok(figure(
            &self.title,
            &self.subtitle,
            &legend,
            layout.height(),
            |canvas, body| self.draw(canvas, layout, body),
        ))
    }
}

impl Correlation {
    fn draw(&self, canvas: &mut Canvas, layout: Layout, body: Rect) {
        let most = self.channels.iter().map(|c| c.correlation.len()).max();
        let lags = Span {
            lo: 0.0,
            hi: most.unwrap_or(0).max(1) as f64 + 0.5,
        };
        let values = self.channels.iter().flat_map(|channel| {
            let band = [-2.0 * channel.band, 2.0 * channel.band];
            channel.correlation.iter().copied().chain(band)
        });
        let ordinate = Span::of(values).unwrap_or(Span::symmetric(1.0));
        for (index, channel) in self.channels.iter().enumerate() {
            let axes = Axes {
                frame: layout.frame(body, index),
                x: Axis::linear(lags, "lag [samples]", "", 12),
                y: Axis::linear(ordinate.padded(0.06), "correlation", "", 4),
            };
            let labels = Labels {
                name: &channel.name,
                note: &channel.note(),
                abscissa: layout.shows_abscissa(index),
                ordinate_title: true,
            };
            let has_data = channel.correlation.iter().any(|value| !value.is_nan());
            axes.draw(canvas, labels, has_data, |axes, canvas| {
                channel.draw(canvas, axes);
            });
        }
    }
}

impl CorrelationChannel {
    /// The band of white noise and the stems.
    fn draw(&self, canvas: &mut Canvas, axes: &Axes) {
        axes.horizontal_band(canvas, (-self.band, self.band), GREY, BAND_OPACITY);
        axes.zero_line(canvas);
        let apart = axes.frame.width() / self.correlation.len().max(1) as f64;
        for (index, &value) in self.correlation.iter().enumerate() {
            if value.is_nan() {
                continue;
            }
            let lag = index as f64 + 1.0;
            let (foot, tip) = (axes.point(lag, 0.0), axes.point(lag, value));
            canvas.line(
                &[foot, tip],
                LineStyle::solid(colour(self.tint), THIN.min(0.8 * apart)),
            );
            // No dots where they would touch.
            if apart > 5.0 {
                canvas.disc(tip, 2.0, colour(self.tint));
            }
        }
    }

    fn note(&self) -> String {
        let values = self.correlation.iter().filter(|value| !value.is_nan());
        let outside = values.clone().filter(|value| value.abs() > self.band);
        format!(
            "{} of {} lags outside; n = {}",
            outside.count(),
            values.count(),
            count(self.samples)
        )
    }
}
