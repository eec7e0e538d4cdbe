//! The answer of a diagnosis of a plant in sentences.

mod fit;
mod noise;
mod path;

pub use fit::{comparison_screen, fit_screen, simulation_error};
pub use noise::undeclared_noise;
pub use path::{path, why};

use crate::diagnosis::likelihood;
use crate::files::joined;
use crate::format::{behind, tested, with_sigma};
use gyrocal_answer::{
    AlternativeKind, Answer, Finding, Gain, NextRun, NullDirection, NullPart, OutputError,
    OutputTest, Parameter, RecordResult, RecordSummary, Subject, UnmodelledTerm, Verdict,
};
use gyrocal_document::{Screen, Standing};
use gyrocal_statistics::format::{p_value, significant};
use gyrocal_statistics::math::{exp, ln};

/// Gain on a later record, nats, below which nothing is said of it.
const LEAST_GAIN: f64 = 3.0;

/// Probability of correlation below which what is left of an output is told, and is not white.
const RARE: f64 = 0.001;

/// Probability of a cause outside of the catalogue from which on it is told.
const LEAST_NONE: f64 = 0.05;

/// The answer in sentences, the verdict first.
#[must_use]
pub fn all(answer: &Answer) -> Vec<String> {
    let Screen { what, facts, .. } = first_screen(answer);
    let facts = facts.into_iter().map(|fact| fact.words);
    core::iter::once(what).chain(facts).collect()
}

/// The first screen: the verdict, and what the answer says after it.
#[must_use]
pub fn first_screen(answer: &Answer) -> Screen {
    let (standing, words) = match answer.verdict {
        Verdict::Clean if !answer.undeclared_noise.is_empty() => {
            (Standing::Doubtful, "NOTHING FOUND BESIDE NOISE")
        }
        Verdict::Clean => (Standing::Good, "NOTHING FOUND"),
        Verdict::NotSettled => (Standing::Bad, "NOT SETTLED"),
        Verdict::Unexplained => (Standing::Bad, "UNEXPLAINED"),
        _ => (Standing::Bad, "MODEL LACKS SOMETHING"),
    };
    let mut screen = Screen::new(standing, words, verdict(answer));
    facts(answer, &mut screen);
    screen
}

/// What the answer says after the verdict.
fn facts(answer: &Answer, screen: &mut Screen) {
    let has = answer.has_findings();
    let found = answer.findings.iter();
    screen.each("effect", found.map(|one| finding(answer, one)));
    let terms = answer.remainder.unmodelled.iter();
    screen.each("unexplained", terms.map(unmodelled));
    let records = answer.records.iter();
    screen.each("record", records.map(|one| record(one, has)));
    let horizon = over(answer.horizon_s);
    let errors = answer.open_loop.iter().map(|error| off(error, has));
    let errors = errors.map(|off| format!("Simulated{horizon}, output {off}."));
    screen.each("open loop", errors);
    // A likelihood of noise that is not white says little of left-out parts: simulations do.
    let gains = answer.gain.iter().filter(|_| answer.path.is_empty());
    screen.each("parts", gains.map(parts));
    screen.each("left out", path(&answer.path));
    screen.each("later record", later_record(answer));
    let tests = answer.remainder.outputs.iter();
    let rare = tests.filter(|one| is_coloured(one));
    screen.each("remainder", rare.map(|one| remainder(answer, one)));
    screen.each(
        "noise",
        answer.undeclared_noise.iter().map(undeclared_noise),
    );
    if !answer.only_in_white_noise.is_empty() {
        let words = format!(
            "In white noise alone {} would be named; beside the noise above the record does not hold it.",
            answer.only_in_white_noise.join(", ")
        );
        screen.fact("noise", words);
    }
    screen.each("undetermined", answer.undetermined.iter().map(direction));
    if !answer.still_inputs.is_empty() {
        let words = format!(
            "Input {} never moves in this record: nothing that depends on it can be told from a \
             constant. Move it.",
            answer.still_inputs.join(", ")
        );
        screen.fact("inputs", words);
    }
    screen.each("next run", answer.next_runs.iter().map(next_run));
}

