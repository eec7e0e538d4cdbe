//! Figures of each population cell with their targets.

use core::ops::Range;
use std::collections::BTreeMap;

use gyrocal::EFFECTS;
use gyrocal::effect::EffectKind;
use gyrocal_statistics::{NORMAL_97_5, Proportion, normal_probability, normal_quantile, quantile};

use crate::campaign::Outcome;
use crate::catalogue::effect_of;
use crate::characteristic::{Characteristic, Measure};
use crate::comparison::{FamilyRow, families};
use crate::population::PopulationCell;
use crate::record_score::{RecordScore, SAME_CLASS_COSINE};
use crate::statistic::{Statistic, Target};

/// A stricter limit than [`SAME_CLASS_COSINE`], for information.
const STRICT_CLASS_COSINE: f64 = 0.97;

/// Strengths given the findings that count as the requested 10 sigmas.
const REACHED: Range<f64> = 9.0..11.5;

/// Largest error of an onset that counts as found, as a part of the record.
const NEAR: f64 = 0.05;

/// Reasons of targets.
const OF_SETS: &str = "sets of 95 %";
const OF_INTERVALS: &str = "intervals of 95 %, two points for what their normal shape leaves out";
const OF_STRONG: &str = "the thresholds are at five sigmas: noise of three hides one of 700";
const OF_FAMILY: &str = "of few records each; none is shown to be found less often";
const OF_WEAK: &str = "as often as the unknown noise lets them: 0.78 of five sigmas, 0.95 of six";
const OF_CLASSES: &str = "signatures that are nearly parallel change places in noise";

/// The characteristics of a cell, in the order of the table.
#[must_use]
pub fn characteristics(
    cell: PopulationCell,
    outcome: &Outcome<RecordScore>,
    seeds: &Range<u64>,
) -> Vec<Characteristic> {
    let records: Vec<&RecordScore> = outcome.successes().map(|(_, record)| record).collect();
    let runs = seeds.end - seeds.start;
    let mut all = measures(cell, &records);
    let failed = outcome.failures().count();
    if failed > 0 {
        all.push(none("records that could not be examined", failed, runs));
    }
    let full = runs >= cell.full_runs();
    let of = |measure: &Measure| Characteristic::of(&cell.name(), seeds, full, measure);
    all.iter().map(of).collect()
}

/// The statistics of a cell over its records, in the order of the table.
#[must_use]
pub fn measures(cell: PopulationCell, records: &[&RecordScore]) -> Vec<Measure> {
    let mut all = match cell {
        PopulationCell::Clean => clean(records),
        PopulationCell::Single(5) => weak(records, 0.72),
        PopulationCell::Single(6) => weak(records, 0.92),
        PopulationCell::Single(8) => strong(records, 0.91),
        PopulationCell::Single(12) => strong(records, 0.97),
        PopulationCell::Single(_) => Vec::new(),
        PopulationCell::LogUniform => single(records, None),
        PopulationCell::Pair => pair(records),
        PopulationCell::OutOfCatalogue => out_of_catalogue(records),
        PopulationCell::Step => step(records),
        PopulationCell::Cubic => {
            let silent = |record: &RecordScore| Some(record.verdict == "clean");
            let reason = "three sigmas are below every threshold, but noise adds to some";
            vec![Measure::share("silent", records, silent).at_least(0.75, reason)]
        }
        PopulationCell::Azimuth => azimuth(records),
    };
    if cell != PopulationCell::Clean && cell != PopulationCell::Cubic {
        let findings = records.iter().flat_map(|record| &record.findings);
        let alone = findings.filter(|finding| finding.lacks_equivalents);
        let figure = "single names for exact equivalents";
        all.push(none(figure, alone.count(), records.len() as u64));
    }
    all
}

/// A count that should be 0.
fn none(figure: &'static str, count: usize, of: u64) -> Measure {
    let statistic = Statistic::Value(count as f64, of);
    Measure::new(figure, statistic).with_target(Target::AtMost(0.0), "there is to be none")
}

