//! Cost of a build and reproducibility of the generation, on temporary copies of the workspace.

use std::path::Path;
use std::time::{Duration, Instant};

use gyrocal_codegen::build::{Derivation, Settings};
use gyrocal_testkit::{WorkspaceCopy, cargo, run};

use super::Error;
use crate::figure::Figure;

pub(crate) fn figures() -> Result<Vec<Figure>, Error> {
    let mut figures = vec![clean_build()?];
    figures.extend(derivation()?);
    Ok(figures)
}

fn seconds(name: &str, limit: f64, measured: Duration) -> Figure {
    let mut figure = Figure::within(name, [0.0, limit], measured.as_secs_f64());
    figure.target = format!("<= {limit} s");
    figure.measured = format!("{:.1} s", measured.as_secs_f64());
    figure.over(1, "this machine")
}

/// Clean `cargo build --release` of the default members, without Python.
fn clean_build() -> Result<Figure, Error> {
    let scratch = tempfile::tempdir()?;
    let copy = WorkspaceCopy::make(&scratch.path().to_string_lossy(), "clean");
    let tools = gyrocal_testkit::tools_only(scratch.path().join("tools"));
    // What a build needs from the registry is downloaded once, as on any machine.
    run(cargo(&copy.root, &scratch.path().join("target")).args(["fetch"])).succeeded();
    let begin = Instant::now();
    run(cargo(&copy.root, &scratch.path().join("target"))
        .args(["build", "--release", "--offline"])
        .env("PATH", &tools))
    .succeeded();
    Ok(seconds(
        "clean release build of the default members, no Python",
        90.0,
        begin.elapsed(),
    ))
}

/// First environment, derivation and emission, and the generated files.
fn derivation() -> Result<Vec<Figure>, Error> {
    let scratch = tempfile::tempdir()?;
    let sources = gyrocal_testkit::workspace().join("codegen/derive");
    let copied = WorkspaceCopy::make(&scratch.path().to_string_lossy(), "elsewhere");
    let mut settings = Settings::from_env();
    settings.environments = Some(scratch.path().join("environments"));
    let derive = |directory: &Path| {
        Derivation::open(directory)?
            .with_settings(settings.clone())
            .derive()
    };
    let first = derive(&sources)?;
    let again = derive(&sources)?;
    let elsewhere = derive(&copied.derivation())?;
    let equals_committed = Derivation::open(&sources)?
        .with_settings(settings.clone())
        .check()
        .is_ok();
    Ok(vec![
        seconds("first environment", 60.0, first.timings.environment),
        seconds(
            "derivation and emission after an edit",
            5.0,
            again.timings.derivation + again.timings.emission,
        ),
        Figure::truth("same bytes in two runs", first.modules == again.modules),
        Figure::truth(
            "same bytes in two folders",
            first.modules == elsewhere.modules,
        ),
        Figure::truth(
            "forced derivation equals the committed files",
            equals_committed,
        ),
    ])
}
