//! The sentences and tables of a plan, made from its result alone.

use crate::result::{Aim, AttitudeOf, Outlook, PlanResult, Proposal, SetForecast, SetMember};
use gyrocal_record::printable_line;

use gyrocal_document::{Column, List, Table, Words};
use gyrocal_words::{hours, joined, setup, size};

/// Probability above which two causes count as distinguished.
const DISTINGUISHED: f64 = 0.95;

/// Probability below which two causes count as not distinguished.
const NOT_DISTINGUISHED: f64 = 0.5;

/// The plan in sentences, in reading order.
#[must_use]
pub fn prose(plan: &PlanResult) -> Vec<Words> {
    let mut blocks = vec![
        Words::Paragraph(known(plan)),
        Words::Paragraph(question(plan)),
    ];
    blocks.extend(setup(&plan.setup));
    blocks.extend(unit_angles(plan).map(|words| Words::Paragraph(format!("Unit angles {words}."))));
    for (index, duration_s) in durations(plan).into_iter().enumerate() {
        let of_it = |p: &&Proposal| p.duration_s == duration_s;
        let Some(best) = plan.proposals.iter().find(of_it) else {
            continue;
        };
        let sets = undecided(&best.outlook).map(set_forecast);
        let sigmas = format!(
            "sigmas of the nine coefficients: {:.2} of the present ones (geometric mean)",
            best.outlook.sigma_ratio
        );
        blocks.push(Words::List(List {
            title: recommendation(plan, best, index == 0),
            entries: sets.chain([sigmas]).collect(),
        }));
        if let Some(going_on) = plan.going_on.iter().find(of_it) {
            blocks.push(Words::Paragraph(continuation(&going_on.outlook)));
        }
    }
    blocks.extend(goal(plan).map(Words::Paragraph));
    blocks.extend(plan.inseparable.iter().map(|class| {
        Words::Paragraph(format!(
            "No run distinguishes {}: they are exact equivalents. `gyrocal diagnose` describes the \
             experiment that would.",
            class.join(" and ")
        ))
    }));
    blocks
}

/// The records that the run is planned from, with their size.
pub(crate) fn known(plan: &PlanResult) -> String {
    let inputs = &plan.manifest.inputs;
    let size = size(plan.record.rows, plan.record.duration_s);
    let count = plan.records.len();
    if count == 0 {
        let path = inputs.first();
        let name = path.map_or("record".into(), |input| printable_line(&input.path));
        return format!("{name}: {size}");
    }
    // Each is followed by its bench file.
    let names = inputs.iter().step_by(2).take(count);
    let named = match &*joined(names.map(|input| printable_line(&input.path)), ", ") {
        "" => String::new(),
        names => format!(" ({names})"),
    };
    format!("{count} records together{named}: {size}")
}

/// Durations in the order in which they were asked for.
pub(crate) fn durations(plan: &PlanResult) -> Vec<f64> {
    let mut durations: Vec<f64> = plan.proposals.iter().map(|p| p.duration_s).collect();
    durations.dedup();
    durations
}

/// Sets of more than one member.
pub(crate) fn undecided(outlook: &Outlook) -> impl Iterator<Item = &SetForecast> {
    outlook.sets.iter().filter(|set| set.members.len() > 1)
}

fn question(plan: &PlanResult) -> String {
    let now = &plan.now;
    let these = match plan.records.is_empty() {
        true => "this record",
        false => "these records",
    };
    let sets = undecided(now).map(|set| {
        let others = joined(set.members[1..].iter().map(|m| &m.effect), ", ");
        format!("{} (alternatives {others})", set.effect)
    });
    let sets = joined(sets, "; ");
    let reported = joined(now.sets.iter().map(|set| &set.effect), ", ");
    let ranked = match plan.aim {
        Aim::Set => "Runs are ranked by the expected size of these sets, then by the sigmas.",
        Aim::Sigmas => "Runs are ranked by the sigmas of the nine coefficients.",
    };
    if !sets.is_empty() {
        format!("Not distinguished by {these}: {sets}. {ranked}")
    } else if reported.is_empty() {
        format!("The diagnosis of {these} has no findings. {ranked}")
    } else {
        format!("Findings without alternatives: {reported}. {ranked}")
    }
}

