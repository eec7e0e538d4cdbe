//! Estimates of several estimators.

use crate::axes::{Axes, Labels};
use crate::axis::Axis;
use crate::canvas::{Align, Canvas, LineStyle, TextStyle};
use crate::check;
use crate::error::Error;
use crate::figure::{Legend, figure};
use crate::geometry::Rect;
use crate::layout::Layout;
use crate::page::Tint;
use crate::picture::Picture;
use crate::span::Span;
use crate::style::{BLACK, Colour, DATA, SERIES, SMALL, THIN, colour};
use crate::text;

/// Dots with error bars: estimates of some quantities by several estimators, one panel a quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Main statement of the picture.
    pub title: String,
    /// Further description; may be empty.
    pub subtitle: String,
    /// Names of the estimators, from top to bottom in each panel.
    pub estimators: Vec<String>,
    /// Colours of the estimators by their meaning; of others, where there are none, in their order.
    pub tints: Vec<Tint>,
    /// The quantities, one panel each, row after row.
    pub quantities: Vec<ComparedQuantity>,
    /// Number of panels in a row.
    pub columns: usize,
    /// Meaning of the references, for the legend: `true value`.
    pub reference_label: String,
}

/// An estimated quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedQuantity {
    /// Name of the quantity: `gyro_x.bias`.
    pub name: String,
    /// Its unit: `deg/h`.
    pub unit: String,
    /// True or otherwise known value.
    pub reference: Option<f64>,
    /// One estimate of each estimator, in their order.
    pub estimates: Vec<ComparedEstimate>,
}

/// One estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComparedEstimate {
    /// The value; nan for a missing one.
    pub value: f64,
    /// Its standard deviation; nan if it is not known.
    pub sigma: f64,
}

/// Height of the row of an estimator, px.
const ROW_PX: f64 = 17.0;

impl Picture for Comparison {
    fn to_svg(&self) -> Result<String, Error> {
        self.check()?;
        let widths = self.estimators.iter();
        let widths = widths.map(|name| text::width_px(name, SMALL, false));
        let names_px = widths.fold(20.0, f64::max).min(170.0);
        let panel_px = ROW_PX * self.estimators.len() as f64 + 10.0;
        let layout = Layout::new(self.columns, self.quantities.len(), panel_px)
            .with_own_abscissae()
            .with_left(34.0);
        Ok(figure(
            &self.title,
            &self.subtitle,
            &self.legend(),
            layout.height(),
            |canvas, mut body| {
                body.left += names_px;
                self.draw(canvas, layout, body, names_px);
            },
        ))
    }
}

impl Comparison {
    fn check(&self) -> Result<(), Error> {
        check::non_empty("the list of estimators", &self.estimators)?;
        check::non_empty("the list of quantities", &self.quantities)?;
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

    fn legend(&self) -> Vec<Legend> {
        let names = self.estimators.iter().enumerate();
        let mut legend: Vec<Legend> = names
            .map(|(index, name)| Legend::dot(self.colour(index), name.as_str()))
            .collect();
        let bar = LineStyle::solid(BLACK, DATA);
        legend.push(Legend::line(bar, "±2σ (95%)"));
        if self.quantities.iter().any(|q| q.reference.is_some()) {
            let style = LineStyle::dashed(BLACK, THIN);
            legend.push(Legend::line(style, self.reference_label.as_str()));
        }
        legend
    }

    fn draw(&self, canvas: &mut Canvas, layout: Layout, body: Rect, names_px: f64) {
        let rows = Span {
            lo: -0.8,
            hi: self.estimators.len() as f64 - 0.2,
        };
        for (index, quantity) in self.quantities.iter().enumerate() {
            let frame = layout.frame(body, index);
            let ends = quantity.estimates.iter().flat_map(|e| e.ends());
            let span = Span::of(ends.chain(quantity.reference));
            let has_data = span.is_some();
            let span = span.unwrap_or(Span { lo: 0.0, hi: 1.0 }).padded(0.08);
            let ticks = (frame.width() / 50.0) as usize;
            let axes = Axes {
                frame,
                x: Axis::linear(span, "", &quantity.unit, ticks),
                y: Axis::named(rows, Vec::new(), ""),
            };
            if layout.is_first_in_row(index) {
                self.draw_names(canvas, &axes, names_px);
            }
            let labels = Labels {
                name: &quantity.name,
                note: "",
                abscissa: true,
                ordinate_title: false,
            };
            axes.draw(canvas, labels, has_data, |axes, canvas| {
                quantity.draw(canvas, axes, |row| self.colour(row));
            });
        }
    }

    fn colour(&self, estimator: usize) -> Colour {
        let in_order = SERIES[estimator % SERIES.len()];
        self.tints
            .get(estimator)
            .map_or(in_order, |tint| colour(*tint))
    }

    /// The names of the estimators left of a panel.
    fn draw_names(&self, canvas: &mut Canvas, axes: &Axes, names_px: f64) {
        for (row, name) in self.estimators.iter().enumerate() {
            let (_, y) = axes.point(0.0, ordinate(row, self.estimators.len()));
            let name = text::fit(name, SMALL, false, names_px);
            let style = TextStyle::new(SMALL, Align::End);
            canvas.text(&name, (axes.frame.left - 8.0, y), style);
        }
    }
}

impl ComparedQuantity {
    fn draw(&self, canvas: &mut Canvas, axes: &Axes, colour: impl Fn(usize) -> Colour) {
        if let Some(reference) = self.reference {
            axes.vertical_line(canvas, reference, LineStyle::dashed(BLACK, THIN));
        }
        for (row, estimate) in self.estimates.iter().enumerate() {
            let colour = colour(row);
            let y = ordinate(row, self.estimates.len());
            let [lower, upper] = estimate.ends();
            if lower < upper {
                let bar = [axes.point(lower, y), axes.point(upper, y)];
                canvas.line(&bar, LineStyle::solid(colour, DATA));
            }
            if !estimate.value.is_nan() {
                canvas.disc(axes.point(estimate.value, y), 3.0, colour);
            }
        }
    }
}

/// Ordinate of a row, counted from the top.
fn ordinate(row: usize, rows: usize) -> f64 {
    rows as f64 - 1.0 - row as f64
}

impl ComparedEstimate {
    /// Both ends of the error bar.
    fn ends(&self) -> [f64; 2] {
        let half = if self.sigma.is_nan() {
            0.0
        } else {
            2.0 * self.sigma
        };
        [self.value - half, self.value + half]
    }
}
