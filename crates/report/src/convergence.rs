//! Estimates against time.

use crate::axes::{Axes, Labels};
use crate::axis::{Axis, elapsed};
use crate::canvas::{Canvas, LineStyle};
use crate::check;
use crate::error::Error;
use crate::figure::{Legend, figure};
use crate::geometry::Rect;
use crate::layout::Layout;
use crate::number::{percent, with_uncertainty};
use crate::picture::Picture;
use crate::span::Span;
use crate::style::{BAND_OPACITY, BLACK, BLUE, DATA, ORANGE, SKY, THIN, VERMILION};

/// Estimates of parameters against time with their bands of two sigma, one panel each.
///
/// The scale of a panel is set by its reference, and by estimate and band after the first tenth of
/// the time (four tenths with a second estimator); earlier values may leave the panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Convergence {
    /// Main statement of the picture.
    pub title: String,
    /// Further description; may be empty.
    pub subtitle: String,
    /// Times of the estimates, s; shown from the first.
    pub time_s: Vec<f64>,
    /// The parameters, one panel each, row after row.
    pub parameters: Vec<ParameterHistory>,
    /// Number of panels in a row.
    pub columns: usize,
    /// Meaning of the references, for the legend: `true value`.
    pub reference_label: String,
    /// The estimator, for the legend: `extended model`; `estimate` if empty.
    pub estimate_label: String,
    /// The second estimator, for the legend, if there is one: `nominal model`.
    pub second_label: String,
}

/// The estimates of one parameter against time.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterHistory {
    /// Name of the parameter: `gyro_x.bias`.
    pub name: String,
    /// Its unit: `deg/h`.
    pub unit: String,
    /// The estimates.
    pub estimates: EstimateHistory,
    /// True or otherwise known value.
    pub reference: Option<f64>,
    /// Estimates of a second estimator.
    pub second: Option<EstimateHistory>,
}

/// Estimates and standard deviations, one of each time.
#[derive(Clone, Debug, PartialEq)]
pub struct EstimateHistory {
    /// Estimates; nan for a missing one.
    pub estimate: Vec<f64>,
    /// Their standard deviations.
    pub sigma: Vec<f64>,
}

/// Initial fraction of the time that does not set the scale.
const UNSETTLED: f64 = 0.1;
/// The same with two estimators: their difference shows when both have settled.
const UNSETTLED_BOTH: f64 = 0.4;

impl Picture for Convergence {
    fn to_svg(&self) -> Result<String, Error> {
        self.check()?;
        let layout = Layout::new(self.columns, self.parameters.len(), 130.0).with_left(70.0);
        let scale = format!(
            "vertical scales leave out the first {} of the time",
            percent(self.unsettled())
        );
        let subtitle = match self.subtitle.trim_end_matches('.') {
            "" => format!("{}{}.", scale[..1].to_uppercase(), &scale[1..]),
            words => format!("{words}; {scale}."),
        };
        Ok(figure(
            &self.title,
            &subtitle,
            &self.legend(),
            layout.height(),
            |canvas, body| self.draw(canvas, layout, body),
        ))
    }
}

impl Convergence {
    fn has_second(&self) -> bool {
        self.parameters.iter().any(|p| p.second.is_some())
    }

    fn unsettled(&self) -> f64 {
        if self.has_second() {
            UNSETTLED_BOTH
        } else {
            UNSETTLED
        }
    }

    fn check(&self) -> Result<(), Error> {
        check::non_empty("the list of parameters", &self.parameters)?;
        check::non_decreasing("the times of the estimates", &self.time_s)?;
        let times = ("the times", self.time_s.len());
        for parameter in &self.parameters {
            let name = &parameter.name;
            for (kind, history) in [
                ("", Some(&parameter.estimates)),
                ("second ", parameter.second.as_ref()),
            ] {
                let Some(history) = history else { continue };
                let what = || format!("{kind}estimates of {name}");
                check::column(what, &history.estimate, times)?;
                let what = || format!("{kind}sigmas of {name}");
                check::column(what, &history.sigma, times)?;
            }
            if let Some(reference) = parameter.reference {
                check::finite(&format!("reference of {name}"), reference)?;
            }
        }
        Ok(())
    }

