//! Several records of one platform, diagnosed together.

use gyrocal::Effect;
use gyrocal::effect::{EffectKind, Enters};
use gyrocal_answer::{Answer, Finding, Verdict};
use gyrocal_evaluation::{
    InjectedEffect, diagnosed, diagnosed_together, effect_of, run_of, set_holds, testable_effects,
};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Coefficients, InitialAttitude, Scenario, Simulation, simulate};
use serde::{Deserialize, Serialize};

use super::oracle;
use crate::harness::{Context, DIAGNOSIS, Error, Figure, Population, Row, Sources, of};

/// What can move the results.
const SOURCES: Sources = of(
    DIAGNOSIS,
    &[file!(), "crates/figures/src/records/oracle.rs"],
);

/// Purpose of the stream of draws.
const EFFECT: u64 = 1810;

/// A population of platforms with a hidden cause.
struct Hidden {
    name: &'static str,
    first: u64,
    small: u64,
    /// Number of records of each platform.
    records: u64,
    /// Root of the mean square of the strengths in the records.
    strength: f64,
    /// Least share of sets that hold the cause, and why.
    found: f64,
    reason: &'static str,
}

const HIDDEN: [Hidden; 2] = [
    Hidden {
        name: "two records, a term with d = 8 in each",
        first: 850_000,
        small: 4,
        records: 2,
        strength: 8.0,
        found: 0.99,
        reason: "eleven sigmas together, of which sets of one record hold 0.99",
    },
    Hidden {
        name: "four records, a term with d = 4 in each",
        first: 860_000,
        small: 2,
        records: 4,
        strength: 4.0,
        found: 0.95,
        reason: "sets of 95 %",
    },
];

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

/// All figures of the part.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for cell in &HIDDEN {
        let job = |seed| hidden(seed, cell.records, cell.strength);
        let seeds = [cell.first, 1000, cell.small];
        let population = Population::new(cell.name, seeds, SOURCES, job);
        figures.extend(context.measure(&population, &rows(cell))?);
    }
    let clean = Population::new("four clean records", [870_000, 2000, 2], SOURCES, is_alarm);
    let name = "four clean records: false alarms, upper bound of 95 %";
    let level = "the level is 1 %: of 2000 twenty are due, and 27 within the bound";
    let alarms = Row::bound(name, |alarm: &bool| *alarm).at_most(0.02, level);
    figures.extend(context.measure(&clean, &[alarms])?);
    Ok(figures)
}

fn rows(cell: &Hidden) -> Vec<Row<'_, Named>> {
    let name = |what: &str| format!("{}: {what}", cell.name);
    // Of terms that are constant in time, and of the others.
    let over_oracle = |what: &str, in_time: bool| {
        Row::ratio(name(what), move |one: &Named| {
            let is_of_these = one.together && one.in_time == in_time;
            let oracle = one.oracle.filter(|_| is_of_these)?;
            Some([(one.set - one.shapes) as f64, oracle])
        })
    };
    let what = "mean size of the set over an oracle's, members without onset or time constant";
    let number = |what: &str, of: fn(&Named) -> Option<usize>| {
        Row::mean(name(what), move |one| Some(of(one)? as f64))
    };
    let beside = "mean number of members with onset or time constant beside these";
    let (set, alone) = (
        "mean size of the set",
        "mean size of the set of the first record alone",
    );
    vec![
        Row::share(name("found"), |one: &Named| Some(one.together))
            .at_least(cell.found, cell.reason),
        over_oracle(what, false).at_most(1.1, "a tenth for levels of noise that are estimated"),
        over_oracle("the same of causes in time or temperature", true),
        number(beside, |one| one.together.then_some(one.shapes)),
        number(set, |one| one.together.then_some(one.set)),
        number(alone, |one| one.alone),
    ]
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
    let effects = testable_effects(&scenarios[0]).into_iter();
    let effects: Vec<&'static Effect> = effects.filter(is_term).collect();
    let (mut injected, own) = loop {
        let effect = *draw.one_of(&effects);
        let sizes = effect.sizes();
        let sizes = sizes.map(|_| UNIT * effect.typical_size * draw.normal());
        let of_unit = InjectedEffect {
            effect,
            sizes: sizes.collect(),
            shape: None,
        };
        let strengths = scenarios.iter().map(|scenario| of_unit.strength(scenario));
        let strengths: Vec<f64> = strengths.collect::<Result<_, _>>()?;
        // Every record has to show it.
        if strengths.iter().all(|own| *own > LEAST) {
            let squares: f64 = strengths.iter().map(|own| own * own).sum();
            break (of_unit, (squares / records as f64).sqrt());
        }
    };
    for size in &mut injected.sizes {
        *size = *size * strength / own;
    }
    let effect = injected.effect;
    for scenario in &mut scenarios {
        scenario.hidden = vec![injected.to_hidden()?];
    }
    let simulations = simulated(&scenarios)?;
    let together = together(&simulations)?;
    let set = together.causes().find(|cause| set_holds(cause, effect.id));
    let members = || set.into_iter().flat_map(Finding::set);
    let has_shape = |id: &&str| effect_of(id).is_some_and(|member| member.shape().is_some());
    let first = diagnosed(&simulations[0])?.result;
    let alone = first.causes().next();
    Ok(Named {
        together: set.is_some(),
        set: members().count(),
        alone: alone.map(|cause| cause.set().count()),
        in_time: effect.kind != EffectKind::Constant,
        shapes: members().filter(has_shape).count(),
        oracle: oracle::set_size(&scenarios[0], &simulations, &injected)?,
    })
}

/// Whether four records of the nominal model show anything together.
fn is_alarm(seed: u64) -> Result<bool, Error> {
    let found = together(&simulated(&scenarios(seed, 4))?)?;
    Ok(found.verdict != Verdict::Clean)
}

fn simulated(scenarios: &[Scenario]) -> Result<Vec<Simulation>, Error> {
    Ok(scenarios.iter().map(simulate).collect::<Result<_, _>>()?)
}

/// What is said of the records together.
fn together(simulations: &[Simulation]) -> Result<Answer, Error> {
    let runs: Vec<_> = simulations.iter().map(run_of).collect();
    Ok(diagnosed_together(&runs)?.result)
}
