//! Several records of one platform, diagnosed together.

use gyrocal::Effect;
use gyrocal::effect::{EffectKind, Enters};
use gyrocal_calibration::Run;
use gyrocal_diagnosis::{
    DiagnoseOptions, Gate, RecordToDiagnose, Verdict, diagnose, diagnose_together,
};
use gyrocal_evaluation::{InjectedEffect, effect_of, same_or_equivalent, testable_effects};
use gyrocal_setup::PlatformKind;
use gyrocal_statistics::Proportion;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Coefficients, InitialAttitude, Scenario, Simulation, simulate};
use serde::{Deserialize, Serialize};

use super::{at_least, oracle};
use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;
use crate::truth::Extent;

/// Purpose of the stream of draws.
const EFFECT: u64 = 1810;

const FIRST_PAIR: u64 = 850_000;
const PAIRS: u64 = 1000;
const SMALL_PAIRS: u64 = 4;

const FIRST_FOUR: u64 = 860_000;
const FOURS: u64 = 1000;
const SMALL_FOURS: u64 = 2;

const FIRST_CLEAN: u64 = 870_000;
const CLEAN: u64 = 2000;
const SMALL_CLEAN: u64 = 2;

/// Largest mean size of the set over an oracle's.
const MOST_OVER_ORACLE: f64 = 1.1;

/// Largest upper bound of the share of clean quadruples with a finding.
const MOST_FALSE: f64 = 0.02;

/// Size for which strengths are computed, in typical sizes: small against the nominal terms.
const UNIT: f64 = 0.01;

/// Least strength of that size in any of the records: below, the records do not show the effect.
const LEAST: f64 = 1e-6;

/// Result for records with a hidden cause.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Named {
    /// Whether a confidence set of the records together holds it.
    together: bool,
    /// Size of that set.
    set: usize,
    /// Size of the set of the first record alone, if it finds anything.
    alone: Option<usize>,
    /// Whether the cause is a function of time or temperature beside force.
    in_time: bool,
    /// Members of the set that have an onset or a time constant.
    shapes: usize,
    /// Expected size of an oracle's set, without such members.
    oracle: Option<f64>,
}

pub(crate) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let small = extent.small;
    let mut figures = named(
        "two records, a term with d = 8 in each",
        0.99,
        Some(MOST_OVER_ORACLE),
        FIRST_PAIR..FIRST_PAIR + extent.records(PAIRS, SMALL_PAIRS),
        small,
        |seed| hidden(seed, 2, 8.0),
    )?;
    figures.extend(named(
        "four records, a term with d = 4 in each",
        0.95,
        None,
        FIRST_FOUR..FIRST_FOUR + extent.records(FOURS, SMALL_FOURS),
        small,
        |seed| hidden(seed, 4, 4.0),
    )?);
    let seeds = FIRST_CLEAN..FIRST_CLEAN + extent.records(CLEAN, SMALL_CLEAN);
    let campaign = resumable::campaign("logs", "clean-quadruples", seeds.clone(), small)?;
    let outcome = campaign.run(is_alarm, |_| ())?;
    let share = Proportion::of(outcome.successes().map(|(_, alarm)| *alarm));
    let name = "four clean records: false alarms, upper bound of 95 %";
    let mut alarms =
        Figure::within(name, [0.0, MOST_FALSE], share.upper_bound(0.95)).of_share(share);
    if small {
        alarms = alarms.judged(share.at_most(MOST_FALSE));
    }
    figures.push(alarms.over(share.trials as usize, format!("{seeds:?}")));
    Ok(figures)
}

/// Figures of records with a cause.
fn named(
    name: &str,
    target: f64,
    most_over_oracle: Option<f64>,
    seeds: core::ops::Range<u64>,
    small: bool,
    record: impl Fn(u64) -> Result<Named, Error> + Sync,
) -> Result<Vec<Figure>, Error> {
    let campaign = resumable::campaign("logs", name, seeds.clone(), small)?;
    let outcome = campaign.run(record, |_| ())?;
    let all: Vec<&Named> = outcome.successes().map(|(_, named)| named).collect();
    let seeds = format!("{seeds:?}");
    let found = all.iter().map(|one| one.together);
    let beside = beside_oracle(name, most_over_oracle, &all, &seeds, small);
    let mean = |sizes: Vec<usize>| sizes.iter().sum::<usize>() as f64 / sizes.len().max(1) as f64;
    let together = mean(
        all.iter()
            .filter(|one| one.together)
            .map(|one| one.set)
            .collect(),
    );
    let alone: Vec<usize> = all.iter().filter_map(|one| one.alone).collect();
    let count = alone.len();
    let mut figures = vec![at_least(
        &format!("{name}: found"),
        target,
        found,
        &seeds,
        small,
    )];
    figures.extend(beside);
    figures.push(
        Figure::note(
            &format!("{name}: mean size of the set, together and of the first record alone"),
            format!("{together:.2} and {:.2} (of {count})", mean(alone)),
        )
        .over(all.len(), seeds),
    );
    Ok(figures)
}

