//! Residuals against time.

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
use crate::style::{BLACK, EXTENDED, LEGEND_LINE, NOMINAL, THIN};

/// Residuals of some channels against time, of one model or before and after a change of it, all
/// on one scale, with the band of the noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Residuals {
    /// Main statement of the picture.
    pub title: String,
    /// Further description; may be empty.
    pub subtitle: String,
    /// Times of the samples, s; shown from the first.
    pub time_s: Vec<f64>,
    /// The channels, one panel each, from top to bottom.
    pub channels: Vec<ResidualChannel>,
    /// The model of the residuals before the change, for the legend: `nominal model`.
    pub before_label: String,
    /// The changed model, for the legend, if any channel has residuals of it:
    /// `with gyro_y.g_z`.
    pub after_label: String,
    /// Name of the ordinate: `residual`.
    pub quantity: String,
    /// Unit of residuals and sigma: `g`, or empty for normalised ones.
    pub unit: String,
}

/// The residuals of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct ResidualChannel {
    /// Name of the channel: `x`.
    pub name: String,
    /// Residuals; nan for a missing one.
    pub before: Vec<f64>,
    /// Residuals of the changed model at the same times.
    pub after: Option<Vec<f64>>,
    /// Standard deviation of the noise, in the same unit.
    pub sigma: f64,
}

impl Picture for Residuals {
    fn to_svg(&self) -> Result<String, Error> {
        self.check()?;
        let layout = Layout::new(1, self.channels.len(), 150.0);
        Ok(figure(
            &self.title,
            &self.subtitle,
            &self.legend(),
            layout.height(),
            |canvas, body| self.draw(canvas, layout, body),
        ))
    }
}

impl Residuals {
    fn check(&self) -> Result<(), Error> {
        check::non_empty("the list of channels", &self.channels)?;
        check::non_decreasing("the times of the residuals", &self.time_s)?;
        let times = ("the times", self.time_s.len());
        for channel in &self.channels {
            let name = &channel.name;
            check::column(|| format!("residuals of {name}"), &channel.before, times)?;
            if let Some(after) = &channel.after {
                check::column(|| format!("residuals of {name} after"), after, times)?;
            }
            check::positive("sigma of the noise", channel.sigma)?;
        }
        Ok(())
    }

    fn legend(&self) -> Vec<Legend> {
        let [before, after] = [NOMINAL, EXTENDED].map(|c| LineStyle::solid(c, LEGEND_LINE));
        let mut legend = vec![Legend::line(before, self.before_label.as_str())];
        if self.has_after() {
            legend.push(Legend::line(after, self.after_label.as_str()));
        }
        let noise = LineStyle::dashed(BLACK, THIN);
        legend.push(Legend::line(noise, "noise, ±2σ (95%)"));
        legend
    }

    fn has_after(&self) -> bool {
        self.channels.iter().any(|channel| channel.after.is_some())
    }

    fn draw(&self, canvas: &mut Canvas, layout: Layout, body: Rect) {
        let columns = self.channels.iter().flat_map(ResidualChannel::columns);
        let sigmas = self.channels.iter().map(|channel| channel.sigma);
        let scale = Scale::about_zero(columns, 2.5 * sigmas.fold(0.0, f64::max));
        let (elapsed, span) = elapsed(&self.time_s);
        let before = LineStyle::solid(NOMINAL, THIN);
        for (index, channel) in self.channels.iter().enumerate() {
            let axes = Axes {
                frame: layout.frame(body, index),
                x: Axis::time(span, 10),
                y: Axis::linear(scale.span(), &self.quantity, &self.unit, 5),
            };
            let labels = Labels {
                name: &channel.name,
                note: &channel.note(&scale, &self.unit),
                abscissa: layout.shows_abscissa(index),
                ordinate_title: true,
            };
            let has_data = channel.columns().any(|column| rms_of_present(column).1 > 0);
            axes.draw(canvas, labels, has_data, |axes, canvas| {
                axes.zero_line(canvas);
                axes.line(canvas, &elapsed, &channel.before, before);
                if let Some(after) = &channel.after {
                    axes.line(canvas, &elapsed, after, LineStyle::solid(EXTENDED, THIN));
                }
                for level in [-2.0 * channel.sigma, 2.0 * channel.sigma] {
                    axes.horizontal_line(canvas, level, LineStyle::dashed(BLACK, THIN));
                }
            });
        }
    }
}

impl ResidualChannel {
    fn columns(&self) -> impl Iterator<Item = &[f64]> {
        let columns = [Some(&self.before), self.after.as_ref()];
        columns.into_iter().flatten().map(Vec::as_slice)
    }

    /// Root mean squares in the order of the legend, number of values, and values outside the
    /// scale.
    fn note(&self, scale: &Scale, unit: &str) -> String {
        let (before, samples) = rms_of_present(&self.before);
        let (factor, unit) = readable_unit(unit, before.max(self.sigma));
        let amount = |value: f64| short(value * factor, 2);
        let mut note = format!("rms {}", amount(before));
        if let Some(after) = &self.after {
            note += &format!(" → {}", amount(rms_of_present(after).0));
        }
        note += &format!(", noise {} {unit}", amount(self.sigma));
        note.truncate(note.trim_end().len());
        note += &format!("; n = {}", count(samples));
        let beyond = self.columns().filter_map(|column| scale.beyond(column));
        let (number, largest) = beyond.fold((0, 0.0_f64), |(number, largest), (more, size)| {
            (number + more, largest.max(size))
        });
        if number > 0 {
            let (number, largest) = (count(number), amount(largest));
            note += &format!("; {number} beyond the scale, to {largest}");
        }
        note
    }
}
