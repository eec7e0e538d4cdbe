//! Records with one hidden effect, diagnosed by interpreted and, of the oscillator, by generated functions.

use std::collections::BTreeMap;

use gyrocal_answer::{Answer, Coefficients, Finding};
use gyrocal_evaluation::Statistic;
use gyrocal_plant::{LoadedPlant, SearchOptions, diagnose};
use serde::{Deserialize, Serialize};

use super::second::{LEAST_GAIN, Second, is_better};
use super::simulated::{Kind, Setting, Stream, simulate, strength, with_strength};
use super::{Of, ROWS, holds, in_turn, oracle, prepared};
use crate::cost::on_one_core;
use crate::harness::{Error, Population, Row};

#[path = "../../../../examples/duffing/plant.rs"]
#[rustfmt::skip]
#[expect(
    unreachable_pub,
    dead_code,
    clippy::too_many_lines,
    clippy::wrong_self_convention,
    reason = "generated for every use"
)]
pub(super) mod duffing;

/// Seed of the records; no constant was tuned on them.
pub(super) const HIDDEN: u64 = 620_000;

/// Strengths of hidden effects, standard deviations.
const STRENGTHS: [f64; 2] = [5.0, 50.0];

/// Strength from which on an effect must be detected, and from which on it must predict.
pub(crate) const DETECTABLE: f64 = 8.0;
const PREDICTIVE: f64 = 12.0;

/// A record with a hidden effect, diagnosed.
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Hidden {
    pub(crate) seed: u64,
    /// The hidden effect, and its strength.
    pub(crate) effect: String,
    pub(crate) strength: f64,
    detected: bool,
    /// Names, each with its rivals.
    pub(crate) sets: Vec<Vec<String>>,
    /// Whether one of the sets holds the effect, or one that no record tells from it.
    holds: bool,
    /// Effects without an onset in the first set, and in that of an oracle, of a hidden effect without one.
    beside_oracle: Option<[f64; 2]>,
    /// Whether the simulation of a second record is better with what was found, of a record whose effect
    /// was named and whose true model gains there.
    better: Option<bool>,
    /// Whether generated functions give the same names and sets, and the largest difference of a number over its
    /// standard deviation.
    generated: Option<(bool, f64)>,
    /// Estimates of the parameters and of the sizes of effects.
    pub(crate) parameters: BTreeMap<String, f64>,
    pub(crate) sizes: BTreeMap<String, f64>,
    /// Processor time of the diagnosis, s.
    pub(crate) seconds: f64,
}

/// Records of all plants.
pub(crate) fn population(plants: &[LoadedPlant]) -> Result<Population<'_, Of<Hidden>>, Error> {
    let generated = plants[Kind::Duffing as usize].with_model(duffing::Duffing)?;
    let job = move |kind: Kind, seed| {
        let generated = (kind == Kind::Duffing).then_some(&generated);
        diagnosed(kind, &plants[kind as usize], generated, seed)
    };
    Ok(in_turn("hidden", &Kind::ALL, [HIDDEN, 200, 3], job))
}

/// A record with a hidden effect and a later one of the same plant.
pub(crate) fn settings(kind: Kind, seed: u64) -> [Setting; 2] {
    let mut setting = Setting::random(kind, seed, ROWS);
    let effects = kind.facts().effects;
    setting.hidden = effects[seed as usize % effects.len()];
    let wanted = Stream::new(seed, 9).log_between(STRENGTHS[0], STRENGTHS[1]);
    let setting = with_strength(&setting, wanted);
    let seed = seed + 10_000_000;
    // What began in the first record is there from the start of the second.
    let later = Setting {
        seed,
        onset: -1.0,
        initial: Setting::random(kind, seed, ROWS).initial,
        ..setting.clone()
    };
    [setting, later]
}

fn diagnosed(
    kind: Kind,
    plant: &LoadedPlant,
    generated: Option<&LoadedPlant>,
    seed: u64,
) -> Result<Hidden, Error> {
    let [setting, later] = settings(kind, seed);
    let second = Second::new(plant, &later)?;
    let first = prepared(plant, simulate(&setting, None))?;
    let options = SearchOptions::default();
    let (made, seconds) =
        on_one_core(|| diagnose(plant, first.clone(), Some(second.record.clone()), &options));
    let made = made?;
    let (answer, nominal) = (made.answer, made.searched.nominal);
    let generated = match generated {
        Some(other) => Some(compared(
            &answer,
            &diagnose(other, first, None, &options)?.answer,
        )),
        None => None,
    };
    let (own, strength) = (setting.hidden.0, strength(&setting));
    let sets: Vec<Vec<String>> = answer.findings.iter().map(set).collect();
    let holds = answer.findings.iter().any(|found| holds(found, own));
    let beside_oracle = sets.first().and_then(|set| {
        let lasting = |id: &&String| !oracle::has_onset(plant.tables(), id);
        let oracle = oracle::set_size(&nominal, own, strength)?;
        Some([set.iter().filter(lasting).count() as f64, oracle])
    });
    let is_named = sets.iter().any(|set| set[0] == own);
    let gain = answer.gain.as_ref();
    let later = gain.and_then(|gain| gain.validation.as_ref());
    let later = later.filter(|later| is_named && second.true_gain(later) >= LEAST_GAIN);
    let sizes = answer.findings.iter().filter_map(|found| {
        let size = found.parameters.first()?;
        Some((found.effect.clone(), size.estimate))
    });
    let parameters = answer.coefficients.iter().flat_map(Coefficients::best);
    Ok(Hidden {
        seed,
        effect: own.to_owned(),
        strength,
        detected: answer.has_findings(),
        holds,
        beside_oracle,
        better: later.map(is_better),
        generated,
        parameters: parameters
            .map(|one| (one.name.clone(), one.estimate))
            .collect(),
        sizes: sizes.collect(),
        seconds,
        sets,
    })
}

