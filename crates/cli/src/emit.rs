//! `gyrocal emit`: a filter as one Rust file.

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal_diagnosis::known_effects;
use gyrocal_document::{Screen, Standing};
use gyrocal_emit::{Emission, Extension, Number};
use gyrocal_record::{ModelFile, SourceText, module_name, printable_path};
use miette::Report;

use crate::numbers::{Choice, one_of};
use crate::outputs::refuse_overlap;
use crate::{Failure, Reply};

/// Write a filter as one self-contained Rust file.
///
/// The file needs `core` only. It has the sources of the libraries, the generated model, and tests with
/// the numbers that the libraries find: docs/embedding.md. Without a model file the filter is the nominal
/// one.
#[derive(Debug, Args)]
pub(crate) struct EmitArguments {
    /// Model file of an extended filter, as `gyrocal extend` writes it.
    #[arg(value_name = "NAME.model.toml", requires = "module")]
    model: Option<PathBuf>,
    /// The Rust module that a build derived from the model file: docs/extending.md.
    #[arg(long, value_name = "NAME.rs", requires = "model")]
    module: Option<PathBuf>,
    /// Number type.
    #[arg(long, value_parser = one_of(NUMBERS), default_value = "f32")]
    number: Number,
    /// Write the file (Rust).
    #[arg(long, value_name = "FILTER.rs")]
    out: PathBuf,
}

/// Number types of a filter.
const NUMBERS: &[Choice<Number>] = &[
    ("f32", "Single precision", Number::F32),
    ("f64", "Double precision", Number::F64),
];

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &EmitArguments) -> Result<Reply, Failure> {
    let files = [&arguments.model, &arguments.module];
    let inputs: Vec<&Path> = files.into_iter().flatten().map(PathBuf::as_path).collect();
    refuse_overlap(&inputs, &[("--out", Some(&arguments.out))])?;
    let number = arguments.number;
    let extended = match (&arguments.model, &arguments.module) {
        (Some(model), Some(module)) => {
            let text = SourceText::read(module)?.text().to_owned();
            Some((
                ModelFile::read(model, &known_effects())?,
                module_name(model)?,
                text,
            ))
        }
        _ => None,
    };
    let extension = extended.as_ref().map(|(model, name, text)| Extension {
        model,
        name,
        module: text,
    });
    let written = Emission { number, extension }.write();
    let text = written.map_err(|error| Failure::Work(Report::msg(error)))?;
    let effects = extended.map_or_else(Vec::new, |(model, _, _)| model.effects);
    let mut reply = Reply::of(screen(arguments, number, &effects), String::new());
    reply.outputs.stage(&arguments.out, text.as_bytes())?;
    Ok(reply)
}

fn screen(arguments: &EmitArguments, number: Number, effects: &[String]) -> Screen {
    let out = printable_path(&arguments.out);
    let what = format!("{out}: one file in {}, core only", number.name());
    let mut screen = Screen::new(Standing::Good, "FILTER", what);
    let estimated = match effects {
        [] => "the nine drift coefficients".to_owned(),
        effects => format!("the nine drift coefficients and {}", effects.join(", ")),
    };
    screen.fact("estimates", estimated);
    let rustc = "rustc --edition 2024";
    screen.fact("compile", format!("{rustc} --crate-type lib {out}"));
    let tests = format!("{rustc} -O --test -o filter_tests {out} && ./filter_tests");
    screen.fact("its tests", tests);
    screen.fact("what to do", "put it into a controller: docs/embedding.md");
    screen
}
