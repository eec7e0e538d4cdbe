//! Estimates of several estimators.

use crate::axis::{Axis, Span};
use crate::canvas::{Align, Canvas, Lettering, Stroke};
use crate::check;
use crate::error::Error;
use crate::page::{Grid, Key, page};
use crate::panel::{Panel, Surround};
use crate::picture::Picture;
use crate::style::{BLACK, DATA, SERIES, SMALL, THIN};
use crate::text;
use crate::trace::Frame;

/// Dots with error bars: some quantities as several estimators see them, one panel a quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// What is seen.
    pub title: String,
    /// More words, or none.
    pub subtitle: String,
    /// Names of the estimators, from top to bottom in each panel.
    pub estimators: Vec<String>,
    /// One panel each, row after row.
    pub quantities: Vec<Quantity>,
    /// Panels side by side.
    pub columns: usize,
    /// What references are, for the key: `true value`.
    pub reference_label: String,
}

/// What was estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Its name: `gyro_x.bias`.
    pub name: String,
    /// Its unit: `deg/h`.
    pub unit: String,
    /// True or otherwise known value.
    pub reference: Option<f64>,
    /// One estimate of each estimator, in their order.
    pub estimates: Vec<Estimate>,
}

/// One estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value; nan if there is none.
    pub value: f64,
    /// Its standard deviation; nan if it is not known.
    pub sigma: f64,
}

const ROW_PX: f64 = 17.0;

impl Picture for Comparison {
    fn to_svg(&self) -> Result<String, Error> {
        self.check()?;
        let rows = self.estimators.len() as f64;
        let names = self
            .estimators
            .iter()
            .map(|e| text::width_px(e, SMALL, false));
        let names = names.fold(20.0, f64::max).min(170.0);
        let columns = self.columns.max(1);
        let mut grid = Grid::new(columns, self.quantities.len(), ROW_PX * rows + 10.0);
        grid.own_abscissa = true;
        grid.left_px = 34.0;
        let mut keys: Vec<Key> = self
            .estimators
            .iter()
            .enumerate()
            .map(|(index, name)| Key::dot(SERIES[index % SERIES.len()], name.as_str()))
            .collect();
        keys.push(Key::line(
            Stroke::solid(BLACK, DATA),
            "plus and minus 2 sigma (95%)",
        ));
        if self.quantities.iter().any(|q| q.reference.is_some()) {
            let stroke = Stroke::dashed(BLACK, THIN);
            keys.push(Key::line(stroke, self.reference_label.as_str()));
        }
        page(
            &self.title,
            &self.subtitle,
            &keys,
            grid.height(),
            |canvas, mut body| {
                body.left += names;
                self.panels(canvas, grid, body, names)
            },
        )
    }
}

impl Comparison {
    fn check(&self) -> Result<(), Error> {
        check::some("the list of estimators", &self.estimators)?;
        check::some("the list of quantities", &self.quantities)?;
        for quantity in &self.quantities {
            if quantity.estimates.len() != self.estimators.len() {
                return Err(Error::UnequalLengths {
                    what: format!("the list of estimates of {}", quantity.name),
                    found: quantity.estimates.len(),
                    against: "the estimators".to_owned(),
                    expected: self.estimators.len(),
                });
            }
            for estimate in &quantity.estimates {
                let what = || format!("an estimate of {}", quantity.name);
                check::not_infinite(what, &[estimate.value, estimate.sigma])?;
            }
            if let Some(reference) = quantity.reference {
                check::finite(&format!("the reference of {}", quantity.name), reference)?;
            }
        }
        Ok(())
    }

    fn panels(
        &self,
        canvas: &mut Canvas<'_>,
        grid: Grid,
        body: Frame,
        names: f64,
    ) -> Result<(), Error> {
        let rows = self.estimators.len() as f64;
        for (index, quantity) in self.quantities.iter().enumerate() {
            let frame = grid.frame(body, index);
            let ends = quantity
                .estimates
                .iter()
                .flat_map(|estimate| estimate.ends());
            let span = Span::of(ends.chain(quantity.reference));
            let any = span.is_some();
            let span = span.unwrap_or(Span { lo: 0.0, hi: 1.0 }).padded(0.08);
            let ticks = (frame.width() / 50.0) as usize;
            let panel = Panel {
                frame,
                x: Axis::linear(span, "", &quantity.unit, ticks),
                y: Axis::named(
                    Span {
                        lo: -0.8,
                        hi: rows - 0.2,
                    },
                    Vec::new(),
                    "",
                ),
            };
            let surround = Surround {
                name: &quantity.name,
                note: "",
                abscissa: true,
                ordinate_title: false,
            };
            panel.surround(canvas, surround)?;
            if !any {
                panel.empty(canvas)?;
            }
            if let Some(reference) = quantity.reference {
                panel.upright(canvas, reference, Stroke::dashed(BLACK, THIN))?;
            }
            for (row, estimate) in quantity.estimates.iter().enumerate() {
                let colour = SERIES[row % SERIES.len()];
                let y = rows - 1.0 - row as f64;
                if index % grid.columns == 0 {
                    let name = text::fit(&self.estimators[row], SMALL, false, names);
                    let place = (frame.left - 8.0, panel.place(0.0, y).1);
                    canvas.text(&name, place, Lettering::new(SMALL, Align::End))?;
                }
                let [lower, upper] = estimate.ends();
                if lower < upper {
                    let bar = [panel.place(lower, y), panel.place(upper, y)];
                    canvas.line(&bar, Stroke::solid(colour, DATA))?;
                }
                if !estimate.value.is_nan() {
                    canvas.disc(panel.place(estimate.value, y), 3.0, colour, 1.0)?;
                }
            }
        }
        Ok(())
    }
}

impl Estimate {
    fn ends(&self) -> [f64; 2] {
        let reach = if self.sigma.is_nan() {
            0.0
        } else {
            2.0 * self.sigma
        };
        [self.value - reach, self.value + reach]
    }
}
