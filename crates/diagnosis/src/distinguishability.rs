//! Distinguishability: effects around a finding that the record does not separate, and experiments
//! that would.

use core::ops::Range;

use gyrocal::effect::{self, EffectKind, Enters, Need};
use gyrocal::{EFFECTS, Effect};
use gyrocal_record::Record;

use crate::prose;
use crate::result::{Experiment, ExperimentKind, Finding, Indistinguishable, Relation};

fn row(id: &str) -> Option<&'static Effect> {
    EFFECTS.iter().find(|row| row.id == id)
}

/// Whether an effect needs data that only a bench file can give.
fn needs_key(id: &str) -> bool {
    let mut needs = row(id).into_iter().flat_map(|row| row.needs);
    needs.any(|need| matches!(need, Need::Key(_)))
}

/// Groups of effects around a finding that the record does not distinguish: its exact equivalents,
/// the other members of its confidence set, and near twins outside of the search that was made.
/// `searched` holds the effects that were tested; `field_is_known` says whether the bench file gives
/// the Earth's magnetic field.
pub(crate) fn indistinguishable(
    finding: &Finding,
    searched: &[&str],
    field_is_known: bool,
) -> Vec<Indistinguishable> {
    let mut groups = Vec::new();
    let named = finding.effect.as_str();
    if !finding.equivalents.is_empty() {
        let others = finding.equivalents.iter().map(|e| e.effect.clone());
        groups.push(exact(named, others.collect()));
    }
    if !finding.alternatives.is_empty() {
        let others = finding.alternatives.iter().map(|a| a.effect.clone());
        groups.push(group(
            Relation::ConfidenceSet,
            prose::why_not_distinguished(finding.coverage),
            members(named, others.collect()),
            Vec::new(),
        ));
    }
    let twins = untested_twins(finding, searched);
    if !twins.is_empty() {
        let testable = twins
            .iter()
            .filter(|id| field_is_known || !needs_key(id))
            .cloned()
            .collect();
        groups.push(group(
            Relation::NearTwins,
            prose::near_twins(),
            members(named, twins),
            testable,
        ));
    }
    groups
}