/// Mean sizes of sets over those of an oracle: of terms that are constant in time, and of the others.
fn beside_oracle(
    name: &str,
    most: Option<f64>,
    all: &[&Named],
    seeds: &str,
    small: bool,
) -> Vec<Figure> {
    let sizes = |in_time: bool| {
        let of = all
            .iter()
            .filter(|one| one.together && one.in_time == in_time);
        let pairs: Vec<[f64; 2]> = of
            .filter_map(|one| Some([(one.set - one.shapes) as f64, one.oracle?]))
            .collect();
        let sum = |part: usize| pairs.iter().map(|pair| pair[part]).sum::<f64>();
        (sum(0) / sum(1), pairs.len())
    };
    let (ratio, count) = sizes(false);
    if count == 0 {
        return Vec::new();
    }
    let what = "mean size of the set over an oracle's, members without onset or time constant";
    let title = format!("{name}: {what}");
    let mut figure = match most {
        Some(most) => Figure::within(&title, [0.0, most], ratio),
        None => Figure::note(&title, format!("{ratio:.3}")),
    };
    if small && most.is_some() {
        figure.holds = None;
        figure.too_few = true;
    }
    let mut figures = vec![figure.over(count, seeds)];
    let (ratio, count) = sizes(true);
    if count > 0 {
        let name = format!("{name}: the same of causes in time or temperature");
        figures.push(Figure::note(&name, format!("{ratio:.3}")).over(count, seeds));
    }
    let found = all.iter().filter(|one| one.together);
    let shapes: Vec<f64> = found.map(|one| one.shapes as f64).collect();
    let mean = shapes.iter().sum::<f64>() / shapes.len().max(1) as f64;
    let name = format!("{name}: mean number of members with onset or time constant beside these");
    figures.push(Figure::note(&name, format!("{mean:.2}")).over(shapes.len(), seeds));
    figures
}

/// A day at a random attitude, of the platform and the record of a seed.
fn scenario(seed: u64, record: u64) -> Scenario {
    Scenario {
        seed: 16 * seed + record,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::Random,
        duration_s: 86_400.0,
        interval_s: 300.0,
        ..Scenario::default()
    }
}

fn scenarios(seed: u64, records: u64) -> Vec<Scenario> {
    (0..records).map(|record| scenario(seed, record)).collect()
}

/// Records with a constant term of forces or outputs, of one size in all of them: the root of the mean square
/// of its strengths is `strength`.
fn hidden(seed: u64, records: u64, strength: f64) -> Result<Named, Error> {
    let mut scenarios = scenarios(seed, records);
    let mut draw = Draw::new(seed, EFFECT);
    let is_term = |effect: &&Effect| {
        effect.has_term()
            && effect.shape().is_none()
            && matches!(effect.enters, Enters::Rates(_) | Enters::Outputs(_))
    };
    let effects: Vec<&'static Effect> = testable_effects(&scenarios[0])
        .into_iter()
        .filter(is_term)
        .collect();
    let (effect, sizes, own) = loop {
        let effect = *draw.one_of(&effects);
        let sizes: Vec<f64> = effect
            .sizes()
            .map(|_| UNIT * effect.typical_size * draw.normal())
            .collect();
        let of_unit = InjectedEffect {
            effect,
            sizes: sizes.clone(),
            shape: None,
        };
        let strengths: Vec<f64> = scenarios
            .iter()
            .map(|scenario| of_unit.strength(scenario))
            .collect::<Result<_, _>>()?;
        // Every record has to show it.
        if strengths.iter().all(|own| *own > LEAST) {
            let squares: f64 = strengths.iter().map(|own| own * own).sum();
            break (effect, sizes, (squares / records as f64).sqrt());
        }
    };
    let injected = InjectedEffect {
        effect,
        sizes: sizes.iter().map(|size| size * strength / own).collect(),
        shape: None,
    };
    for scenario in &mut scenarios {
        scenario.hidden = vec![injected.to_hidden()?];
    }
    let simulations = simulated(&scenarios)?;
    let options = DiagnoseOptions::default();
    let together = diagnose_together(checked(&simulations, &options), &options, |_| ())?.result;
    let holds = together.causes().find(|cause| {
        let others = cause.alternatives.iter().map(|other| &*other.effect);
        let mut all = core::iter::once(&*cause.effect).chain(others);
        all.any(|member| same_or_equivalent(effect.id, member))
    });
    let first = diagnose(&simulations[0].record, &simulations[0].bench, &options)?;
    let alone = first.result.causes().next();
    let shapes = holds.map_or(0, |cause| {
        let others = cause.alternatives.iter().map(|other| &*other.effect);
        let all = core::iter::once(&*cause.effect).chain(others);
        all.filter(|id| effect_of(id).is_some_and(|member| member.shape().is_some()))
            .count()
    });
    Ok(Named {
        together: holds.is_some(),
        set: holds.map_or(0, |cause| 1 + cause.alternatives.len()),
        alone: alone.map(|cause| 1 + cause.alternatives.len()),
        in_time: effect.kind != EffectKind::Constant,
        shapes,
        oracle: oracle::set_size(&scenarios[0], &simulations, &injected)?,
    })
}

/// Whether four records of the nominal model show anything together.
fn is_alarm(seed: u64) -> Result<bool, Error> {
    let simulations = simulated(&scenarios(seed, 4))?;
    let options = DiagnoseOptions::default();
    let found = diagnose_together(checked(&simulations, &options), &options, |_| ())?;
    Ok(found.result.verdict != Verdict::Clean)
}

fn simulated(scenarios: &[Scenario]) -> Result<Vec<Simulation>, Error> {
    Ok(scenarios.iter().map(simulate).collect::<Result<_, _>>()?)
}

fn checked<'a>(
    simulations: &'a [Simulation],
    options: &DiagnoseOptions,
) -> Vec<RecordToDiagnose<'a>> {
    let records = simulations.iter().enumerate();
    records
        .map(
            |(index, Simulation { record, bench, .. })| RecordToDiagnose {
                name: format!("record {}", index + 1),
                gate: Gate::new(
                    PlatformKind::Stabilised,
                    &Run { record, bench },
                    &options.calibration,
                ),
                bench,
            },
        )
        .collect()
}
