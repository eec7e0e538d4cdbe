//! The first screen of a diagnosis.

use gyrocal_setup::{LEAST_TURN_S, SetupKind};
use gyrocal_statistics::format::{self, p_value, percent, with_sigma};

use super::catalogue::has_random_walk;
use super::clean_screen;
use super::findings::{likely, value};
use super::records::{files, sizes};
use super::verdict;
use crate::files::{few, joined};
use crate::format::{NO_P, behind, counted, short, tested};
use gyrocal_answer::{Answer, Finding, FindingKind, ResidualVerdict, SetupProblem, Verdict};
use gyrocal_document::{Screen, Standing};

/// Findings that are told one by one.
const FINDINGS_SHOWN: usize = 4;
/// Alternatives that are named.
pub(super) const ALTERNATIVES_SHOWN: usize = 4;
/// Coefficients that are named with their change.
const SHIFTS_SHOWN: usize = 3;
/// Errors of a set-up that are told.
const PROBLEMS_SHOWN: usize = 2;
/// Probability of none of the catalogue from which on it is told.
const TOLD: f64 = 0.2;

/// What coefficients and effects of a strapdown unit are.
const STRAPDOWN: &str = "coefficients and effects are errors of the outputs of instruments that are fixed to a body, \
                         in their own axes";

/// What coefficients are where something is left over.
const BIASED: &str = "of the nominal model: they may be biased by more than their sigmas";

/// The first screen: verdict, size, significance, alternatives, effect on the coefficients, next step.
#[must_use]
pub fn first_screen(result: &Answer) -> Screen {
    let mut screen = match result.verdict {
        Verdict::EffectsFound => found(result),
        Verdict::NotSettled if !result.findings.is_empty() => found(result),
        Verdict::NotSettled => not_settled(result),
        Verdict::Unexplained => unexplained(result),
        Verdict::Setup => wrong_setup(result),
        Verdict::Clean => clean_screen::clean(result),
    };
    if result.is_strapdown() {
        screen.fact("axes", STRAPDOWN);
    }
    if let Some(group) = &result.set_ups {
        let others = joined(group.members.iter().skip(1), ", ");
        screen.fact("axes", format!("{others} fit as well: {}", group.why));
    }
    if result.verdict != Verdict::Setup {
        if result.record.duration_s < LEAST_TURN_S && !result.is_strapdown() {
            screen.fact("set-up", too_short_for_turn());
        }
        let mended = result.setup.iter().take(PROBLEMS_SHOWN);
        screen.each("set-up mended", mended.map(SetupProblem::placed));
        if !result.search_complete {
            let words =
                "ended at its budget of work: there may be more to find, or other names for it";
            screen.fact("search", words);
        }
    }
    screen.fact("record", verdict::record(result));
    screen
}

/// What a record of less than [`LEAST_TURN_S`] does not tell.
fn too_short_for_turn() -> String {
    format!(
        "axes, their signs, latitude and clock were not checked: that takes a record of {} h",
        short(LEAST_TURN_S / 3600.0)
    )
}

fn found(result: &Answer) -> Screen {
    let what = match &result.findings[..] {
        [one] => format!("{}, {}", one.effect, one.name),
        several => {
            let ids = few(several.iter().map(|one| &one.effect), FINDINGS_SHOWN);
            format!("{}: {ids}", counted(several.len(), "effect"))
        }
    };
    let is_settled = result.verdict == Verdict::EffectsFound;
    let verdict = if is_settled { "FAULT" } else { "NOT SETTLED" };
    let mut screen = Screen::new(Standing::Bad, verdict, what);
    for finding in result.findings.iter().take(FINDINGS_SHOWN) {
        let label = match result.findings.len() {
            1 => "how large",
            _ => &*finding.effect,
        };
        screen.fact(label, size(finding));
    }
    let sizes = joined(result.causes().filter_map(sizes), "; ");
    screen.fact("in each record", sizes);
    if !is_settled {
        screen.fact("not settled", verdict::not_settled(result));
    }
    let words = format!(
        "{} of sound records would show any effect by chance",
        percent(result.false_alarm_probability)
    );
    screen.fact("how sure", words);
    screen.fact("may also be", may_also_be(result));
    effect_on_fit(result, &mut screen);
    screen.fact("left over", remainder(result));
    next_of_found(result, &mut screen);
    screen
}

