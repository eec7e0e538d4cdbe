//! Open-loop simulation against measurement.

use gyrocal_statistics::rms_of_present;

use crate::axes::{Axes, Labels};
use crate::axis::{Axis, elapsed};
use crate::canvas::{Canvas, LineStyle};
use crate::check;
use crate::error::Error;
use crate::figure::{Legend, figure};
use crate::geometry::Rect;
use crate::layout::Layout;
use crate::number::{count, readable_unit, short};
use crate::picture::Picture;
use crate::scale::Scale;
use crate::span::Span;
use crate::style::{BLACK, DATA, HAIR, LEGEND_LINE, SKY, THIN, VERMILION};

/// Channels as measured and as simulated from the first sample on without measurement updates, and
/// below each the difference of both, with the noise of one sample.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenLoop {
    /// Main statement of the picture.
    pub title: String,
    /// Further description; may be empty.
    pub subtitle: String,
    /// Times of the samples, s; shown from the first.
    pub time_s: Vec<f64>,
    /// The channels, from left to right.
    pub channels: Vec<OpenLoopChannel>,
    /// Name of the ordinate: `specific force`.
    pub quantity: String,
    /// Unit of all values: `g`.
    pub unit: String,
}

/// One measured channel.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenLoopChannel {
    /// Name of the channel: `x`.
    pub name: String,
    /// Measured values; nan for a missing one.
    pub measured: Vec<f64>,
    /// Simulated values; nan for a missing one.
    pub simulated: Vec<f64>,
    /// Standard deviation of the noise of one sample.
    pub sigma: f64,
}

/// Width of the line of measured values, under that of the simulated ones.
const BROAD: f64 = 3.0;

impl Picture for OpenLoop {
    fn to_svg(&self) -> Result<String, Error> {
        check::non_empty("the list of channels", &self.channels)?;
        check::non_decreasing("the times of the samples", &self.time_s)?;
        let times = ("the times", self.time_s.len());
        for channel in &self.channels {
            let name = &channel.name;
            check::column(|| format!("measured {name}"), &channel.measured, times)?;
            check::column(|| format!("simulated {name}"), &channel.simulated, times)?;
            check::positive("sigma of a sample", channel.sigma)?;
        }
        let legend = [
            Legend::line(LineStyle::solid(SKY, BROAD), "measured"),
            Legend::line(LineStyle::solid(BLACK, THIN), "simulated"),
            Legend::line(
                LineStyle::solid(VERMILION, LEGEND_LINE),
                "measured minus simulated",
            ),
            Legend::line(
                LineStyle::dashed(BLACK, THIN),
                "noise of one sample, ±2σ (95%)",
            ),
        ];
        let count = self.channels.len();
        let layout = Layout::new(count, 2 * count, 180.0);
        Ok(figure(
            &self.title,
            &self.subtitle,
            &legend,
            layout.height(),
            |canvas, body| self.draw(canvas, layout, body),
        ))
    }
}

impl OpenLoop {
    fn draw(&self, canvas: &mut Canvas, layout: Layout, body: Rect) {
        let (elapsed, span) = elapsed(&self.time_s);
        let differences: Vec<Vec<f64>> = self.channels.iter().map(|c| c.difference()).collect();
        for (index, channel) in self.channels.iter().enumerate() {
            let axes = Axes {
                frame: layout.frame(body, index),
                x: Axis::time(span, 5),
                y: self.ordinate(),
            };
            let (_, number) = rms_of_present(&differences[index]);
            let labels = Labels {
                name: &channel.name,
                note: &format!("n = {}", count(number)),
                abscissa: false,
                ordinate_title: layout.is_first_in_row(index),
            };
            let has_data =
                rms_of_present(&channel.measured).1 + rms_of_present(&channel.simulated).1 > 0;
            axes.draw(canvas, labels, has_data, |axes, canvas| {
                let [measured, simulated] = [(SKY, BROAD), (BLACK, THIN)]
                    .map(|(colour, width)| LineStyle::solid(colour, width));
                axes.line(canvas, &elapsed, &channel.measured, measured);
                axes.line(canvas, &elapsed, &channel.simulated, simulated);
            });
        }
        let sigmas = self.channels.iter().map(|channel| channel.sigma);
        let columns = differences.iter().map(Vec::as_slice);
        let scale = Scale::about_zero(columns, 2.5 * sigmas.fold(0.0, f64::max));
        for (index, (channel, difference)) in self.channels.iter().zip(&differences).enumerate() {
            let below = self.channels.len() + index;
            let axes = Axes {
                frame: layout.frame(body, below),
                x: Axis::time(span, 5),
                y: Axis::linear(scale.span(), "difference", &self.unit, 6),
            };
            let labels = Labels {
                name: &format!("{}, difference", channel.name),
                note: &self.note(&scale, difference, channel.sigma),
                abscissa: true,
                ordinate_title: layout.is_first_in_row(below),
            };
            let has_data = rms_of_present(difference).1 > 0;
            axes.draw(canvas, labels, has_data, |axes, canvas| {
                axes.zero_line(canvas);
                let style = LineStyle::solid(VERMILION, DATA);
                axes.line(canvas, &elapsed, difference, style);
                for level in [-2.0 * channel.sigma, 2.0 * channel.sigma] {
                    axes.horizontal_line(canvas, level, LineStyle::dashed(BLACK, HAIR));
                }
            });
        }
    }

    /// One scale for the values of all channels.
    fn ordinate(&self) -> Axis {
        let channels = self.channels.iter();
        let values = channels.flat_map(|c| c.measured.iter().chain(&c.simulated));
        let span = Span::of(values.copied()).unwrap_or(Span::symmetric(1.0));
        Axis::linear(span.padded(0.04), &self.quantity, &self.unit, 6)
    }

    fn note(&self, scale: &Scale, difference: &[f64], sigma: f64) -> String {
        let (size, _) = rms_of_present(difference);
        let (factor, unit) = readable_unit(&self.unit, size.max(sigma));
        let mut note = format!(
            "rms {}, noise {} {unit}",
            short(size * factor, 2),
            short(sigma * factor, 2)
        );
        if let Some((number, _)) = scale.beyond(difference) {
            note += &format!("; {} beyond", count(number));
        }
        note
    }
}

impl OpenLoopChannel {
    fn difference(&self) -> Vec<f64> {
        let pairs = self.measured.iter().zip(&self.simulated);
        pairs
            .map(|(measured, simulated)| measured - simulated)
            .collect()
    }
}
