//! The first screen of a record in which nothing was found.

use gyrocal_statistics::format::percent;

use super::first_screen::{ALTERNATIVES_SHOWN, plan, remainder};
use super::records::files;
use crate::files::few;
use crate::format::counted;
use gyrocal_answer::{Answer, NotTestedReason};
use gyrocal_document::{Screen, Standing};

pub(super) fn clean(result: &Answer) -> Screen {
    let is_short = result.hides_most();
    let mut screen = if is_short {
        let what = "the record fits the model, and would with most faults of typical size";
        Screen::new(Standing::Doubtful, "TOO SHORT TO TELL", what)
    } else {
        let what = "the record fits the model and the declared noise";
        Screen::new(Standing::Good, "NO FAULT FOUND", what)
    };
    let words = format!(
        "{} tested, false-alarm rate {}; {}",
        counted(result.ranking.len(), "effect"),
        percent(result.false_alarm_probability),
        remainder(result).replace("nothing: ", "")
    );
    screen.fact("how sure", words);
    screen.fact("may still hide", undetected(result));
    screen.fact("not tested", untested(result));
    if let Some(nis) = result.residuals.as_ref().and_then(|shown| shown.nis) {
        let ([low, high], mean) = (nis.band, nis.mean);
        let words = format!("mean NIS {mean:.3} (expected {low:.3} to {high:.3})");
        screen.fact("innovations", words);
    }
    if is_short {
        screen.fact("what to do", "record for a day or longer");
    }
    let command = format!("gyrocal calibrate {}", files(result));
    screen.then(command, "the nine coefficients with their sigmas");
    plan(result, &mut screen, "the run that reduces the sigmas most");
    screen
}

/// Effects that would go undetected at their typical size.
fn undetected(result: &Answer) -> String {
    let low = result.low_power();
    match low.len() {
        0 => "effects well below their typical size (gyrocal effects)".to_owned(),
        count => format!(
            "{count} of {} of typical size, as the record is short: {}",
            counted(result.ranking.len(), "effect"),
            few(low, ALTERNATIVES_SHOWN)
        ),
    }
}

/// Effects that were not tested for.
fn untested(result: &Answer) -> String {
    let others = result.not_searched.iter();
    let others = others.filter(|effect| effect.reason != NotTestedReason::LowPower);
    let others: Vec<&str> = others.map(|effect| &*effect.effect).collect();
    if others.is_empty() {
        return String::new();
    }
    let (count, named) = (counted(others.len(), "effect"), few(others, 2));
    format!("{count} (missing inputs, or on request): {named}")
}
