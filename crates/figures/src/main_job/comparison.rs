//! The paper's filter against exact integration, and Euler angles against a moving chart.

use gyrocal::{Discretisation, Integration, Recentring};
use gyrocal_calibration::Options;
use gyrocal_truth::{Coefficients, Scenario, euler_rule, simulate};
use rayon::prelude::*;

use super::Error;
use super::runs::{Judged, judge};
use crate::figure::Figure;

/// Seeds of the comparison, fixed beforehand.
const SEEDS: std::ops::RangeInclusive<u64> = 1..=60;
/// Mean NIS over the 4321 rows of one consistent record is 3 ± 0.037, so the median over 60 seeds
/// is 3 ± 0.006 (1.25 · 0.037 / √60). The rest of the interval is for the bias of a single pass,
/// which may have either sign.
const FITS: [f64; 2] = [2.95, 3.05];
/// Euler angles as states are over-confident (see the NEES): nearly 3, and at times far above.
const NEARLY_FITS: [f64; 2] = [2.9, 3.3];
/// Far beyond chance: least mean NIS of a wrong rule.
const DOES_NOT_FIT: [f64; 2] = [100.0, f64::INFINITY];
/// The median of a consistent filter is 8.3. One pass of an extended filter falls short of that:
/// 13.4 was measured after one day, aligned. The seeds are fixed, so the limit need not allow for
/// chance; a change of that filter shows.
const NEES_LIMIT: f64 = 14.0;

pub(crate) fn figures() -> Result<Vec<Figure>, Error> {
    let mut figures = rules()?;
    figures.extend(coordinates()?);
    Ok(figures)
}

fn scenario(seed: u64, days: f64) -> Scenario {
    Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        duration_s: days * 86_400.0,
        ..Scenario::default()
    }
}

/// Three days of the paper's bench: the rule that made the data and the rule of the filter.
fn rules() -> Result<Vec<Figure>, Error> {
    let paper = Options::paper_baseline();
    let fine_euler = Options {
        discretisation: Discretisation {
            integration: Integration::Euler { substeps: 64 },
            ..paper.discretisation
        },
        ..paper
    };
    let rk4 = Options {
        discretisation: Discretisation {
            integration: Integration::RK4,
            ..paper.discretisation
        },
        ..paper
    };
    let rows = [
        (
            "data by the paper's rule, paper's filter",
            true,
            paper,
            NEARLY_FITS,
        ),
        ("exact data, paper's filter", false, paper, DOES_NOT_FIT),
        (
            "exact data, Euler with 64 sub-steps",
            false,
            fine_euler,
            NEARLY_FITS,
        ),
        (
            "exact data, RK4, Euler angles in one chart",
            false,
            rk4,
            NEARLY_FITS,
        ),
        (
            "exact data, default filter",
            false,
            Options::streaming(),
            FITS,
        ),
    ];
    let mut figures = Vec::new();
    for (name, by_euler_rule, options, target) in rows {
        let judged = SEEDS
            .into_par_iter()
            .map(|seed| {
                let scenario = scenario(seed, 3.0);
                let simulated = if by_euler_rule {
                    euler_rule(&scenario)
                } else {
                    simulate(&scenario)
                };
                judge(&simulated?, &options)
            })
            .collect::<Result<Vec<Judged>, Error>>()?;
        let nis = Spread::of(judged.iter().map(|run| run.calibration.fit.nis_mean()));
        let mut figure = Figure::within(&format!("{name}: mean NIS, median"), target, nis.median);
        figure.measured = nis.text();
        figures.push(figure.over(judged.len(), "1 to 60"));
        let rms: Vec<String> = (0..9)
            .map(|i| {
                let squares = judged.iter().map(|run| run.percent()[i].powi(2));
                format!("{:.2}", (squares.sum::<f64>() / judged.len() as f64).sqrt())
            })
            .collect();
        let name = format!("{name}: RMS error in % (x: F I II, y, z)");
        figures.push(Figure::note(&name, rms.join(" ")).over(judged.len(), "1 to 60"));
    }
    Ok(figures)
}

/// NEES after one day of the same bench: the covariance in three sets of coordinates.
fn coordinates() -> Result<Vec<Figure>, Error> {
    let limit_rad = 20.0_f64.to_radians();
    let rows = [
        ("Euler angles as states", Recentring::Never, None),
        (
            "chart moved beyond 20 deg",
            Recentring::Beyond(limit_rad),
            None,
        ),
        (
            "chart moved at every step",
            Recentring::EveryStep,
            Some(NEES_LIMIT),
        ),
    ];
    let mut figures = Vec::new();
    for (name, recentring, limit) in rows {
        let options = Options {
            discretisation: Discretisation {
                recentring,
                ..Discretisation::default()
            },
            ..Options::streaming()
        };
        let nees = SEEDS
            .into_par_iter()
            .map(|seed| judge(&simulate(&scenario(seed, 1.0))?, &options)?.nees())
            .collect::<Result<Vec<f64>, Error>>()?;
        let spread = Spread::of(nees.iter().copied());
        let mut figure = Figure::note(
            &format!("NEES after one day, aligned, {name}: median (8.3 if consistent)"),
            spread.text(),
        );
        if let Some(limit) = limit {
            figure.target = format!("<= {limit}");
            figure.holds = Some(spread.median <= limit);
        }
        figures.push(figure.over(nees.len(), "1 to 60"));
    }
    Ok(figures)
}

/// Median and the range of the middle 80 %.
struct Spread {
    median: f64,
    middle: [f64; 2],
}

impl Spread {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = values.collect();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| sorted[(share * (sorted.len() - 1) as f64).round() as usize];
        Self {
            median: at(0.5),
            middle: [at(0.1), at(0.9)],
        }
    }

    fn text(&self) -> String {
        let [low, high] = self.middle;
        format!("{:.2} (80 %: {low:.2} to {high:.2})", self.median)
    }
}
