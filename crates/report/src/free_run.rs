//! Simulation against measurement.

use crate::axis::{Axis, Span};
use crate::canvas::{Canvas, Stroke};
use crate::check;
use crate::error::Error;
use crate::number::{count, readable_unit, short};
use crate::page::{Grid, Key, page};
use crate::panel::{Panel, Surround};
use crate::picture::Picture;
use crate::scale::{Scale, rms};
use crate::style::{BLACK, DATA, GREY, HAIR, SKY, THIN, VERMILION};
use crate::trace::Frame;

/// Specific force in three axes as measured and as simulated freely from the first sample, and
/// the difference of both below, with the noise of a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeRun {
    /// What is seen.
    pub title: String,
    /// More words, or none.
    pub subtitle: String,
    /// Times of the samples, s; shown from the first.
    pub time_s: Vec<f64>,
    /// Measured specific force of x, y, z, g; nan where there is none.
    pub measured_g: [Vec<f64>; 3],
    /// Simulated specific force of x, y, z, g.
    pub simulated_g: [Vec<f64>; 3],
    /// Standard deviation of the noise of one sample of x, y, z, g.
    pub sigma_g: [f64; 3],
}

const AXES: [&str; 3] = ["x", "y", "z"];

impl Picture for FreeRun {
    fn to_svg(&self) -> Result<String, Error> {
        check::rising("the times of the samples", &self.time_s)?;
        let times = ("the times", self.time_s.len());
        for (axis, name) in AXES.iter().enumerate() {
            let measured = &self.measured_g[axis];
            check::column(|| format!("measured {name}"), measured, times)?;
            let simulated = &self.simulated_g[axis];
            check::column(|| format!("simulated {name}"), simulated, times)?;
            check::positive("sigma of a sample", self.sigma_g[axis])?;
        }
        let keys = [
            Key::line(Stroke::solid(SKY, 3.0), "measured"),
            Key::line(Stroke::solid(BLACK, THIN), "simulated"),
            Key::line(Stroke::solid(VERMILION, 2.0), "measured less simulated"),
            Key::line(
                Stroke::dashed(BLACK, THIN),
                "noise of a sample, plus and minus 2 sigma (95%)",
            ),
        ];
        let grid = Grid::new(3, 6, 180.0);
        page(
            &self.title,
            &self.subtitle,
            &keys,
            grid.height(),
            |canvas, body| self.panels(canvas, grid, body),
        )
    }
}

impl FreeRun {
    fn panels(&self, canvas: &mut Canvas<'_>, grid: Grid, body: Frame) -> Result<(), Error> {
        let origin = self.time_s.first().copied().unwrap_or(0.0);
        let elapsed: Vec<f64> = self.time_s.iter().map(|time| time - origin).collect();
        let span = Span::of(elapsed.iter().copied()).unwrap_or(Span { lo: 0.0, hi: 1.0 });
        let abscissa = Axis::time(span.open(), 5);
        let forces = self.measured_g.iter().chain(&self.simulated_g);
        let forces = Span::of(forces.flatten().copied()).unwrap_or(Span::symmetric(1.0));
        let forces = Axis::linear(forces.padded(0.04), "specific force", "g", 6);
        let differences: [Vec<f64>; 3] = std::array::from_fn(|axis| {
            let pairs = self.measured_g[axis].iter().zip(&self.simulated_g[axis]);
            pairs
                .map(|(measured, simulated)| measured - simulated)
                .collect()
        });
        let widest = self
            .sigma_g
            .iter()
            .fold(0.0_f64, |most, &sigma| most.max(sigma));
        let columns = differences.iter().map(Vec::as_slice);
        let scale = Scale::about_zero(columns, 2.5 * widest);
        for axis in 0..3 {
            let panel = Panel {
                frame: grid.frame(body, axis),
                x: abscissa.clone(),
                y: forces.clone(),
            };
            let (_, there) = rms(&differences[axis]);
            let surround = Surround {
                name: AXES[axis],
                note: &format!("n = {}", count(there)),
                abscissa: false,
                ordinate_title: axis == 0,
            };
            panel.surround(canvas, surround)?;
            let measured = &self.measured_g[axis];
            let simulated = &self.simulated_g[axis];
            if rms(measured).1 + rms(simulated).1 == 0 {
                panel.empty(canvas)?;
            }
            panel.line(canvas, &elapsed, measured, Stroke::solid(SKY, 3.0))?;
            panel.line(canvas, &elapsed, simulated, Stroke::solid(BLACK, THIN))?;

            let panel = Panel {
                frame: grid.frame(body, 3 + axis),
                x: abscissa.clone(),
                y: Axis::linear(scale.span(), "difference", "g", 6),
            };
            let surround = Surround {
                name: &format!("{}, difference", AXES[axis]),
                note: &self.note(&scale, &differences[axis], axis),
                abscissa: true,
                ordinate_title: axis == 0,
            };
            panel.surround(canvas, surround)?;
            if there == 0 {
                panel.empty(canvas)?;
                continue;
            }
            panel.level(canvas, 0.0, Stroke::solid(GREY, HAIR))?;
            let stroke = Stroke::solid(VERMILION, DATA);
            panel.line(canvas, &elapsed, &differences[axis], stroke)?;
            let sigma = self.sigma_g[axis];
            for level in [-2.0 * sigma, 2.0 * sigma] {
                panel.level(canvas, level, Stroke::dashed(BLACK, HAIR))?;
            }
        }
        Ok(())
    }

    fn note(&self, scale: &Scale, difference: &[f64], axis: usize) -> String {
        let (size, _) = rms(difference);
        let (factor, unit) = readable_unit("g", size.max(self.sigma_g[axis]));
        let mut note = format!(
            "rms {}, noise {} {unit}",
            short(size * factor, 2),
            short(self.sigma_g[axis] * factor, 2)
        );
        if let Some((number, _)) = scale.beyond(difference) {
            note += &format!("; {} beyond", count(number));
        }
        note
    }
}
