//! The first screen of a plan.

use gyrocal_document::{Screen, Standing};
use gyrocal_record::InputRole;
use gyrocal_words::{counted, few, hours, input_files, joined};

use crate::prose::{attitude, durations, known, percent, undecided, unit_angles};
use crate::result::{Aim, AttitudeOf, PlanResult, Proposal};

/// Names of a list that are shown.
const SHOWN: usize = 4;

/// Durations that are told beside the first one.
const DURATIONS_SHOWN: usize = 3;

/// The command that makes a record of the next log of a strapdown unit.
const IMPORT: &str = "gyrocal import strapdown LOG.csv --log-description LOG.toml --out next.csv --bench-out \
                      next.toml --axes-out next.axes.csv";

/// The first screen: the run to make, what it will tell, and how much more that is than going on.
#[must_use]
pub fn first_screen(plan: &PlanResult) -> Screen {
    let mut screen = match plan.proposals.first() {
        Some(best) => {
            let run = format!("{} from {}", hours(best.duration_s), attitude(plan, best));
            Screen::new(Standing::Good, "NEXT RUN", run)
        }
        None => Screen::new(Standing::Doubtful, "NO RUN", "no attitude is better"),
    };
    screen.fact("angles", unit_angles(plan).unwrap_or_default());
    screen.fact("why", question(plan));
    if let Some(best) = plan.proposals.first() {
        expectation(plan, best, &mut screen);
    }
    let durations = durations(plan).into_iter();
    for duration_s in durations.skip(1).take(DURATIONS_SHOWN) {
        let mut runs = plan.proposals.iter();
        if let Some(run) = runs.find(|run| run.duration_s == duration_s) {
            let (hours, from) = (hours(duration_s), attitude(plan, run));
            screen.fact("or", format!("{hours} from {from}: {}", outlook(run)));
        }
    }
    screen.fact("goal", crate::prose::goal(plan).unwrap_or_default());
    if !plan.inseparable.is_empty() {
        let classes = plan.inseparable.iter().map(|ids| ids.join(" = "));
        let words = format!("{} (exact equivalents)", few(classes, SHOWN));
        screen.fact("no run tells", words);
    }
    screen.fact("record", known(plan));
    let what = match plan.records.is_empty() {
        true => "both runs, once the next is recorded",
        false => "all runs, once the next is recorded",
    };
    if plan.attitude_of == AttitudeOf::Unit {
        screen.then(IMPORT, "the platform of the next log");
    }
    screen.then(format!("gyrocal calibrate {}", with_next(plan)), what);
    screen
}

/// The records and the next one with their bench files and axes, as arguments of a command.
fn with_next(plan: &PlanResult) -> String {
    let next = [
        (InputRole::Record, "next.csv"),
        (InputRole::Bench, "next.toml"),
        (InputRole::GyroAxes, "next.axes.csv"),
    ];
    let is_unit = plan.attitude_of == AttitudeOf::Unit;
    let next = &next[..if is_unit { 3 } else { 2 }];
    input_files(&plan.manifest.inputs, is_unit, next)
}

/// What the records leave open.
fn question(plan: &PlanResult) -> String {
    let sets = undecided(&plan.now).map(|set| {
        let others = few(set.members[1..].iter().map(|m| &m.effect), SHOWN);
        format!("{} may also be {others}", set.effect)
    });
    let sets = joined(sets, "; ");
    match (sets.is_empty(), plan.aim) {
        (false, _) => sets,
        (true, Aim::Set) => "every finding has one name".to_owned(),
        // A plan has no verdict: a record without findings, or with one name for each, may still be unexplained.
        (true, Aim::Sigmas) => {
            let what = match plan.now.sets.as_slice() {
                [] => "there are no findings",
                _ => "every finding has one name",
            };
            format!("{what}: the run reduces the sigmas most")
        }
    }
}

fn expectation(plan: &PlanResult, best: &Proposal, screen: &mut Screen) {
    for set in undecided(&best.outlook) {
        let words = format!(
            "{}: one of {} left with a probability of {} ({:.2} on average)",
            set.effect,
            counted(set.members.len(), "cause"),
            percent(set.one_left),
            set.mean_size
        );
        screen.fact("it decides", words);
    }
    let words = format!(
        "sigmas fall to {:.2} of the present ones (geometric mean of the nine)",
        best.outlook.sigma_ratio
    );
    screen.fact("coefficients", words);
    let mut going_on = plan.going_on.iter();
    if let Some(run) = going_on.find(|run| run.duration_s == best.duration_s) {
        let words = format!("as long in the present attitude: {}", outlook(run));
        screen.fact("going on", words);
    }
}

/// What a run gives, in a few words.
fn outlook(run: &Proposal) -> String {
    let sets = undecided(&run.outlook).map(|set| {
        let causes = counted(set.members.len(), "cause");
        format!("{:.2} of {causes} left, ", set.mean_size)
    });
    let sets = sets.collect::<String>();
    format!("{sets}sigmas {:.2}", run.outlook.sigma_ratio)
}
