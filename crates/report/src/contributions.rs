//! What single terms of a law contribute, measurement by measurement.

use crate::axis::{Axis, Span};
use crate::canvas::{Canvas, Stroke};
use crate::check;
use crate::error::Error;
use crate::number::count;
use crate::page::{Grid, Key, page};
use crate::panel::{Panel, Surround};
use crate::picture::Picture;
use crate::style::{BLUE, DATA, GREY, HAIR, LEFT, THIN, VERMILION};
use crate::trace::Frame;

/// What is left of measurements when all terms of a law but one are taken off, against what that
/// one multiplies, with the term as it was fitted; all panels have one scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Contributions {
    /// What is seen.
    pub title: String,
    /// More words, or none.
    pub subtitle: String,
    /// Name of the ordinate: `rate`.
    pub quantity: String,
    /// Its unit: `deg/h`.
    pub unit: String,
    /// What a dot is: `one static stop`.
    pub dot: String,
    /// One panel each, row after row.
    pub panels: Vec<Contribution>,
    /// Panels side by side.
    pub columns: usize,
}

/// One term.
#[derive(Clone, Debug, PartialEq)]
pub struct Contribution {
    /// Name of the term, over its panel.
    pub name: String,
    /// Its size, over its panel.
    pub size: String,
    /// Name of what it multiplies: `specific force z`.
    pub abscissa: String,
    /// Unit of that.
    pub abscissa_unit: String,
    /// What it multiplies, at each measurement.
    pub abscissae: Vec<f64>,
    /// What is left of each measurement.
    pub rest: Vec<f64>,
    /// Standard error of each measurement.
    pub standard_error: Vec<f64>,
    /// The fitted term in one unit of the abscissa.
    pub slope: f64,
}

impl Picture for Contributions {
    fn to_svg(&self) -> Result<String, Error> {
        check::some("the list of panels", &self.panels)?;
        for panel in &self.panels {
            let of = |what: &str| format!("{what} of {}", panel.name);
            let abscissae = ("the abscissae", panel.abscissae.len());
            check::column(|| of("values"), &panel.rest, abscissae)?;
            check::column(|| of("standard errors"), &panel.standard_error, abscissae)?;
            check::not_infinite(|| of("abscissae"), &panel.abscissae)?;
            check::finite(&of("slope"), panel.slope)?;
        }
        let mut grid = Grid::new(self.columns, self.panels.len(), 170.0);
        grid.own_abscissa = true;
        grid.left_px = LEFT;
        let keys = [
            Key::dot(BLUE, &self.dot),
            Key::line(
                Stroke::solid(BLUE, THIN),
                "plus and minus 2 standard errors (95%)",
            ),
            Key::line(Stroke::solid(VERMILION, DATA), "the fitted term"),
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

impl Contributions {
    fn draw(&self, canvas: &mut Canvas<'_>, grid: Grid, body: Frame) -> Result<(), Error> {
        let ends = self.panels.iter().flat_map(Contribution::ends);
        let span = Span::of(ends.filter(|end| !end.is_nan()));
        let span = span.unwrap_or(Span::symmetric(1.0)).padded(0.06);
        for (index, data) in self.panels.iter().enumerate() {
            let frame = grid.frame(body, index);
            let there = data.abscissae.iter().copied().filter(|x| !x.is_nan());
            let along = Span::of(there).unwrap_or(Span { lo: 0.0, hi: 1.0 });
            let ticks = (frame.width() / 50.0) as usize;
            let panel = Panel {
                frame,
                x: Axis::linear(
                    along.padded(0.05),
                    &data.abscissa,
                    &data.abscissa_unit,
                    ticks,
                ),
                y: Axis::linear(span, &self.quantity, &self.unit, 5),
            };
            let surround = Surround {
                name: &data.name,
                note: &format!("{}, n = {}", data.size, count(data.rest.len())),
                abscissa: true,
                ordinate_title: index % self.columns.max(1) == 0,
            };
            panel.surround(canvas, surround)?;
            if data.rest.is_empty() {
                panel.empty(canvas)?;
                continue;
            }
            panel.level(canvas, 0.0, Stroke::solid(GREY, HAIR))?;
            let at_ends = [along.lo, along.hi];
            let fitted = at_ends.map(|x| data.slope * x);
            panel.line(canvas, &at_ends, &fitted, Stroke::solid(VERMILION, DATA))?;
            for ((x, y), sigma) in data.dots() {
                let bar = [y - 2.0 * sigma, y + 2.0 * sigma].map(|end| panel.place(x, end));
                canvas.line(&bar, Stroke::solid(BLUE, THIN))?;
                canvas.disc(panel.place(x, y), 2.5, BLUE, 1.0)?;
            }
        }
        Ok(())
    }
}

impl Contribution {
    /// Measurements that are there.
    fn dots(&self) -> impl Iterator<Item = ((f64, f64), f64)> {
        let places = self
            .abscissae
            .iter()
            .copied()
            .zip(self.rest.iter().copied());
        let dots = places.zip(self.standard_error.iter().copied());
        dots.filter(|((x, y), sigma)| !(x + y + sigma).is_nan())
    }

    fn ends(&self) -> impl Iterator<Item = f64> {
        self.dots()
            .flat_map(|((_, y), sigma)| [y - 2.0 * sigma, y + 2.0 * sigma])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(rest: Vec<f64>) -> Contributions {
        Contributions {
            title: "Terms".to_owned(),
            subtitle: String::new(),
            quantity: "rate".to_owned(),
            unit: "deg/h".to_owned(),
            dot: "one static stop".to_owned(),
            panels: vec![Contribution {
                name: "gyro_x.g_z".to_owned(),
                size: "2 deg/h/g".to_owned(),
                abscissa: "specific force z".to_owned(),
                abscissa_unit: "g".to_owned(),
                abscissae: vec![-1.0, 0.0, 1.0],
                rest,
                standard_error: vec![0.1; 3],
                slope: 2.0,
            }],
            columns: 2,
        }
    }

    #[test]
    fn every_measurement_is_a_dot_and_a_missing_one_is_none() {
        let dots = |svg: &str| svg.matches("<circle").count();
        let all = picture(vec![-2.0, 0.1, 2.0]).to_svg().unwrap_or_default();
        let one_less = picture(vec![-2.0, f64::NAN, 2.0])
            .to_svg()
            .unwrap_or_default();
        // One more is in the key.
        assert_eq!((dots(&all), dots(&one_less)), (4, 3));
        assert!(all.contains("2 deg/h/g, n = 3"));
    }

    #[test]
    fn columns_of_unequal_length_and_infinite_values_are_refused() {
        assert!(picture(vec![0.0; 2]).to_svg().is_err());
        assert!(picture(vec![0.0, f64::INFINITY, 0.0]).to_svg().is_err());
    }
}
