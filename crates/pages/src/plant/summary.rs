//! The first screen of a diagnosis of a plant.

use gyrocal_diagnosis::prose::counted;
use gyrocal_plant::answer::{Diagnosis, Found};
use gyrocal_report::page::{Card, Cell, Column, Summary, Table, Tone};
use gyrocal_statistics::format;

use super::with_unit;
use crate::words::{capitalised, listed};

/// Alternatives named on the first screen.
const ALTERNATIVES: usize = 3;

/// Parameters named there.
const PARAMETERS: usize = 6;

pub(super) fn summary(answer: &Diagnosis) -> Summary {
    let (tone, headline) = verdict(answer);
    Summary {
        tone,
        headline,
        sentence: answer.verdict(),
        cards: vec![
            cause(answer),
            alternatives(answer),
            gain(answer),
            parameters(answer),
            next(answer),
        ],
    }
}

fn verdict(answer: &Diagnosis) -> (Tone, String) {
    let effects: Vec<&str> = answer
        .findings
        .iter()
        .map(|one| one.effect.as_str())
        .collect();
    match &*effects {
        [] if answer.unexplained.is_empty() => {
            (Tone::Good, "No model mismatch detected".to_owned())
        }
        [] => (
            Tone::Bad,
            "Unexplained: the catalogue has no term for it".to_owned(),
        ),
        [_, _, _, _, ..] => (
            Tone::Found,
            format!("Model lacks {} effects", effects.len()),
        ),
        few => (Tone::Found, format!("Model lacks {}", listed(few))),
    }
}

fn cause(answer: &Diagnosis) -> Card {
    let columns = 5;
    let Some(first) = answer.findings.first() else {
        let strongest = answer.ranking.first().map(|first| {
            format!(
                "The strongest is {}, statistic {:.1}; detection begins at {:.1}.",
                first.effect,
                first.statistic.max(0.0),
                answer.threshold
            )
        });
        let unexplained = answer.unexplained.iter().map(|one| one.sentence());
        let tested = counted(answer.tested, "effect");
        return Card {
            title: "Tested".to_owned(),
            main: format!("None of {tested} is significant"),
            text: unexplained.chain(strongest).collect(),
            columns,
            ..Card::default()
        };
    };
    let mut text = vec![format!(
        "{:.1} sigma, {} after correction for the search",
        first.z,
        format::p_value(first.p_value)
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

fn size(found: &Found) -> String {
    let sizes: Vec<String> = found.sizes.iter().map(|size| size.words()).collect();
    format!("{}: {}", found.effect, sizes.join(", "))
}

fn alternatives(answer: &Diagnosis) -> Card {
    let mut card = Card {
        title: "What else it might be".to_owned(),
        columns: 4,
        ..Card::default()
    };
    let Some(first) = answer.findings.first() else {
        "What could go undetected".clone_into(&mut card.title);
        card.main = match answer.left_out.len() {
            0 => "Every effect was tested".to_owned(),
            count => counted(count, "effect"),
        };
        if !answer.left_out.is_empty() {
            let reason = "Not tested: listed under What cannot be told apart.";
            card.text.push(reason.to_owned());
        }
        return card;
    };
    let equal = first.equivalents.iter();
    card.text
        .extend(equal.map(|id| format!("{id}: exact equivalent")));
    let others = first.rivals.iter().take(ALTERNATIVES);
    card.text
        .extend(others.map(|(id, deficit)| format!("{id}: {deficit:.1} nats less likely")));
    let more = first.rivals.len().saturating_sub(ALTERNATIVES);
    if more > 0 {
        card.text.push(format!("and {more} more"));
    }
    if card.text.is_empty() {
        "Nothing of the catalogue".clone_into(&mut card.main);
    }
    card.text.extend(first.none_of_these.map(|none| {
        format!(
            "Outside of the catalogue: probability {} %",
            format::short(100.0 * none, 2)
        )
    }));
    card
}

fn gain(answer: &Diagnosis) -> Card {
    let mut card = Card {
        title: "Open-loop error".to_owned(),
        columns: 3,
        ..Card::default()
    };
    let Some(first) = answer.errors.first() else {
        return card;
    };
    let has_findings = answer.has_findings();
    if has_findings {
        "Gain".clone_into(&mut card.title);
    }
    let amount = |error: &gyrocal_plant::answer::OutputError| match has_findings {
        true => format!(
            "{} → {}",
            format::short(error.nominal, 3),
            with_unit(error.extended, &error.unit)
        ),
        false => with_unit(error.nominal, &error.unit),
    };
    card.main = amount(first);
    card.number = format!("open-loop error of {}, rms", first.output);
    let others = answer.errors[1..].iter();
    card.text = others
        .map(|error| format!("{}: {}", error.output, amount(error)))
        .collect();
    if let (Some(later), true) = (&answer.later_record, has_findings) {
        let nats = format!("later record: {:+.1} nats", later.gain_nats);
        card.text.push(nats.replace('-', "−"));
        let errors = later.errors.iter();
        card.text
            .extend(errors.map(|error| format!("{} there: {}", error.output, amount(error))));
    }
    card
}

fn parameters(answer: &Diagnosis) -> Card {
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
    let rows = answer.parameters.iter().take(PARAMETERS).map(|one| {
        let mut row = vec![
            Cell::from(one.name.clone()),
            Cell::from(format::short(one.declared, 4).replace('-', "−")),
            cell(one.nominal, one.nominal_sigma),
        ];
        if has_findings {
            row.push(cell(one.value, one.sigma));
        }
        row.push(Cell::from(one.unit.clone()));
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
fn next(answer: &Diagnosis) -> Card {
    let text = if !answer.has_findings() {
        "Nothing to add to the equations. What could go undetected depends on how the inputs move: an effect \
         that is not excited does not show."
    } else if answer.findings.is_empty() {
        "No term of the catalogue explains it: look at the residual, and declare a term of your own with \
         `effect()` in the script."
    } else if answer.later_record.is_none() {
        "Measure the gain on a second record with --validate, then write the terms into the equations with \
         `extend`."
    } else {
        "Write the terms into the equations with `extend`, and derive the plant again."
    };
    Card {
        title: "Next".to_owned(),
        text: vec![text.to_owned()],
        columns: 4,
        ..Card::default()
    }
}
