//! What a new plant takes: lines of Python and Rust of the examples, a build of one from nothing, and
//! packages that build from their own files.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use crate::error::Error;
use crate::figure::Figure;
use crate::kernel::instructions::{cargo, output, root};

const EXAMPLES: [&str; 2] = ["cart_pole", "quadrotor"];
const MOST_PYTHON: f64 = 60.0;
const MOST_RUST: f64 = 20.0;

/// Lines of code of each example: its equations, and its build script with its filter. Blank lines and
/// comments do not count, and neither do simulation and tests.
pub(crate) fn lines() -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for example in EXAMPLES {
        let directory = root().join("examples").join(example);
        let python = code_lines(&directory.join("derive/main.py"), "#")?;
        let rust = code_lines(&directory.join("build.rs"), "//")?
            + code_lines(&directory.join("src/lib.rs"), "//")?;
        for (what, limit, count) in [("Python", MOST_PYTHON, python), ("Rust", MOST_RUST, rust)] {
            let name = format!("{example}: lines of {what} from equations to a filter");
            let mut figure = Figure::within(&name, [f64::NEG_INFINITY, limit], count as f64);
            figure.measured = count.to_string();
            figures.push(figure);
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
        !(line.is_empty()
            || line.starts_with(comment)
            || line.starts_with("\"\"\"")
            || is_simulation)
    };
    Ok(text.lines().filter(is_code).count())
}

/// Seconds of a build of an example and all that it depends on, without the network.
pub(crate) fn clean_build() -> Result<Figure, Error> {
    let target = tempfile::tempdir()?;
    let begin = Instant::now();
    output(
        Command::new(cargo())
            .current_dir(root())
            .args(["build", "--offline", "--quiet"])
            .args(["--package", "gyrocal-example-cart-pole"])
            .env("CARGO_TARGET_DIR", target.path()),
    )?;
    let seconds = begin.elapsed().as_secs_f64();
    let what = "cart_pole: build from nothing, packages downloaded before";
    Ok(Figure::note(what, format!("{seconds:.0} s")))
}

/// Every package of the workspace, packaged in the order of publication and built from its own files,
/// in a target directory of its own: cargo takes packages of one version for unchanged.
pub(crate) fn packages() -> Result<Figure, Error> {
    let what = "every package builds from its own files: cargo publish --workspace --dry-run";
    let target = tempfile::tempdir()?;
    let begin = Instant::now();
    let result = output(
        Command::new(cargo())
            .current_dir(root())
            .args(["publish", "--workspace", "--dry-run", "--allow-dirty"])
            .env("CARGO_TARGET_DIR", target.path()),
    );
    let mut figure = Figure::truth(what, result.is_ok());
    figure.measured = match result {
        Ok(_) => format!("yes, {:.0} s", begin.elapsed().as_secs_f64()),
        Err(error) => {
            let text = error.to_string();
            let line = text.lines().find(|line| line.starts_with("error"));
            format!("no: {}", line.unwrap_or("no reason is told"))
        }
    };
    Ok(figure)
}
