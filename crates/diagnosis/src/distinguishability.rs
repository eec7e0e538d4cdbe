//! Distinguishability: effects around a finding that the record does not separate, and experiments
//! that would.

use core::ops::Range;

use gyrocal::effect::{self, EffectKind, Enters, Need};
use gyrocal::{EFFECTS, Effect};
use gyrocal_record::Record;

use gyrocal_answer::{
    Alternative, AlternativeKind, Experiment, ExperimentKind, Finding, Separation, SetUps,
};

fn row(id: &str) -> Option<&'static Effect> {
    EFFECTS.iter().find(|row| row.id == id)
}

/// Whether an effect needs data that only a bench file can give.
fn needs_key(id: &str) -> bool {
    let mut needs = row(id).into_iter().flat_map(|row| row.needs);
    needs.any(|need| matches!(need, Need::Key(_)))
}

/// What would tell a finding from its exact equivalents, from the other members of its confidence set, and from
/// near twins outside of the search that was made, which become its alternatives. `searched` holds the effects that
/// were tested; `field_is_known` says whether the bench file gives the Earth's magnetic field.
pub(crate) fn separate(finding: &mut Finding, searched: &[&str], field_is_known: bool) {
    let twins = untested_twins(finding, searched);
    let testable = twins.iter().filter(|id| field_is_known || !needs_key(id));
    let testable: Vec<String> = testable.map(|id| (*id).to_owned()).collect();
    let twins = twins.into_iter().map(|id| Alternative {
        effect: id.to_owned(),
        kind: AlternativeKind::NotSearched,
        log_likelihood_deficit: None,
        parameters: Vec::new(),
    });
    finding.alternatives.extend(twins);
    let kinds = [
        AlternativeKind::ExactEquivalent,
        AlternativeKind::NotExcluded,
        AlternativeKind::NotSearched,
    ];
    let present = kinds
        .into_iter()
        .filter(|kind| finding.of_kind(*kind).next().is_some());
    finding.separations = present
        .map(|kind| match kind {
            AlternativeKind::ExactEquivalent => exact(&finding.effect),
            AlternativeKind::NotSearched => {
                separation(finding, kind, gyrocal_words::near_twins(), testable.clone())
            }
            _ => {
                let why = gyrocal_words::why_not_distinguished(finding.coverage);
                separation(finding, kind, why, Vec::new())
            }
        })
        .collect();
}

/// Set-ups that fit a record without declared angles as well as the declared one: `docs/setup-checks.md` has
/// the symmetry.
pub(crate) fn set_ups_without_angles() -> SetUps {
    let experiments = vec![Experiment {
        kind: ExperimentKind::MeasureAttitude,
        what: None,
    }];
    let members = [
        "axes as declared",
        "axes exchanged in a circle",
        "two axes negated",
        "mirrored axes at the opposite latitude",
    ];
    SetUps {
        members: members.map(str::to_owned).to_vec(),
        why: gyrocal_words::SET_UPS_WITHOUT_ANGLES.to_owned(),
        would_separate: gyrocal_words::would_distinguish(&[], &experiments),
        experiments,
    }
}

/// Correlation of time and temperature from which on their effects are not told apart.
const TOGETHER: f64 = 0.9;

/// Correlation of temperature with the time since the first row of each record, by their rows; `None` without
/// temperature, or if it does not change.
pub(crate) fn time_and_temperature(record: &Record, each: &[Range<usize>]) -> Option<f64> {
    let temperature = about_mean(record.temperature_c.as_ref()?);
    let of_one = |rows: &Range<usize>| {
        let times_s = record.time_s.get(rows.clone()).unwrap_or_default();
        times_s.iter().map(|time_s| time_s - times_s[0])
    };
    let time: Vec<f64> = each.iter().flat_map(of_one).collect();
    let time = about_mean(&time);
    let sum = |one: &[f64], other: &[f64]| -> f64 {
        let pairs = one.iter().zip(other);
        pairs.map(|(a, b)| a * b).sum()
    };
    let norms = (sum(&temperature, &temperature) * sum(&time, &time)).sqrt();
    (norms > 0.0).then(|| sum(&temperature, &time) / norms)
}

fn about_mean(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.iter().map(|value| value - mean).collect()
}

/// Says of sets with effects of temperature and of time that the two went together in the record.
pub(crate) fn tell_together(findings: &mut [Finding], correlation: f64) {
    if correlation.abs() < TOGETHER {
        return;
    }
    for finding in findings {
        let named = row(&finding.effect).into_iter();
        let told = |kind| {
            let others = finding.of_kind(kind).filter_map(|other| row(&other.effect));
            let members: Vec<&Effect> = named.clone().chain(others).collect();
            let of_kind =
                |kinds: &[EffectKind]| members.iter().any(|row| kinds.contains(&row.kind));
            of_kind(&[EffectKind::Regressor]) && of_kind(&OF_TIME)
        };
        let told: Vec<bool> = finding
            .separations
            .iter()
            .map(|one| told(one.from))
            .collect();
        for (separation, told) in finding.separations.iter_mut().zip(told) {
            if told {
                separation.why += &gyrocal_words::time_is_temperature(correlation);
            }
        }
    }
}

