//! Periodograms.

use crate::axes::{Axes, Labels};
use crate::axis::Axis;
use crate::canvas::{Align, Canvas, LineStyle, TextStyle};
use crate::check;
use crate::error::Error;
use crate::figure::{Legend, figure, model_legend};
use crate::geometry::Rect;
use crate::layout::Layout;
use crate::number::{count, percent};
use crate::page::Tint;
use crate::picture::Picture;
use crate::span::Span;
use crate::style::{BLACK, HAIR, INNER_WIDTH, PURPLE, SMALL, THIN, colour};
use crate::text;

/// Periodograms of some channels, on logarithmic scales, with thresholds and marked frequencies;
/// all panels have one scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Main statement of the picture.
    pub title: String,
    /// Further description; may be empty.
    pub subtitle: String,
    /// Frequencies, increasing. Zero has no place on the logarithmic scale and is left out.
    pub frequency: Vec<f64>,
    /// Unit of all frequencies: `cycles/day`.
    pub frequency_unit: String,
    /// The channels, one panel each, from top to bottom.
    pub channels: Vec<SpectrumChannel>,
    /// Name of the ordinate: `power`.
    pub quantity: String,
    /// Unit of the ordinate: `g²`, or empty for normalised power.
    pub unit: String,
    /// Frequencies that are marked in all panels.
    pub marks: Vec<MarkedFrequency>,
}

/// The periodogram of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectrumChannel {
    /// Name of the channel: `x`.
    pub name: String,
    /// Power at the frequencies; nan for a missing one. Zero has no place on the logarithmic scale
    /// and is left out.
    pub power: Vec<f64>,
    /// Number of samples of the channel.
    pub samples: usize,
    /// The model that it is of.
    pub tint: Tint,
    /// Detection threshold of a line.
    pub threshold: Option<PowerThreshold>,
}

/// Detection threshold of a spectral line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerThreshold {
    /// The power.
    pub power: f64,
    /// Probability that white noise exceeds it anywhere in the panel.
    pub false_alarm_probability: f64,
}

/// A frequency that is marked by a vertical line.
#[derive(Clone, Debug, PartialEq)]
pub struct MarkedFrequency {
    /// The frequency, in the unit of the picture.
    pub frequency: f64,
    /// Its label: `sidereal day`, `5.3 h`.
    pub label: String,
}

/// Height of a row of labels of marks, px.
const MARK_ROW: f64 = 14.0;

impl Picture for Spectrum {
    fn to_svg(&self) -> Result<String, Error> {
        self.check()?;
        let layout = Layout::new(1, self.channels.len(), 170.0);
        let span = Span::of(self.frequency.iter().copied().filter(|f| *f > 0.0));
        let span = span.unwrap_or(Span { lo: 0.1, hi: 10.0 }).open();
        let abscissa = Axis::logarithmic(span, "frequency", &self.frequency_unit, 8);
        let labels = self.mark_labels(&abscissa, layout);
        let rows = labels.iter().map(|(_, row, _)| row + 1).max().unwrap_or(0);
        let room = MARK_ROW * rows as f64;
        Ok(figure(
            &self.title,
            &self.subtitle,
            &self.legend(),
            layout.height() + room,
            |canvas, mut body| {
                body.top += room;
                for (x, row, label) in &labels {
                    let y = body.top - MARK_ROW * (*row as f64 + 0.5);
                    let style = TextStyle::new(SMALL, Align::Middle).colour(PURPLE);
                    canvas.text(label, (body.left + x, y), style);
                }
                self.draw(canvas, layout, body, &abscissa);
            },
        ))
    }
}

impl Spectrum {
    fn check(&self) -> Result<(), Error> {
        check::non_empty("the list of channels", &self.channels)?;
        check::non_decreasing("the frequencies", &self.frequency)?;
        let frequencies = ("the frequencies", self.frequency.len());
        for channel in &self.channels {
            let what = || format!("power of {}", channel.name);
            check::column(what, &channel.power, frequencies)?;
            if let Some(threshold) = channel.threshold {
                check::positive("the threshold of power", threshold.power)?;
            }
        }
        for mark in &self.marks {
            check::positive("a marked frequency", mark.frequency)?;
        }
        Ok(())
    }

