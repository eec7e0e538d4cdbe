//! What an extended model gains.

use crate::axis::{Axis, Span};
use crate::canvas::{Canvas, Stroke};
use crate::check;
use crate::error::Error;
use crate::number::short;
use crate::page::{Grid, Key, page};
use crate::panel::{Panel, Surround};
use crate::picture::Picture;
use crate::style::{BLACK, BLUE, DATA, GREY, HAIR, THIN, VERMILION};
use crate::trace::Frame;

/// The gain of an extended model over the nominal one: in the predictive log score of each
/// held-out block, and in the predicted drift of the platform.
#[derive(Clone, Debug, PartialEq)]
pub struct Gain {
    /// What is seen.
    pub title: String,
    /// More words, or none.
    pub subtitle: String,
    /// Log score of the extended model less that of the nominal one, for each held-out block in
    /// the order of time, nats.
    pub block_gain_nats: Vec<f64>,
    /// Predicted drift of another record; none if there is none.
    pub drift: Option<DriftPrediction>,
}

/// Errors of the predicted drift of the platform against time since the prediction began.
#[derive(Clone, Debug, PartialEq)]
pub struct DriftPrediction {
    /// Times, s; shown from the first.
    pub time_s: Vec<f64>,
    /// Error of the prediction with nominal coefficients, arc minutes.
    pub nominal_arcmin: Vec<f64>,
    /// Error of the prediction with extended coefficients, arc minutes.
    pub extended_arcmin: Vec<f64>,
    /// Error that is to be expected with extended coefficients, arc minutes, if known.
    pub expected_arcmin: Option<Vec<f64>>,
}

impl Picture for Gain {
    fn to_svg(&self) -> Result<String, Error> {
        self.check()?;
        let panels = if self.drift.is_some() { 2 } else { 1 };
        let mut grid = Grid::new(panels, panels, 240.0);
        grid.own_abscissa = true;
        page(
            &self.title,
            &self.subtitle,
            &self.keys(),
            grid.height(),
            |canvas, body| {
                self.blocks(canvas, grid.frame(body, 0))?;
                match &self.drift {
                    Some(drift) => drift.draw(canvas, grid.frame(body, 1)),
                    None => Ok(()),
                }
            },
        )
    }
}

impl Gain {
    fn check(&self) -> Result<(), Error> {
        check::not_infinite(|| "gains of the blocks".to_owned(), &self.block_gain_nats)?;
        if let Some(drift) = &self.drift {
            check::rising("the times of the prediction", &drift.time_s)?;
            let times = ("the times", drift.time_s.len());
            let nominal = || "nominal predictions".to_owned();
            check::column(nominal, &drift.nominal_arcmin, times)?;
            let extended = || "extended predictions".to_owned();
            check::column(extended, &drift.extended_arcmin, times)?;
            if let Some(expected) = &drift.expected_arcmin {
                check::column(|| "expected errors".to_owned(), expected, times)?;
            }
        }
        Ok(())
    }

    fn keys(&self) -> Vec<Key> {
        let mut keys = vec![
            Key::area(BLUE, 1.0, "the extended model predicts better"),
            Key::area(VERMILION, 1.0, "the nominal model predicts better"),
        ];
        if let Some(drift) = &self.drift {
            keys.push(Key::line(Stroke::solid(VERMILION, DATA), "nominal model"));
            keys.push(Key::line(Stroke::solid(BLUE, DATA), "extended model"));
            if drift.expected_arcmin.is_some() {
                let label = "to be expected of the extended model";
                keys.push(Key::line(Stroke::dashed(BLACK, THIN), label));
            }
        }
        keys
    }

    fn blocks(&self, canvas: &mut Canvas<'_>, frame: Frame) -> Result<(), Error> {
        let gains = &self.block_gain_nats;
        let span = Span::of(gains.iter().copied().chain([0.0]));
        let span = span.unwrap_or(Span::symmetric(1.0)).padded(0.08);
        let blocks = gains.len();
        let every = blocks / 20 + 1;
        let ticks = (0..blocks).step_by(every);
        let ticks = ticks.map(|block| (block as f64, (block + 1).to_string()));
        let ends = Span {
            lo: -0.6,
            hi: blocks.max(1) as f64 - 0.4,
        };
        let panel = Panel {
            frame,
            x: Axis::named(
                ends,
                ticks.collect(),
                "held-out block, in the order of time",
            ),
            y: Axis::linear(span, "gain in log score", "nats", 7),
        };
        let there: Vec<f64> = gains
            .iter()
            .copied()
            .filter(|gain| !gain.is_nan())
            .collect();
        let total: f64 = there.iter().sum();
        let note = format!("sum {} nats, {} blocks", short(total, 3), there.len());
        let surround = Surround {
            name: "Cross-validation",
            note: &note,
            abscissa: true,
            ordinate_title: true,
        };
        panel.surround(canvas, surround)?;
        if there.is_empty() {
            panel.empty(canvas)?;
        }
        for (block, &gain) in gains.iter().enumerate() {
            if gain.is_nan() {
                continue;
            }
            let colour = if gain >= 0.0 { BLUE } else { VERMILION };
            let corner = panel.place(block as f64 - 0.35, 0.0);
            canvas.rect(corner, panel.place(block as f64 + 0.35, gain), colour, 1.0)?;
        }
        panel.level(canvas, 0.0, Stroke::solid(GREY, HAIR))
    }
}

impl DriftPrediction {
    fn draw(&self, canvas: &mut Canvas<'_>, frame: Frame) -> Result<(), Error> {
        let origin = self.time_s.first().copied().unwrap_or(0.0);
        let elapsed: Vec<f64> = self.time_s.iter().map(|time| time - origin).collect();
        let values = self.nominal_arcmin.iter().chain(&self.extended_arcmin);
        let expected = self.expected_arcmin.iter().flatten();
        let span = Span::of(values.chain(expected).copied().chain([0.0]));
        let times = Span::of(elapsed.iter().copied()).unwrap_or(Span { lo: 0.0, hi: 1.0 });
        let panel = Panel {
            frame,
            x: Axis::time(times.open(), 8),
            y: Axis::linear(
                span.unwrap_or(Span::symmetric(1.0)).padded(0.06),
                "error of the predicted drift",
                "arc minutes",
                7,
            ),
        };
        let last = |values: &[f64]| {
            values
                .last()
                .map_or(String::new(), |value| short(*value, 2))
        };
        let note = format!(
            "at the end: nominal {}, extended {} arc minutes",
            last(&self.nominal_arcmin),
            last(&self.extended_arcmin)
        );
        let surround = Surround {
            name: "Compensation",
            note: if elapsed.is_empty() { "" } else { &note },
            abscissa: true,
            ordinate_title: true,
        };
        panel.surround(canvas, surround)?;
        let shown = self.nominal_arcmin.iter().chain(&self.extended_arcmin);
        if shown.into_iter().all(|value| value.is_nan()) {
            return panel.empty(canvas);
        }
        panel.level(canvas, 0.0, Stroke::solid(GREY, HAIR))?;
        if let Some(expected) = &self.expected_arcmin {
            panel.line(canvas, &elapsed, expected, Stroke::dashed(BLACK, THIN))?;
        }
        let nominal = Stroke::solid(VERMILION, DATA);
        panel.line(canvas, &elapsed, &self.nominal_arcmin, nominal)?;
        panel.line(
            canvas,
            &elapsed,
            &self.extended_arcmin,
            Stroke::solid(BLUE, DATA),
        )
    }
}
