//! The first screen of a diagnosis.

use gyrocal_answer::{Answer, CoefficientShift, Coefficients, Finding, Gain, Parameter, Verdict};
use gyrocal_report::page::{Card, Cell, Column, Summary, Table, Tone};
use gyrocal_statistics::format;

use super::{found, limits};
use crate::words::{capitalised, listed, micro_g};

/// Alternatives named on the first screen.
const ALTERNATIVES: usize = 3;
/// A change of a coefficient from which on it is marked, in claimed sigmas.
const NOTABLE: f64 = 2.0;
/// Letters of proposals that a card of the first screen has room for.
const ROOM: usize = 300;

pub(super) fn summary(result: &Answer) -> Summary {
    // The first paragraph is on the record.
    let sentence = match gyrocal_words::diagnosis(result).into_iter().nth(1) {
        Some(gyrocal_document::Words::Paragraph(words)) => words,
        _ => String::new(),
    };
    let (tone, headline) = verdict(result);
    let mut cards = Vec::new();
    if result.verdict == Verdict::Setup {
        cards.push(setup(result));
    } else {
        cards.push(cause(result));
        cards.push(alternatives(result));
        cards.push(gain(result));
        cards.extend(
            result
                .coefficients
                .as_ref()
                .map(|all| coefficients(result, all)),
        );
        cards.push(limits::next_card(result));
    }
    Summary {
        tone,
        headline,
        sentence,
        cards,
    }
}

fn verdict(result: &Answer) -> (Tone, String) {
    match result.verdict {
        Verdict::Clean if result.hides_most() => (
            Tone::Found,
            "Too short to tell: most faults would not show".to_owned(),
        ),
        Verdict::Clean => (Tone::Good, "No model mismatch detected".to_owned()),
        Verdict::NotSettled => (
            Tone::Bad,
            format!("Not settled: {}", gyrocal_words::not_settled(result)),
        ),
        Verdict::EffectsFound => {
            let effects: Vec<&str> = found(result).iter().map(|one| &*one.effect).collect();
            let headline = match &*effects {
                [] => "The tested filter is not consistent".to_owned(),
                [_, _, _, _, ..] => format!("Fault found: {} effects", effects.len()),
                few => format!("Fault found: {}", listed(few)),
            };
            (Tone::Found, headline)
        }
        Verdict::Setup => (Tone::Bad, "Wrong set-up: not diagnosed".to_owned()),
        Verdict::Unexplained => (
            Tone::Bad,
            "Unexplained: the model does not fit the record".to_owned(),
        ),
    }
}

fn setup(result: &Answer) -> Card {
    Card {
        title: "What is wrong with the set-up".to_owned(),
        text: result.setup.iter().map(|problem| problem.text()).collect(),
        columns: 12,
        ..Card::default()
    }
}

fn cause(result: &Answer) -> Card {
    let found = found(result);
    let columns = 5;
    let Some(first) = found.first() else {
        return nothing(result, columns);
    };
    let size = first.parameters.first();
    let p = match first.p_value {
        Some(p) => format!("{} after correction for the search", format::p_value(p)),
        None => gyrocal_words::NO_P.to_owned(),
    };
    let mut text = vec![format!("{:.1} sigma, {p}{}", first.z, further(first))];
    if let [_, others @ ..] = &*found
        && !others.is_empty()
    {
        let others = others.iter().map(|one| {
            let size = one.parameters.first().map(value).unwrap_or_default();
            format!("{} {size} ({:.1} sigma)", one.effect, one.z)
        });
        text.push(format!("Also: {}", others.collect::<Vec<_>>().join("; ")));
    }
    Card {
        title: match found.len() {
            1 => "Cause".to_owned(),
            count => format!("Strongest of {count} causes"),
        },
        main: capitalised(&first.name),
        number: size
            .map(|size| format!("{} = {}", first.effect, value(size)))
            .unwrap_or_default(),
        text,
        columns,
        ..Card::default()
    }
}

/// Parameters of a finding beside its size.
fn further(finding: &Finding) -> String {
    match finding.parameters.get(1..) {
        Some(further) if !further.is_empty() => {
            format!("; {}", gyrocal_words::parameter_values(further))
        }
        _ => String::new(),
    }
}

