//! What a record does not tell apart, why, and what would separate it.

use gyrocal::effect::{Enters, Experiment, Need};
use gyrocal::{EFFECTS, Effect};
use gyrocal_record::{CannotTellReport, FindingReport};

/// Whether it needs data that the bench file does not give.
fn needs_key(id: &str) -> bool {
    let mut needs = row(id).into_iter().flat_map(|row| row.needs);
    needs.any(|need| matches!(need, Need::Key(_)))
}

fn row(id: &str) -> Option<&'static Effect> {
    EFFECTS.iter().find(|row| row.id == id)
}

/// Groups of effects around a finding that the record does not tell apart: its exact
/// equivalents, the rest of its named set, and near twins outside of the search
/// that was made: `searched` holds the effects that it did hold against the finding, and a field
/// is known or not.
pub(super) fn cannot_tell(
    finding: &FindingReport,
    searched: &[&str],
    field_is_known: bool,
) -> Vec<CannotTellReport> {
    let mut groups = Vec::new();
    let named = finding.effect.as_str();
    if !finding.equivalents.is_empty() {
        let others = finding.equivalents.iter().map(|e| e.effect.clone());
        groups.push(exact(named, others.collect()));
    }
    if !finding.rivals.is_empty() {
        let others: Vec<String> = finding.rivals.iter().map(|r| r.effect.clone()).collect();
        groups.push(CannotTellReport {
            why: format!(
                "over this record they explain nearly as much, once the nine coefficients and the \
                 first attitude have taken up what they can: the set holds the cause with a \
                 probability of {:.0} %",
                100.0 * finding.coverage
            ),
            would_separate: separation(named, &others),
            members: members(named, others),
        });
    }
    let twins = twins_outside(finding, searched);
    if !twins.is_empty() {
        let possible: Vec<&str> = twins
            .iter()
            .map(String::as_str)
            .filter(|id| field_is_known || !needs_key(id))
            .collect();
        let asked = if possible.is_empty() {
            String::new()
        } else {
            format!("--effects {} holds them against it; ", possible.join(","))
        };
        groups.push(CannotTellReport {
            why: "near twins that the usual search leaves out: at one attitude they look alike"
                .to_owned(),
            would_separate: format!("{asked}{}", separation(named, &twins)),
            members: members(named, twins),
        });
    }
    groups
}

fn members(named: &str, others: Vec<String>) -> Vec<String> {
    std::iter::once(named.to_owned()).chain(others).collect()
}

fn exact(named: &str, others: Vec<String>) -> CannotTellReport {
    let equivalence = row(named).map(|row| row.equivalence);
    CannotTellReport {
        members: members(named, others),
        why: equivalence.map_or("", |found| found.reason).to_owned(),
        would_separate: equivalence.map_or("", |found| found.experiment).to_owned(),
    }
}

/// Near twins of the catalogue that the search did not hold against the finding.
fn twins_outside(finding: &FindingReport, searched: &[&str]) -> Vec<String> {
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

/// The experiments that change one and not the other.
fn separation(named: &str, others: &[String]) -> String {
    let ids = std::iter::once(named).chain(others.iter().map(String::as_str));
    let mut experiments: Vec<Experiment> = ids
        .filter_map(row)
        .flat_map(|row| row.separated_by)
        .copied()
        .collect();
    experiments.sort_unstable();
    experiments.dedup();
    // Another initial attitude does all that another start does.
    let turned = experiments.contains(&Experiment::OtherInitialState);
    experiments.retain(|one| !(turned && *one == Experiment::OtherStart));
    let ways: Vec<String> = experiments.iter().map(|one| words(*one)).collect();
    ways.join("; ")
}

fn words(experiment: Experiment) -> String {
    match experiment {
        Experiment::OtherInitialState => {
            "a second run from another initial attitude, which does far more than a longer run: \
             what goes with specific force changes its course there, what goes with time does not"
                .to_owned()
        }
        Experiment::OtherStart => {
            "a second run from another initial attitude or started at another time of day, which \
             does far more than a longer run"
                .to_owned()
        }
        Experiment::MeasureInitialState => {
            "an independent measurement of the attitude at the first row".to_owned()
        }
        Experiment::ControlRegressor(name) => {
            format!("a run with the {name} held or stepped on purpose")
        }
        Experiment::ChangeInput(what) => format!("a run with {what}"),
        Experiment::MeasureInput(what) => what.to_owned(),
        Experiment::StartLate => "a run that starts long after switching on".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyrocal_record::{EquivalentReport, RivalReport};

    fn finding(effect: &str, rivals: &[&str], equivalents: &[&str]) -> FindingReport {
        FindingReport {
            effect: effect.to_owned(),
            parameters: Vec::new(),
            z: 8.0,
            p_value: 1e-12,
            coverage: 0.95,
            rivals: rivals
                .iter()
                .map(|effect| RivalReport {
                    effect: (*effect).to_owned(),
                    log_likelihood_deficit: 1.0,
                })
                .collect(),
            equivalents: equivalents
                .iter()
                .map(|effect| EquivalentReport {
                    effect: (*effect).to_owned(),
                    parameters: Vec::new(),
                })
                .collect(),
            gain_nats: Some(20.0),
            accepted: Some(true),
        }
    }

    #[test]
    fn each_group_says_what_would_separate_it() {
        let latitude = cannot_tell(&finding("site.latitude", &[], &["clock.rate"]), &[], false);
        assert_eq!(latitude.len(), 1);
        assert_eq!(latitude[0].members, ["site.latitude", "clock.rate"]);
        assert!(
            latitude[0]
                .would_separate
                .contains("independent astronomic latitude")
        );

        let cross = cannot_tell(&finding("gyro_x.g_y", &["gyro_x.warmup"], &[]), &[], false);
        assert_eq!(cross[0].members, ["gyro_x.g_y", "gyro_x.warmup"]);
        assert!(cross[0].would_separate.contains("another initial attitude"));
        assert!(cross[0].would_separate.contains("long after switching on"));
        // Axis misalignment and the field are in no usual search.
        assert!(cross[1].members.iter().any(|id| id == "gyro_x.magnetic"));
        let asked = |groups: &[CannotTellReport]| {
            let words = groups.last().map(|group| group.would_separate.clone());
            words.unwrap_or_default()
        };
        assert!(asked(&cross).starts_with("--effects gyro_xy.axis_misalignment holds"));
        let with_field = cannot_tell(&finding("gyro_x.g_y", &[], &[]), &[], true);
        assert!(asked(&with_field).contains("gyro_x.magnetic"));

        // What was searched for and is no rival is told apart.
        let both = ["gyro_x.magnetic", "gyro_xy.axis_misalignment"];
        assert!(cannot_tell(&finding("gyro_x.g_y", &[], &[]), &both, true).is_empty());

        assert!(cannot_tell(&finding("accel_x.noise", &[], &[]), &[], false).is_empty());
    }

    #[test]
    fn every_effect_of_the_search_has_a_way_out() {
        for effect in EFFECTS.iter().filter(|effect| effect.has_term()) {
            assert_ne!(separation(effect.id, &[]), "", "{}", effect.id);
        }
    }
}
