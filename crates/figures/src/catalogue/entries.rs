//! Entries of the catalogue as Markdown.

use gyrocal::effect::Enters;
use gyrocal::{EFFECTS, Effect};
use gyrocal_diagnosis::prose::explained;

use super::signature;

/// Part of the page: the part of the model that its effects enter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Chapter {
    Gyros,
    Accelerometers,
    Attitude,
    Site,
    Clock,
    Filter,
}

impl Chapter {
    const ALL: [Self; 6] = [
        Self::Gyros,
        Self::Accelerometers,
        Self::Attitude,
        Self::Site,
        Self::Clock,
        Self::Filter,
    ];

    fn of(effect: &Effect) -> Self {
        match effect.enters {
            Enters::Rates(_) => Self::Gyros,
            Enters::Outputs(_) => Self::Accelerometers,
            Enters::States(_) => Self::Attitude,
            Enters::Inputs(_) => Self::Site,
            Enters::Time => Self::Clock,
            Enters::Filter => Self::Filter,
        }
    }

    fn title(self) -> &'static str {
        match self {
            Self::Gyros => "Gyros",
            Self::Accelerometers => "Accelerometers",
            Self::Attitude => "Attitude",
            Self::Site => "Site",
            Self::Clock => "Clock",
            Self::Filter => "Filter",
        }
    }
}

/// All entries, by the part of the model that they enter.
pub(super) fn of(families: &[&Effect]) -> String {
    let mut chapters = Vec::new();
    for chapter in Chapter::ALL {
        let members = families
            .iter()
            .filter(|effect| Chapter::of(effect) == chapter);
        let entries: Vec<String> = members.map(|effect| entry(effect)).collect();
        chapters.push(format!(
            "## {}\n\n{}",
            chapter.title(),
            entries.join("\n\n")
        ));
    }
    chapters.join("\n\n")
}

/// The entry of a family, by its first effect.
fn entry(first: &Effect) -> String {
    let screen = explained(first);
    let family = EFFECTS
        .iter()
        .filter(|effect| effect.family == first.family);
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
        let words = if letters(&fact.words) == letters(first.formula) {
            format!("`{}`", fact.words)
        } else {
            fact.words.clone()
        };
        text += &format!("| {} | {} |\n", fact.label, words.replace('|', "\\|"));
    }
    if signature::has_picture(first) {
        text += &format!(
            "\n![signature of {}](pictures/catalogue/{}.svg)",
            first.id, first.family
        );
    }
    text.trim_end().to_owned()
}