fn value(parameter: &Parameter) -> String {
    let unnamed = Parameter {
        name: String::new(),
        ..parameter.clone()
    };
    gyrocal_words::parameter_values(&[unnamed])
        .trim_start()
        .to_owned()
}

/// The first tile without a named cause.
fn nothing(result: &Answer, columns: usize) -> Card {
    let tested = gyrocal_words::counted(result.ranking.len(), "effect");
    let strongest = result
        .ranking
        .first()
        .zip(result.threshold)
        .map(|(first, threshold)| {
            format!(
                "The strongest is {}, statistic {:.1}; detection begins at {threshold:.1}.",
                first.effect,
                first.statistic.max(0.0)
            )
        });
    let (title, main) = match result.verdict {
        Verdict::Unexplained => (
            "Cause",
            "None of the catalogue explains the residual".to_owned(),
        ),
        Verdict::NotSettled => ("Tested", "Not to the end: nothing is named".to_owned()),
        _ => ("Tested", format!("None of {tested} is significant")),
    };
    let description = &result.remainder.description;
    let mut text: Vec<String> = strongest.into_iter().collect();
    if !description.is_empty() {
        text.push(capitalised(description));
    }
    Card {
        title: title.to_owned(),
        main,
        text,
        columns,
        ..Card::default()
    }
}

fn alternatives(result: &Answer) -> Card {
    let mut text = Vec::new();
    let mut main = String::new();
    let mut title = "What else it might be";
    let found = found(result);
    match found.first() {
        None => {
            title = "What could go undetected";
            main = match result.not_searched.len() {
                _ if !result.is_settled() => "Not settled".to_owned(),
                0 => "Nothing of typical size".to_owned(),
                count => gyrocal_words::counted(count, "effect"),
            };
            text.push(match result.not_searched.len() {
                _ if !result.is_settled() => {
                    "Effects were not compared to the end, or what is left is not white.".to_owned()
                }
                0 => "Every effect of the catalogue would show.".to_owned(),
                _ => {
                    "Not tested, or not visible in this record at typical size: listed under What \
                      cannot be told apart."
                        .to_owned()
                }
            });
        }
        Some(first) => {
            let others = first.alternatives.iter().take(ALTERNATIVES);
            let others: Vec<String> = others
                .map(|other| format!("{}: {}", other.effect, gyrocal_words::likelihood(other)))
                .collect();
            let more = first.alternatives.len().saturating_sub(ALTERNATIVES);
            text.extend(others);
            if more > 0 {
                text.push(format!("and {more} more"));
            }
            let probability = match first.none_of_these {
                Some(none) => format!("{} %", format::short(100.0 * none, 2)),
                None => "not estimated".to_owned(),
            };
            text.push(format!(
                "Outside of the catalogue: probability {probability}"
            ));
            if first.alternatives.is_empty() {
                main = gyrocal_words::may_also_be(result);
                if result.is_settled() {
                    let sure = first.coverage.map_or_else(String::new, |coverage| {
                        format!(" at {}", format::percent(coverage))
                    });
                    let excluded = format!("All alternatives that were tested are excluded{sure}.");
                    text.insert(0, excluded);
                }
            }
        }
    }
    Card {
        title: title.to_owned(),
        main,
        text,
        columns: 4,
        ..Card::default()
    }
}

fn gain(result: &Answer) -> Card {
    let mut card = Card {
        title: "Gain".to_owned(),
        columns: 3,
        ..Card::default()
    };
    match &result.gain {
        Some(gain) => with_gain(&mut card, gain),
        None => {
            card.title = "Open-loop error".to_owned();
            if let Some(residuals) = &result.residuals {
                let squares = residuals.free_run_rms_g.map(|rms| rms * rms);
                let rms_g = (squares.iter().sum::<f64>() / 3.0).sqrt();
                card.main = micro_g(rms_g);
                card.text = vec!["rms of the simulation without measurement updates".to_owned()];
            }
        }
    }
    card
}

