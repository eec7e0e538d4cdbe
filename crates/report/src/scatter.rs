//! Points with error bars against covariates: one panel a covariate, one scale of ordinates.

use crate::axes::{Axes, Labels};
use crate::axis::Axis;
use crate::canvas::{Canvas, LineStyle};
use crate::figure::Legend;
use crate::geometry::Rect;
use crate::layout::Layout;
use crate::span::Span;
use crate::style::{BLUE, DATA, THIN, VERMILION};

/// Entry of the legend for the error bars.
pub(crate) fn error_bar_legend() -> Legend {
    Legend::line(LineStyle::solid(BLUE, THIN), "±2 standard errors (95%)")
}

/// All panels.
pub(crate) struct Scatter<'a> {
    /// Name and unit of the ordinate.
    pub quantity: &'a str,
    pub unit: &'a str,
    /// The span of the ordinates.
    pub span: Span,
    pub panels: Vec<ScatterPanel<'a>>,
}

/// One panel.
pub(crate) struct ScatterPanel<'a> {
    pub name: &'a str,
    pub note: String,
    /// Name and unit of the abscissa.
    pub covariate: &'a str,
    pub covariate_unit: &'a str,
    /// The span of the abscissae; `None` without data.
    pub span: Option<Span>,
    pub points: Vec<ErrorPoint>,
    /// Slope of a line through the origin.
    pub slope: Option<f64>,
}

/// A point with its error bar.
#[derive(Clone, Copy)]
pub(crate) struct ErrorPoint {
    pub x: f64,
    pub y: f64,
    /// Half-length of the error bar; nan for none.
    pub half: f64,
}

impl ErrorPoint {
    /// Both ends of the error bar.
    pub(crate) fn ends(self) -> [f64; 2] {
        let half = if self.half.is_nan() { 0.0 } else { self.half };
        [self.y - half, self.y + half]
    }
}

impl Scatter<'_> {
    /// The span of all error bars; `None` without points.
    pub(crate) fn span_of(panels: &[ScatterPanel<'_>]) -> Option<Span> {
        let points = panels.iter().flat_map(|panel| &panel.points);
        Span::of(points.flat_map(|point| point.ends()))
    }

    pub(crate) fn draw(&self, canvas: &mut Canvas, layout: Layout, body: Rect) {
        for (index, panel) in self.panels.iter().enumerate() {
            let frame = layout.frame(body, index);
            let span = panel.span.unwrap_or(Span { lo: 0.0, hi: 1.0 });
            let ticks = (frame.width() / 50.0) as usize;
            let axes = Axes {
                frame,
                x: Axis::linear(
                    span.padded(0.05),
                    panel.covariate,
                    panel.covariate_unit,
                    ticks,
                ),
                y: Axis::linear(self.span, self.quantity, self.unit, 5),
            };
            let labels = Labels {
                name: panel.name,
                note: &panel.note,
                abscissa: true,
                ordinate_title: layout.is_first_in_row(index),
            };
            axes.draw(canvas, labels, panel.span.is_some(), |axes, canvas| {
                axes.zero_line(canvas);
                if let Some(slope) = panel.slope {
                    let ends = [span.lo, span.hi];
                    let style = LineStyle::solid(VERMILION, DATA);
                    axes.line(canvas, &ends, &ends.map(|x| slope * x), style);
                }
                for point in &panel.points {
                    axes.error_bar(canvas, (point.x, point.y), point.half);
                }
            });
        }
    }
}
