//! Residuals in three axes.

use crate::axis::{Axis, Span};
use crate::canvas::{Canvas, Stroke};
use crate::check;
use crate::error::Error;
use crate::number::{count, readable_unit, short};
use crate::page::{Grid, Key, page};
use crate::panel::{Panel, Surround};
use crate::picture::Picture;
use crate::scale::{Scale, rms};
use crate::style::{BLACK, BLUE, GREY, HAIR, THIN, VERMILION};
use crate::trace::Frame;

/// Residuals of three axes against time, before and maybe after a change of the model, all on
/// one scale, with the band of the noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Residuals {
    /// What is seen.
    pub title: String,
    /// More words, or none.
    pub subtitle: String,
    /// Times of the samples, s; shown from the first.
    pub time_s: Vec<f64>,
    /// Residuals of x, y, z; nan where there is none.
    pub before: [Vec<f64>; 3],
    /// What these residuals are of, for the key: `nominal model`.
    pub before_label: String,
    /// Residuals of the changed model.
    pub after: Option<After>,
    /// Standard deviation of the noise of x, y, z, in the same unit.
    pub sigma: [f64; 3],
    /// Name of the ordinate: `residual`.
    pub quantity: String,
    /// Unit of residuals and sigma: `g`, or empty for normalised ones.
    pub unit: String,
}

/// Residuals of a changed model at the same times.
#[derive(Clone, Debug, PartialEq)]
pub struct After {
    /// Residuals of x, y, z; nan where there is none.
    pub values: [Vec<f64>; 3],
    /// What they are of, for the key: `with gyro_y.g_z`.
    pub label: String,
}

const AXES: [&str; 3] = ["x", "y", "z"];

impl Picture for Residuals {
    fn to_svg(&self) -> Result<String, Error> {
        self.check()?;
        let grid = Grid::new(1, 3, 150.0);
        page(
            &self.title,
            &self.subtitle,
            &self.keys(),
            grid.height(),
            |canvas, body| self.panels(canvas, grid, body),
        )
    }
}

impl Residuals {
    fn check(&self) -> Result<(), Error> {
        check::rising("the times of the residuals", &self.time_s)?;
        let times = ("the times", self.time_s.len());
        for (axis, values) in AXES.iter().zip(&self.before) {
            check::column(|| format!("residuals of {axis}"), values, times)?;
        }
        for (axis, values) in AXES.iter().zip(self.after.iter().flat_map(|a| &a.values)) {
            check::column(|| format!("residuals of {axis} after"), values, times)?;
        }
        for sigma in self.sigma {
            check::positive("sigma of the noise", sigma)?;
        }
        Ok(())
    }

    fn keys(&self) -> Vec<Key> {
        let before = if self.after.is_some() {
            format!("before: {}", self.before_label)
        } else {
            self.before_label.clone()
        };
        let mut keys = vec![Key::line(Stroke::solid(self.first_colour(), 2.0), before)];
        if let Some(after) = &self.after {
            let label = format!("after: {}", after.label);
            keys.push(Key::line(Stroke::solid(BLUE, 2.0), label));
        }
        let noise = "noise, plus and minus 2 sigma (95%)";
        keys.push(Key::line(Stroke::dashed(BLACK, THIN), noise));
        keys
    }

    fn first_colour(&self) -> plotters::style::RGBColor {
        if self.after.is_some() {
            VERMILION
        } else {
            BLUE
        }
    }

    fn panels(&self, canvas: &mut Canvas<'_>, grid: Grid, body: Frame) -> Result<(), Error> {
        let after = self.after.as_ref().map(|after| &after.values);
        let columns = self.before.iter().chain(after.into_iter().flatten());
        let widest = self
            .sigma
            .iter()
            .fold(0.0_f64, |most, &sigma| most.max(sigma));
        let scale = Scale::about_zero(columns.map(Vec::as_slice), 2.5 * widest);
        let origin = self.time_s.first().copied().unwrap_or(0.0);
        let elapsed: Vec<f64> = self.time_s.iter().map(|time| time - origin).collect();
        let span = Span::of(elapsed.iter().copied()).unwrap_or(Span { lo: 0.0, hi: 1.0 });
        for axis in 0..3 {
            let panel = Panel {
                frame: grid.frame(body, axis),
                x: Axis::time(span.open(), 10),
                y: Axis::linear(scale.span(), &self.quantity, &self.unit, 5),
            };
            let before = &self.before[axis];
            let after = after.map(|values| &values[axis]);
            panel.surround(
                canvas,
                Surround {
                    name: AXES[axis],
                    note: &self.note(&scale, axis),
                    abscissa: grid.shows_abscissa(axis),
                    ordinate_title: true,
                },
            )?;
            let (_, there) = rms(before);
            let (_, there_after) = after.map_or((0.0, 0), |values| rms(values));
            if there + there_after == 0 {
                panel.empty(canvas)?;
                continue;
            }
            let sigma = self.sigma[axis];
            panel.level(canvas, 0.0, Stroke::solid(GREY, HAIR))?;
            let stroke = Stroke::solid(self.first_colour(), THIN);
            panel.line(canvas, &elapsed, before, stroke)?;
            if let Some(values) = after {
                panel.line(canvas, &elapsed, values, Stroke::solid(BLUE, THIN))?;
            }
            for level in [-2.0 * sigma, 2.0 * sigma] {
                panel.level(canvas, level, Stroke::dashed(BLACK, THIN))?;
            }
        }
        Ok(())
    }

    /// Root mean squares, number of values, and what the scale leaves out.
    fn note(&self, scale: &Scale, axis: usize) -> String {
        let (before, there) = rms(&self.before[axis]);
        let after = self.after.as_ref().map(|after| &after.values[axis]);
        let (factor, unit) = readable_unit(&self.unit, before.max(self.sigma[axis]));
        let amount = |value: f64| short(value * factor, 2);
        let mut note = format!("rms {}", amount(before));
        if let Some(values) = after {
            note += &format!(" before, {} after", amount(rms(values).0));
        }
        note += &format!(", noise {} {unit}", amount(self.sigma[axis]));
        note.truncate(note.trim_end().len());
        note += &format!("; n = {}", count(there));
        let beyond = [Some(&self.before[axis]), after];
        let beyond = beyond.into_iter().flatten();
        let beyond: Vec<_> = beyond.filter_map(|values| scale.beyond(values)).collect();
        if !beyond.is_empty() {
            let number: usize = beyond.iter().map(|(number, _)| number).sum();
            let largest = beyond
                .iter()
                .fold(0.0_f64, |most, (_, size)| most.max(*size));
            note += &format!(
                "; {} beyond the scale, to {}",
                count(number),
                amount(largest)
            );
        }
        note
    }
}
