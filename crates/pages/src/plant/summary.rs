//! The first screen of a diagnosis of a plant.

use gyrocal_answer::{AlternativeKind, Answer, Finding, OutputError, Verdict};
use gyrocal_report::page::{Card, Cell, Column, Summary, Table, Tone};
use gyrocal_statistics::format;
use gyrocal_words::counted;

use super::rms;
use crate::words::{capitalised, listed};

/// Alternatives named on the first screen.
const ALTERNATIVES: usize = 3;

/// Parameters named there.
const PARAMETERS: usize = 6;

pub(super) fn summary(answer: &Answer) -> Summary {
    let (tone, headline) = verdict(answer);
    Summary {
        tone,
        headline,
        sentence: gyrocal_words::plant::verdict(answer),
        cards: vec![
            cause(answer),
            alternatives(answer),
            gain(answer),
            parameters(answer),
            next(answer),
        ],
    }
}

fn verdict(answer: &Answer) -> (Tone, String) {
    let effects: Vec<&str> = answer
        .findings
        .iter()
        .map(|one| one.effect.as_str())
        .collect();
    let lacks = match &*effects {
        [_, _, _, _, ..] => format!("Model lacks {} effects", effects.len()),
        few => format!("Model lacks {}", listed(few)),
    };
    match answer.verdict {
        Verdict::Clean => (Tone::Good, "No model mismatch detected".to_owned()),
        Verdict::Unexplained => (
            Tone::Bad,
            "Unexplained: the catalogue has no term for it".to_owned(),
        ),
        Verdict::NotSettled if effects.is_empty() => (
            Tone::Bad,
            "Not settled: the search ended at its budget of work".to_owned(),
        ),
        Verdict::NotSettled => (Tone::Bad, format!("Not settled. {lacks}")),
        _ => (Tone::Found, lacks),
    }
}

fn cause(answer: &Answer) -> Card {
    let columns = 5;
    let Some(first) = answer.findings.first() else {
        let strongest = answer.ranking.first().map(|first| {
            format!(
                "The strongest is {}, statistic {:.1}; detection begins at {:.1}.",
                first.effect,
                first.statistic.max(0.0),
                answer.threshold.unwrap_or_default()
            )
        });
        let unmodelled = answer.remainder.unmodelled.iter();
        let tested = counted(answer.ranking.len(), "effect");
        return Card {
            title: "Tested".to_owned(),
            main: match answer.is_settled() {
                true => format!("None of {tested} is significant"),
                false => "Not to the end: nothing is named".to_owned(),
            },
            text: unmodelled
                .map(gyrocal_words::plant::unmodelled)
                .chain(strongest)
                .collect(),
            columns,
            ..Card::default()
        };
    };
    let mut text = vec![format!(
        "{:.1} sigma, {} after correction for the search",
        first.z,
        gyrocal_words::plant::probability(first)
    )];
    if answer.findings.len() > 1 {
        let others = answer.findings[1..].iter();
        let others = others.map(|one| format!("{} ({:.1} sigma)", one.effect, one.z));
        text.push(format!("Also: {}", others.collect::<Vec<_>>().join("; ")));
    }
    Card {
        title: match answer.findings.len() {
            1 => "Cause".to_owned(),
            count => format!("First of {count} causes"),
        },
        main: capitalised(&first.name),
        number: size(first),
        text,
        columns,
        ..Card::default()
    }
}

fn size(found: &Finding) -> String {
    let sizes: Vec<String> = found
        .parameters
        .iter()
        .map(gyrocal_words::plant::parameter)
        .collect();
    format!("{}: {}", found.effect, sizes.join(", "))
}

