//! Entries of the catalogue as Markdown.

use gyrocal::effect::Enters;
use gyrocal::{EFFECTS, Effect};
use gyrocal_words::explained;

use super::signature;

/// Title of a chapter, and what is in it.
type Chapter = (&'static str, fn(&Enters) -> bool);

/// Chapters of the page: the parts of the model that effects enter.
const CHAPTERS: [Chapter; 6] = [
    ("Gyros", |enters| matches!(enters, Enters::Rates(_))),
    ("Accelerometers", |enters| {
        matches!(enters, Enters::Outputs(_))
    }),
    ("Attitude", |enters| matches!(enters, Enters::States(_))),
    ("Site", |enters| matches!(enters, Enters::Inputs(_))),
    ("Clock", |enters| matches!(enters, Enters::Time)),
    ("Filter", |enters| matches!(enters, Enters::Filter)),
];

/// All entries, by chapter.
pub(super) fn of(families: &[&Effect]) -> String {
    let chapters = CHAPTERS.map(|(title, is_of)| {
        let members = families.iter().filter(|effect| is_of(&effect.enters));
        let entries: Vec<String> = members.map(|effect| entry(effect)).collect();
        format!("## {title}\n\n{}", entries.join("\n\n"))
    });
    chapters.join("\n\n")
}

/// The entry of a family, by its first effect.
fn entry(first: &Effect) -> String {
    let screen = explained(first);
    let family = EFFECTS.iter().filter(|of| of.family == first.family);
    let ids: Vec<String> = family.map(|effect| format!("`{}`", effect.id)).collect();
    let mut text = format!(
        "### `{}`\n\n`{}`: {}.\n\n| | |\n|---|---|\n",
        first.family, first.id, screen.what
    );
    if ids.len() > 1 {
        text += &format!("| family | {} |\n", ids.join(", "));
    }
    let letters = |words: &str| words.replace(' ', "");
    for fact in &screen.facts {
        let words = match letters(&fact.words) == letters(first.formula) {
            true => format!("`{}`", fact.words),
            false => fact.words.clone(),
        };
        text += &format!("| {} | {} |\n", fact.label, words.replace('|', "\\|"));
    }
    if signature::has_picture(first) {
        let (id, family) = (first.id, first.family);
        text += &format!("\n![signature of {id}](pictures/catalogue/{family}.svg)");
    }
    text.trim_end().to_owned()
}
