//! Figures of each population cell with their targets.

use core::ops::Range;
use std::collections::BTreeMap;

use gyrocal::EFFECTS;
use gyrocal::effect::EffectKind;
use gyrocal_statistics::{NORMAL_97_5, Proportion, normal_probability, normal_quantile, quantile};

use crate::campaign::Outcome;
use crate::catalogue::effect_of;
use crate::characteristic::{CellFigures, Characteristic};
use crate::effect_family::{FamilyRow, families};
use crate::population::PopulationCell;
use crate::record_score::{RecordScore, SAME_CLASS_COSINE};
use crate::statistic::{Statistic, Target};

/// A stricter limit than [`SAME_CLASS_COSINE`], for information.
const STRICT_CLASS_COSINE: f64 = 0.97;

/// Targets for single effects by strength: detection on average and of the worst family, class of
/// the first finding.
const SINGLE_TARGETS: [(u32, [f64; 2], f64); 2] =
    [(8, [0.995, 0.99], 0.91), (12, [0.995, 0.99], 0.97)];

/// Weak effects are found as often as the unknown noise lets them. By strength, what detection is not to fall
/// below: measured were 0.78 and 0.95 of 250 records.
const WEAK_TARGETS: [(u32, f64); 2] = [(5, 0.72), (6, 0.92)];

/// Least detection of weak effects over that of a search that knows that no rate walks, which also has to
/// estimate the levels of the noise.
const OF_ORACLE: f64 = 0.95;

/// Strengths given the findings that count as the requested 10 sigmas.
const REACHED: Range<f64> = 9.0..11.5;

/// The figures of a cell, in the order of the table.
#[must_use]
pub fn characteristics(
    cell: PopulationCell,
    outcome: &Outcome<RecordScore>,
    seeds: &Range<u64>,
) -> Vec<Characteristic> {
    let records: Vec<&RecordScore> = outcome.successes().map(|(_, record)| record).collect();
    let mut figures = CellFigures {
        cell: cell.name(),
        seeds: seeds.clone(),
        full: seeds.end - seeds.start >= cell.full_runs(),
        all: Vec::new(),
    };
    match cell {
        PopulationCell::Clean => clean(&mut figures, &records),
        PopulationCell::Single(strength) => {
            let asked = SINGLE_TARGETS.iter().find(|(of, ..)| *of == strength);
            let is_weak = WEAK_TARGETS.iter().find(|(of, _)| *of == strength);
            if let Some((_, least)) = is_weak {
                weak(&mut figures, &records, *least);
                single(&mut figures, &records, None);
            } else if let Some((_, detected, first)) = asked {
                single(&mut figures, &records, Some((*detected, *first)));
            }
        }
        PopulationCell::LogUniform => single(&mut figures, &records, None),
        PopulationCell::Pair => pair(&mut figures, &records),
        PopulationCell::OutOfCatalogue => out_of_catalogue(&mut figures, &records),
        PopulationCell::Step => step(&mut figures, &records),
        PopulationCell::Cubic => {
            let silent = share(&records, |record| Some(record.verdict == "clean"));
            figures.judge("silent", Target::AtLeast(0.75), silent);
        }
        PopulationCell::Azimuth => {
            let first = share(&records, |record| {
                let first = record.findings.first();
                Some(first.is_some_and(|first| is_of_kind(&first.effect, EffectKind::InitialState)))
            });
            figures.judge(
                "named `platform.initial_attitude`",
                Target::AtLeast(0.95),
                first,
            );
            let strengths = Statistic::Mean(strengths(&records));
            figures.note("its mean size in sigmas", strengths);
        }
    }
    let single_names = records.iter().flat_map(|record| &record.findings);
    let single_names = single_names
        .filter(|finding| finding.lacks_equivalents)
        .count();
    if cell != PopulationCell::Clean && cell != PopulationCell::Cubic {
        figures.none(
            "single names for exact equivalents",
            single_names,
            records.len() as u64,
        );
    }
    let failed = outcome.failures().count();
    if failed > 0 {
        let runs = seeds.end - seeds.start;
        figures.none("records that could not be examined", failed, runs);
    }
    figures.all
}

fn share(records: &[&RecordScore], of: impl Fn(&RecordScore) -> Option<bool>) -> Statistic {
    Statistic::share(records, |record| of(record))
}

/// The same for each injected effect separately: some are injected more often than others.
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

/// `true` if an id is of an effect of a kind.
fn is_of_kind(id: &str, kind: EffectKind) -> bool {
    effect_of(id).is_some_and(|effect| effect.kind == kind)
}

