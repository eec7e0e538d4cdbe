//! Topics of figures and their parts.

use serde::Deserialize;

use super::context::Context;
use super::pages;
use super::sources::Sources;
use crate::error::Error;
use crate::figure::{Figure, table_of};

/// What measures the figures of a part.
pub(crate) type Measure = fn(&Context) -> Result<Vec<Figure>, Error>;

/// Makes the text above a table from its figures.
pub(crate) type Introduce = fn(&[Figure]) -> String;

/// A topic: a page of figures.
#[derive(Deserialize)]
pub(crate) struct Topic {
    /// Its name on the command line and of its page.
    pub(crate) name: String,
    /// What it measures, in one line.
    pub(crate) about: String,
    #[serde(rename = "part")]
    pub(crate) parts: Vec<Part>,
}

/// A part of a topic: a section of its page.
#[derive(Deserialize)]
pub(crate) struct Part {
    /// Its name on the command line and its heading.
    pub(crate) name: String,
    /// What it measures, in one line.
    pub(crate) about: String,
    /// Whether it is left to a slow section, or to nothing: the gate has the small version of others.
    #[serde(default)]
    pub(crate) slow: bool,
    /// What can move its figures, beside this program.
    #[serde(flatten)]
    pub(crate) sources: Sources,
    #[serde(skip, default = "unmeasured")]
    pub(crate) figures: Measure,
    #[serde(skip)]
    pub(crate) introduction: Option<Introduce>,
}

/// Measures nothing.
fn unmeasured() -> Measure {
    |_| Ok(Vec::new())
}

impl Topic {
    /// The figures of the parts of these names, of all parts without a name; `told` has those of each part as soon
    /// as they are there.
    pub(crate) fn figures(
        &self,
        context: &Context,
        parts: &[String],
        mut told: impl FnMut(&Part, &[Figure]) -> Result<(), Error>,
    ) -> Result<Vec<Figure>, Error> {
        if let Some(unknown) = parts.iter().find(|name| self.part(name).is_none()) {
            let known: Vec<&str> = self.parts.iter().map(|part| &*part.name).collect();
            let known = known.join(", ");
            let topic = &self.name;
            return Err(format!("{topic} has no part `{unknown}`; expected one of {known}").into());
        }
        let mut figures = Vec::new();
        for part in &self.parts {
            let asked = parts.contains(&part.name);
            if !asked && (!parts.is_empty() || (context.is_small() && part.slow)) {
                continue;
            }
            let of_part = (part.figures)(context)?;
            told(part, &of_part)?;
            figures.extend(of_part);
        }
        Ok(figures)
    }

    pub(crate) fn part(&self, name: &str) -> Option<&Part> {
        self.parts.iter().find(|part| part.name == name)
    }

    /// Writes the section of a part into the page of the topic.
    pub(crate) fn write(
        &self,
        part: &Part,
        command: &str,
        figures: &[Figure],
    ) -> Result<(), Error> {
        let names: Vec<&str> = self.parts.iter().map(|part| &*part.name).collect();
        let introduction = part.introduction.map_or_else(String::new, |of| of(figures));
        let table = table_of(figures);
        let table = [introduction.trim_end(), &table].join("\n\n");
        let body = pages::section(part, command, table.trim_start())?;
        pages::write_section(&self.name, &part.name, &names, &body)
    }
}