/// Size and significance of a finding.
fn size(finding: &Finding) -> String {
    let parameters = finding.parameters.iter().map(|parameter| {
        let value = match parameter.sigma {
            Some(sigma) => with_sigma(parameter.estimate, sigma),
            None => value(parameter),
        };
        let value = value + &behind(&parameter.unit);
        match parameter.name.as_str() {
            "size" => value,
            name => format!("{name} {value}"),
        }
    });
    let mut parts: Vec<String> = parameters.collect();
    parts.push(format!("{:.1} sigma", finding.z));
    parts.push(match finding.p_value {
        Some(p) => format!("search-corrected {}", p_value(p)),
        None => NO_P.to_owned(),
    });
    let left_out = match finding.accepted {
        Some(false) => "; no predictive gain: not in the extended model",
        _ => "",
    };
    parts.join(", ") + left_out
}

/// The other members of the confidence sets, exact equivalents and near twins, without repetition.
#[must_use]
pub fn may_also_be(result: &Answer) -> String {
    let mut names: Vec<&str> = Vec::new();
    let mut add = |name| {
        if !names.contains(&name) {
            names.push(name);
        }
    };
    let all = result.findings.iter();
    for alternative in all.flat_map(|finding| &finding.alternatives) {
        add(alternative.effect.as_str());
    }
    let none_of_these = || result.causes().map(|finding| finding.none_of_these);
    let told = none_of_these().flatten();
    let is_untold = none_of_these().any(|one| one.is_none());
    let unlisted = match told.reduce(f64::max) {
        Some(most) if most >= TOLD => Some(likely(most)),
        _ if is_untold && !result.is_settled() => Some("not estimated".to_owned()),
        _ => None,
    };
    let unlisted = unlisted
        .map(|probability| format!("a cause outside of the catalogue (probability {probability})"));
    let listed = (!names.is_empty()).then(|| few(&names, ALTERNATIVES_SHOWN));
    match (listed, unlisted) {
        (None, None) if result.causes().next().is_some() => nothing_else(result),
        (listed, unlisted) => joined(listed.into_iter().chain(unlisted), "; "),
    }
}

/// What sets without a second member say: their coverage, where it was measured and names are settled.
fn nothing_else(result: &Answer) -> String {
    if !result.search_complete {
        return "nothing else that the search came to compare".to_owned();
    }
    if !result.is_settled() {
        return "nothing else that was compared; what is left is not white".to_owned();
    }
    let coverages = result.causes().map(|finding| finding.coverage);
    let least = coverages.reduce(|least, own| Some(least?.min(own?)));
    match least.flatten() {
        Some(coverage) => format!("nothing else of the catalogue, at {}", percent(coverage)),
        None => "nothing else of the catalogue".to_owned(),
    }
}

/// Error of the open-loop simulation, gain and changes of the coefficients.
fn effect_on_fit(result: &Answer, screen: &mut Screen) {
    let Some(gain) = &result.gain else {
        return;
    };
    let micro = |g: f64| format::short(1e6 * g, 3);
    let nats = gain.cross_validated_log_score_nats;
    let left_out = format!("{nats:+.1} nats on left-out blocks");
    let shown = gain.free_run_rms_g.filter(|_| !has_random_walk(result));
    let what = match shown {
        None => left_out,
        Some(rms) => format!(
            "open-loop error {} → {} µg with it in the model (noise {}); {left_out}",
            micro(rms.before),
            micro(rms.after),
            micro(rms.noise),
        ),
    };
    screen.fact("what it does", what);
    if let Some(validation) = &gain.validation
        && let Some(error) = &validation.compensation
    {
        let (nats, hours) = (validation.log_score_nats, format::short(error.after_h, 3));
        let errors = [
            error.nominal_arcmin,
            error.extended_arcmin,
            error.expected_arcmin,
        ];
        let [before, after, expected] = errors.map(|arcmin| format::short(arcmin, 2));
        let words = format!(
            "{nats:+.1} nats with it; attitude after {hours} h of compensation off by {before} → {after} arcmin \
             ({expected} expected)"
        );
        screen.fact("later record", words);
    }
    let mut shifts: Vec<_> = gain.coefficient_shift.iter().collect();
    shifts.sort_by(|a, b| b.in_sigmas.abs().total_cmp(&a.in_sigmas.abs()));
    let largest = shifts.iter().take(SHIFTS_SHOWN);
    let named = largest.map(|shift| format!("{} {:+.1}", shift.coefficient, shift.in_sigmas));
    let named = joined(named, ", ");
    let words = format!("change by {named} sigma; the others less");
    screen.fact("coefficients", words);
}

