//! Binned residuals against covariates.

use crate::check;
use crate::error::Error;
use crate::figure::{Legend, figure};
use crate::layout::Layout;
use crate::number::count;
use crate::picture::Picture;
use crate::scatter::{ErrorPoint, Scatter, ScatterPanel, error_bar_legend};
use crate::span::Span;
use crate::style::BLUE;

/// Binned means of residuals against covariates such as a component of the input, time or
/// temperature, with two standard errors; all panels have one scale of residuals.
#[derive(Clone, Debug, PartialEq)]
pub struct ResidualVsCovariate {
    /// Main statement of the picture.
    pub title: String,
    /// Further description; may be empty.
    pub subtitle: String,
    /// Name of the ordinate: `mean residual`.
    pub quantity: String,
    /// Unit of the ordinate: `g`.
    pub unit: String,
    /// The panels, row after row.
    pub panels: Vec<CovariatePanel>,
    /// Number of panels in a row.
    pub columns: usize,
}

/// One residual against one covariate.
#[derive(Clone, Debug, PartialEq)]
pub struct CovariatePanel {
    /// Name of the residual: `x`.
    pub name: String,
    /// Name of the covariate: `specific force y`.
    pub covariate: String,
    /// Unit of the covariate: `g`, `days`, `°C`.
    pub covariate_unit: String,
    /// The bins, in any order.
    pub bins: Vec<Bin>,
}

/// Mean of the residuals in one bin of the covariate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// Mean covariate of its samples.
    pub centre: f64,
    /// Mean residual.
    pub mean: f64,
    /// Standard error of that mean; nan if it is not known, as with a single sample.
    pub standard_error: f64,
    /// Number of samples.
    pub samples: usize,
}

impl Bin {
    /// Means in bins of equal width over the span of the covariate, from pairs that are both
    /// finite; bins without samples are left out. The standard error is that of independent
    /// samples, from their scatter in the bin.
    #[must_use]
    pub fn of(covariate: &[f64], residual: &[f64], bins: usize) -> Vec<Self> {
        let pairs = || {
            let pairs = covariate.iter().copied().zip(residual.iter().copied());
            pairs.filter(|(x, y)| x.is_finite() && y.is_finite())
        };
        let Some(span) = Span::of(pairs().map(|(x, _)| x)) else {
            return Vec::new();
        };
        let bins = bins.max(1);
        let width = span.length() / bins as f64;
        // Number, mean covariate, mean residual, sum of squared deviations (Welford).
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
                    // Not a number for a single sample.
                    standard_error: (squares / (number - 1.0) / number).sqrt(),
                    samples,
                }
            })
            .collect()
    }

    /// Share of the mean square of a residual that its means in bins hold.
    #[must_use]
    pub fn share_of_mean_square(covariate: &[f64], residual: &[f64], bins: usize) -> f64 {
        let between: f64 = Self::of(covariate, residual, bins)
            .iter()
            .map(|bin| bin.samples as f64 * bin.mean * bin.mean)
            .sum();
        let pairs = covariate.iter().zip(residual);
        let total: f64 = pairs
            .filter(|(x, y)| x.is_finite() && y.is_finite())
            .map(|(_, y)| y * y)
            .sum();
        if total > 0.0 { between / total } else { 0.0 }
    }
}

impl Picture for ResidualVsCovariate {
    fn to_svg(&self) -> Result<String, Error> {
        check::non_empty("the list of panels", &self.panels)?;
        for (panel, bin) in self
            .panels
            .iter()
            .flat_map(|p| p.bins.iter().map(move |b| (p, b)))
        {
            let what = format!("bins of {} against {}", panel.name, panel.covariate);
            check::finite(&what, bin.centre)?;
            check::finite(&what, bin.mean)?;
            check::not_infinite(|| what.clone(), &[bin.standard_error])?;
        }
        let layout = Layout::new(self.columns, self.panels.len(), 140.0).with_own_abscissae();
        let legend = [Legend::dot(BLUE, "bin mean"), error_bar_legend()];
        let panels: Vec<_> = self.panels.iter().map(CovariatePanel::scatter).collect();
        let span = Scatter::span_of(&panels).unwrap_or(Span::symmetric(1.0));
        let scatter = Scatter {
            quantity: &self.quantity,
            unit: &self.unit,
            span: span.with(Span { lo: 0.0, hi: 0.0 }).padded(0.06),
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

impl CovariatePanel {
    fn scatter(&self) -> ScatterPanel<'_> {
        ScatterPanel {
            name: &self.name,
            note: format!(
                "n = {}",
                count(self.bins.iter().map(|bin| bin.samples).sum())
            ),
            covariate: &self.covariate,
            covariate_unit: &self.covariate_unit,
            span: Span::of(self.bins.iter().map(|bin| bin.centre)),
            points: self
                .bins
                .iter()
                .map(|bin| ErrorPoint {
                    x: bin.centre,
                    y: bin.mean,
                    half: 2.0 * bin.standard_error,
                })
                .collect(),
            slope: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_hold_means_and_their_errors() {
        let covariate = [0.0, 0.1, 0.2, 0.9, 1.0, f64::NAN];
        let residual = [1.0, 2.0, 3.0, 7.0, f64::NAN, 5.0];
        let bins = Bin::of(&covariate, &residual, 2);
        assert_eq!(bins.len(), 2);
        assert_eq!((bins[0].samples, bins[1].samples), (3, 1));
        assert!((bins[0].mean - 2.0).abs() < 1e-12 && (bins[0].centre - 0.1).abs() < 1e-12);
        // Variance 1 of three samples.
        assert!((bins[0].standard_error - (1.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert!(bins[1].standard_error.is_nan());
        assert!(Bin::of(&[f64::NAN], &[1.0], 4).is_empty());
    }
}