/// The share of records for each injected effect separately: some are injected more often than others.
fn by_effect(
    records: &[&RecordScore],
    of: impl Fn(&RecordScore) -> Option<bool>,
) -> Vec<Proportion> {
    let mut effects: BTreeMap<&str, Vec<bool>> = BTreeMap::new();
    for record in records {
        if let (Some(hidden), Some(counts)) = (record.hidden.first(), of(record)) {
            effects.entry(&hidden.effect).or_default().push(counts);
        }
    }
    effects.into_values().map(Proportion::of).collect()
}

fn clean(records: &[&RecordScore]) -> Vec<Measure> {
    let alarms = Proportion::of(records.iter().map(|record| record.verdict != "clean"));
    let by = |figure, of: fn(&RecordScore) -> bool| {
        Measure::share(figure, records, |record| Some(of(record)))
    };
    vec![
        Measure::new("false alarms, upper 95 % bound", Statistic::Bound(alarms)).at_most(
            0.02,
            "the level is 1 %: of 2000 twenty are due, and 27 within the bound",
        ),
        Measure::new("false alarms", Statistic::Share(alarms)),
        by("false alarms of the search", RecordScore::detected),
        by("false alarms of noise", |record| !record.noise.is_empty()),
        by("false alarms of the remainder", |record| {
            record.unexplained.is_some()
        }),
    ]
}

/// The same weight for each effect: some are injected more often than others.
fn average_detected(records: &[&RecordScore]) -> Measure {
    let of = by_effect(records, |record| Some(record.detected()));
    Measure::new("detected, average of the effects", Statistic::Average(of))
}

/// Weak effects: how often they are found, and how often a set holds them beside an oracle's.
fn weak(records: &[&RecordScore], least: f64) -> Vec<Measure> {
    let in_set = |record: &RecordScore| record.hidden.iter().all(|hidden| hidden.in_set);
    let pair = |record: &&RecordScore| Some([in_set(record), record.oracle_in_set?]);
    let both: Vec<[bool; 2]> = records.iter().filter_map(pair).collect();
    let of = |which: usize| Statistic::share(&both, |pair| Some(pair[which]));
    let number = |pair: &[bool; 2]| pair.map(|held| f64::from(u8::from(held)));
    let detected = Statistic::share(records, |record| Some(record.detected()));
    let expected = coverage_given_detection(detected.value());
    let mut all = vec![
        average_detected(records).at_least(least, OF_WEAK),
        Measure::new(
            "a set holds the truth, over a search that knows that no rate walks",
            Statistic::Ratio(both.iter().map(number).collect()),
        )
        .at_least(0.95, "the levels of the noise are estimated by both"),
        Measure::new("a set holds the truth, of all", of(0)),
        Measure::new("the same of that search", of(1)),
        Measure::new(
            "95 % interval of the size, expected of what is detected as often",
            Statistic::Value(expected, detected.runs()),
        ),
    ];
    all.extend(single(records, None));
    all
}

/// Coverage of the 95 % interval of a normal estimate that is looked at where it exceeds a threshold, which a
/// share of all estimates does: low estimates, whose intervals lie below the truth, are missing.
fn coverage_given_detection(detected: f64) -> f64 {
    if detected >= 1.0 {
        return 0.95;
    }
    // What is detected as rarely lies above its interval.
    if detected <= 0.025 {
        return f64::NAN;
    }
    let least = normal_quantile(1.0 - detected).max(-NORMAL_97_5);
    (normal_probability(NORMAL_97_5) - normal_probability(least)) / detected
}