/// The residual with all causes in the model.
pub(super) fn remainder(result: &Answer) -> String {
    let test = &result.remainder;
    match test.verdict {
        ResidualVerdict::White => format!("nothing: innovations white ({})", tested(test.p_value)),
        ResidualVerdict::NotTested => format!("not tested for {}", test.description),
        ResidualVerdict::Unexplained => test.description.clone(),
    }
}

fn next_of_found(result: &Answer, screen: &mut Screen) {
    let files = files(result);
    let causes = result.causes();
    let causes = causes.filter(|finding| finding.accepted == Some(true));
    let causes = joined(causes.map(|finding| &finding.effect), ",");
    let mut findings = result.findings.iter();
    if findings.any(|finding| !finding.alternatives.is_empty()) {
        plan(result, screen, "the run that would distinguish them");
    }
    if causes.is_empty() {
        let mut others = [FindingKind::Filter, FindingKind::Noise].into_iter();
        if others.any(|kind| result.of_kind(kind).next().is_some()) {
            let command = format!("gyrocal diagnose {files} --verbose");
            screen.then(command, "noise and filter in detail");
        }
    } else if result.records.is_empty() {
        let command = format!("gyrocal calibrate {files} --with {causes}");
        screen.then(command, "the coefficients with it in the model");
    } else {
        screen.then(
            "gyrocal extend RESULT.json --out NAME.model.toml",
            "the model file with it, from the result of --json",
        );
    }
}

/// The next step that plans a run.
pub(super) fn plan(result: &Answer, screen: &mut Screen, why: &str) {
    screen.then(format!("gyrocal plan {}", files(result)), why);
}

fn unexplained(result: &Answer) -> Screen {
    let test = &result.remainder;
    let what = "the record contradicts the model, and no effect of the catalogue explains it";
    let mut screen = Screen::new(Standing::Bad, "UNEXPLAINED", what);
    screen.fact("what is seen", &*test.description);
    let words = format!(
        "{}; {} of sound records would show any effect by chance",
        tested(test.p_value),
        percent(result.false_alarm_probability)
    );
    screen.fact("how sure", words);
    let words = "an effect that the catalogue lacks: docs/adding-a-term.md adds one";
    screen.fact("may also be", words);
    screen.fact("coefficients", BIASED);
    let (option, why) = match result.records.is_empty() {
        true => ("--figures figures", "pictures of the residual"),
        false => ("--report report.html", "the residual of each record"),
    };
    let command = format!("gyrocal diagnose {} {option}", files(result));
    screen.then(command, why);
    screen
}

/// A search that ended at its budget before it named anything.
fn not_settled(result: &Answer) -> Screen {
    let mut screen = Screen::new(Standing::Bad, "NOT SETTLED", verdict::not_settled(result));
    screen.fact("left over", remainder(result));
    screen.fact("coefficients", BIASED);
    let command = format!("gyrocal diagnose {} --verbose", files(result));
    screen.then(command, "statistics of all effects");
    screen
}

fn wrong_setup(result: &Answer) -> Screen {
    let what = "the record was not diagnosed";
    let mut screen = Screen::new(Standing::Bad, "SET-UP WRONG", what);
    let of = |stops: bool| result.setup.iter().filter(move |one| one.stops == stops);
    // What stops comes first.
    let labelled = of(true).map(|problem| ("what is wrong", problem));
    let labelled = labelled.chain(of(false).map(|problem| ("can be mended", problem)));
    for (label, problem) in labelled.take(PROBLEMS_SHOWN) {
        screen.fact(label, problem.text());
    }
    if result.setup.len() > PROBLEMS_SHOWN {
        let more = result.setup.len() - PROBLEMS_SHOWN;
        screen.fact("and", format!("{more} more"));
    }
    let mut lost = SetupKind::ALL.iter().filter(|kind| kind.loses_samples());
    let is_lost = lost.any(|kind| of(true).any(|problem| problem.kind.as_str() == kind.as_str()));
    let what = match is_lost {
        true => "record again, or diagnose the sound rows alone",
        false => "mend the record or its bench file",
    };
    let words = format!("{what}: docs/setup-checks.md lists what is checked");
    screen.fact("what to do", words);
    screen
}
