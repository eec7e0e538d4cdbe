//! Cross-validation of an extended model.

use crate::axes::{Axes, Labels};
use crate::axis::{Axis, elapsed};
use crate::canvas::{Canvas, LineStyle};
use crate::check;
use crate::error::Error;
use crate::figure::{Legend, figure};
use crate::geometry::Rect;
use crate::layout::Layout;
use crate::number::short;
use crate::picture::Picture;
use crate::span::Span;
use crate::style::{BLACK, BLUE, DATA, THIN, VERMILION};

/// Improvement of an extended model over the nominal one: in the predictive log score of each
/// held-out block, and in the prediction of a later record.
#[derive(Clone, Debug, PartialEq)]
pub struct CrossValidation {
    /// Main statement of the picture.
    pub title: String,
    /// Further description; may be empty.
    pub subtitle: String,
    /// Log score of the extended model minus that of the nominal one, nats, for each held-out
    /// block in the order of time.
    pub block_gain_nats: Vec<f64>,
    /// Prediction of a later record, if there is one.
    pub prediction: Option<PredictionError>,
}

/// Errors of a predicted quantity against time since the prediction began.
#[derive(Clone, Debug, PartialEq)]
pub struct PredictionError {
    /// Name of the panel: `Later record`.
    pub name: String,
    /// Name of the ordinate: `drift prediction error`.
    pub quantity: String,
    /// Unit of all errors: `arcmin`.
    pub unit: String,
    /// Times, s; shown from the first.
    pub time_s: Vec<f64>,
    /// Error of the nominal model.
    pub nominal: Vec<f64>,
    /// Error of the extended model.
    pub extended: Vec<f64>,
    /// Expected error of the extended model, if known.
    pub expected: Option<Vec<f64>>,
}

impl Picture for CrossValidation {
    fn to_svg(&self) -> Result<String, Error> {
        self.check()?;
        let panels = if self.prediction.is_some() { 2 } else { 1 };
        let layout = Layout::new(panels, panels, 240.0).with_own_abscissae();
        Ok(figure(
            &self.title,
            &self.subtitle,
            &self.legend(),
            layout.height(),
            |canvas, body| {
                self.draw_blocks(canvas, layout.frame(body, 0));
                if let Some(prediction) = &self.prediction {
                    prediction.draw(canvas, layout.frame(body, 1));
                }
            },
        ))
    }
}

impl CrossValidation {
    fn check(&self) -> Result<(), Error> {
        check::not_infinite(|| "gains of the blocks".to_owned(), &self.block_gain_nats)?;
        if let Some(prediction) = &self.prediction {
            check::non_decreasing("the times of the prediction", &prediction.time_s)?;
            let times = ("the times", prediction.time_s.len());
            let nominal = || "nominal predictions".to_owned();
            check::column(nominal, &prediction.nominal, times)?;
            let extended = || "extended predictions".to_owned();
            check::column(extended, &prediction.extended, times)?;
            if let Some(expected) = &prediction.expected {
                check::column(|| "expected errors".to_owned(), expected, times)?;
            }
        }
        Ok(())
    }

    fn legend(&self) -> Vec<Legend> {
        let mut legend = vec![
            Legend::area(BLUE, 1.0, "extended model predicts better"),
            Legend::area(VERMILION, 1.0, "nominal model predicts better"),
        ];
        if let Some(prediction) = &self.prediction {
            let [nominal, extended] = [VERMILION, BLUE].map(|c| LineStyle::solid(c, DATA));
            legend.push(Legend::line(nominal, "nominal model"));
            legend.push(Legend::line(extended, "extended model"));
            if prediction.expected.is_some() {
                let expected = LineStyle::dashed(BLACK, THIN);
                legend.push(Legend::line(expected, "expected for the extended model"));
            }
        }
        legend
    }

    fn draw_blocks(&self, canvas: &mut Canvas, frame: Rect) {
        let gains = &self.block_gain_nats;
        let span = Span::of(gains.iter().copied().chain([0.0]));
        let span = span.unwrap_or(Span::symmetric(1.0)).padded(0.08);
        let blocks = gains.len();
        let ticks = (0..blocks).step_by(blocks / 20 + 1);
        let ticks = ticks.map(|block| (block as f64, (block + 1).to_string()));
        let ends = Span {
            lo: -0.6,
            hi: blocks.max(1) as f64 - 0.4,
        };
        let axes = Axes {
            frame,
            x: Axis::named(ends, ticks.collect(), "held-out block, in order of time"),
            y: Axis::linear(span, "gain in predictive log score", "nats", 7),
        };
        let finite = gains.iter().filter(|gain| !gain.is_nan());
        let (number, total) = (finite.clone().count(), finite.sum());
        let labels = Labels {
            name: "Cross-validation",
            note: &format!("sum {} nats, {number} blocks", short(total, 3)),
            abscissa: true,
            ordinate_title: true,
        };
        axes.draw(canvas, labels, number > 0, |axes, canvas| {
            for (block, &gain) in gains.iter().enumerate() {
                if gain.is_nan() {
                    continue;
                }
                let colour = if gain >= 0.0 { BLUE } else { VERMILION };
                let corner = axes.point(block as f64 - 0.35, 0.0);
                canvas.rect(corner, axes.point(block as f64 + 0.35, gain), colour, 1.0);
            }
            axes.zero_line(canvas);
        });
    }
}

impl PredictionError {
    fn draw(&self, canvas: &mut Canvas, frame: Rect) {
        let (elapsed, times) = elapsed(&self.time_s);
        let models = self.nominal.iter().chain(&self.extended);
        let expected = self.expected.iter().flatten();
        let span = Span::of(models.clone().chain(expected).copied().chain([0.0]));
        let span = span.unwrap_or(Span::symmetric(1.0)).padded(0.06);
        let axes = Axes {
            frame,
            x: Axis::time(times, 8),
            y: Axis::linear(span, &self.quantity, &self.unit, 7),
        };
        let has_data = models.clone().any(|value| !value.is_nan());
        let labels = Labels {
            name: &self.name,
            note: &self.note(),
            abscissa: true,
            ordinate_title: true,
        };
        axes.draw(canvas, labels, has_data, |axes, canvas| {
            axes.zero_line(canvas);
            if let Some(expected) = &self.expected {
                axes.line(canvas, &elapsed, expected, LineStyle::dashed(BLACK, THIN));
            }
            let [nominal, extended] = [VERMILION, BLUE].map(|c| LineStyle::solid(c, DATA));
            axes.line(canvas, &elapsed, &self.nominal, nominal);
            axes.line(canvas, &elapsed, &self.extended, extended);
        });
    }

    /// The errors at the end.
    fn note(&self) -> String {
        match (self.nominal.last(), self.extended.last()) {
            (Some(nominal), Some(extended)) => format!(
                "at the end: nominal {}, extended {} {}",
                short(*nominal, 2),
                short(*extended, 2),
                self.unit
            ),
            _ => String::new(),
        }
    }
}
