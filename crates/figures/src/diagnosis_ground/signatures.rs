//! Signatures of all effects against finite differences of the nonlinear simulation.

use gyrocal_testkit::signature_differences::{Compared, compare};
use gyrocal_truth::{Population, Scenario, Temperature};
use rayon::prelude::*;

use crate::error::Error;
use crate::figure::Figure;

/// Seed of the population, and how many scenarios of it are compared.
const POPULATION: u64 = 8;
const SCENARIOS: u64 = 12;
const FEW: u64 = 2;

/// Largest difference of a signature to a finite difference, relative to its norm.
const TARGET: f64 = 1e-3;

/// The same of the rate of change of the temperature. Its slope over forty minutes loses 0.012 of a wave of six
/// hours, the fastest. At both ends of a record it is up to ten minutes off the row, where it errs by up to 0.17:
/// about 0.01 over three days. The records have no gaps.
const TARGET_OF_SLOPE: f64 = 0.02;

pub(super) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let scenarios = if small { FEW } else { SCENARIOS };
    let of = |number| {
        compare(&Scenario {
            duration_s: 3.0 * 86_400.0,
            temperature: Some(Temperature::default()),
            magnetic_field_gauss: Some([0.01, 0.2, -0.45]),
            ..Population::new(POPULATION).scenario(number)
        })
    };
    let each: Result<Vec<Vec<Compared>>, Error> = (0..scenarios).into_par_iter().map(of).collect();
    let (slopes, all): (Vec<Compared>, Vec<Compared>) =
        each?.into_iter().flatten().partition(|one| one.is_of_slope);
    let worst = |name: &str, target: f64, of: &[Compared], error: fn(&Compared) -> Option<f64>| {
        let errors = of.iter().filter_map(|one| Some((error(one)?, &*one.name)));
        let errors: Vec<(f64, &str)> = errors.collect();
        let worst = errors.iter().max_by(|a, b| a.0.total_cmp(&b.0));
        let (error, of) = worst.copied().unwrap_or((f64::NAN, "none"));
        Figure {
            measured: format!("{error:.1e} ({of})"),
            ..Figure::within(name, [f64::NEG_INFINITY, target], error)
        }
        .over(
            errors.len(),
            format!("population {POPULATION}, 0 to {}", scenarios - 1),
        )
    };
    let own = |one: &Compared| Some(one.error);
    let name = "signatures against the simulation: worst difference over norm, whitened";
    let left = "the same with the nine coefficients projected out, where a thousandth is left";
    let slope = "signatures of the rate of a logged temperature: the same difference";
    Ok(vec![
        worst(name, TARGET, &all, own),
        Figure {
            // Not asked for: what is left of a signature is smaller than the signature.
            target: String::new(),
            holds: None,
            ..worst(left, TARGET, &all, |one| one.projected)
        },
        worst(slope, TARGET_OF_SLOPE, &slopes, own),
    ])
}
