//! Gain of extended models: in cross-validation, in the coefficients, and on a second record.

mod records;

use core::ops::Range;

use gyrocal::effect::Enters;
use gyrocal_evaluation::{Outcome, effect_of};
use gyrocal_statistics::{Proportion, mean_square_band, median};
use gyrocal_testkit::extended_comparison;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;
use records::{Errors, Extension, Second};

/// First seed and number of records of each cell; small versions have a fraction of them.
const CLEAN: [u64; 2] = [600_000, 2_000];
const HIDDEN: [u64; 2] = [700_000, 1_000];
const CROSS_AXIS: [u64; 2] = [800_000, 300];
const SECOND: [u64; 2] = [900_000, 1_000];
const SMALL_SHARE: u64 = 100;
const SMALL_LEAST: u64 = 10;

/// Strength of an injected effect, in sigmas of its own bound, and the least one for second records.
const STRENGTH: f64 = 8.0;
const LEAST_STRENGTH: f64 = 12.0;

/// All figures of the topic.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let mut figures = clean(small)?;
    figures.extend(hidden(small)?);
    figures.extend(cross_axis(small)?);
    figures.extend(second(small)?);
    figures.extend(filters());
    Ok(figures)
}

/// The filter of `examples/extended`, derived from a model file, against that on the whole
/// catalogue.
fn filters() -> [Figure; 2] {
    let figure = |name: &str, most: f64, [state, sigma]: [f64; 2]| {
        let mut figure = Figure::within(name, [f64::NEG_INFINITY, most], state.max(sigma));
        figure.target = format!("<= {most:e}");
        figure.measured = format!("{:.1e}", state.max(sigma));
        figure
    };
    let name = "extended filter less that of the catalogue, sigmas:";
    [
        figure(
            &format!("{name} one step"),
            1e-9,
            extended_comparison::after_one_step(),
        ),
        figure(
            &format!("{name} three days"),
            1e-5,
            extended_comparison::after_three_days(),
        ),
    ]
}

/// Runs a cell; the full version is resumable.
fn cell<T: Serialize + DeserializeOwned + Send>(
    name: &str,
    [first, runs]: [u64; 2],
    small: bool,
    job: impl Fn(u64) -> Result<T, Error> + Sync,
) -> Result<(Outcome<T>, Range<u64>), Error> {
    let runs = if small {
        (runs / SMALL_SHARE).max(SMALL_LEAST)
    } else {
        runs
    };
    let seeds = first..first + runs;
    let campaign = resumable::campaign("gain", name, seeds.clone(), small)?;
    Ok((campaign.run(job, |_| ())?, seeds))
}

/// A fraction with a lower limit; a small population may be too small to tell.
fn at_least(name: &str, least: f64, found: Proportion, small: bool) -> Figure {
    let figure = Figure::within(name, [least, f64::INFINITY], found.share()).of_share(found);
    if small {
        return figure.judged(found.at_least(least));
    }
    figure
}

/// Records that could not be diagnosed, if there are any: there must be none.
fn failures<T>(cell: &str, outcome: &Outcome<T>) -> Option<Figure> {
    let failed = outcome.failures().count();
    let first = outcome.failures().next()?.message;
    let name = format!("{cell}: records that could not be diagnosed");
    let mut figure = Figure::note(&name, format!("{failed} ({first})"));
    figure.target = "none".to_owned();
    figure.holds = Some(false);
    Some(figure)
}

/// Extensions of clean records.
fn clean(small: bool) -> Result<Vec<Figure>, Error> {
    let (outcome, seeds) = cell("clean", CLEAN, small, records::clean)?;
    let of = |what: &dyn Fn(&Extension) -> bool| {
        Proportion::of(outcome.successes().map(|(_, found)| what(found)))
    };
    let extended = of(&Extension::extended);
    let significant = of(&|found: &Extension| !found.findings.is_empty());
    let runs = extended.trials as usize;
    let mut bound = Figure::within(
        "clean records: extensions accepted, one-sided 95 % upper bound",
        [f64::NEG_INFINITY, 0.02],
        extended.upper_bound(0.95),
    );
    if small {
        bound = bound.judged(extended.at_most(0.02));
    }
    let figures = [
        bound.over(runs, format!("{seeds:?}")),
        Figure::note(
            "clean records: significant terms, and of these accepted",
            format!("{} and {}", significant.hits, extended.hits),
        ),
    ];
    Ok(figures
        .into_iter()
        .chain(failures("clean", &outcome))
        .collect())
}

/// Gain of the findings in records with one injected effect.
fn hidden(small: bool) -> Result<Vec<Figure>, Error> {
    let job = |seed| records::hidden(seed, STRENGTH);
    let (outcome, seeds) = cell("hidden", HIDDEN, small, job)?;
    let found: Vec<&Extension> = outcome.successes().map(|(_, found)| found).collect();
    let terms = || found.iter().flat_map(|found| &found.findings);
    let gain = Proportion::of(terms().map(|(_, nats, _)| *nats > 0.0));
    let nats: Vec<f64> = found.iter().filter_map(|found| found.gain_nats).collect();
    let runs = found.len();
    let name = format!("d = {STRENGTH}: significant terms that gain under cross-validation");
    let figures = [
        at_least(&name, 0.95, gain, small).over(runs, format!("{seeds:?}")),
        Figure::within(
            &format!("d = {STRENGTH}: median gain of a record, nats"),
            [8.0, f64::INFINITY],
            median(&nats),
        )
        .over(nats.len(), format!("{seeds:?}")),
    ];
    Ok(figures
        .into_iter()
        .chain(failures("hidden", &outcome))
        .collect())
}