fn recommendation(plan: &PlanResult, best: &Proposal, first: bool) -> String {
    let records = match plan.records.is_empty() {
        true => "record",
        false => "records",
    };
    let what = match first {
        true => "Recommended next run:",
        false => "Alternatively",
    };
    let (hours, from) = (hours(best.duration_s), attitude(plan, best));
    format!("{what} {hours} from {from}. Expected result of {records} and run together")
}

fn set_forecast(set: &SetForecast) -> String {
    let others = |test: &dyn Fn(f64) -> bool| {
        let those = set.members[1..].iter();
        let those = those.filter(|member| test(member.told_apart));
        let told = |one: &SetMember| format!("{} ({})", one.effect, percent(one.told_apart));
        joined(those.map(told), ", ")
    };
    let lists = [
        (others(&|p| p >= DISTINGUISHED), "distinguished from"),
        (
            others(&|p| (NOT_DISTINGUISHED..DISTINGUISHED).contains(&p)),
            "possibly distinguished from",
        ),
        (others(&|p| p < NOT_DISTINGUISHED), "not distinguished from"),
    ];
    let mut words = format!(
        "confidence set of {}: {:.2} of {} members stay on average, one alone with a probability \
         of {}",
        set.effect,
        set.mean_size,
        set.members.len(),
        percent(set.one_left)
    );
    for (list, verb) in lists {
        if !list.is_empty() {
            words.push_str(&format!("; {verb} {list}"));
        }
    }
    words
}

fn continuation(outlook: &Outlook) -> String {
    let sets = undecided(outlook).map(|set| {
        let members = set.members.len();
        format!("{:.2} of {members} members stay, ", set.mean_size)
    });
    format!(
        "The same duration in the present attitude: {}sigmas {:.2}.",
        sets.collect::<String>(),
        outlook.sigma_ratio
    )
}

pub(crate) fn goal(plan: &PlanResult) -> Option<String> {
    let goal = plan.goal.as_ref()?;
    let wish = &goal.wish;
    Some(match &goal.run {
        _ if goal.already => format!("This record alone meets the goal: {wish}."),
        Some(run) => format!(
            "Shortest run that meets the goal ({wish}): {} from {}.",
            hours(run.duration_s),
            attitude(plan, run)
        ),
        None => format!(
            "No run of up to {} among those examined meets the goal: {wish}.",
            hours(goal.longest_s)
        ),
    })
}

/// Runs, standard deviations, and what is distinguished.
#[must_use]
pub fn tables(plan: &PlanResult) -> Vec<Table> {
    let mut tables = vec![runs(plan)];
    let Some(best) = plan.proposals.first() else {
        return tables;
    };
    let mut going_on = plan.going_on.iter();
    let going_on = going_on.find(|run| run.duration_s == best.duration_s);
    let later: Vec<(&str, &Outlook)> = going_on
        .map(|run| ("present attitude", &run.outlook))
        .into_iter()
        .chain([("best run", &best.outlook)])
        .collect();
    tables.push(sigmas(&plan.now, &later, best.duration_s));
    if undecided(&plan.now).next().is_some() {
        tables.push(members(plan, &later));
    }
    tables
}

