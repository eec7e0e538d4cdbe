//! Estimates against time.

use crate::axis::{Axis, Span};
use crate::canvas::{Canvas, Stroke};
use crate::check;
use crate::error::Error;
use crate::number::{percent, short};
use crate::page::{Grid, Key, page};
use crate::panel::{Panel, Surround};
use crate::picture::Picture;
use crate::style::{BLACK, BLUE, DATA, ORANGE, SKY, THIN, VERMILION};
use crate::trace::Frame;

/// Estimates of coefficients against time with their bands of two sigma, one panel each.
///
/// The scale of a panel is set by what the estimate and its band do after the first tenth of the
/// time (four tenths if there is a rival), and by the reference; what was before may leave the
/// panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Convergence {
    /// What is seen.
    pub title: String,
    /// More words, or none.
    pub subtitle: String,
    /// Times of the estimates, s; shown from the first.
    pub time_s: Vec<f64>,
    /// One panel each, row after row.
    pub coefficients: Vec<ConvergingCoefficient>,
    /// Panels side by side: three for x, y, z.
    pub columns: usize,
    /// What references are, for the key: `true value`.
    pub reference_label: String,
    /// What estimates are, for the key: `extended model`; empty: `estimate`.
    pub estimate_label: String,
    /// What the rival estimates are, for the key, if there are any: `nominal model`.
    pub rival_label: String,
}

/// One coefficient while it converges.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvergingCoefficient {
    /// Its name: `gyro_x.bias`.
    pub name: String,
    /// Its unit: `deg/h`.
    pub unit: String,
    /// Estimates at the times; nan where there is none.
    pub estimate: Vec<f64>,
    /// Their standard deviations.
    pub sigma: Vec<f64>,
    /// True or otherwise known value.
    pub reference: Option<f64>,
    /// Another estimator's estimates and standard deviations at the times.
    pub rival: Option<[Vec<f64>; 2]>,
}

/// The part of the time that does not set the scale.
const UNSETTLED: f64 = 0.1;
/// The same with rivals: how two estimators differ shows when both have settled.
const UNSETTLED_RIVALS: f64 = 0.4;
const BAND_OPACITY: f64 = 0.35;

impl Picture for Convergence {
    fn to_svg(&self) -> Result<String, Error> {
        self.check()?;
        let mut grid = Grid::new(self.columns, self.coefficients.len(), 130.0);
        grid.left_px = 70.0;
        let estimate = match self.estimate_label.as_str() {
            "" => "estimate",
            label => label,
        };
        let mut keys = vec![
            Key::line(Stroke::solid(BLUE, DATA), estimate),
            Key::area(SKY, BAND_OPACITY, "plus and minus 2 sigma (95%)"),
        ];
        if self.coefficients.iter().any(|c| c.rival.is_some()) {
            let stroke = Stroke::solid(VERMILION, DATA);
            keys.push(Key::line(stroke, self.rival_label.as_str()));
            keys.push(Key::area(ORANGE, BAND_OPACITY, "the same of it"));
        }
        if self.coefficients.iter().any(|c| c.reference.is_some()) {
            let stroke = Stroke::dashed(BLACK, THIN);
            keys.push(Key::line(stroke, self.reference_label.as_str()));
        }
        let scale = format!(
            "scales leave the first {} of the time out",
            percent(self.unsettled())
        );
        let subtitle = match self.subtitle.trim_end_matches('.') {
            "" => format!("{}{}.", scale[..1].to_uppercase(), &scale[1..]),
            words => format!("{words}; {scale}."),
        };
        page(
            &self.title,
            &subtitle,
            &keys,
            grid.height(),
            |canvas, body| self.panels(canvas, grid, body),
        )
    }
}

impl Convergence {
    fn unsettled(&self) -> f64 {
        if self.coefficients.iter().any(|c| c.rival.is_some()) {
            UNSETTLED_RIVALS
        } else {
            UNSETTLED
        }
    }

    fn check(&self) -> Result<(), Error> {
        check::some("the list of converging coefficients", &self.coefficients)?;
        check::rising("the times of the estimates", &self.time_s)?;
        let times = ("the times", self.time_s.len());
        for coefficient in &self.coefficients {
            let name = &coefficient.name;
            check::column(
                || format!("estimates of {name}"),
                &coefficient.estimate,
                times,
            )?;
            check::column(|| format!("sigmas of {name}"), &coefficient.sigma, times)?;
            if let Some([estimate, sigma]) = &coefficient.rival {
                check::column(|| format!("rival estimates of {name}"), estimate, times)?;
                check::column(|| format!("rival sigmas of {name}"), sigma, times)?;
            }
            if let Some(reference) = coefficient.reference {
                check::finite(&format!("reference of {name}"), reference)?;
            }
        }
        Ok(())
    }