/// The name of an effect and those of the others of its set.
fn set(found: &Finding) -> Vec<String> {
    found.set().map(str::to_owned).collect()
}

/// Whether two answers have the same names and sets, and the largest difference of a parameter or size over its
/// standard deviation.
fn compared(one: &Answer, other: &Answer) -> (bool, f64) {
    let sets = |answer: &Answer| -> Vec<_> { answer.findings.iter().map(set).collect() };
    let numbers = |answer: &Answer| -> Vec<[f64; 2]> {
        let sizes = answer.findings.iter().flat_map(|found| &found.parameters);
        let sizes = sizes.filter_map(|size| Some([size.estimate, size.sigma?]));
        let parameters = answer.coefficients.iter().flat_map(Coefficients::best);
        let parameters = parameters.map(|one| [one.estimate, one.sigma]);
        parameters.chain(sizes).collect()
    };
    let (ours, theirs) = (numbers(one), numbers(other));
    let pairs = ours.iter().zip(&theirs);
    let differences = pairs.map(|([one, sigma], [other, _])| (one - other).abs() / sigma);
    (sets(one) == sets(other), differences.fold(0.0, f64::max))
}

/// What is found in a record whose effect must be detected.
fn strong(one: &Of<Hidden>) -> Option<&Hidden> {
    Some(&one.found).filter(|found| found.strength >= DETECTABLE)
}

pub(super) fn rows() -> Vec<Row<'static, Of<Hidden>>> {
    let first = |one: &Of<Hidden>| {
        let found = strong(one)?;
        Some(found.sets.first().is_some_and(|set| set[0] == found.effect))
    };
    let better = |one: &Of<Hidden>| {
        let found = Some(&one.found).filter(|found| found.strength >= PREDICTIVE);
        found?.better
    };
    let worst = |records: &[Of<Hidden>]| {
        let differences = records
            .iter()
            .filter_map(|one| Some(one.found.generated?.1));
        let count = differences.clone().count() as u64;
        Statistic::Value(differences.fold(0.0, f64::max), count)
    };
    let of_second = format!(
        "any plant: effect of d >= {PREDICTIVE} named, true model gains >= {LEAST_GAIN} nats: \
         simulations over all {ROWS} rows of a second record have less error"
    );
    let mut rows = vec![
        Row::share("any plant: effect of d >= 8 detected", |one| {
            Some(strong(one)?.detected)
        })
        .at_least(0.99, "the threshold of the level of 1 % is four to five"),
        Row::share("any plant: set holds the effect of d >= 8", |one| {
            Some(strong(one)?.holds)
        })
        .at_least(0.95, "sets of 95 %"),
        Row::share("any plant: first name of d >= 8 is the effect", first),
        Row::share(of_second, better).at_least(
            0.95,
            "what is true predicts; a name of a set need not be it",
        ),
        Row::ratio(
            "any plant: mean size of the set of d >= 8 over an oracle's, effects without onset",
            |one| strong(one)?.beside_oracle,
        )
        .at_most(
            1.1,
            "a tenth for the noise and the size, which the oracle knows",
        ),
    ];
    for kind in Kind::ALL {
        let is_own = move |one: &Of<Hidden>| (one.plant == kind as usize).then_some(());
        let holds = format!("any plant: set holds the effect, {kind:?}");
        let size = format!("any plant: mean size of the set, {kind:?}");
        rows.extend([
            Row::share(holds, move |one| is_own(one).and(Some(strong(one)?.holds))),
            Row::mean(size, move |one| {
                let size = strong(one)?.sets.first().map_or(0, Vec::len);
                is_own(one).map(|()| size as f64)
            }),
        ]);
    }
    rows.extend([
        Row::share(
            "any plant: interpreted and generated, equal names and sets",
            |one: &Of<Hidden>| Some(one.found.generated?.0),
        )
        .at_least(1.0, "the functions are the same"),
        Row::new(
            "any plant: interpreted over generated, largest difference of a parameter or size",
            worst,
        )
        .at_most(1e-6, "sigmas: rounding, through a fit"),
    ]);
    rows
}