fn with_gain(card: &mut Card, gain: &Gain) {
    if let Some(rms) = gain.free_run_rms_g {
        card.main = format!(
            "{} → {}",
            micro_g(rms.before).trim_end_matches(" µg"),
            micro_g(rms.after)
        );
        card.number = "open-loop error".to_owned();
        card.text = vec![format!("accelerometer noise {}", micro_g(rms.noise))];
    }
    let blocks = gain.block_log_score_nats.iter().flatten();
    let better = blocks.filter(|nats| **nats > 0.0);
    card.text.push(format!(
        "{:+.1} nats in cross-validation, better in {} of {} blocks",
        gain.cross_validated_log_score_nats,
        better.count(),
        gain.block_log_score_nats.len()
    ));
    let later = gain.validation.as_ref();
    let error = later.and_then(|later| later.compensation.as_ref());
    card.text.extend(error.map(|error| {
        format!(
            "later record: {:.2} → {:.2} arcmin after {:.0} h",
            error.nominal_arcmin, error.extended_arcmin, error.after_h
        )
    }));
}

fn coefficients(result: &Answer, all: &Coefficients) -> Card {
    let number = |head: &str| Column {
        head: head.to_owned(),
        is_number: true,
    };
    let word = |head: &str| Column {
        head: head.to_owned(),
        is_number: false,
    };
    let cell = |estimate: f64, sigma: f64| {
        let [estimate, sigma] = format::estimate(estimate, sigma);
        Cell::from(format!("{estimate} ± {sigma}").replace('-', "−"))
    };
    let mut columns = vec![word("coefficient"), number("nominal model")];
    let extended = all
        .extended
        .as_ref()
        .filter(|one| one.len() == all.nominal.len());
    if extended.is_some() {
        columns.extend([number("extended model"), number("change, σ")]);
    }
    columns.push(word("unit"));
    let shifts = result.gain.as_ref().map(|gain| &*gain.coefficient_shift);
    let rows = all.nominal.iter().enumerate().map(|(place, nominal)| {
        let mut row = vec![
            Cell::from(nominal.name.clone()),
            cell(nominal.estimate, nominal.sigma),
        ];
        if let Some(extended) = extended {
            row.push(cell(extended[place].estimate, extended[place].sigma));
            row.push(change(shifts.unwrap_or_default(), &nominal.name));
        }
        row.push(Cell::from(nominal.unit.clone()));
        row
    });
    Card {
        title: "Drift coefficients".to_owned(),
        table: Some(Table {
            title: String::new(),
            rows: rows.collect(),
            columns,
        }),
        columns: 8,
        ..Card::default()
    }
}

/// The change of a coefficient in claimed sigmas.
pub(super) fn change(shifts: &[CoefficientShift], name: &str) -> Cell {
    let shift = shifts.iter().find(|shift| shift.coefficient == name);
    Cell {
        text: shift.map_or_else(String::new, |shift| {
            format!("{:+.1}", shift.in_sigmas).replace('-', "−")
        }),
        strong: shift.is_some_and(|shift| shift.in_sigmas.abs() >= NOTABLE),
    }
}

/// The first of some proposals, separated by semicolons, as many as a card has room for; the section of the
/// next run has all.
pub(super) fn first_of(proposals: &str) -> String {
    let mut text = String::new();
    for proposal in proposals.split("; ") {
        if !text.is_empty() {
            if text.chars().count() + proposal.chars().count() > ROOM {
                return text + "; and others below.";
            }
            text.push_str("; ");
        }
        text.push_str(proposal);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_card_has_whole_proposals() {
        let one =
            "a second run from another initial attitude, which does far more than a longer run";
        let all = [one; 3].join("; ") + ".";
        assert!(all.len() <= ROOM);
        assert_eq!(first_of(&all), all);
        let more = [one; 5].join("; ") + ".";
        let shown = [one; 3].join("; ") + "; and others below.";
        assert_eq!(first_of(&more), shown);
        // The first stands whole, however long it is.
        let long = "x".repeat(2 * ROOM);
        assert_eq!(first_of(&long), long);
    }
}
