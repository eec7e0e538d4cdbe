//! Contributions of single terms of a law, measurement by measurement.

use crate::canvas::LineStyle;
use crate::check;
use crate::error::Error;
use crate::figure::{Legend, figure};
use crate::layout::Layout;
use crate::number::count;
use crate::picture::Picture;
use crate::scatter::{ErrorPoint, Scatter, ScatterPanel, error_bar_legend};
use crate::span::Span;
use crate::style::{BLUE, DATA, VERMILION};

/// Partial residuals: measurements minus all fitted terms of a law but one, against the regressor
/// of that one, with the fitted term; all panels have one scale.
#[derive(Clone, Debug, PartialEq)]
pub struct TermContributions {
    /// Main statement of the picture.
    pub title: String,
    /// Further description; may be empty.
    pub subtitle: String,
    /// Name of the ordinate: `rate`.
    pub quantity: String,
    /// Unit of the ordinate: `deg/h`.
    pub unit: String,
    /// Meaning of one dot, for the legend: `one static stop`.
    pub point_label: String,
    /// The panels, row after row.
    pub terms: Vec<TermContribution>,
    /// Number of panels in a row.
    pub columns: usize,
}

/// The contribution of one term.
#[derive(Clone, Debug, PartialEq)]
pub struct TermContribution {
    /// Name of the term, above its panel.
    pub name: String,
    /// Its estimate with uncertainty and unit, above its panel.
    pub estimate: String,
    /// Name of its regressor: `specific force z`.
    pub regressor: String,
    /// Unit of the regressor.
    pub regressor_unit: String,
    /// The regressor at each measurement.
    pub regressor_values: Vec<f64>,
    /// Partial residual of each measurement.
    pub partial_residuals: Vec<f64>,
    /// Standard error of each measurement.
    pub standard_errors: Vec<f64>,
    /// The fitted term divided by its regressor.
    pub slope: f64,
}

impl Picture for TermContributions {
    fn to_svg(&self) -> Result<String, Error> {
        check::non_empty("the list of terms", &self.terms)?;
        for term in &self.terms {
            let of = |what: &str| format!("{what} of {}", term.name);
            let values = ("the regressor", term.regressor_values.len());
            check::column(|| of("partial residuals"), &term.partial_residuals, values)?;
            check::column(|| of("standard errors"), &term.standard_errors, values)?;
            check::not_infinite(|| of("regressor"), &term.regressor_values)?;
            check::finite(&of("slope"), term.slope)?;
        }
        let layout = Layout::new(self.columns, self.terms.len(), 170.0).with_own_abscissae();
        let legend = [
            Legend::dot(BLUE, &self.point_label),
            error_bar_legend(),
            Legend::line(LineStyle::solid(VERMILION, DATA), "fitted term"),
        ];
        let panels: Vec<_> = self.terms.iter().map(TermContribution::scatter).collect();
        let span = Scatter::span_of(&panels).unwrap_or(Span::symmetric(1.0));
        let scatter = Scatter {
            quantity: &self.quantity,
            unit: &self.unit,
            span: span.padded(0.06),
            panels,
        };
        Ok(figure(
            &self.title,
            &self.subtitle,
            &legend,
            layout.height(),
            |canvas, body| scatter.draw(canvas, layout, body),
        ))
    }
}

impl TermContribution {
    fn scatter(&self) -> ScatterPanel<'_> {
        let n = count(self.partial_residuals.len());
        ScatterPanel {
            name: &self.name,
            note: format!("{}, n = {n}", self.estimate),
            covariate: &self.regressor,
            covariate_unit: &self.regressor_unit,
            span: Span::of(self.regressor_values.iter().copied()),
            points: self.points().collect(),
            slope: Some(self.slope),
        }
    }

    /// The measurements without missing values.
    fn points(&self) -> impl Iterator<Item = ErrorPoint> {
        let values = self.regressor_values.iter().zip(&self.partial_residuals);
        let points = values.zip(&self.standard_errors);
        let points = points.map(|((x, y), sigma)| ErrorPoint {
            x: *x,
            y: *y,
            half: 2.0 * sigma,
        });
        points.filter(|point| !(point.x + point.y + point.half).is_nan())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(partial_residuals: Vec<f64>) -> TermContributions {
        TermContributions {
            title: "Terms".to_owned(),
            subtitle: String::new(),
            quantity: "rate".to_owned(),
            unit: "deg/h".to_owned(),
            point_label: "one static stop".to_owned(),
            terms: vec![TermContribution {
                name: "gyro_x.g_z".to_owned(),
                estimate: "2 deg/h/g".to_owned(),
                regressor: "specific force z".to_owned(),
                regressor_unit: "g".to_owned(),
                regressor_values: vec![-1.0, 0.0, 1.0],
                partial_residuals,
                standard_errors: vec![0.1; 3],
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
        // One more is in the legend.
        assert_eq!((dots(&all), dots(&one_less)), (4, 3));
        assert!(all.contains("2 deg/h/g, n = 3"));
    }

    #[test]
    fn columns_of_unequal_length_and_infinite_values_are_refused() {
        assert!(picture(vec![0.0; 2]).to_svg().is_err());
        assert!(picture(vec![0.0, f64::INFINITY, 0.0]).to_svg().is_err());
    }
}