/// Errors of the coefficients with a large cross-axis term.
fn cross_axis(small: bool) -> Result<Vec<Figure>, Error> {
    let (outcome, seeds) = cell("cross-axis", CROSS_AXIS, small, records::cross_axis)?;
    let errors: Vec<&Errors> = outcome.successes().map(|(_, errors)| errors).collect();
    let runs = errors.len();
    let all = |of: &dyn Fn(&Errors) -> f64| errors.iter().map(|e| of(e)).collect::<Vec<f64>>();
    let mean = |values: Vec<f64>| gyrocal_statistics::mean(&values);
    let name = "0.05 deg/h/g across an axis:";
    let band = mean_square_band(9.0 * runs as f64, runs as f64, 0.99);
    let figures = [
        Figure::within(
            &format!("{name} median of the largest nominal error, sigmas"),
            [10.0, f64::INFINITY],
            median(&all(&|e| e.largest[0])),
        )
        .over(runs, format!("{seeds:?}")),
        Figure::within(
            &format!("{name} mean NEES of the extended model, 99 % band"),
            band.map(|end| (100.0 * end).round() / 100.0),
            mean(all(&|e| e.nees[1])),
        )
        .over(runs, format!("{seeds:?}")),
        Figure::note(
            &format!("{name} median of the largest extended error, sigmas"),
            format!("{:.2}", median(&all(&|e| e.largest[1]))),
        ),
        Figure::note(
            &format!("{name} median NEES of the nominal model"),
            format!("{:.0}", median(&all(&|e| e.nees[0]))),
        ),
    ];
    Ok(figures
        .into_iter()
        .chain(failures("cross-axis", &outcome))
        .collect())
}

/// `true` for an error of an accelerometer.
fn enters_outputs(effect: &str) -> bool {
    effect_of(effect).is_some_and(|effect| matches!(effect.enters, Enters::Outputs(_)))
}

/// Prediction of a second record.
fn second(small: bool) -> Result<Vec<Figure>, Error> {
    let job = |seed| records::second(seed, LEAST_STRENGTH);
    let (outcome, seeds) = cell("second", SECOND, small, job)?;
    let found: Vec<&Second> = outcome.successes().map(|(_, second)| second).collect();
    let runs = found.len();
    // What a model that has exactly what was hidden wins is what can be won: an error of an
    // accelerometer, say, often changes the coefficients by less than the first record leaves open
    // in them, and then chance decides which model predicts a day better.
    let better = |within: &dyn Fn(&Second) -> bool| {
        let these = found.iter().filter(|second| within(second));
        Proportion::of(these.map(|second| second.predicted_better()))
    };
    let within_reach = better(&Second::within_reach);
    let beyond_noise = better(&Second::beyond_noise);
    let by_kind = |of_accelerometers: bool| {
        let of_kind = |second: &Second| enters_outputs(&second.effect) == of_accelerometers;
        let ours = better(&of_kind);
        let told = found.iter().filter(|second| of_kind(second));
        let told = Proportion::of(told.map(|second| second.within_reach()));
        format!(
            "{:.3}, {:.3} of {}",
            ours.share(),
            told.share(),
            ours.trials
        )
    };
    let scored = Proportion::of(
        found
            .iter()
            .map(|second| second.gain_nats.is_some_and(|nats| nats > 0.0)),
    );
    let angles: Vec<[f64; 3]> = found.iter().filter_map(|s| s.after_a_day_arcmin).collect();
    let of = |which: usize| median(&angles.iter().map(|a| a[which]).collect::<Vec<f64>>());
    let name = format!(
        "second record, d = {LEAST_STRENGTH} to {}:",
        4.0 * LEAST_STRENGTH
    );
    let figures = [
        at_least(
            &format!("{name} drift predicted better, of those that the true cause predicts better"),
            0.95,
            within_reach,
            small,
        )
        .over(within_reach.trials as usize, format!("{seeds:?}")),
        at_least(
            &format!("{name} drift predicted better where the nominal error is beyond noise"),
            0.95,
            beyond_noise,
            small,
        )
        .over(beyond_noise.trials as usize, format!("{seeds:?}")),
        Figure::note(
            &format!("{name} drift predicted better, and by the true cause: errors of gyros, site"),
            by_kind(false),
        ),
        Figure::note(
            &format!("{name} drift predicted better, and by the true cause: of accelerometers"),
            by_kind(true),
        ),
        at_least(&format!("{name} higher log score"), 0.95, scored, small)
            .over(runs, format!("{seeds:?}")),
        Figure::note(
            &format!("{name} median error after a day, nominal, extended, expected, arcmin"),
            format!("{:.2}, {:.2}, {:.2}", of(0), of(1), of(2)),
        ),
    ];
    Ok(figures
        .into_iter()
        .chain(failures("second", &outcome))
        .collect())
}
