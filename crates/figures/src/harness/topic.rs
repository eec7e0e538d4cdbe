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
    #[serde(skip, default = "nothing")]
    pub(crate) figures: Measure,
    #[serde(skip)]
    pub(crate) introduction: Option<Introduce>,
}

fn nothing() -> Measure {
    |_| Ok(Vec::new())
}

impl Topic {
    /// The figures of the parts of these names, of all parts without a name.
    pub(crate) fn figures(
        &self,
        context: &Context,
        parts: &[String],
    ) -> Result<Vec<Figure>, Error> {
        let known = self.names();
        if let Some(unknown) = parts.iter().find(|name| !known.contains(&name.as_str())) {
            let (topic, known) = (&self.name, known.join(", "));
            return Err(format!("{topic} has no part `{unknown}`; expected one of {known}").into());
        }
        let mut figures = Vec::new();
        for part in &self.parts {
            let asked = parts.contains(&part.name);
            if !asked && (!parts.is_empty() || (context.is_small() && part.slow)) {
                continue;
            }
            figures.extend((part.figures)(context)?);
        }
        Ok(figures)
    }

    fn names(&self) -> Vec<&str> {
        self.parts.iter().map(|part| &*part.name).collect()
    }

    /// Writes the section of a part into the page of the topic.
    pub(crate) fn write(
        &self,
        part: &Part,
        command: &str,
        figures: &[Figure],
    ) -> Result<(), Error> {
        let introduction = part.introduction.map_or_else(String::new, |of| of(figures));
        let table = table_of(figures);
        let table = [introduction.trim_end(), &table].join("\n\n");
        let body = pages::section(part, command, table.trim_start())?;
        pages::write_section(&self.name, &part.name, &self.names(), &body)
    }
}