fn alternatives(answer: &Answer) -> Card {
    let mut card = Card {
        title: "What else it might be".to_owned(),
        columns: 4,
        ..Card::default()
    };
    let Some(first) = answer.findings.first() else {
        "What could go undetected".clone_into(&mut card.title);
        card.main = match answer.not_searched.len() {
            _ if !answer.is_settled() => "Not settled".to_owned(),
            0 => "Every effect was tested".to_owned(),
            count => counted(count, "effect"),
        };
        if !answer.not_searched.is_empty() {
            let reason = "Not tested: listed under What cannot be told apart.";
            card.text.push(reason.to_owned());
        }
        return card;
    };
    let equal = first.equivalents();
    card.text
        .extend(equal.map(|id| format!("{id}: exact equivalent")));
    let rivals = first.of_kind(AlternativeKind::NotExcluded);
    let rivals: Vec<String> = rivals
        .map(|other| {
            format!(
                "{}: {}",
                other.effect,
                gyrocal_words::plant::likelihood(other)
            )
        })
        .collect();
    let more = rivals.len().saturating_sub(ALTERNATIVES);
    card.text.extend(rivals.into_iter().take(ALTERNATIVES));
    if more > 0 {
        card.text.push(format!("and {more} more"));
    }
    if card.text.is_empty() {
        let words = match answer.is_settled() {
            true => "Nothing of the catalogue",
            false => "Nothing else that was compared",
        };
        words.clone_into(&mut card.main);
    }
    let probability = match first.none_of_these {
        Some(none) => format!("{} %", format::short(100.0 * none, 2)),
        None => "not estimated".to_owned(),
    };
    let unlisted = format!("Outside of the catalogue: probability {probability}");
    card.text.push(unlisted);
    card
}

fn gain(answer: &Answer) -> Card {
    let mut card = Card {
        title: "Open-loop error".to_owned(),
        columns: 3,
        ..Card::default()
    };
    let Some(first) = answer.open_loop.first() else {
        return card;
    };
    let has_findings = answer.has_findings();
    if has_findings {
        "Gain".clone_into(&mut card.title);
    }
    let amount = |error: &OutputError| match has_findings {
        true => format!(
            "{} → {}",
            rms(error.nominal, "1"),
            rms(error.extended, &error.unit)
        ),
        false => rms(error.nominal, &error.unit),
    };
    card.main = amount(first);
    card.number = format!("open-loop error of {}, rms", first.output);
    let others = answer.open_loop[1..].iter();
    card.text = others
        .map(|error| format!("{}: {}", error.output, amount(error)))
        .collect();
    let later = answer.gain.as_ref();
    if let Some(later) = later.and_then(|gain| gain.validation.as_ref()) {
        let nats = format!("later record: {:+.1} nats", later.log_score_nats);
        card.text.push(nats.replace('-', "−"));
        let errors = later.open_loop.iter();
        card.text
            .extend(errors.map(|error| format!("{} there: {}", error.output, amount(error))));
    }
    card
}

fn parameters(answer: &Answer) -> Card {
    let number = |head: &str| Column {
        head: head.to_owned(),
        is_number: true,
    };
    let word = |head: &str| Column {
        head: head.to_owned(),
        is_number: false,
    };
    let cell = |value: f64, sigma: f64| {
        let [value, sigma] = format::estimate(value, sigma);
        Cell::from(format!("{value} ± {sigma}").replace('-', "−"))
    };
    let has_findings = answer.has_findings();
    let mut columns = vec![
        word("parameter"),
        number("declared"),
        number("nominal model"),
    ];
    if has_findings {
        columns.push(number("with what was found"));
    }
    columns.push(word("unit"));
    let all = answer.coefficients.iter();
    let all = all.flat_map(|all| all.declared.iter().zip(all.nominal.iter().zip(all.best())));
    let rows = all.take(PARAMETERS).map(|(declared, (nominal, best))| {
        let mut row = vec![
            Cell::from(nominal.name.clone()),
            Cell::from(format::short(*declared, 4).replace('-', "−")),
            cell(nominal.estimate, nominal.sigma),
        ];
        if has_findings {
            row.push(cell(best.estimate, best.sigma));
        }
        row.push(Cell::from(nominal.unit.clone()));
        row
    });
    Card {
        title: "Parameters".to_owned(),
        table: Some(Table {
            title: String::new(),
            rows: rows.collect(),
            columns,
        }),
        columns: 8,
        ..Card::default()
    }
}

/// What to do next.
fn next(answer: &Answer) -> Card {
    let text = match answer.verdict {
        Verdict::Clean => {
            "Nothing to add to the equations. What could go undetected depends on how the inputs move: an effect \
             that is not excited does not show."
        }
        _ if !answer.search_complete => {
            "The search ended at its budget of work: diagnose a part of the record, which takes less of it."
        }
        _ if answer.findings.is_empty() => {
            "No term of the catalogue explains it: look at the residual, and declare a term of your own with \
             `effect()` in the script."
        }
        _ if answer.later_record.is_none() => {
            "Measure the gain on a second record with --validate, then write the terms into the equations with \
             `extend`."
        }
        _ => "Write the terms into the equations with `extend`, and derive the plant again.",
    };
    Card {
        title: "Next".to_owned(),
        text: vec![text.to_owned()],
        columns: 4,
        ..Card::default()
    }
}