/// Effects that are functions of time.
const OF_TIME: [EffectKind; 6] = [
    EffectKind::Step,
    EffectKind::FromOnset,
    EffectKind::Exponential,
    EffectKind::Ramp,
    EffectKind::Periodic,
    EffectKind::RandomWalk,
];

fn separation(
    finding: &Finding,
    from: AlternativeKind,
    why: String,
    testable: Vec<String>,
) -> Separation {
    let others = finding.of_kind(from).map(|other| &*other.effect);
    let experiments = experiments(core::iter::once(&*finding.effect).chain(others));
    Separation {
        from,
        why,
        words: gyrocal_words::would_distinguish(&testable, &experiments),
        testable,
        experiments,
    }
}

fn exact(named: &str) -> Separation {
    let equivalence = row(named).map(|row| row.equivalence);
    let experiments = vec![Experiment {
        kind: ExperimentKind::Other,
        what: equivalence.map(|found| found.experiment.to_owned()),
    }];
    Separation {
        from: AlternativeKind::ExactEquivalent,
        why: equivalence.map_or("", |found| found.reason).to_owned(),
        testable: Vec::new(),
        words: gyrocal_words::would_distinguish(&[], &experiments),
        experiments,
    }
}

/// Near twins of the catalogue that were not tested against the finding.
fn untested_twins(finding: &Finding, searched: &[&str]) -> Vec<&'static str> {
    let Some(named) = row(&finding.effect) else {
        return Vec::new();
    };
    named
        .near_twins
        .iter()
        .filter_map(|id| row(id))
        .filter(|twin| !twin.default_search && twin.has_term())
        .filter(|twin| matches!(twin.enters, Enters::Rates(_)))
        .filter(|twin| !searched.contains(&twin.id))
        .map(|twin| twin.id)
        .collect()
}

/// Experiments that change one member otherwise than another.
fn experiments<'i>(members: impl Iterator<Item = &'i str>) -> Vec<Experiment> {
    let rows = members.filter_map(row);
    let mut all: Vec<effect::Experiment> = rows.flat_map(|row| row.separated_by).copied().collect();
    all.sort_unstable();
    all.dedup();
    // Another initial attitude does all that another start does.
    let turned = all.contains(&effect::Experiment::OtherInitialState);
    all.retain(|one| !(turned && *one == effect::Experiment::OtherStart));
    all.into_iter().map(of_catalogue).collect()
}

