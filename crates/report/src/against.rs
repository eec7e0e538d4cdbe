//! Residuals against what may cause them.

use crate::axis::{Axis, Span};
use crate::canvas::{Canvas, Stroke};
use crate::check;
use crate::error::Error;
use crate::number::count;
use crate::page::{Grid, Key, page};
use crate::panel::{Panel, Surround};
use crate::picture::Picture;
use crate::style::{BLUE, GREY, HAIR, LEFT, THIN};
use crate::trace::Frame;

/// Binned means of residuals against components of specific force, time or temperature, with two
/// standard errors; all panels have one scale of residuals.
#[derive(Clone, Debug, PartialEq)]
pub struct Against {
    /// What is seen.
    pub title: String,
    /// More words, or none.
    pub subtitle: String,
    /// Name of the ordinate: `mean residual`.
    pub quantity: String,
    /// Its unit: `g`.
    pub unit: String,
    /// One panel each, row after row.
    pub panels: Vec<AgainstPanel>,
    /// Panels side by side.
    pub columns: usize,
}

/// One residual against one abscissa.
#[derive(Clone, Debug, PartialEq)]
pub struct AgainstPanel {
    /// What the residual is of: `x`.
    pub name: String,
    /// Name of the abscissa: `specific force y`.
    pub abscissa: String,
    /// Unit of the abscissa: `g`, `days`, `°C`.
    pub abscissa_unit: String,
    /// The bins, in any order.
    pub bins: Vec<Bin>,
}

/// The mean of the residuals in one bin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// Mean abscissa of its samples.
    pub centre: f64,
    /// Mean residual.
    pub mean: f64,
    /// Standard error of that mean; nan if it is not known, as with a single sample.
    pub standard_error: f64,
    /// Number of samples.
    pub samples: usize,
}

impl Bin {
    /// Means in bins of equal width over the span of the abscissa, from pairs that are both
    /// finite; bins without samples are left out. The standard error is that of independent
    /// samples, from their scatter in the bin.
    #[must_use]
    pub fn of(abscissa: &[f64], residual: &[f64], bins: usize) -> Vec<Self> {
        let pairs = || {
            let pairs = abscissa.iter().copied().zip(residual.iter().copied());
            pairs.filter(|(x, y)| x.is_finite() && y.is_finite())
        };
        let Some(span) = Span::of(pairs().map(|(x, _)| x)) else {
            return Vec::new();
        };
        let bins = bins.max(1);
        let width = span.length() / bins as f64;
        // Number, mean abscissa, mean residual, sum of squared deviations (Welford).
        let mut sums = vec![(0_usize, 0.0, 0.0, 0.0); bins];
        for (x, y) in pairs() {
            let bin = ((x - span.lo) / width) as usize;
            let (number, mean_x, mean_y, squares) = &mut sums[bin.min(bins - 1)];
            *number += 1;
            *mean_x += (x - *mean_x) / *number as f64;
            let before = y - *mean_y;
            *mean_y += before / *number as f64;
            *squares += before * (y - *mean_y);
        }
        let there = sums.into_iter().filter(|(number, ..)| *number > 0);
        there
            .map(|(samples, centre, mean, squares)| {
                let number = samples as f64;
                Self {
                    centre,
                    mean,
                    // Not a number for a single sample, as it should be.
                    standard_error: (squares / (number - 1.0) / number).sqrt(),
                    samples,
                }
            })
            .collect()
    }
}

impl Picture for Against {
    fn to_svg(&self) -> Result<String, Error> {
        check::some("the list of panels", &self.panels)?;
        for (panel, bin) in self
            .panels
            .iter()
            .flat_map(|p| p.bins.iter().map(move |b| (p, b)))
        {
            let what = format!("bins of {} against {}", panel.name, panel.abscissa);
            check::finite(&what, bin.centre)?;
            check::finite(&what, bin.mean)?;
            check::not_infinite(|| what.clone(), &[bin.standard_error])?;
        }
        let mut grid = Grid::new(self.columns, self.panels.len(), 140.0);
        grid.own_abscissa = true;
        grid.left_px = LEFT;
        let keys = [
            Key::dot(BLUE, "mean of a bin"),
            Key::line(
                Stroke::solid(BLUE, THIN),
                "plus and minus 2 standard errors (95%)",
            ),
        ];
        page(
            &self.title,
            &self.subtitle,
            &keys,
            grid.height(),
            |canvas, body| self.draw(canvas, grid, body),
        )
    }
}

impl Against {
    fn draw(&self, canvas: &mut Canvas<'_>, grid: Grid, body: Frame) -> Result<(), Error> {
        let bins = self.panels.iter().flat_map(|panel| &panel.bins);
        let ends = bins.flat_map(|bin| bin.ends());
        let span = Span::of(ends).unwrap_or(Span::symmetric(1.0));
        let span = span.with(Span { lo: 0.0, hi: 0.0 }).padded(0.06);
        for (index, data) in self.panels.iter().enumerate() {
            let frame = grid.frame(body, index);
            let centres = Span::of(data.bins.iter().map(|bin| bin.centre));
            let centres = centres.unwrap_or(Span { lo: 0.0, hi: 1.0 }).padded(0.05);
            let ticks = (frame.width() / 50.0) as usize;
            let panel = Panel {
                frame,
                x: Axis::linear(centres, &data.abscissa, &data.abscissa_unit, ticks),
                y: Axis::linear(span, &self.quantity, &self.unit, 5),
            };
            let samples = data.bins.iter().map(|bin| bin.samples).sum();
            let surround = Surround {
                name: &data.name,
                note: &format!("n = {}", count(samples)),
                abscissa: true,
                ordinate_title: index % self.columns.max(1) == 0,
            };
            panel.surround(canvas, surround)?;
            if data.bins.is_empty() {
                panel.empty(canvas)?;
                continue;
            }
            panel.level(canvas, 0.0, Stroke::solid(GREY, HAIR))?;
            for bin in &data.bins {
                let [lower, upper] = bin.ends();
                if !bin.standard_error.is_nan() {
                    let bar = [
                        panel.place(bin.centre, lower),
                        panel.place(bin.centre, upper),
                    ];
                    canvas.line(&bar, Stroke::solid(BLUE, THIN))?;
                }
                canvas.disc(panel.place(bin.centre, bin.mean), 2.5, BLUE, 1.0)?;
            }
        }
        Ok(())
    }
}

impl Bin {
    fn ends(&self) -> [f64; 2] {
        let reach = if self.standard_error.is_nan() {
            0.0
        } else {
            2.0 * self.standard_error
        };
        [self.mean - reach, self.mean + reach]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_hold_means_and_their_errors() {
        let abscissa = [0.0, 0.1, 0.2, 0.9, 1.0, f64::NAN];
        let residual = [1.0, 2.0, 3.0, 7.0, f64::NAN, 5.0];
        let bins = Bin::of(&abscissa, &residual, 2);
        assert_eq!(bins.len(), 2);
        assert_eq!((bins[0].samples, bins[1].samples), (3, 1));
        assert!((bins[0].mean - 2.0).abs() < 1e-12 && (bins[0].centre - 0.1).abs() < 1e-12);
        // Variance 1 of three samples.
        assert!((bins[0].standard_error - (1.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert!(bins[1].standard_error.is_nan());
        assert!(Bin::of(&[f64::NAN], &[1.0], 4).is_empty());
    }
}