    fn legend(&self) -> Vec<Legend> {
        let tints = self.channels.iter().map(|channel| channel.tint);
        let mut legend = model_legend(tints, "periodogram");
        if let Some(threshold) = self.channels.iter().find_map(|channel| channel.threshold) {
            let label = format!(
                "detection threshold (false-alarm probability {} per panel)",
                percent(threshold.false_alarm_probability)
            );
            legend.push(Legend::line(LineStyle::dashed(BLACK, THIN), label));
        }
        if !self.marks.is_empty() {
            let mark = LineStyle::dashed(PURPLE, THIN);
            legend.push(Legend::line(mark, "marked frequency"));
        }
        legend
    }

    /// The span of the values of a channel that a logarithmic scale can show.
    fn powers(&self, channel: &SpectrumChannel) -> Option<Span> {
        let shown = self.frequency.iter().zip(&channel.power);
        let shown = shown.filter(|(frequency, power)| **frequency > 0.0 && **power > 0.0);
        Span::of(shown.map(|(_, power)| *power))
    }

    /// Labels of marks: px from the left of the body, row above the panels, text; no two overlap.
    fn mark_labels(&self, abscissa: &Axis, layout: Layout) -> Vec<(f64, usize, String)> {
        let body = Rect {
            left: 0.0,
            top: 0.0,
            right: INNER_WIDTH,
            bottom: 0.0,
        };
        let frame = layout.frame(body, 0);
        let mut taken: Vec<Vec<(f64, f64)>> = Vec::new();
        let mut labels = Vec::new();
        for mark in &self.marks {
            let part = abscissa.at(mark.frequency);
            if !(0.0..=1.0).contains(&part) {
                continue;
            }
            let half = 0.5 * text::width_px(&mark.label, SMALL, false);
            let most = (body.right - half).max(half);
            let middle = (frame.left + part * frame.width()).clamp(half, most);
            let (from, to) = (middle - half - 6.0, middle + half + 6.0);
            let free =
                |row: &Vec<(f64, f64)>| row.iter().all(|other| to < other.0 || from > other.1);
            let row = taken.iter().position(free).unwrap_or_else(|| {
                taken.push(Vec::new());
                taken.len() - 1
            });
            taken[row].push((from, to));
            labels.push((middle, row, mark.label.clone()));
        }
        labels
    }

    fn draw(&self, canvas: &mut Canvas, layout: Layout, body: Rect, abscissa: &Axis) {
        let spans: Vec<Option<Span>> = self.channels.iter().map(|c| self.powers(c)).collect();
        let ends = spans.iter().flatten().flat_map(|span| [span.lo, span.hi]);
        let thresholds = self.channels.iter().filter_map(|channel| channel.threshold);
        let span = Span::of(ends.chain(thresholds.map(|threshold| threshold.power)));
        let span = room_above(span.unwrap_or(Span { lo: 1.0, hi: 10.0 }));
        for (index, channel) in self.channels.iter().enumerate() {
            let axes = Axes {
                frame: layout.frame(body, index),
                x: abscissa.clone(),
                y: Axis::logarithmic(span, &self.quantity, &self.unit, 6),
            };
            let labels = Labels {
                name: &channel.name,
                note: &format!("n = {}", count(channel.samples)),
                abscissa: layout.shows_abscissa(index),
                ordinate_title: true,
            };
            axes.draw(canvas, labels, spans[index].is_some(), |axes, canvas| {
                self.draw_channel(canvas, axes, channel);
            });
        }
    }

    fn draw_channel(&self, canvas: &mut Canvas, axes: &Axes, channel: &SpectrumChannel) {
        for mark in &self.marks {
            let style = LineStyle::dashed(PURPLE, HAIR);
            axes.vertical_line(canvas, mark.frequency, style);
        }
        let style = LineStyle::solid(colour(channel.tint), THIN);
        let (frequency, power) = (&self.frequency, &channel.power);
        axes.line_bridging(canvas, frequency, power, style, f64::INFINITY);
        if let Some(threshold) = channel.threshold {
            let style = LineStyle::dashed(BLACK, THIN);
            axes.horizontal_line(canvas, threshold.power, style);
        }
    }
}

/// Some room above the largest power; at most eight decades, so that ordinates near zero by chance
/// do not flatten the rest.
fn room_above(span: Span) -> Span {
    let hi = 2.0 * span.hi;
    Span {
        lo: span.lo.max(1e-8 * hi).min(0.5 * span.hi),
        hi,
    }
}