/// Effects that are all but always found: detection, and the class of the first finding.
fn strong(records: &[&RecordScore], first: f64) -> Vec<Measure> {
    let families = families(records);
    // Jumps of the attitude have three sizes at any row, and are found less often.
    let is_jump = |row: &FamilyRow| {
        let mut effects = EFFECTS.iter().filter(|effect| effect.family == row.family);
        effects.any(|effect| effect.kind == EffectKind::StateJump)
    };
    let mut all = vec![average_detected(records).at_least(0.995, OF_STRONG)];
    for (figure, jumps) in [
        ("detected, the worst family but knocks", false),
        ("detected, knocks", true),
    ] {
        let of = families.iter().filter(|row| is_jump(row) == jumps);
        let of: Vec<Proportion> = of.map(FamilyRow::detected).collect();
        if !of.is_empty() {
            all.push(Measure::new(figure, Statistic::Least(of)).at_least(0.99, OF_FAMILY));
        }
    }
    all.extend(single(records, Some(first)));
    all
}

/// Names, sets and sizes of single effects; with a least share of right first classes.
fn single(records: &[&RecordScore], first: Option<f64>) -> Vec<Measure> {
    let in_set = |record: &RecordScore| {
        let all = || record.hidden.iter().all(|hidden| hidden.in_set);
        record.detected().then(all)
    };
    let right = |record: &RecordScore, cosine: f64| {
        let hidden = record.hidden.first()?;
        record.detected().then_some(hidden.first_cosine >= cosine)
    };
    let first_at =
        |figure, cosine: f64| Measure::share(figure, records, move |record| right(record, cosine));
    let detected = records.iter().filter(|record| record.detected());
    let pair = |of: &&RecordScore| Some([of.set_size() as f64, of.oracle_set_size? as f64]);
    let sizes: Vec<[f64; 2]> = detected.filter_map(pair).collect();
    let own = Statistic::Mean(sizes.iter().map(|pair| pair[0]).collect());
    let class = match first {
        Some(least) => {
            let of = by_effect(records, |record| right(record, SAME_CLASS_COSINE));
            let figure = "the class named first is right, average of the effects";
            Measure::new(figure, Statistic::Average(of)).at_least(least, OF_CLASSES)
        }
        None => first_at("the class named first is right", SAME_CLASS_COSINE),
    };
    let second = |record: &RecordScore| record.detected().then_some(record.findings.len() > 1);
    vec![
        Measure::share("the named set holds the truth", records, in_set).at_least(0.95, OF_SETS),
        Measure::new(
            "mean size of the set over the oracle's",
            Statistic::Ratio(sizes),
        )
        .at_most(1.2, "a fifth for noise that has to be estimated"),
        Measure::new("mean size of the set", own),
        Measure::new(
            "mean size of the smallest sets that hold it in 95 %",
            Statistic::Mean(smallest(records)),
        ),
        class,
        first_at(
            "the same with classes of a cosine of 0.97 or more",
            STRICT_CLASS_COSINE,
        ),
        first_at("the name named first is right", 1.0),
        covered(records),
        Measure::share("a spurious second", records, second),
    ]
}

/// Sizes of the confidence sets of the first search with the constant at which they contain the truth
/// in 95 % of the detected records: the least possible for sets of this kind.
fn smallest(records: &[&RecordScore]) -> Vec<f64> {
    let detected = || records.iter().filter(|record| record.detected());
    let deficits: Vec<f64> = detected()
        .filter_map(|record| record.hidden.first()?.deficit)
        .collect();
    let constant = quantile(&deficits, 0.95);
    let size = |record: &&RecordScore| {
        let near = record.nearest.iter().filter(|near| near.1 <= constant);
        (1 + near.count()) as f64
    };
    detected().map(size).collect()
}

fn covered(records: &[&RecordScore]) -> Measure {
    let hidden = records.iter().flat_map(|record| &record.hidden);
    let covered = Proportion::of(hidden.filter_map(|hidden| hidden.covered));
    let figure = "95 % interval of the size holds it, given the right name";
    Measure::new(figure, Statistic::Share(covered)).at_least(0.93, OF_INTERVALS)
}