/// Set-ups that fit a record without declared angles as well as the declared one: `docs/setup-checks.md` has
/// the symmetry.
pub(crate) fn set_ups_without_angles() -> Indistinguishable {
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
    Indistinguishable {
        members: members.map(str::to_owned).to_vec(),
        relation: Relation::SetUps,
        why: prose::SET_UPS_WITHOUT_ANGLES.to_owned(),
        testable: Vec::new(),
        would_separate: prose::would_distinguish(&[], &experiments),
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
pub(crate) fn tell_together(groups: &mut [Indistinguishable], correlation: f64) {
    if correlation.abs() < TOGETHER {
        return;
    }
    let of_kind = |group: &Indistinguishable, kinds: &[EffectKind]| {
        let mut rows = group.members.iter().filter_map(|id| row(id));
        rows.any(|row| kinds.contains(&row.kind))
    };
    for group in groups {
        if of_kind(group, &[EffectKind::Regressor]) && of_kind(group, &OF_TIME) {
            group.why += &prose::time_is_temperature(correlation);
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

fn group(
    relation: Relation,
    why: String,
    members: Vec<String>,
    testable: Vec<String>,
) -> Indistinguishable {
    let experiments = experiments(&members);
    Indistinguishable {
        relation,
        why,
        would_separate: prose::would_distinguish(&testable, &experiments),
        testable,
        experiments,
        members,
    }
}

fn members(named: &str, others: Vec<String>) -> Vec<String> {
    core::iter::once(named.to_owned()).chain(others).collect()
}

fn exact(named: &str, others: Vec<String>) -> Indistinguishable {
    let equivalence = row(named).map(|row| row.equivalence);
    let experiments = vec![Experiment {
        kind: ExperimentKind::Other,
        what: equivalence.map(|found| found.experiment.to_owned()),
    }];
    Indistinguishable {
        members: members(named, others),
        relation: Relation::ExactEquivalents,
        why: equivalence.map_or("", |found| found.reason).to_owned(),
        testable: Vec::new(),
        would_separate: prose::would_distinguish(&[], &experiments),
        experiments,
    }
}

/// Near twins of the catalogue that were not tested against the finding.
fn untested_twins(finding: &Finding, searched: &[&str]) -> Vec<String> {
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
        .map(|twin| twin.id.to_owned())
        .collect()
}

/// Experiments that change one member otherwise than another.
fn experiments(members: &[String]) -> Vec<Experiment> {
    let rows = members.iter().filter_map(|id| row(id));
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
    use crate::result::{Alternative, Equivalent, FindingKind};

    fn finding(effect: &str, alternatives: &[&str], equivalents: &[&str]) -> Finding {
        let alternatives: Vec<Alternative> = alternatives
            .iter()
            .map(|effect| Alternative {
                effect: (*effect).to_owned(),
                log_likelihood_deficit: 1.0,
            })
            .collect();
        let equivalents = equivalents.iter().map(|effect| Equivalent {
            effect: (*effect).to_owned(),
            parameters: Vec::new(),
        });
        Finding {
            effect: effect.to_owned(),
            name: String::new(),
            kind: FindingKind::Cause,
            parameters: Vec::new(),
            z: 8.0,
            p_value: 1e-12,
            coverage: Some(0.95),
            rivals: alternatives.clone(),
            alternatives,
            none_of_these: None,
            none_of_these_log_likelihood_ratio: None,
            by_record: None,
            equivalents: equivalents.collect(),
            gain_nats: Some(20.0),
            accepted: Some(true),
        }
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
            let mut groups = indistinguishable(&finding(effect, &[other], &[]), &[], false);
            tell_together(&mut groups, correlation.unwrap_or(0.0));
            groups[0].why.contains("time and temperature go together")
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
        let latitude = finding("site.latitude", &[], &["clock.rate"]);
        let latitude = indistinguishable(&latitude, &[], false);
        assert_eq!(latitude.len(), 1);
        assert_eq!(latitude[0].members, ["site.latitude", "clock.rate"]);
        assert_eq!(latitude[0].relation, Relation::ExactEquivalents);
        assert!(latitude[0].would_separate.contains("astronomic latitude"));

        let cross = finding("gyro_x.g_y", &["gyro_x.warmup"], &[]);
        let cross = indistinguishable(&cross, &[], false);
        assert_eq!(cross[0].members, ["gyro_x.g_y", "gyro_x.warmup"]);
        assert!(cross[0].why.contains("coverage of 95 %"));
        let kinds: Vec<ExperimentKind> = cross[0].experiments.iter().map(|e| e.kind).collect();
        assert_eq!(
            kinds,
            [ExperimentKind::OtherAttitude, ExperimentKind::StartLate]
        );
        assert!(cross[0].would_separate.contains("another initial attitude"));
        assert!(cross[0].would_separate.contains("long after switching on"));
        // Axis misalignment and the field are not in the default search.
        assert_eq!(cross[1].relation, Relation::NearTwins);
        assert!(cross[1].members.iter().any(|id| id == "gyro_x.magnetic"));
        assert_eq!(cross[1].testable, ["gyro_xy.axis_misalignment"]);
        assert!(
            cross[1]
                .would_separate
                .starts_with("--effects gyro_xy.axis_misalignment tests")
        );
        let with_field = indistinguishable(&finding("gyro_x.g_y", &[], &[]), &[], true);
        assert!(
            with_field[0]
                .testable
                .iter()
                .any(|id| id == "gyro_x.magnetic")
        );
    }

    #[test]
    fn effects_that_were_tested_and_are_no_alternatives_are_distinguished() {
        let both = ["gyro_x.magnetic", "gyro_xy.axis_misalignment"];
        assert!(indistinguishable(&finding("gyro_x.g_y", &[], &[]), &both, true).is_empty());
        assert!(indistinguishable(&finding("accel_x.noise", &[], &[]), &[], false).is_empty());
    }

    #[test]
    fn every_effect_of_the_search_has_an_experiment() {
        for effect in EFFECTS.iter().filter(|e| e.has_term() && !e.is_nominal) {
            assert_ne!(experiments(&[effect.id.to_owned()]), [], "{}", effect.id);
        }
    }
}
