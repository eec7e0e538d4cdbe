//! Origin of an answer.

use std::collections::BTreeMap;

use gyrocal_document::{Fact, Origin, OriginFile, Part, Screen, Section};
use gyrocal_record::{Input, Manifest};
use gyrocal_words::counted;

/// Keys of an identification that stand first, in this order.
const FIRST: [&str; 9] = [
    "report_number",
    "unit",
    "serial_number",
    "serial_numbers",
    "laboratory",
    "place",
    "operator",
    "date",
    "time",
];

/// How many of these keys stand in the foot of each page.
const IN_FOOT: usize = 4;

/// Program, command, files and identification of a manifest.
fn origin(manifest: &Manifest) -> Origin {
    let program = format!("{} {}", manifest.program, manifest.version);
    let mut facts: BTreeMap<(usize, &str), Vec<&str>> = BTreeMap::new();
    for (key, value) in manifest.inputs.iter().flat_map(|one| &one.identification) {
        let place = FIRST.iter().position(|first| first == key);
        let values = facts
            .entry((place.unwrap_or(FIRST.len()), key))
            .or_default();
        // Bench files of several records differ in some of them.
        if !values.contains(&&**value) {
            values.push(value);
        }
    }
    let in_foot = facts.keys().filter(|(place, _)| *place < IN_FOOT).count();
    let facts = facts.iter().map(|((_, key), values)| Fact {
        label: key.replace('_', " "),
        words: values.join("; "),
    });
    let identification: Vec<Fact> = facts.collect();
    let foot = identification[..in_foot].iter();
    let mut foot: Vec<String> = foot
        .map(|one| format!("{} {}", one.label, one.words))
        .collect();
    foot.push(program.clone());
    if !manifest.model_hash.is_empty() {
        foot.push(format!("model {}", manifest.model_hash));
    }
    Origin {
        identification,
        foot: foot.join(" · "),
        program,
        model_hash: manifest.model_hash.clone(),
        seed: manifest.seed.to_string(),
        command: manifest.command.clone(),
        files: manifest
            .inputs
            .iter()
            .map(|input| OriginFile {
                path: input.path.clone(),
                sha256: input.sha256.clone(),
            })
            .collect(),
    }
}

/// The page of an answer: name and size of what was examined, its first screen and its sections.
pub(crate) fn part(
    manifest: &Manifest,
    name: String,
    size: String,
    first: Screen,
    sections: Vec<Section>,
) -> Part {
    Part {
        name,
        size,
        first,
        sections,
        origin: origin(manifest),
    }
}

/// Name of the file of an input, without its folders.
pub(crate) fn file_name(manifest: &Manifest, place: usize, otherwise: &str) -> String {
    let input = manifest.inputs.get(place);
    let name = input.and_then(|input| input.path.rsplit(['/', '\\']).next());
    name.unwrap_or(otherwise).to_owned()
}

/// Name of a record, the first file, or the number of several.
pub(crate) fn record_name(manifest: &Manifest, several: usize) -> String {
    match several {
        0 => file_name(manifest, 0, "record"),
        several => counted(several, "record"),
    }
}

/// Files by name: the first, and how many follow.
pub(crate) fn named(files: &[Input]) -> String {
    match files {
        [] => String::new(),
        [one] => one.path.clone(),
        [first, rest @ ..] => format!("{} and {} further logs", first.path, rest.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_identifies_a_run_is_told_once_and_in_order() {
        let bench = |facts: &[(&str, &str)]| {
            let facts = facts.iter();
            Input {
                identification: facts
                    .map(|(key, value)| ((*key).to_owned(), (*value).to_owned()))
                    .collect(),
                ..Input::default()
            }
        };
        let manifest = Manifest {
            program: "gyrocal".to_owned(),
            version: "1.2.3".to_owned(),
            model_hash: "abc".to_owned(),
            inputs: vec![
                Input::default(),
                bench(&[("chamber", "2"), ("date", "2026-03-01"), ("unit", "P-7")]),
                bench(&[
                    ("date", "2026-03-02"),
                    ("report_number", "R 17"),
                    ("unit", "P-7"),
                ]),
            ],
            ..Manifest::default()
        };
        let found = origin(&manifest);
        let facts = found.identification.iter();
        let facts: Vec<_> = facts.map(|one| (&*one.label, &*one.words)).collect();
        let expected = [
            ("report number", "R 17"),
            ("unit", "P-7"),
            ("date", "2026-03-01; 2026-03-02"),
            ("chamber", "2"),
        ];
        assert_eq!(facts, expected);
        assert_eq!(
            found.foot,
            "report number R 17 · unit P-7 · gyrocal 1.2.3 · model abc"
        );
    }
}
