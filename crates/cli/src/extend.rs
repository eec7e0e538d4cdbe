//! `gyrocal extend`: the model file of an extended filter from a diagnosis.

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal::generated::MODEL_HASH;
use gyrocal_answer::read_platform;
use gyrocal_diagnosis::{
    ExtensionError, ModelExtension, extension_by, extension_of, known_effects, with_members,
};
use gyrocal_document::{Screen, Standing};
use gyrocal_record::{ExtensionReport, Gyros, SCHEMA_VERSION, printable_path};
use miette::MietteDiagnostic;

use crate::numbers::{Choice, one_of};
use crate::outputs::{manifest, refuse_overlap};
use crate::{Failure, Reply};

/// Write the model file of an extended filter.
///
/// Takes the findings of `gyrocal diagnose --json`, or a list of effects of the catalogue. A
/// package that embeds a filter derives its model from the file when it is built:
/// docs/extending.md.
#[derive(Debug, Args)]
pub(crate) struct ExtendArguments {
    /// Result of `gyrocal diagnose --json`.
    #[arg(required_unless_present = "effects", conflicts_with = "effects")]
    diagnosis: Option<PathBuf>,
    /// Effects of the catalogue instead of a diagnosis.
    #[arg(long, value_name = "ID,ID", value_delimiter = ',')]
    effects: Option<Vec<String>>,
    /// What the gyros of the listed effects are fixed to; a diagnosis says it itself.
    #[arg(long, value_parser = one_of(GYROS), default_value = "platform", conflicts_with = "diagnosis")]
    gyros: Gyros,
    /// Members of the confidence sets to take in the place of the effects that the diagnosis names; without
    /// initial values, which the diagnosis gives for the named ones only.
    #[arg(
        long,
        value_name = "ID,ID",
        value_delimiter = ',',
        conflicts_with = "effects"
    )]
    member: Vec<String>,
    /// Write the model file (TOML); its name up to the first dot is that of the model.
    #[arg(long, value_name = "NAME.model.toml")]
    out: PathBuf,
    /// Write the result for programs (JSON).
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,
}

/// What gyros are fixed to.
const GYROS: &[Choice<Gyros>] = &[
    (
        "platform",
        "The platform that they stabilise",
        Gyros::Platform,
    ),
    (
        "strapdown",
        "A body: a platform is computed from their outputs",
        Gyros::Strapdown,
    ),
];

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &ExtendArguments) -> Result<Reply, Failure> {
    let inputs: Vec<&Path> = arguments.diagnosis.iter().map(PathBuf::as_path).collect();
    let (out, json) = (Some(&*arguments.out), arguments.json.as_deref());
    refuse_overlap(&inputs, &[("--out", out), ("--json", json)])?;
    let mut is_settled = true;
    let extension = match &arguments.diagnosis {
        Some(path) => {
            let diagnosis = read_platform(path)?;
            is_settled = diagnosis.is_settled();
            with_members(diagnosis, &arguments.member)
                .and_then(|diagnosis| extension_of(&diagnosis))
                .map_err(|error| not_extended(&printable_path(path), &error))?
        }
        None => {
            let listed = arguments.effects.as_deref().unwrap_or_default();
            extension_by(listed, arguments.gyros)
                .map_err(|error| not_extended("--effects", &error))?
        }
    };
    let mut screen = summary(arguments, &extension);
    if !is_settled {
        let words = "the diagnosis did not settle these names: other effects may be the cause";
        screen.fact("not settled", words);
    }
    let mut shown = Reply::of(screen, String::new());
    let text = extension.model.to_toml(&arguments.out, &known_effects())?;
    shown.outputs.stage(&arguments.out, text.as_bytes())?;
    shown.write_json(json, &report(&extension, &inputs)?)?;
    Ok(shown)
}

/// The failure of a diagnosis or a list, with the advice.
fn not_extended(of: &str, error: &ExtensionError) -> Failure {
    let mut told = MietteDiagnostic::new(format!("{of}: {error}"));
    told.help = error.advice();
    Failure::Work(told.into())
}

fn report(extension: &ModelExtension, inputs: &[&Path]) -> Result<ExtensionReport, Failure> {
    Ok(ExtensionReport {
        schema_version: SCHEMA_VERSION,
        manifest: manifest(MODEL_HASH, 0, inputs)?,
        strapdown: extension.model.gyros == Gyros::Strapdown,
        effects: extension.model.effects.clone(),
        left_out: extension.left_out.clone(),
    })
}

fn summary(arguments: &ExtendArguments, extension: &ModelExtension) -> Screen {
    let model = &extension.model;
    let (out, effects) = (printable_path(&arguments.out), model.effects.join(", "));
    let what = format!("{out}: the nine drift coefficients and {effects}");
    let mut screen = Screen::new(Standing::Good, "MODEL FILE", what);
    if model.gyros == Gyros::Strapdown {
        screen.fact(
            "gyros",
            "fixed to a body: coefficients and effects are errors of the outputs of the instruments, in their \
             own axes",
        );
    }
    for estimate in &model.estimates {
        let words = format!(
            "{} starts at {:.3e} ± {:.1e}",
            estimate.parameter, estimate.value, estimate.sigma
        );
        screen.fact("start value", words);
    }
    let shapes = model.shapes.iter();
    let shapes = shapes.map(|(id, value)| format!("{id} is {value}"));
    screen.each("built in", shapes);
    let known = known_effects();
    let own = known.iter();
    let own = own.filter(|one| model.effects.iter().any(|id| id == one.id));
    for id in own.flat_map(|effect| &effect.shapes) {
        if !model.shapes.iter().any(|(given, _)| given == id) {
            let words =
                format!("{id} is an input of the model; give it in [shapes] to build it in");
            screen.fact("input", words);
        }
    }
    for (id, others) in &extension.equivalents {
        let words = format!("exact equivalents of {id}: {}", others.join(", "));
        screen.fact("may also be", words);
    }
    let left_out = extension.left_out.iter();
    let left_out = left_out.map(|one| format!("{} {}", one.effect, one.why));
    screen.each("left out", left_out);
    let words = "derive the filter in your package: docs/extending.md";
    screen.fact("what to do", words);
    screen
}
