//! The first screen: the recommended run and its predicted result.

use gyrocal_diagnosis::plan::{Aim, Outlook, Proposal, SetForecast};

use super::{Found, tables};
use crate::text::{bullet, paragraph};

/// Probability above which two effects count as distinguished.
const DISTINGUISHED: f64 = 0.95;
/// Probability below which two effects count as not distinguished.
const NOT_DISTINGUISHED: f64 = 0.5;

pub(super) fn summary(found: &Found<'_>) -> String {
    let planned = &found.planned;
    let mut text = format!(
        "{}: {} rows over {:.2} days\n\n",
        found.arguments.record.display(),
        found.record.len(),
        found.record.duration_s() / 86_400.0
    );
    text.push_str(&paragraph(&question(planned.aim, &planned.now)));
    for (index, duration_s) in durations(found).into_iter().enumerate() {
        let of_it = |p: &&Proposal| p.duration_s == duration_s;
        let mut runs = planned.proposals.iter().filter(of_it);
        let Some(best) = runs.next() else { continue };
        let going_on = planned.going_on.iter().find(of_it);
        text.push('\n');
        text.push_str(&paragraph(&recommended(best, index == 0)));
        for set in &best.outlook.sets {
            if set.members.len() > 1 {
                text.push_str(&bullet(&expected_set(set)));
            }
        }
        text.push_str(&bullet(&sigmas(&best.outlook)));
        if let Some(going_on) = going_on {
            text.push_str(&paragraph(&present_attitude(&going_on.outlook)));
        }
    }
    if let (Some(wish), Some(reached)) = (&found.wish, &planned.reached) {
        text.push('\n');
        text.push_str(&paragraph(&match &reached.run {
            _ if reached.already => format!("This record alone meets the goal: {wish}."),
            Some(run) => format!(
                "Shortest run that meets the goal ({wish}): {} from {}.",
                hours(run.duration_s),
                attitude(run)
            ),
            None => format!(
                "No run of up to {} among those examined meets the goal: {wish}.",
                hours(reached.longest_s)
            ),
        }));
    }
    for class in &planned.inseparable {
        text.push('\n');
        text.push_str(&paragraph(&format!(
            "No run distinguishes {}: they are exact equivalents. `gyrocal diagnose` describes the \
             experiment that would.",
            class.join(" and ")
        )));
    }
    text.push_str(&tables::all(found));
    text
}

/// Durations in the order of the request.
pub(super) fn durations(found: &Found<'_>) -> Vec<f64> {
    let mut durations: Vec<f64> = Vec::new();
    for proposal in &found.planned.proposals {
        if durations.last() != Some(&proposal.duration_s) {
            durations.push(proposal.duration_s);
        }
    }
    durations
}

fn question(aim: Aim, now: &Outlook) -> String {
    let sets: Vec<String> = now
        .sets
        .iter()
        .filter(|set| set.members.len() > 1)
        .map(|set| {
            let rivals: Vec<&str> = set.members[1..]
                .iter()
                .map(|member| member.effect)
                .collect();
            format!("{} (alternatives {})", set.effect, rivals.join(", "))
        })
        .collect();
    let named: Vec<&str> = now.sets.iter().map(|set| set.effect).collect();
    let ranked = match aim {
        Aim::Set => "Runs are ranked by the expected size of these sets, then by the sigmas.",
        _ => "Runs are ranked by the sigmas of the nine coefficients.",
    };
    if !sets.is_empty() {
        format!(
            "Not distinguished by this record: {}. {ranked}",
            sets.join("; ")
        )
    } else if named.is_empty() {
        format!("The diagnosis of this record has no findings. {ranked}")
    } else {
        format!(
            "Findings without alternatives: {}. {ranked}",
            named.join(", ")
        )
    }
}

fn recommended(best: &Proposal, first: bool) -> String {
    format!(
        "{} {} from {}. Expected result of record and run together:",
        if first {
            "Recommended next run:"
        } else {
            "Alternatively"
        },
        hours(best.duration_s),
        attitude(best)
    )
}

fn expected_set(set: &SetForecast) -> String {
    let members = |test: &dyn Fn(f64) -> bool| -> Vec<String> {
        set.members[1..]
            .iter()
            .filter(|member| test(member.told_apart))
            .map(|member| format!("{} ({})", member.effect, percent(member.told_apart)))
            .collect()
    };
    let mut words = format!(
        "confidence set of {}: {:.2} of {} members stay on average, one alone with a probability \
         of {}",
        set.effect,
        set.mean_size,
        set.members.len(),
        percent(set.one_left)
    );
    for (list, verb) in [
        (members(&|p| p >= DISTINGUISHED), "distinguished from"),
        (
            members(&|p| (NOT_DISTINGUISHED..DISTINGUISHED).contains(&p)),
            "possibly distinguished from",
        ),
        (
            members(&|p| p < NOT_DISTINGUISHED),
            "not distinguished from",
        ),
    ] {
        if !list.is_empty() {
            words.push_str(&format!("; {verb} {}", list.join(", ")));
        }
    }
    words
}

fn sigmas(outlook: &Outlook) -> String {
    format!(
        "sigmas of the nine coefficients: {:.2} of the present ones (geometric mean)",
        outlook.sigma_ratio
    )
}

fn present_attitude(outlook: &Outlook) -> String {
    let sets: Vec<String> = outlook
        .sets
        .iter()
        .filter(|set| set.members.len() > 1)
        .map(|set| {
            format!(
                "{:.2} of {} members stay, ",
                set.mean_size,
                set.members.len()
            )
        })
        .collect();
    format!(
        "The same duration in the present attitude: {}sigmas {:.2}.",
        sets.concat(),
        outlook.sigma_ratio
    )
}

/// Platform angles as text.
pub(super) fn attitude(run: &Proposal) -> String {
    match run.angles_deg {
        Some([x, y, z]) => format!("platform angles x {x:.0}°, y {y:.0}°, z {z:.0}°"),
        None => "the present attitude".to_owned(),
    }
}

/// A duration in hours.
pub(super) fn hours(duration_s: f64) -> String {
    let hours = duration_s / 3600.0;
    if hours >= 10.0 {
        format!("{hours:.0} h")
    } else {
        format!("{hours:.1} h")
    }
}

/// A probability in percent, never 100 %.
pub(super) fn percent(p: f64) -> String {
    if p > 0.99 {
        "over 99 %".to_owned()
    } else {
        format!("{:.0} %", 100.0 * p)
    }
}

#[cfg(test)]
mod tests {
    use super::{hours, percent};

    #[test]
    fn no_probability_is_called_certain() {
        assert_eq!(percent(1.0), "over 99 %");
        assert_eq!(percent(0.954), "95 %");
        assert_eq!(percent(0.0), "0 %");
    }

    #[test]
    fn hours_have_the_digits_that_matter() {
        assert_eq!(hours(259_200.0), "72 h");
        assert_eq!(hours(5_400.0), "1.5 h");
    }
}
