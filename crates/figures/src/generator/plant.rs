//! What a model takes: lines of Python and Rust of the examples, first environment, derivation, builds from nothing,
//! and packages that build from their own files.

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use gyrocal_codegen::build::{Derivation, Settings};

use crate::harness::{Error, Figure};
use crate::kernel::instructions::{cargo, output, root};

const EXAMPLES: [&str; 2] = ["cart_pole", "quadrotor"];

/// Files of an example with the marks of their comments, and most lines of code of them together.
type Language = (&'static str, &'static str, &'static [&'static str], f64);
const LANGUAGES: [Language; 2] = [
    ("Python", "#", &["derive/main.py"], 60.0),
    ("Rust", "//", &["build.rs", "src/lib.rs"], 20.0),
];

/// Lines of code of each example: its equations, and its build script with its filter. Blank lines and
/// comments do not count, and neither do simulation and tests.
pub(super) fn lines() -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for example in EXAMPLES {
        for (language, comment, files, most) in LANGUAGES {
            let mut count = 0;
            for file in files {
                count += code_lines(&root().join("examples").join(example).join(file), comment)?;
            }
            let name = format!("{example}: lines of {language} from equations to a filter");
            figures.push(Figure::at_most(&name, most, count as f64, ""));
        }
    }
    Ok(figures)
}

/// Lines that are neither blank nor comments nor modules of the simulation.
fn code_lines(path: &Path, comment: &str) -> Result<usize, Error> {
    let text = std::fs::read_to_string(path)?;
    let is_code = |line: &&str| {
        let line = line.trim();
        let is_simulation = ["pub mod random;", "pub mod simulation;"].contains(&line);
        let is_comment = line.starts_with(comment) || line.starts_with("\"\"\"");
        !(line.is_empty() || is_comment || is_simulation)
    };
    Ok(text.lines().filter(is_code).count())
}

/// First environment and derivation of the model, a build of an example and all that it depends on without the
/// network, and every package of the workspace, packaged in the order of publication and built from its own files.
pub(super) fn builds() -> Result<Vec<Figure>, Error> {
    let scratch = tempfile::tempdir()?;
    let mut settings = Settings::from_env();
    settings.environments = Some(scratch.path().join("environments"));
    let derive = || {
        let derivation = Derivation::open(root().join("codegen/derive"))?;
        derivation.with_settings(settings.clone()).derive()
    };
    let (first, again) = (derive()?.timings, derive()?.timings);
    let seconds = |name, most, time: Duration| Figure::at_most(name, most, time.as_secs_f64(), "s");
    let (edit, edited) = (
        "derivation and emission after an edit",
        again.derivation + again.emission,
    );
    let mut figures = vec![
        seconds("first environment", 60.0, first.environment),
        seconds(edit, 5.0, edited),
    ];
    // Target folders of their own: cargo takes packages of one version for unchanged.
    let timed = |arguments: &str| {
        let target = tempfile::tempdir()?;
        let mut command = Command::new(cargo());
        command.current_dir(root()).args(arguments.split(' '));
        let begin = Instant::now();
        let result = output(command.env("CARGO_TARGET_DIR", target.path()));
        Ok::<_, Error>(result.map(|_| format!("{:.0} s", begin.elapsed().as_secs_f64())))
    };
    let example = timed("build --offline --quiet --package gyrocal-example-cart-pole")??;
    let name = "cart_pole: build from nothing, packages downloaded before";
    figures.push(Figure::note(name, example));
    let packages = timed("publish --workspace --dry-run --allow-dirty")?;
    let name = "every package builds from its own files: cargo publish --workspace --dry-run";
    let (is_built, text) = match packages {
        Ok(time) => (true, format!("yes, {time}")),
        Err(error) => {
            let text = error.to_string();
            let line = text.lines().find(|line| line.starts_with("error"));
            (
                false,
                format!("no: {}", line.unwrap_or("no reason is told")),
            )
        }
    };
    figures.push(Figure::told(name, "yes", text, is_built));
    Ok(figures)
}
