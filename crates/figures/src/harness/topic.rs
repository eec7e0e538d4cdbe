//! Topics of figures and their parts.

use super::context::Context;
use super::pages;
use super::sources::Sources;
use crate::error::Error;
use crate::figure::{Figure, table_of};

/// A topic: a page of figures.
pub(crate) struct Topic {
    /// Its name on the command line and of its page.
    pub(crate) name: &'static str,
    /// What it measures, in one line.
    pub(crate) about: &'static str,
    pub(crate) parts: &'static [Part],
}

/// A part of a topic: a section of its page.
pub(crate) struct Part {
    /// Its name on the command line and its heading.
    pub(crate) name: &'static str,
    /// What it measures, in one line.
    pub(crate) about: &'static str,
    /// Whether the gate has its small version; of others a slow section has it, or nothing.
    pub(crate) small: bool,
    /// What can move its figures, beside this program.
    pub(crate) sources: Sources,
    pub(crate) figures: fn(&Context) -> Result<Vec<Figure>, Error>,
    /// Text above the table; may be empty.
    pub(crate) introduction: fn(&[Figure]) -> String,
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
            let known: Vec<&str> = self.parts.iter().map(|part| part.name).collect();
            let known = known.join(", ");
            let topic = self.name;
            return Err(format!("{topic} has no part `{unknown}`; expected one of {known}").into());
        }
        let mut figures = Vec::new();
        for part in self.parts {
            let asked = parts.iter().any(|name| name == part.name);
            if !asked && (!parts.is_empty() || (context.is_small() && !part.small)) {
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
        let names: Vec<&str> = self.parts.iter().map(|part| part.name).collect();
        let introduction = (part.introduction)(figures);
        let table = table_of(figures);
        let table = [introduction.trim_end(), &table].join("\n\n");
        let body = pages::section(part, command, table.trim_start())?;
        pages::write_section(self.name, part.name, &names, &body)
    }
}
