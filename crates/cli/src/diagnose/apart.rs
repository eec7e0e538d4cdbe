//! What a record does not tell apart, why, and what would separate it.

use gyrocal::generated::catalogue::EFFECTS;
use gyrocal_record::{CannotTellReport, FindingReport};

/// What an effect goes with, which another experiment can change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Course {
    /// Specific force, as the platform turns.
    Force,
    /// Time alone.
    Time,
    /// The logged temperature.
    Temperature,
    /// The first attitude.
    Start,
    /// The Earth's field.
    Field,
    /// The drift of another gyro.
    OtherGyro,
    /// The reading of an accelerometer.
    Accelerometer,
    /// Latitude, Earth rate, clock.
    Site,
}

impl Course {
    fn of(effect: &str) -> Self {
        let (channel, term) = effect.split_once('.').unwrap_or((effect, ""));
        match term {
            "temperature" => Self::Temperature,
            "ramp" | "step" | "warmup" | "diurnal" | "random_walk" => Self::Time,
            "magnetic" => Self::Field,
            "axis_misalignment" => Self::OtherGyro,
            "initial_attitude" | "knock" => Self::Start,
            _ if channel.starts_with("accel") => Self::Accelerometer,
            _ if channel == "site" || channel == "clock" => Self::Site,
            _ => Self::Force,
        }
    }
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
            .filter(|id| field_is_known || Course::of(id) != Course::Field)
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
    let (why, would_separate) = if Course::of(named) == Course::Site {
        (
            "each turns or scales the Earth's rate as the platform sees it, and the three \
             coefficients along the input axes take up all but one direction of that: the same \
             samples, at any attitude and for ever",
            "an independent astronomic latitude, or a check of the sampling clock against a time \
             signal; the Earth's rate itself is known far better",
        )
    } else {
        (
            "the squares of the three components of specific force add up to gravity squared, so \
             these differ by a constant drift and by the square along the input axis, which are \
             estimated anyway: the same samples, at any attitude and for ever",
            "no bench at rest: only specific force of another size, as on a centrifuge; at rest \
             one compensates as well as the other",
        )
    };
    CannotTellReport {
        members: members(named, others),
        why: why.to_owned(),
        would_separate: would_separate.to_owned(),
    }
}

/// Near twins of the catalogue that the search did not hold against the finding.
fn twins_outside(finding: &FindingReport, searched: &[&str]) -> Vec<String> {
    let Some(row) = EFFECTS.iter().find(|row| row.id == finding.effect) else {
        return Vec::new();
    };
    row.near_twins
        .iter()
        .filter_map(|id| EFFECTS.iter().find(|effect| effect.id == *id))
        .filter(|twin| !twin.default_search && twin.kind == "term" && twin.enters == "drift")
        .filter(|twin| !searched.contains(&twin.id))
        .map(|twin| twin.id.to_owned())
        .collect()
}

/// The experiment that changes one and not the other.
fn separation(named: &str, others: &[String]) -> String {
    use Course as C;

    let courses: Vec<Course> = std::iter::once(named)
        .chain(others.iter().map(String::as_str))
        .map(Course::of)
        .collect();
    let any = |wanted: &[Course]| courses.iter().any(|course| wanted.contains(course));
    let mut ways: Vec<&str> = Vec::new();
    if any(&[C::Force, C::Accelerometer, C::OtherGyro, C::Field]) {
        ways.push(
            "a second run from another initial attitude, which does far more than a longer run: \
             what goes with specific force changes its course there, what goes with time does not",
        );
    } else if any(&[C::Time, C::Site, C::Temperature]) {
        ways.push(
            "a second run from another initial attitude or started at another time of day, which \
             does far more than a longer run",
        );
    }
    if any(&[C::Start]) {
        ways.push("an independent measurement of the attitude at the first row");
    }
    if any(&[C::Temperature]) {
        ways.push("a run with the temperature held or stepped on purpose");
    }
    if any(&[C::Field]) {
        ways.push("a run with the magnetic field turned or shielded");
    }
    if any(&[C::Site]) {
        ways.push("an independent astronomic latitude and a checked clock");
    }
    if others.iter().any(|id| id.ends_with(".warmup")) || named.ends_with(".warmup") {
        ways.push("a run that starts long after switching on");
    }
    ways.join("; ")
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
        for effect in EFFECTS.iter().filter(|effect| effect.kind == "term") {
            assert_ne!(separation(effect.id, &[]), "", "{}", effect.id);
        }
    }
}