fn pair(records: &[&RecordScore]) -> Vec<Measure> {
    let third = |record: &RecordScore| Some(record.findings.len() > 2);
    let each = |record: &RecordScore| Some(record.each_in_its_set());
    vec![
        Measure::share("each in its set", records, each).at_least(0.90, "two sets of 95 %"),
        Measure::share("a spurious third", records, third)
            .at_most(0.08, "each of two sets that lack their cause may leave one"),
        covered(records),
    ]
}

fn azimuth(records: &[&RecordScore]) -> Vec<Measure> {
    let kind = EffectKind::InitialState;
    let is_attitude = |id: &str| effect_of(id).is_some_and(|effect| effect.kind == kind);
    let first = |record: &RecordScore| {
        let first = record.findings.first();
        Some(first.is_some_and(|first| is_attitude(&first.effect)))
    };
    let hidden = records.iter().flat_map(|record| &record.hidden);
    let strengths = hidden.map(|hidden| hidden.strength).collect();
    vec![
        Measure::share("named `platform.initial_attitude`", records, first)
            .at_least(0.95, "of some ten sigmas, and like no other effect"),
        Measure::new("its mean size in sigmas", Statistic::Mean(strengths)),
    ]
}

fn out_of_catalogue(records: &[&RecordScore]) -> Vec<Measure> {
    let reached = |record: &RecordScore| {
        let hidden = record.hidden.first();
        hidden.is_some_and(|hidden| REACHED.contains(&hidden.strength))
    };
    let named = |record: &RecordScore| record.detected() && !record.tells_of_another();
    let of_reached = |figure, of: &dyn Fn(&RecordScore) -> bool| {
        let of = |record: &RecordScore| reached(record).then(|| of(record));
        Measure::share(figure, records, of)
    };
    let of_all = |figure, of: &dyn Fn(&RecordScore) -> bool| {
        Measure::share(figure, records, |record| Some(of(record)))
    };
    vec![
        of_reached(
            "told: unexplained, or none of these above a half",
            &RecordScore::tells_of_another,
        )
        .at_least(0.98, "ten sigmas are five above the thresholds"),
        // Records where the names took up most of the effect are in the note alone.
        of_reached("a false name, and not told", &named)
            .at_most(0.05, "as often as a set of 95 % may lack a cause"),
        of_all("the same, of all records", &named),
        of_reached("unexplained", &|record| record.unexplained.is_some()),
        of_all("taken for noise alone", &|record| {
            !record.noise.is_empty() && !record.detected() && record.unexplained.is_none()
        }),
        of_all(
            "as long as asked for beside the causes that were named",
            &reached,
        ),
    ]
}

fn step(records: &[&RecordScore]) -> Vec<Measure> {
    let near = |record: &RecordScore| Some(record.hidden.first()?.onset_error? <= NEAR);
    let of_all = |record: &RecordScore| Some(near(record) == Some(true));
    let share =
        |figure, of: &dyn Fn(&RecordScore) -> Option<bool>| Measure::share(figure, records, of);
    let reason = "at eight sigmas the onset is uncertain by a few percent";
    vec![
        share(
            "onset within 5 % of the record, given the right name",
            &near,
        )
        .at_least(0.90, reason),
        share("onset within 5 % of the record, of all", &of_all),
        share("detected", &|record| Some(record.detected())),
    ]
}

#[cfg(test)]
mod tests {
    use super::coverage_given_detection;

    #[test]
    fn intervals_of_what_is_detected_cover_more_often() {
        // Half is detected, that above the truth: 47.5 of 50 %.
        assert!((coverage_given_detection(0.5) - 0.95).abs() < 1e-9);
        // By tables of the normal distribution: (0.975 - 0.125)/0.875 and 0.95/0.986.
        assert!((coverage_given_detection(0.875) - 0.971_43).abs() < 1e-4);
        assert!((coverage_given_detection(0.986) - 0.963_49).abs() < 1e-4);
        assert_eq!(coverage_given_detection(1.0), 0.95);
    }
}