    fn legend(&self) -> Vec<Legend> {
        let estimate = match self.estimate_label.as_str() {
            "" => "estimate",
            label => label,
        };
        let mut legend = vec![
            Legend::line(LineStyle::solid(BLUE, DATA), estimate),
            Legend::area(SKY, BAND_OPACITY, "±2σ (95%)"),
        ];
        if self.has_second() {
            let style = LineStyle::solid(VERMILION, DATA);
            legend.push(Legend::line(style, self.second_label.as_str()));
            legend.push(Legend::area(ORANGE, BAND_OPACITY, "±2σ (95%)"));
        }
        if self.parameters.iter().any(|p| p.reference.is_some()) {
            let style = LineStyle::dashed(BLACK, THIN);
            legend.push(Legend::line(style, self.reference_label.as_str()));
        }
        legend
    }

    fn draw(&self, canvas: &mut Canvas, layout: Layout, body: Rect) {
        let (elapsed, span) = elapsed(&self.time_s);
        for (index, parameter) in self.parameters.iter().enumerate() {
            let frame = layout.frame(body, index);
            let ticks = (frame.width() / 45.0) as usize;
            let ordinate = parameter.span(&elapsed, self.unsettled());
            let axes = Axes {
                frame,
                x: Axis::time(span, ticks),
                y: Axis::linear(ordinate.padded(0.06), "", &parameter.unit, 5),
            };
            let labels = Labels {
                name: &parameter.name,
                note: &parameter.estimates.note(axes.y.factor),
                abscissa: layout.shows_abscissa(index),
                ordinate_title: true,
            };
            let has_data = parameter.estimates.estimate.iter().any(|v| !v.is_nan());
            axes.draw(canvas, labels, has_data, |axes, canvas| {
                parameter.draw(canvas, axes, &elapsed);
            });
        }
    }
}

impl ParameterHistory {
    fn draw(&self, canvas: &mut Canvas, axes: &Axes, elapsed: &[f64]) {
        let second = self
            .second
            .as_ref()
            .map(|second| (second, ORANGE, VERMILION));
        let histories = second.into_iter().chain([(&self.estimates, SKY, BLUE)]);
        for (history, area, line) in histories {
            let [lower, upper] = history.band();
            axes.band(canvas, elapsed, (&lower, &upper), area, BAND_OPACITY);
            let style = LineStyle::solid(line, DATA);
            axes.line(canvas, elapsed, &history.estimate, style);
        }
        if let Some(reference) = self.reference {
            axes.horizontal_line(canvas, reference, LineStyle::dashed(BLACK, THIN));
        }
    }

    /// The span of the settled estimates with their bands, and of the reference.
    fn span(&self, elapsed: &[f64], unsettled: f64) -> Span {
        let whole = elapsed.last().copied().unwrap_or(0.0);
        let settled = elapsed.partition_point(|&time| time < unsettled * whole);
        let mut columns = vec![self.estimates.estimate.clone()];
        columns.extend(self.estimates.band());
        columns.extend(self.second.iter().flat_map(EstimateHistory::band));
        let values = columns
            .iter()
            .flat_map(|column| column.iter().skip(settled));
        let all = columns.iter().flat_map(|column| column.iter());
        Span::of(values.copied().chain(self.reference))
            .or_else(|| Span::of(all.copied()))
            .unwrap_or(Span::symmetric(1.0))
    }
}

impl EstimateHistory {
    /// Lower and upper edge of the band of two sigma.
    fn band(&self) -> [Vec<f64>; 2] {
        [-2.0, 2.0].map(|factor| {
            let pairs = self.estimate.iter().zip(&self.sigma);
            pairs
                .map(|(estimate, sigma)| estimate + factor * sigma)
                .collect()
        })
    }

    /// The last estimate with its band, as read from the axis.
    fn note(&self, factor: f64) -> String {
        let last = self.estimate.iter().zip(&self.sigma).rev();
        let mut finite = last.filter(|(estimate, sigma)| !estimate.is_nan() && !sigma.is_nan());
        finite.next().map_or(String::new(), |(estimate, sigma)| {
            with_uncertainty(factor * estimate, 2.0 * factor * sigma)
        })
    }
}
