//! The first screen: which run to make, and what it will leave, in words.

use gyrocal_diagnosis::plan::{Aim, Outlook, Proposal, SetForecast};

use super::{Found, tables};
use crate::text::{bullet, paragraph};

/// A member is as good as told apart with this probability, and hardly below the other.
const SURELY: f64 = 0.95;
const HARDLY: f64 = 0.5;

pub(super) fn summary(found: &Found<'_>) -> String {
    let planned = &found.planned;
    let mut text = format!(
        "{}: {} rows over {:.2} days\n\n",
        found.arguments.record.display(),
        found.record.len(),
        found.record.duration_s() / 86_400.0
    );
    text.push_str(&paragraph(&in_question(planned.aim, &planned.now)));
    for (index, duration_s) in durations(found).into_iter().enumerate() {
        let of_it = |p: &&Proposal| p.duration_s == duration_s;
        let mut runs = planned.proposals.iter().filter(of_it);
        let Some(best) = runs.next() else { continue };
        let going_on = planned.going_on.iter().find(of_it);
        text.push('\n');
        text.push_str(&paragraph(&recommended(best, index == 0)));
        for set in &best.outlook.sets {
            if set.members.len() > 1 {
                text.push_str(&bullet(&left(set)));
            }
        }
        text.push_str(&bullet(&sigmas(&best.outlook)));
        if let Some(going_on) = going_on {
            text.push_str(&paragraph(&instead(&going_on.outlook)));
        }
    }
    if let (Some(wish), Some(reached)) = (&found.wish, &planned.reached) {
        text.push('\n');
        text.push_str(&paragraph(&match &reached.run {
            _ if reached.already => format!("This record alone has {wish}."),
            Some(run) => format!(
                "The shortest run that was found for {wish}: {} from {}.",
                hours(run.duration_s),
                attitude(run)
            ),
            None => format!(
                "No run of up to {} that was looked at reaches {wish}.",
                hours(reached.longest_s)
            ),
        }));
    }
    for class in &planned.inseparable {
        text.push('\n');
        text.push_str(&paragraph(&format!(
            "No run tells {} apart: the same samples, at any attitude and for ever. Nothing is \
             planned for that; `gyrocal diagnose` says what else would separate them.",
            class.join(" and ")
        )));
    }
    text.push_str(&tables::all(found));
    text
}

/// Durations in the order in which they were asked for.
pub(super) fn durations(found: &Found<'_>) -> Vec<f64> {
    let mut durations: Vec<f64> = Vec::new();
    for proposal in &found.planned.proposals {
        if durations.last() != Some(&proposal.duration_s) {
            durations.push(proposal.duration_s);
        }
    }
    durations
}

fn in_question(aim: Aim, now: &Outlook) -> String {
    let sets: Vec<String> = now
        .sets
        .iter()
        .filter(|set| set.members.len() > 1)
        .map(|set| {
            let rivals: Vec<&str> = set.members[1..]
                .iter()
                .map(|member| member.effect)
                .collect();
            format!("{} or else {}", set.effect, rivals.join(", "))
        })
        .collect();
    let named: Vec<&str> = now.sets.iter().map(|set| set.effect).collect();
    let ranked = match aim {
        Aim::Set => "Runs are ranked by how many of these they leave, then by the sigmas.",
        _ => "Runs are ranked by the sigmas of the nine coefficients.",
    };
    if !sets.is_empty() {
        format!(
            "What this record does not tell apart: {}. {ranked}",
            sets.join("; ")
        )
    } else if named.is_empty() {
        format!("Nothing was found in this record that would have to be told apart. {ranked}")
    } else {
        format!(
            "Found in this record, and told from everything else that was searched: {}. {ranked}",
            named.join(", ")
        )
    }
}

fn recommended(best: &Proposal, first: bool) -> String {
    format!(
        "{} {} for {}. Together with this record it will, on average:",
        if first {
            "Make the next run from"
        } else {
            "Or from"
        },
        attitude(best),
        hours(best.duration_s)
    )
}

fn left(set: &SetForecast) -> String {
    let told = |test: &dyn Fn(f64) -> bool| -> Vec<String> {
        set.members[1..]
            .iter()
            .filter(|member| test(member.told_apart))
            .map(|member| format!("{} ({})", member.effect, percent(member.told_apart)))
            .collect()
    };
    let surely = told(&|p| p >= SURELY);
    let perhaps = told(&|p| (HARDLY..SURELY).contains(&p));
    let hardly = told(&|p| p < HARDLY);
    let mut words = format!(
        "leave {:.2} of the {} that may be the cause, one alone with a probability of {}",
        set.mean_size,
        set.members.len(),
        percent(set.one_left)
    );
    for (list, verb) in [
        (surely, "tell"),
        (perhaps, "perhaps tell"),
        (hardly, "hardly tell"),
    ] {
        if !list.is_empty() {
            words.push_str(&format!("; {verb} {} from {}", set.effect, list.join(", ")));
        }
    }
    words
}

fn sigmas(outlook: &Outlook) -> String {
    format!(
        "shrink the sigmas of the nine coefficients to {:.2} of what they are (geometric mean)",
        outlook.sigma_ratio
    )
}

fn instead(outlook: &Outlook) -> String {
    let sets: Vec<String> = outlook
        .sets
        .iter()
        .filter(|set| set.members.len() > 1)
        .map(|set| format!("leave {:.2} of {}", set.mean_size, set.members.len()))
        .collect();
    let sets = if sets.is_empty() {
        String::new()
    } else {
        format!("{} and ", sets.join(", "))
    };
    format!(
        "Going on in the present attitude for as long would {sets}shrink the sigmas to {:.2}.",
        outlook.sigma_ratio
    )
}

/// Platform angles in words.
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

/// A probability in percent, never all of it.
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