/// The verdict, a sentence.
#[must_use]
pub fn verdict(answer: &Answer) -> String {
    let plant = match &answer.subject {
        Subject::Plant(name) => name,
        _ => "The plant",
    };
    let names = &answer.findings;
    let all = joined(names.iter().map(|one| &one.effect), ", ");
    match answer.verdict {
        Verdict::NotSettled => {
            let mut why = Vec::new();
            if !answer.search_complete {
                why.push("the search ended at its budget of work");
            }
            if !answer.remainder.unmodelled.is_empty() {
                why.push("it lacks something that its catalogue has no term for");
            }
            if answer.remainder.outputs.iter().any(is_coloured) {
                why.push("what is left is not white noise");
            }
            let why = why.join(", and ");
            let found = if all.is_empty() { "nothing" } else { &all };
            format!("What {plant} lacks is not settled: {why}. Found so far: {found}.")
        }
        Verdict::Unexplained if answer.has_findings() => {
            format!("{plant} lacks something that its catalogue has no term for.")
        }
        Verdict::Unexplained => {
            format!("No effect is found that {plant} lacks, but what is left is not white noise.")
        }
        _ if names.is_empty() => {
            let of_records = match answer.records.len() {
                0 => String::new(),
                count => format!(" of {count} records"),
            };
            let (tested, rows) = (answer.ranking.len(), answer.record.rows);
            let beside = match answer.undeclared_noise.as_slice() {
                [] => "",
                _ => " beside noise that it does not declare, which hides effects of its own size",
            };
            format!(
                "Nothing is found that {plant} lacks{beside}: {tested} effects were tested on {rows} rows{of_records}."
            )
        }
        _ => match names.len() {
            1 => format!("{plant} lacks one effect: {all}."),
            count => format!("{plant} lacks {count} effects: {all}."),
        },
    }
}

/// An effect of an answer with its size, significance and set, a sentence or more.
#[must_use]
pub fn finding(answer: &Answer, found: &Finding) -> String {
    let mut sizes: Vec<String> = found.parameters.iter().map(parameter).collect();
    sizes.extend(found.in_record.map(|record| format!("in record {record}")));
    let mut text = format!(
        "{} ({}): {}; {} standard deviations, {}.",
        found.effect,
        found.name,
        sizes.join(", "),
        significant(found.z, 3),
        tested(found.p_value),
    );
    let rivals = found.of_kind(AlternativeKind::NotExcluded);
    let rivals = rivals.map(|other| format!("{} ({})", other.effect, likelihood(other)));
    text += &match (&*joined(rivals, ", "), answer.is_settled()) {
        ("", true) => " Its set has no other effect.".to_owned(),
        ("", false) => " No other effect of what was compared is in its set.".to_owned(),
        (rivals, _) => format!(" The cause may also be {rivals}."),
    };
    let equivalents = joined(found.equivalents(), ", ");
    if !equivalents.is_empty() {
        text += &format!(" No record tells it from {equivalents}.");
    }
    text += &match found.none_of_these {
        Some(none) if none > LEAST_NONE => format!(
            " With a probability of {} % the cause is outside of the catalogue.",
            significant(100.0 * none, 2)
        ),
        Some(_) => String::new(),
        None => {
            " The probability of a cause outside of the catalogue was not estimated.".to_owned()
        }
    };
    text
}

/// A size or an onset: name, value, standard deviation and unit.
#[must_use]
pub fn parameter(one: &Parameter) -> String {
    let value = match one.sigma {
        Some(sigma) => with_sigma(one.estimate, sigma),
        None => significant(one.estimate, 4),
    };
    format!("{} {value}{}", one.name, behind(&one.unit))
}

/// A term outside of the catalogue.
#[must_use]
pub fn unmodelled(one: &UnmodelledTerm) -> String {
    let form = match (one.period_h, &one.depends_on) {
        (Some(period_h), _) => format!("a line with a period of {:.4} s", 3600.0 * period_h),
        (None, variable) => format!(
            "a function of {} that is in no term of the catalogue",
            variable.as_deref().unwrap_or("time")
        ),
    };
    format!(
        "In {}: {form}, {} {} ({}).",
        one.channel,
        significant(one.size, 3),
        one.unit,
        p_value(one.p_value)
    )
}

/// Whether what is left of an output is not white.
#[must_use]
pub fn is_coloured(one: &OutputTest) -> bool {
    one.p_value < RARE
}

/// That in words.
#[must_use]
pub fn coloured(one: &OutputTest) -> String {
    format!(
        "What is left of output {} is not white noise ({}): the model still lacks something, or the noise is \
         coloured. Significances rest on white noise, take them as too good.",
        one.output,
        p_value(one.p_value)
    )
}

/// The same in an answer: significances rest on the noise that it tells.
fn remainder(answer: &Answer, one: &OutputTest) -> String {
    let words = coloured(one);
    match answer.undeclared_noise.as_slice() {
        [] => words,
        _ => words.replace("white noise, take", "the noise above, take"),
    }
}

/// What no record, or this one, does not determine.
#[must_use]
pub fn direction(one: &NullDirection) -> String {
    let part = |part: &NullPart| {
        let sign = if part.change < 0.0 { "−" } else { "+" };
        let unit = if part.is_share { " %" } else { "" };
        let size = significant(part.change.abs(), 3);
        format!("{} by {sign}{size}{unit}", part.name)
    };
    let parts = joined(one.parts.iter().map(part), ", ");
    let held = one.held.as_ref().map_or_else(String::new, |held| {
        format!("; {held} is held at its declared value")
    });
    if one.is_gauge {
        format!("No record of this plant shows a change of {parts} together{held}.")
    } else {
        format!("This record does not show a change of {parts}{held}: with another input it would.")
    }
}

