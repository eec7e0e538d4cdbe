//! The paper's filter against exact integration, and Euler angles against a moving chart.

use gyrocal::{Integration, Recentring};
use gyrocal_calibration::Options;
use gyrocal_truth::{Coefficients, Scenario, Simulation, euler_rule, simulate};

use super::Error;
use super::runs::judge;
use crate::figure::Figure;

const SEED: u64 = 1;
/// Mean NIS over 4321 rows that fit: 3 ± 0.037; three sigmas.
const FITS: [f64; 2] = [2.89, 3.11];
/// Far beyond chance: what a wrong rule must be seen as.
const DOES_NOT_FIT: [f64; 2] = [10.0, f64::INFINITY];

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
    let own = euler_rule(&scenario(SEED, 3.0))?;
    let exact = simulate(&scenario(SEED, 3.0))?;
    let fine_euler = Options {
        integration: Integration::Euler { substeps: 64 },
        ..Options::of_the_paper()
    };
    let rk4 = Options { integration: Integration::RK4, ..Options::of_the_paper() };
    let rows: [(&str, &Simulation, Options, [f64; 2]); 5] = [
        ("data by the paper's rule, paper's filter", &own, Options::of_the_paper(), FITS),
        ("exact data, paper's filter", &exact, Options::of_the_paper(), DOES_NOT_FIT),
        ("exact data, Euler with 64 sub-steps", &exact, fine_euler, FITS),
        ("exact data, RK4, Euler angles in one chart", &exact, rk4, FITS),
        ("exact data, default filter", &exact, Options::default(), FITS),
    ];
    let mut figures = Vec::new();
    for (name, simulation, options, target) in rows {
        let judged = judge(simulation, &options)?;
        let seeds = format!("seed {SEED}");
        figures.push(
            Figure::within(&format!("{name}: mean NIS"), target, judged.calibration.fit.nis_mean())
                .over(1, seeds.clone()),
        );
        let note = Figure::note(&format!("{name}: errors in %"), judged.percent());
        figures.push(note.over(1, seeds));
    }
    Ok(figures)
}

/// NEES after one day of the same bench: the covariance in three sets of coordinates.
fn coordinates() -> Result<Vec<Figure>, Error> {
    let limit_rad = 20.0_f64.to_radians();
    // One NEES of 9 degrees of freedom lies below 27.9 with probability 99.9 %.
    let rows = [
        ("Euler angles as states", Recentring::Never, None),
        ("chart moved beyond 20 deg", Recentring::Beyond(limit_rad), None),
        ("chart moved at every step", Recentring::EveryStep, Some([0.0, 27.9])),
    ];
    let mut figures = Vec::new();
    for (name, recentring, target) in rows {
        let options = Options { recentring, ..Options::default() };
        let nees = [1, 2, 3]
            .into_iter()
            .map(|seed| judge(&simulate(&scenario(seed, 1.0))?, &options)?.nees())
            .collect::<Result<Vec<f64>, Error>>()?;
        let text: Vec<_> = nees.iter().map(|nees| format!("{nees:.1}")).collect();
        let mut figure = Figure::note(
            &format!("NEES after one day (9 expected), {name}"),
            text.join(" / "),
        );
        if let Some(bounds) = target {
            figure.target = format!("<= {} each", bounds[1]);
            figure.holds = Some(nees.iter().all(|nees| *nees <= bounds[1]));
        }
        figures.push(figure.over(nees.len(), "seeds 1 to 3"));
    }
    Ok(figures)
}