fn of_catalogue(experiment: effect::Experiment) -> Experiment {
    use effect::Experiment as E;

    let (kind, what) = match experiment {
        E::OtherInitialState => (ExperimentKind::OtherAttitude, None),
        E::OtherStart => (ExperimentKind::OtherStart, None),
        E::MeasureInitialState => (ExperimentKind::MeasureAttitude, None),
        E::ControlRegressor(what) => (ExperimentKind::ControlRegressor, Some(what)),
        E::ChangeInput(what) => (ExperimentKind::ChangeInput, Some(what)),
        E::MeasureInput(what) => (ExperimentKind::MeasureInput, Some(what)),
        E::StartLate => (ExperimentKind::StartLate, None),
    };
    Experiment {
        kind,
        what: what.map(str::to_owned),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyrocal_answer::FindingKind;

    /// A finding with other members of its set and equivalents, told apart from what was not searched.
    fn separated(
        effect: &str,
        (set, equivalents): (&[&str], &[&str]),
        searched: &[&str],
        field_is_known: bool,
    ) -> Finding {
        let of = |effects: &[&str], kind: AlternativeKind| -> Vec<Alternative> {
            let all = effects.iter().map(|effect| Alternative {
                effect: (*effect).to_owned(),
                kind,
                log_likelihood_deficit: Some(1.0),
                parameters: Vec::new(),
            });
            all.collect()
        };
        let mut alternatives = of(equivalents, AlternativeKind::ExactEquivalent);
        alternatives.extend(of(set, AlternativeKind::NotExcluded));
        let mut finding = Finding {
            effect: effect.to_owned(),
            name: String::new(),
            kind: FindingKind::Cause,
            parameters: Vec::new(),
            z: 8.0,
            p_value: Some(1e-12),
            coverage: Some(0.95),
            alternatives,
            separations: Vec::new(),
            none_of_these: None,
            none_of_these_log_likelihood_ratio: None,
            by_record: None,
            in_record: None,
            formula: None,
            gain_nats: Some(20.0),
            accepted: Some(true),
        };
        separate(&mut finding, searched, field_is_known);
        finding
    }

    #[test]
    fn sets_say_that_temperature_went_with_time() {
        let record = |temperature: fn(f64) -> f64| Record {
            time_s: (0..100).map(f64::from).collect(),
            accel_g: vec![[0.0, 0.0, 1.0]; 100],
            temperature_c: Some((0..100).map(|row| temperature(f64::from(row))).collect()),
        };
        let correlation =
            |record: Record| time_and_temperature(&record, core::slice::from_ref(&(0..100)));
        let rising = correlation(record(|t| 20.0 + 0.1 * t + (0.3 * t).sin()));
        let turning = correlation(record(|t| 20.0 + (0.3 * t).sin()));
        assert_eq!(correlation(record(|_| 20.0)), None);
        let told = |effect: &str, other: &str, correlation: Option<f64>| {
            let mut findings = [separated(effect, (&[other], &[]), &[], false)];
            tell_together(&mut findings, correlation.unwrap_or(0.0));
            findings[0].separations[0]
                .why
                .contains("time and temperature go together")
        };
        assert!(told("gyro_x.temperature", "gyro_x.ramp", rising));
        assert!(told("gyro_x.ramp", "gyro_x.temperature", rising));
        assert!(told("gyro_x.temperature_square", "gyro_x.ramp", rising));
        assert!(told("gyro_x.warmup", "gyro_x.temperature_rate", rising));
        assert!(told(
            "accel_x.ramp",
            "accel_x.temperature_hysteresis",
            rising
        ));
        assert!(!told("gyro_x.ramp", "gyro_x.step", rising));
        assert!(!told("gyro_x.temperature", "gyro_x.ramp", turning));
    }

    #[test]
    fn time_begins_anew_with_each_record() {
        let correlation = |each_c: &[[f64; 2]]| {
            let rows = 50;
            let each: Vec<Range<usize>> = (0..each_c.len())
                .map(|one| one * rows..(one + 1) * rows)
                .collect();
            let share = |row: usize| row as f64 / (rows - 1) as f64;
            let warming = |[from, to]: &[f64; 2]| {
                let (from, to) = (*from, *to);
                (0..rows).map(move |row| from + share(row) * (to - from))
            };
            let record = Record {
                time_s: (0..rows * each_c.len())
                    .map(|row| 60.0 * row as f64)
                    .collect(),
                accel_g: vec![[0.0, 0.0, 1.0]; rows * each_c.len()],
                temperature_c: Some(each_c.iter().flat_map(warming).collect()),
            };
            time_and_temperature(&record, &each).unwrap_or(f64::NAN)
        };
        // From record to record only: rounding is left.
        assert!(correlation(&[[20.0; 2], [25.0; 2], [30.0; 2]]).abs() < 1e-12);
        assert!(correlation(&[[20.0, 22.0]; 2]) > TOGETHER);
    }

    #[test]
    fn each_group_has_its_experiment() {
        let latitude = separated("site.latitude", (&[], &["clock.rate"]), &[], false);
        assert_eq!(latitude.equivalents().collect::<Vec<_>>(), ["clock.rate"]);
        let [exact] = &latitude.separations[..] else {
            panic!("{:?}", latitude.separations);
        };
        assert_eq!(exact.from, AlternativeKind::ExactEquivalent);
        assert!(exact.words.contains("astronomic latitude"));

        let cross = separated("gyro_x.g_y", (&["gyro_x.warmup"], &[]), &[], false);
        let [set, twins] = &cross.separations[..] else {
            panic!("{:?}", cross.separations);
        };
        assert!(set.why.contains("coverage of 95 %"));
        let kinds: Vec<ExperimentKind> = set.experiments.iter().map(|e| e.kind).collect();
        assert_eq!(
            kinds,
            [ExperimentKind::OtherAttitude, ExperimentKind::StartLate]
        );
        assert!(set.words.contains("another initial attitude"));
        assert!(set.words.contains("long after switching on"));
        // Axis misalignment and the field are not in the default search.
        assert_eq!(twins.from, AlternativeKind::NotSearched);
        let mut not_searched = cross.of_kind(AlternativeKind::NotSearched);
        assert!(not_searched.any(|other| other.effect == "gyro_x.magnetic"));
        assert_eq!(twins.testable, ["gyro_xy.axis_misalignment"]);
        assert!(
            twins
                .words
                .starts_with("--effects gyro_xy.axis_misalignment tests")
        );
        let with_field = separated("gyro_x.g_y", (&[], &[]), &[], true);
        let mut testable = with_field.separations[0].testable.iter();
        assert!(testable.any(|id| id == "gyro_x.magnetic"));
    }

    #[test]
    fn effects_that_were_tested_and_are_no_alternatives_are_distinguished() {
        let both = ["gyro_x.magnetic", "gyro_xy.axis_misalignment"];
        let tested = separated("gyro_x.g_y", (&[], &[]), &both, true);
        assert!(tested.separations.is_empty() && tested.alternatives.is_empty());
        let noise = separated("accel_x.noise", (&[], &[]), &[], false);
        assert!(noise.separations.is_empty());
    }

    #[test]
    fn every_effect_of_the_search_has_an_experiment() {
        for effect in EFFECTS.iter().filter(|e| e.has_term() && !e.is_nominal) {
            assert_ne!(
                experiments(core::iter::once(effect.id)),
                [],
                "{}",
                effect.id
            );
        }
    }
}