fn runs(plan: &PlanResult) -> Table {
    let sets = undecided(&plan.now).map(|set| {
        let (effect, count) = (&set.effect, set.members.len());
        Column::numbers(&format!("mean size of set {effect} (now {count})"))
    });
    let mut columns = ["duration", "x", "y", "z", "sigmas"]
        .map(Column::numbers)
        .to_vec();
    columns.extend(sets);
    let row = |run: &Proposal| {
        let angles = match run.angles_deg {
            Some(angles) => angles.map(|angle| format!("{angle:.0}°")),
            None => ["present".to_owned(), String::new(), String::new()],
        };
        let sizes = undecided(&run.outlook).map(|set| format!("{:.2}", set.mean_size));
        let mut cells = vec![hours(run.duration_s)];
        cells.extend(angles);
        cells.push(format!("{:.3}", run.outlook.sigma_ratio));
        cells.extend(sizes);
        cells
    };
    let rows = durations(plan).into_iter().flat_map(|duration_s| {
        let all = plan.proposals.iter().chain(&plan.going_on);
        all.filter(move |run| run.duration_s == duration_s)
    });
    let title = "Runs for each duration, the best first";
    Table::new(title, columns, rows.map(row))
}

fn sigmas(now: &Outlook, later: &[(&str, &Outlook)], duration_s: f64) -> Table {
    let all = |outlook: &Outlook| -> Vec<String> {
        let forecasts = outlook.coefficients.iter().chain(&outlook.sizes);
        forecasts.map(|f| format!("{:.1e}", f.sigma)).collect()
    };
    let heads = core::iter::once("now").chain(later.iter().map(|(head, _)| *head));
    let mut columns = vec![Column::words("")];
    columns.extend(heads.map(Column::numbers));
    columns.push(Column::words("unit"));
    let outlooks = core::iter::once(now).chain(later.iter().map(|(_, outlook)| *outlook));
    let values: Vec<Vec<String>> = outlooks.map(all).collect();
    let forecasts = now.coefficients.iter().chain(&now.sizes).enumerate();
    let rows = forecasts.map(|(index, forecast)| {
        let cells = values.iter().map(|sigmas| sigmas.get(index).cloned());
        let mut row = vec![forecast.name.to_string()];
        row.extend(cells.map(Option::unwrap_or_default));
        row.push(forecast.unit.to_string());
        row
    });
    let hours = hours(duration_s);
    let title = format!("Standard deviations now, and after {hours} more");
    Table::new(&title, columns, rows)
}

fn members(plan: &PlanResult, later: &[(&str, &Outlook)]) -> Table {
    let mut columns = vec![Column::words("reported"), Column::words("alternative")];
    columns.extend(later.iter().map(|(head, _)| Column::numbers(head)));
    let mut rows: Vec<Vec<String>> = Vec::new();
    for (at, set) in plan.now.sets.iter().enumerate() {
        for (index, member) in set.members.iter().enumerate().skip(1) {
            let cells = later.iter().map(|(_, outlook)| {
                let later = outlook.sets.get(at).and_then(|set| set.members.get(index));
                later.map_or_else(String::new, |member| percent(member.told_apart))
            });
            let ids = [set.effect.to_string(), member.effect.to_string()];
            rows.push(ids.into_iter().chain(cells).collect());
        }
    }
    Table::new(
        "Probability that the reported cause and the alternative are distinguished, whichever \
                of the two it is",
        columns,
        rows,
    )
}

/// The attitude of a run in words.
pub(crate) fn attitude(plan: &PlanResult, run: &Proposal) -> String {
    let Some([x, y, z]) = run.angles_deg else {
        return "the present attitude".to_owned();
    };
    let body = match plan.attitude_of {
        AttitudeOf::Platform => "platform",
        AttitudeOf::Unit => "unit",
    };
    format!("{body} angles x {x:.0}°, y {y:.0}°, z {z:.0}°")
}

/// What the angles of a strapdown unit are; `None` of a platform.
pub(crate) fn unit_angles(plan: &PlanResult) -> Option<&'static str> {
    (plan.attitude_of == AttitudeOf::Unit).then_some(
        "turn East, North, Up into the axes of the instruments, about x, then y, then z; the unit rests \
         in them for the whole log",
    )
}

/// A probability in percent, never 100 %.
pub(crate) fn percent(p: f64) -> String {
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
        assert_eq!(hours(45_000.0), "12.5 h");
        assert_eq!(hours(5_400.0), "1.5 h");
    }
}
