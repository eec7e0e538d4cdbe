//! The first screen of operating characteristics.

use gyrocal_document::{Screen, Standing};
use gyrocal_evaluation::{CellReport, Characteristic};

use super::{interval, measured, target};

/// Figures that are told one by one.
const FIGURES_SHOWN: usize = 8;

/// How many figures hold, and those that do not.
pub(super) fn first(reports: &[CellReport]) -> Screen {
    let all = reports
        .iter()
        .flat_map(|report| report.characteristics.iter().map(move |one| (report, one)));
    let judged: Vec<(&CellReport, &Characteristic)> =
        all.filter(|(_, one)| one.target.is_some()).collect();
    let of = |verdict: Option<bool>| judged.iter().filter(move |(_, one)| one.holds == verdict);
    let [held, missed] = [of(Some(true)).count(), of(Some(false)).count()];
    let what = format!(
        "{held} of {} figures hold, {missed} do not, {} have too few records to tell",
        judged.len(),
        judged.len() - held - missed
    );
    let mut screen = match (missed, held == judged.len()) {
        (0, true) => Screen::new(Standing::Good, "HOLDS", what),
        (0, false) => Screen::new(Standing::Neutral, "NOTHING MISSED", what),
        _ => Screen::new(Standing::Bad, "MISSED", what),
    };
    for (report, one) in of(Some(false)).chain(of(None)).take(FIGURES_SHOWN) {
        let interval = match &*interval(one) {
            "" => String::new(),
            some => format!(" ({some})"),
        };
        let (measured, target) = (measured(one), target(one));
        let words = format!("{}: {measured}{interval}, target {target}", one.figure);
        screen.fact(&report.title, words);
    }
    screen
}