/// An error of a simulation; that of one that leaves the finite numbers is infinite.
fn rms(error: Option<f64>) -> String {
    error.map_or_else(|| "∞".to_owned(), |rms| significant(rms, 3))
}

/// An error of simulations in words; `has` tells whether anything was found.
fn off(error: &OutputError, has: bool) -> String {
    let (unit, nominal) = (&error.unit, rms(error.nominal));
    let mut text = format!(
        "{} is off by {nominal} {unit} rms with the nominal model",
        error.output
    );
    if has {
        let extended = rms(error.extended);
        text += &format!(" and by {extended} {unit} with what was found");
    }
    text
}

/// The horizon of simulations.
fn over(horizon_s: Option<f64>) -> String {
    horizon_s.map_or_else(String::new, |s| format!(" over {} s", significant(s, 4)))
}

fn record(one: &RecordResult, has: bool) -> String {
    let errors = joined(one.open_loop.iter().map(|error| off(error, has)), ", ");
    let (name, rows, alone) = (&one.name, one.record.rows, alone(one));
    format!("{name}, {rows} rows: output {errors}. Alone: {alone}")
}

/// The verdict of one of several records alone, or why it has none.
#[must_use]
pub fn alone(one: &RecordResult) -> String {
    let none = || format!("not diagnosed, {}.", one.why_not_alone);
    one.alone.as_ref().map_or_else(none, verdict)
}

/// What a gain says of what was found; `tells` are the words for what is left open.
fn judged(gain_nats: f64, tells: &str) -> String {
    if gain_nats >= LEAST_GAIN {
        "what was found holds there".to_owned()
    } else if gain_nats > -LEAST_GAIN {
        format!("{tells} nothing of it")
    } else {
        "what was found does not hold there".to_owned()
    }
}

/// The gain in parts that are predicted from the others.
#[must_use]
pub fn parts(gain: &Gain) -> String {
    let blocks = &gain.block_log_score_nats;
    let parts = blocks.len();
    let alone = blocks.iter().filter(|block| block.is_none()).count();
    if alone == parts {
        return format!("Without any of {parts} parts the others do not determine what was found.");
    }
    let nats = gain.cross_validated_log_score_nats;
    let words = format!(
        "Each of {parts} parts predicted from the others, the gain is {nats:.1} nats: {}.",
        judged(nats, "they tell")
    );
    match alone {
        0 => words,
        1 => format!("{words} One part is left out: only there is shown what was found."),
        more => format!("{words} {more} parts are left out: only they show what was found."),
    }
}

/// The gain on the later record; `None` without one.
#[must_use]
pub fn later_record(answer: &Answer) -> Option<String> {
    let RecordSummary { rows, .. } = answer.later_record?;
    let gain = answer.gain.as_ref();
    let Some(later) = gain.and_then(|gain| gain.validation.as_ref()) else {
        let none = "Nothing was found, so there is no gain on the second record to be measured.";
        return Some(none.to_owned());
    };
    let errors = later.open_loop.iter().map(|error| {
        let [nominal, extended] = [error.nominal, error.extended].map(rms);
        let (output, unit) = (&error.output, &error.unit);
        format!("output {output} is off by {extended} instead of {nominal} {unit} rms")
    });
    let nats = later.log_score_nats;
    Some(format!(
        "On the second record ({rows} rows), predicted with the parameters of the first, the gain is {nats:.1} \
         nats: {}. Simulated{}, {}.",
        judged(nats, "the second record tells"),
        over(later.horizon_s),
        joined(errors, ", ")
    ))
}

/// The forecast of a run, a sentence or two.
fn next_run(run: &NextRun) -> String {
    let told = run.told_apart.iter().map(|one| {
        format!(
            " It tells {} from {} with a probability of {} % ({} standard deviations apart, now {}).",
            one.effect,
            one.alternative,
            significant(100.0 * one.probability, 2),
            significant(one.after, 2),
            significant(one.now, 2),
        )
    });
    format!(
        "{} ({} rows, {} s) brings standard deviations to {} of what they are (geometric mean).{}",
        run.name,
        run.rows,
        significant(run.duration_s, 4),
        significant(mean_ratio(run), 2),
        told.collect::<String>()
    )
}

/// Geometric mean of the standard deviations after a run over those before.
#[must_use]
pub fn mean_ratio(run: &NextRun) -> f64 {
    let ratios = run.sigmas.iter().map(|one| ln(one.after / one.now));
    exp(ratios.sum::<f64>() / run.sigmas.len().max(1) as f64)
}
