//! Periodograms.

use crate::axis::{Axis, Span};
use crate::canvas::{Align, Canvas, Lettering, Stroke};
use crate::check;
use crate::error::Error;
use crate::number::{count, percent};
use crate::page::{Grid, Key, page};
use crate::panel::{Panel, Surround};
use crate::picture::Picture;
use crate::style::{BLUE, HAIR, PURPLE, SMALL, THIN, VERMILION};
use crate::text;
use crate::trace::Frame;

/// Periodograms of some channels, on logarithmic scales, with thresholds and marked lines; all
/// panels have one scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// What is seen.
    pub title: String,
    /// More words, or none.
    pub subtitle: String,
    /// Frequencies, cycles a day, rising. That of zero has no place on the scale and is left out.
    pub frequency_per_day: Vec<f64>,
    /// One panel each, one above the other.
    pub channels: Vec<SpectrumPanel>,
    /// Name of the ordinate: `power`.
    pub quantity: String,
    /// Its unit: `g²`, or empty for normalised power.
    pub unit: String,
    /// Frequencies to be marked in all panels.
    pub marks: Vec<MarkedLine>,
}

/// The periodogram of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectrumPanel {
    /// Its name: `x`.
    pub name: String,
    /// Power at the frequencies; nan where there is none. Zero has no place on the scale and is
    /// left out.
    pub power: Vec<f64>,
    /// Number of samples it was made of.
    pub samples: usize,
    /// Power that noise alone seldom passes.
    pub threshold: Option<Threshold>,
}

/// A power that the largest ordinate of noise alone passes with a known probability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// The power.
    pub power: f64,
    /// Probability that noise alone passes it anywhere in the panel.
    pub false_alarm_probability: f64,
}

/// A frequency to be marked.
#[derive(Clone, Debug, PartialEq)]
pub struct MarkedLine {
    /// The frequency, cycles a day.
    pub frequency_per_day: f64,
    /// What it is: `sidereal day`, `5.3 h`.
    pub label: String,
}

const MARK_ROW: f64 = 14.0;

impl Picture for Spectrum {
    fn to_svg(&self) -> Result<String, Error> {
        self.check()?;
        let grid = Grid::new(1, self.channels.len(), 170.0);
        let span = Span::of(self.frequency_per_day.iter().copied().filter(|f| *f > 0.0));
        let span = span.unwrap_or(Span { lo: 0.1, hi: 10.0 }).open();
        let abscissa = Axis::logarithmic(span, "frequency", "cycles a day", 8);
        let rows = self.mark_rows(&abscissa, grid);
        let lines = rows.iter().map(|(_, row, _)| row + 1).max().unwrap_or(0) as f64;
        let room = MARK_ROW * lines;
        let keys = self.keys();
        page(
            &self.title,
            &self.subtitle,
            &keys,
            grid.height() + room,
            |canvas, mut body| {
                body.top += room;
                for (x, row, label) in &rows {
                    let y = body.top - MARK_ROW * (*row as f64 + 0.5);
                    let lettering = Lettering::new(SMALL, Align::Middle).colour(PURPLE);
                    canvas.text(label, (body.left + x, y), lettering)?;
                }
                self.panels(canvas, grid, body, &abscissa)
            },
        )
    }
}

impl Spectrum {
    fn check(&self) -> Result<(), Error> {
        check::some("the list of channels", &self.channels)?;
        check::rising("the frequencies", &self.frequency_per_day)?;
        let frequencies = ("the frequencies", self.frequency_per_day.len());
        for channel in &self.channels {
            let what = || format!("power of {}", channel.name);
            check::column(what, &channel.power, frequencies)?;
            if let Some(threshold) = channel.threshold {
                check::positive("the threshold of power", threshold.power)?;
            }
        }
        for mark in &self.marks {
            check::positive("a marked frequency", mark.frequency_per_day)?;
        }
        Ok(())
    }

    fn keys(&self) -> Vec<Key> {
        let mut keys = vec![Key::line(Stroke::solid(BLUE, 2.0), "periodogram")];
        if let Some(threshold) = self.channels.iter().find_map(|channel| channel.threshold) {
            let label = format!(
                "threshold; noise alone passes it anywhere in a panel with probability {}",
                percent(threshold.false_alarm_probability)
            );
            keys.push(Key::line(Stroke::dashed(VERMILION, THIN), label));
        }
        if !self.marks.is_empty() {
            keys.push(Key::line(Stroke::dashed(PURPLE, THIN), "marked frequency"));
        }
        keys
    }

    /// The span of what a logarithmic scale can show of a channel.
    fn powers(&self, channel: &SpectrumPanel) -> Option<Span> {
        let shown = self.frequency_per_day.iter().zip(&channel.power);
        let shown = shown.filter(|(frequency, power)| **frequency > 0.0 && **power > 0.0);
        Span::of(shown.map(|(_, power)| *power))
    }

    /// Labels of marks: px from the left of the body, row above the panels, text; no two overlap.
    fn mark_rows(&self, abscissa: &Axis, grid: Grid) -> Vec<(f64, usize, String)> {
        let body = Frame {
            left: 0.0,
            top: 0.0,
            right: crate::style::WIDTH - 2.0 * crate::style::MARGIN,
            bottom: 0.0,
        };
        let frame = grid.frame(body, 0);
        let mut taken: Vec<Vec<(f64, f64)>> = Vec::new();
        let mut labels = Vec::new();
        for mark in &self.marks {
            let part = abscissa.at(mark.frequency_per_day);
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

    fn panels(
        &self,
        canvas: &mut Canvas<'_>,
        grid: Grid,
        body: Frame,
        abscissa: &Axis,
    ) -> Result<(), Error> {
        let spans: Vec<Option<Span>> = self.channels.iter().map(|c| self.powers(c)).collect();
        let ends = spans.iter().flatten().flat_map(|span| [span.lo, span.hi]);
        let thresholds = self.channels.iter().filter_map(|channel| channel.threshold);
        let span = Span::of(ends.chain(thresholds.map(|threshold| threshold.power)));
        let span = room_above(span.unwrap_or(Span { lo: 1.0, hi: 10.0 }));
        for (index, channel) in self.channels.iter().enumerate() {
            let panel = Panel {
                frame: grid.frame(body, index),
                x: abscissa.clone(),
                y: Axis::logarithmic(span, &self.quantity, &self.unit, 6),
            };
            let surround = Surround {
                name: &channel.name,
                note: &format!("n = {}", count(channel.samples)),
                abscissa: grid.shows_abscissa(index),
                ordinate_title: true,
            };
            panel.surround(canvas, surround)?;
            if spans[index].is_none() {
                panel.empty(canvas)?;
                continue;
            }
            for mark in &self.marks {
                let stroke = Stroke::dashed(PURPLE, HAIR);
                panel.upright(canvas, mark.frequency_per_day, stroke)?;
            }
            panel.line_bridging(
                canvas,
                &self.frequency_per_day,
                &channel.power,
                Stroke::solid(BLUE, THIN),
                f64::INFINITY,
            )?;
            if let Some(threshold) = channel.threshold {
                panel.level(canvas, threshold.power, Stroke::dashed(VERMILION, THIN))?;
            }
        }
        Ok(())
    }
}

/// Some room above the largest power; at most eight decades, so that ordinates near zero by
/// chance do not press the rest flat.
fn room_above(span: Span) -> Span {
    let hi = 2.0 * span.hi;
    Span {
        lo: span.lo.max(1e-8 * hi).min(0.5 * span.hi),
        hi,
    }
}
