//! Gain of extended models: in cross-validation, and in the coefficients.

use gyrocal_calibration::FittedPlatform;
use gyrocal_evaluation::{FindingScore, RecordScore, diagnosed, scenario};
use gyrocal_testkit::extended_comparison;
use gyrocal_truth::{Hidden, Scenario, simulate};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::harness::{Context, DIAGNOSIS, Error, Figure, Population, Row, of};
use crate::naming::{CLEAN, WITH_EFFECT, population};

/// First number of these records among the scenarios; the cells have those below.
pub(crate) const FIRST_NUMBER: u64 = 100_000_000;

/// Mass unbalance across the input axis, deg/h/g, which the coefficients cannot absorb.
const CROSS_AXIS: f64 = 0.05;
const CROSS_AXES: [&str; 6] = [
    "gyro_x.g_y",
    "gyro_x.g_z",
    "gyro_y.g_x",
    "gyro_y.g_z",
    "gyro_z.g_x",
    "gyro_z.g_y",
];

/// All figures of the part.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let is_accepted = |one: &FindingScore| one.accepted == Some(true);
    let extended = move |record: &RecordScore| record.findings.iter().any(is_accepted);
    let name = "clean records: extensions accepted, one-sided 95 % upper bound";
    let level = "the level is 1 %: of 2000 twenty are due, and 27 within the bound";
    let clean = Row::bound(name, extended).at_most(0.02, level);
    let mut figures = context.measure(&population(CLEAN), &[clean])?;
    let gains = |record: &RecordScore| -> Vec<bool> {
        let gains = |one: &FindingScore| one.gain_nats.is_some_and(|nats| nats > 0.0);
        record.findings.iter().map(gains).collect()
    };
    let name = "d = 8: significant terms that gain under cross-validation";
    let nats = |record: &RecordScore| record.gain_nats;
    let with_effect = [
        Row::each(name, gains).at_least(0.95, "as often as a set of 95 % holds the cause"),
        Row::median("d = 8: median gain of a record, nats", nats)
            .at_least(8.0, "a quarter of the 32 nats of an effect of known size"),
    ];
    figures.extend(context.measure(&population(WITH_EFFECT), &with_effect)?);
    let sources = of(DIAGNOSIS, &[file!()]);
    let across = Population::new("cross-axis", [800_000, 300, 10], sources, cross_axis);
    figures.extend(context.measure(&across, &of_coefficients())?);
    figures.extend(filters());
    Ok(figures)
}

/// Errors of the coefficients, of the nominal and of the extended model.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Errors {
    /// Largest error of a coefficient in sigmas.
    largest: [f64; 2],
    /// Normalised squared error of the nine.
    nees: [f64; 2],
}

/// Of records with a large cross-axis term.
fn of_coefficients() -> [Row<'static, Errors>; 4] {
    let name = |what: &str| format!("0.05 deg/h/g across an axis: {what}");
    let largest = |model: usize| move |of: &Errors| Some(of.largest[model]);
    let nees = |model: usize| move |of: &Errors| Some(of.nees[model]);
    let of_nominal = name("median of the largest nominal error, sigmas");
    let of_extended = name("median of the largest extended error, sigmas");
    [
        Row::median(of_nominal, largest(0))
            .at_least(10.0, "the nominal model is wrong beyond doubt"),
        Row::mean(name("mean NEES of the extended model"), nees(1))
            .between([8.5, 9.5], "nine coefficients, half of one for wrong names"),
        Row::median(of_extended, largest(1)),
        Row::median(name("median NEES of the nominal model"), nees(0)),
    ]
}

fn cross_axis(seed: u64) -> Result<Errors, Error> {
    let effect = CROSS_AXES[(seed % 6) as usize];
    let simulation = simulate(&Scenario {
        hidden: vec![Hidden::new(effect, &[("size", CROSS_AXIS)])?],
        ..scenario(FIRST_NUMBER + seed)
    })?;
    let found = diagnosed(&simulation)?;
    let truth = simulation.truth.coefficients.named().map(|(_, v, _)| v);
    let extended = found.extended.as_ref().unwrap_or(&found.nominal);
    let of = |fit: &FittedPlatform<'_>| {
        let error = DVector::from_fn(9, |i, _| fit.values()[i] - truth[i]);
        let covariance: DMatrix<f64> = fit.covariance().view((0, 0), (9, 9)).into_owned();
        let largest = (0..9).map(|i| error[i].abs() / covariance[(i, i)].sqrt());
        let largest = largest.fold(0.0, f64::max);
        let solved = covariance.cholesky().ok_or("a singular covariance")?;
        Ok::<_, Error>((largest, solved.solve(&error).dot(&error)))
    };
    let (before, after) = (of(&found.nominal)?, of(extended)?);
    Ok(Errors {
        largest: [before.0, after.0],
        nees: [before.1, after.1],
    })
}

/// The filter of `examples/extended`, derived from a model file, against that on the whole
/// catalogue.
fn filters() -> [Figure; 2] {
    let figure = |length: &str, most: f64, [state, sigma]: [f64; 2]| {
        let name = format!("extended filter less that of the catalogue, sigmas: {length}");
        Figure::at_most_small(&name, most, state.max(sigma))
    };
    [
        figure("one step", 1e-9, extended_comparison::after_one_step()),
        figure("three days", 1e-5, extended_comparison::after_three_days()),
    ]
}