fn strengths(records: &[&RecordScore]) -> Vec<f64> {
    let hidden = records.iter().flat_map(|record| &record.hidden);
    hidden.map(|hidden| hidden.strength).collect()
}

fn clean(figures: &mut CellFigures, records: &[&RecordScore]) {
    let alarms = Proportion::of(records.iter().map(|record| record.verdict != "clean"));
    // The level is 1 %: of 2000 records 27 are within the bound, and twenty are due.
    figures.judge(
        "false alarms, upper 95 % bound",
        Target::AtMost(0.02),
        Statistic::Bound(alarms),
    );
    figures.note("false alarms", Statistic::Share(alarms));
    let by = |of: fn(&RecordScore) -> bool| share(records, |record| Some(of(record)));
    figures.note("false alarms of the search", by(|record| record.detected()));
    figures.note(
        "false alarms of noise",
        by(|record| !record.noise.is_empty()),
    );
    figures.note(
        "false alarms of the remainder",
        by(|record| record.unexplained.is_some()),
    );
}

/// Weak effects: how often they are found, and how often a set holds them beside an oracle's.
fn weak(figures: &mut CellFigures, records: &[&RecordScore], least: f64) {
    let in_set = |record: &RecordScore| record.hidden.iter().all(|hidden| hidden.in_set);
    let both: Vec<[bool; 2]> = records
        .iter()
        .filter_map(|record| Some([in_set(record), record.oracle_in_set?]))
        .collect();
    let of = |which: usize| Statistic::share(&both, |pair| Some(pair[which]));
    let pairs: Vec<[f64; 2]> = both
        .iter()
        .map(|pair| pair.map(|held| f64::from(u8::from(held))))
        .collect();
    let all = by_effect(records, |record| Some(record.detected()));
    figures.judge(
        "detected, average of the effects",
        Target::AtLeast(least),
        Statistic::Average(all),
    );
    let ratio = "a set holds the truth, over a search that knows that no rate walks";
    figures.judge(ratio, Target::AtLeast(OF_ORACLE), Statistic::Ratio(pairs));
    figures.note("a set holds the truth, of all", of(0));
    figures.note("the same of that search", of(1));
    let detected = share(records, |record| Some(record.detected()));
    let expected = coverage_given_detection(detected.value());
    figures.note(
        "95 % interval of the size, expected of what is detected as often",
        Statistic::Value(expected, detected.runs()),
    );
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

fn single(figures: &mut CellFigures, records: &[&RecordScore], strong: Option<([f64; 2], f64)>) {
    let first = strong.map(|(_, first)| first);
    if let Some(([average, worst], _)) = strong {
        let of = by_effect(records, |record| Some(record.detected()));
        figures.judge(
            "detected, average of the effects",
            Target::AtLeast(average),
            Statistic::Average(of),
        );
        let all = families(records);
        // Jumps of the attitude have three sizes at any row, and are found less often.
        let is_jump = |row: &FamilyRow| {
            let mut effects = EFFECTS.iter().filter(|effect| effect.family == row.family);
            effects.any(|effect| effect.kind == EffectKind::StateJump)
        };
        let of = |jumps: bool| -> Vec<Proportion> {
            let some = all.iter().filter(|row| is_jump(row) == jumps);
            some.map(|row| row.detected()).collect()
        };
        for (name, of) in [
            ("detected, the worst family but knocks", of(false)),
            ("detected, knocks", of(true)),
        ] {
            if !of.is_empty() {
                figures.judge(name, Target::AtLeast(worst), Statistic::Least(of));
            }
        }
    }
    let in_set = share(records, |record| {
        record
            .detected()
            .then(|| record.hidden.iter().all(|hidden| hidden.in_set))
    });
    figures.judge(
        "the named set holds the truth",
        Target::AtLeast(0.95),
        in_set,
    );
    set_size(figures, records);
    let right = |record: &RecordScore, cosine: f64| {
        let hidden = record.hidden.first()?;
        record.detected().then_some(hidden.first_cosine >= cosine)
    };
    let first_at = |cosine: f64| share(records, move |record| right(record, cosine));
    match first {
        Some(least) => figures.judge(
            "the class named first is right, average of the effects",
            Target::AtLeast(least),
            Statistic::Average(by_effect(records, |record| {
                right(record, SAME_CLASS_COSINE)
            })),
        ),
        None => figures.note(
            "the class named first is right",
            first_at(SAME_CLASS_COSINE),
        ),
    }
    figures.note(
        "the same with classes of a cosine of 0.97 or more",
        first_at(STRICT_CLASS_COSINE),
    );
    figures.note("the name named first is right", first_at(1.0));
    covered(figures, records);
    let more = share(records, |record| {
        record.detected().then_some(record.findings.len() > 1)
    });
    figures.note("a spurious second", more);
}

fn set_size(figures: &mut CellFigures, records: &[&RecordScore]) {
    let sizes: Vec<[f64; 2]> = records
        .iter()
        .filter(|record| record.detected())
        .filter_map(|record| Some([record.set_size() as f64, record.oracle_set_size? as f64]))
        .collect();
    let own = Statistic::Mean(sizes.iter().map(|pair| pair[0]).collect());
    figures.judge(
        "mean size of the set over the oracle's",
        Target::AtMost(1.2),
        Statistic::Ratio(sizes),
    );
    figures.note("mean size of the set", own);
    figures.note(
        "mean size of the smallest sets that hold it in 95 %",
        Statistic::Mean(smallest(records)),
    );
}

/// Sizes of the confidence sets of the first search with the constant at which they contain the truth
/// in 95 % of the detected records: the least possible for sets of this kind.
fn smallest(records: &[&RecordScore]) -> Vec<f64> {
    let detected = || records.iter().filter(|record| record.detected());
    let deficits: Vec<f64> = detected()
        .filter_map(|record| record.hidden.first()?.deficit)
        .collect();
    let constant = quantile(&deficits, 0.95);
    detected()
        .map(|record| {
            1 + record
                .nearest
                .iter()
                .filter(|near| near.1 <= constant)
                .count()
        })
        .map(|size| size as f64)
        .collect()
}

fn covered(figures: &mut CellFigures, records: &[&RecordScore]) {
    let covered = records
        .iter()
        .flat_map(|record| &record.hidden)
        .filter_map(|hidden| hidden.covered);
    figures.judge(
        "95 % interval of the size holds it, given the right name",
        Target::AtLeast(0.93),
        Statistic::Share(Proportion::of(covered)),
    );
}

fn pair(figures: &mut CellFigures, records: &[&RecordScore]) {
    let each = share(records, |record| Some(record.each_in_its_set()));
    figures.judge("each in its set", Target::AtLeast(0.90), each);
    let third = share(records, |record| Some(record.findings.len() > 2));
    figures.judge("a spurious third", Target::AtMost(0.08), third);
    covered(figures, records);
}

fn out_of_catalogue(figures: &mut CellFigures, records: &[&RecordScore]) {
    let reached = |record: &RecordScore| {
        let hidden = record.hidden.first();
        hidden.is_some_and(|hidden| REACHED.contains(&hidden.strength))
    };
    let told = share(records, |record| {
        reached(record).then(|| record.tells_of_another())
    });
    figures.judge(
        "told: unexplained, or none of these above a half",
        Target::AtLeast(0.98),
        told,
    );
    // Records where the names took up most of the effect are in the note alone.
    let named = |record: &RecordScore| record.detected() && !record.tells_of_another();
    let masked = share(records, |record| reached(record).then(|| named(record)));
    figures.judge("a false name, and not told", Target::AtMost(0.05), masked);
    figures.note(
        "the same, of all records",
        share(records, |record| Some(named(record))),
    );
    let unexplained = share(records, |record| {
        reached(record).then(|| record.unexplained.is_some())
    });
    figures.note("unexplained", unexplained);
    let noise = share(records, |record| {
        Some(!record.noise.is_empty() && !record.detected() && record.unexplained.is_none())
    });
    figures.note("taken for noise alone", noise);
    figures.note(
        "as long as asked for beside the causes that were named",
        share(records, |record| Some(reached(record))),
    );
}

fn step(figures: &mut CellFigures, records: &[&RecordScore]) {
    const NEAR: f64 = 0.05;
    let onset = |record: &RecordScore| record.hidden.first().and_then(|hidden| hidden.onset_error);
    figures.judge(
        "onset within 5 % of the record, given the right name",
        Target::AtLeast(0.90),
        share(records, |record| onset(record).map(|error| error <= NEAR)),
    );
    figures.note(
        "onset within 5 % of the record, of all",
        share(records, |record| {
            Some(onset(record).is_some_and(|error| error <= NEAR))
        }),
    );
    figures.note("detected", share(records, |record| Some(record.detected())));
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
