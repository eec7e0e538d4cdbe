//! The estimators of the coefficients over random records: consistency, exactness, cost.

mod attitudes;
pub(crate) mod budget;
mod cost;

use gyrocal_calibration::Options;
use gyrocal_evaluation::CalibrationTrial;
use gyrocal_statistics::NORMAL_97_5;
use gyrocal_truth::{Coefficients, simulate};
use serde::{Deserialize, Serialize};

use crate::harness::{CALIBRATION, Context, Error, Figure, Population, Row, of};

/// Seed of the population of scenarios; its numbers are the seeds of the records.
const SEED: u64 = 20_150_904;

/// A record, calibrated as a whole and by the streaming filter.
#[derive(Serialize, Deserialize)]
struct Both {
    batch: CalibrationTrial,
    streaming: CalibrationTrial,
}

/// All figures of the part.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    // Memory first, while nothing else has been asked of the allocator. Times of a small version say little.
    let mut figures = match context.is_small() {
        true => Vec::new(),
        false => cost::figures()?,
    };
    figures.extend(context.measure(&population(), &rows())?);
    figures.extend(attitudes::figures(context)?);
    Ok(figures)
}

/// Names of the coefficients, with their index.
fn names() -> impl Iterator<Item = (usize, &'static str)> {
    let named = Coefficients::NONE.named().into_iter();
    named.map(|(name, _, _)| name).enumerate()
}

/// Any attitude, both hemispheres, one to fourteen days.
fn population() -> Population<'static, Both> {
    let drawn = gyrocal_truth::Population::new(SEED);
    let sources = of(CALIBRATION, &[file!()]);
    Population::new("estimators", [0, 2000, 30], sources, move |number| {
        let simulation = simulate(&drawn.scenario(number))?;
        let of = |options| CalibrationTrial::of_simulation(&simulation, &options);
        Ok(Both {
            batch: of(Options::default())?.with_bound(&simulation)?,
            streaming: of(Options::streaming())?,
        })
    })
}

fn rows() -> Vec<Row<'static, Both>> {
    let nine = "nine degrees of freedom, and a hundredth for what linearisation leaves";
    let all = |one: &Both| Some(one.batch.nees);
    let determined = |one: &Both| Some(one.batch.nees_determined);
    let nis = |one: &Both| Some(1e3 * (one.batch.nis_sum / one.batch.values as f64 - 1.0));
    let streaming = |one: &Both| Some(one.streaming.nees);
    let near = |one: &Both| -> [bool; 9] {
        let CalibrationTrial { error, sigma, .. } = one.streaming;
        core::array::from_fn(|i| error[i].abs() <= 3.5 * sigma[i])
    };
    let none = "none; truths nearer than their priors take nine of some ten thousand";
    let one_pass = "one pass of a filter: a third more than a consistent estimator";
    let beyond = "0.9995 of a normal distribution; ten times as many may be beyond";
    let name = |what: &str| format!("random scenarios, streaming filter: {what}");
    let mut rows = vec![
        Row::mean("mean NEES of the nine coefficients", all).between([8.9, 9.1], nine),
        Row::mean("mean NEES of the determined coefficients", determined).between([8.9, 9.1], nine),
        Row::mean(
            "NIS over the number of values, less one, in thousandths",
            nis,
        )
        .between([-1.0, 1.0], none),
        Row::mean(name("mean NEES (9 expected)"), streaming).at_most(12.0, one_pass),
        Row::each(name("share of coefficients within 3.5 sigmas"), near).at_least(0.995, beyond),
    ];
    for (index, name) in names() {
        let over_bound = move |one: &Both| {
            let over = one.batch.error[index] / one.batch.bound_sigma?[index];
            one.batch.determined[index].then_some([over, 1.0])
        };
        let held = move |one: &Both| {
            let held = one.batch.error[index].abs() <= NORMAL_97_5 * one.batch.sigma[index];
            one.batch.determined[index].then_some(held)
        };
        let holds = format!("{name}: share of 95 % intervals that hold the truth");
        rows.extend([
            Row::rms_ratio(format!("{name}: RMSE / Cramér–Rao bound"), over_bound)
                .between([0.93, 1.07], "as good as any estimator can be"),
            Row::share(holds, held).of_coverage(),
        ]);
    }
    rows
}