    fn panels(&self, canvas: &mut Canvas<'_>, grid: Grid, body: Frame) -> Result<(), Error> {
        let origin = self.time_s.first().copied().unwrap_or(0.0);
        let elapsed: Vec<f64> = self.time_s.iter().map(|time| time - origin).collect();
        let span = Span::of(elapsed.iter().copied()).unwrap_or(Span { lo: 0.0, hi: 1.0 });
        for (index, coefficient) in self.coefficients.iter().enumerate() {
            let band = band(&coefficient.estimate, &coefficient.sigma);
            let rival = coefficient.rival.as_ref();
            let rival_band = rival.map(|[estimate, sigma]| self::band(estimate, sigma));
            let ordinate = coefficient.span(&elapsed, &band, rival_band.as_ref(), self.unsettled());
            let frame = grid.frame(body, index);
            let ticks = (frame.width() / 45.0) as usize;
            let panel = Panel {
                frame,
                x: Axis::time(span.open(), ticks),
                y: Axis::linear(ordinate.padded(0.06), "", &coefficient.unit, 5),
            };
            let surround = Surround {
                name: &coefficient.name,
                note: &coefficient.note(panel.y.factor),
                abscissa: grid.shows_abscissa(index),
                ordinate_title: true,
            };
            panel.surround(canvas, surround)?;
            if coefficient.estimate.iter().all(|value| value.is_nan()) {
                panel.empty(canvas)?;
                continue;
            }
            if let (Some([estimate, _]), Some((lower, upper))) = (rival, &rival_band) {
                panel.area(canvas, &elapsed, (lower, upper), ORANGE, BAND_OPACITY)?;
                panel.line(canvas, &elapsed, estimate, Stroke::solid(VERMILION, DATA))?;
            }
            panel.area(canvas, &elapsed, (&band.0, &band.1), SKY, BAND_OPACITY)?;
            panel.line(
                canvas,
                &elapsed,
                &coefficient.estimate,
                Stroke::solid(BLUE, DATA),
            )?;
            if let Some(reference) = coefficient.reference {
                panel.level(canvas, reference, Stroke::dashed(BLACK, THIN))?;
            }
        }
        Ok(())
    }
}

fn band(estimates: &[f64], sigmas: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let pairs = estimates.iter().zip(sigmas);
    pairs
        .map(|(estimate, sigma)| (estimate - 2.0 * sigma, estimate + 2.0 * sigma))
        .unzip()
}

impl ConvergingCoefficient {
    fn span(
        &self,
        elapsed: &[f64],
        band: &(Vec<f64>, Vec<f64>),
        rival: Option<&(Vec<f64>, Vec<f64>)>,
        unsettled: f64,
    ) -> Span {
        let whole = elapsed.last().copied().unwrap_or(0.0);
        let settled = elapsed.partition_point(|&time| time < unsettled * whole);
        let mut columns = vec![&self.estimate, &band.0, &band.1];
        columns.extend(rival.into_iter().flat_map(|(lower, upper)| [lower, upper]));
        let values = columns
            .iter()
            .flat_map(|column| column.iter().skip(settled));
        let all = columns.iter().flat_map(|column| column.iter());
        Span::of(values.copied().chain(self.reference))
            .or_else(|| Span::of(all.copied()))
            .unwrap_or(Span::symmetric(1.0))
    }

    /// The last estimate with its band, as read from the axis.
    fn note(&self, factor: f64) -> String {
        let last = self.estimate.iter().zip(&self.sigma).rev();
        let mut there = last.filter(|(estimate, sigma)| !estimate.is_nan() && !sigma.is_nan());
        there.next().map_or(String::new(), |(estimate, sigma)| {
            let (estimate, width) = (factor * estimate, 2.0 * factor * sigma);
            with_uncertainty(estimate, width)
        })
    }
}

/// A value and its uncertainty, both to the place of the second digit of the uncertainty.
fn with_uncertainty(value: f64, uncertainty: f64) -> String {
    let places = 1.0 - uncertainty.log10().floor();
    if !(0.0..8.0).contains(&places) {
        return format!("{} ± {}", short(value, 3), short(uncertainty, 2));
    }
    let places = places as usize;
    format!("{value:.places$} ± {uncertainty:.places$}").replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_has_the_places_of_its_uncertainty() {
        assert_eq!(with_uncertainty(-0.026_251, 1.62e-4), "−0.02625 ± 0.00016");
        assert_eq!(with_uncertainty(12.3, 0.0), "12.3 ± 0");
    }
}
