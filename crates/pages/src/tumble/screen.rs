//! The first screen of a multi-position test.

use gyrocal_document::{Screen, Standing};
use gyrocal_instruments::multi_position::{Finding, MultiPositionReport, SensorReport};
use gyrocal_statistics::format;
use gyrocal_words::{counted, few, joined};

use super::TumbleAnswer;
use crate::bad_samples::left_out;
use crate::origin::named;
use crate::signs::against_the_earth;

/// Terms that are told one by one.
const TERMS_SHOWN: usize = 6;
/// Names of a list that are shown.
const NAMES_SHOWN: usize = 3;

/// What the nominal law lacks, how sure that is, and what it changes.
pub(super) fn first(answer: &TumbleAnswer<'_>) -> Screen {
    let result = answer.result;
    let report = &result.test;
    let mut screen = law(report);
    if result.earth_is_reversed {
        let law = screen;
        screen = against_the_earth();
        screen.facts.extend(law.facts);
    }
    if report.tells_noise() {
        let words = format!(
            "{} of sound instruments would show any term by chance",
            format::percent(answer.false_alarm)
        );
        screen.fact("how sure", words);
    }
    screen.fact(
        "not told",
        match answer.prepared.instrument.latitude_deg {
            Some(_) => "squares along all three axes from the bias (they sum to 1 g²)",
            None => "squares along all three axes from the bias; g_i from Earth rate (no latitude)",
        },
    );
    screen.fact("left out", saturated(&result.sensors));
    // The last file is the description.
    let logs = answer
        .manifest
        .inputs
        .split_last()
        .map_or(&[][..], |(_, logs)| logs);
    let bad = left_out(&result.sensors.bad_samples, logs.len());
    screen.fact("left out", bad);
    let stops = counted(answer.prepared.stops.len(), "static stop");
    screen.fact("log", format!("{}: {stops}", named(logs)));
    screen
}

/// The turns that are left out of the calibration of the gyros, and why; empty without any.
fn saturated(sensors: &SensorReport) -> String {
    let turns = &sensors.saturated_turns;
    let each = turns.iter().take(NAMES_SHOWN).map(|turn| {
        format!(
            "the turn from {} to {} s, with {} of `{}` at the end of its range, {}, from sample {} on",
            format::short(turn.from_s, 5),
            format::short(turn.to_s, 5),
            counted(turn.samples, "sample"),
            turn.column,
            turn.end,
            turn.first_sample
        )
    });
    let each = joined(each, "; ");
    match turns.len().saturating_sub(NAMES_SHOWN) {
        0 => each,
        more => format!("{each}; and {more} more"),
    }
}

fn verdict(terms: &[Finding]) -> Screen {
    let mut screen = match terms.len() {
        0 => Screen::new(
            Standing::Good,
            "LAW HOLDS",
            "no significant term beyond the nominal drift law",
        ),
        count => {
            let what = format!("the nominal drift law lacks {}", counted(count, "term"));
            Screen::new(Standing::Bad, "TERMS MISSING", what)
        }
    };
    for one in terms.iter().take(TERMS_SHOWN) {
        let names: Vec<&str> = one.alternatives.iter().map(|one| &*one.effect).collect();
        let others = match &names[..] {
            [] => "nothing else of the catalogue".to_owned(),
            names => format!("may also be {}", few(names, NAMES_SHOWN)),
        };
        let estimate = format::with_sigma(one.estimate, one.sigma);
        let p = format::p_value(one.p_value);
        let words = format!("{estimate} {}, {p}; {others}", one.unit);
        screen.fact(&one.effect, words);
    }
    if terms.len() > TERMS_SHOWN {
        screen.fact("and", format!("{} more", terms.len() - TERMS_SHOWN));
    }
    screen
}

fn law(report: &MultiPositionReport) -> Screen {
    let mut screen = match report.tells_noise() {
        true => verdict(&report.findings),
        false => Screen::new(
            Standing::Doubtful,
            "NOT TESTED",
            "too few stops to tell a term from the noise between them",
        ),
    };
    for one in &report.log_biases {
        let differences = one.differences_deg_per_h.iter().zip(&one.sigmas_deg_per_h);
        let differences = differences.map(|(one, sigma)| format::with_sigma(*one, *sigma));
        let words = format!(
            "{}.bias by {} deg/h from the first log on, {}: another turn-on, or another unit, whose logs are \
             evaluated alone",
            one.gyro,
            joined(differences, ", "),
            format::p_value(one.p_value)
        );
        screen.fact("logs differ", words);
    }
    screen.fact("no gain", report.not_confirmed.join(", "));
    if let Some(gain) = &report.cross_validation {
        let list = |values: [f64; 3]| values.map(|value| format!("{value:.0}")).join(", ");
        let words = format!(
            "rms of gyros x, y, z on left-out stops {} → {} deg/h (noise {}); {:+.1} ± {:.1} nats",
            list(gain.rms_before_deg_per_h),
            list(gain.rms_after_deg_per_h),
            list(gain.noise_deg_per_h),
            gain.cross_validated_log_score_nats,
            gain.standard_error_nats
        );
        screen.fact("what they do", words);
    }
    laws(report, &mut screen);
    let between = report.gyros.iter().map(|gyro| {
        let levels = gyro.extended.noise.scatter_deg_per_h;
        let [median, most] = levels.map(|level| format::short(level, 2));
        format!("{} {median} (at most {most})", gyro.gyro)
    });
    if report.tells_noise() {
        let between = joined(between, ", ");
        let words = format!("scatter beyond the noise of a stop, deg/h: {between}");
        screen.fact("between stops", words);
    } else {
        let left = counted(report.freedom_of_noise, "degree");
        let words = format!(
            "{left} of freedom tell the noise between stops, a test needs six: repeat positions, each repeat gives \
             one to each gyro"
        );
        screen.fact("not tested", words);
    }
    screen
}

/// The law of each gyro, and what the positions do not determine. Where the gain of the terms is told the screen has no
/// place for them.
fn laws(report: &MultiPositionReport, screen: &mut Screen) {
    if report.cross_validation.is_some() {
        return;
    }
    for gyro in &report.gyros {
        let law = gyro.extended.coefficients.iter().take(NAMES_SHOWN);
        let law = law.map(|one| {
            let size = format::with_sigma(one.estimate, one.sigma);
            format!("{} {size} {}", one.name, one.unit)
        });
        screen.fact(&gyro.gyro, joined(law, ", "));
        screen.fact("not determined", few(&gyro.undetermined, NAMES_SHOWN));
    }
}
