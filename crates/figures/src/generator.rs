//! The generator against others: time and instructions of emitted functions, time of derivation and emission, edges
//! of operations, random graphs, and what a new plant takes.

mod emission;
mod operations;
mod plant;
mod race;

use gyrocal_testkit::python_with;

use crate::harness::{Context, Error, Figure};
use crate::kernel::instructions::root;

/// How to read the page of the topic, and why targets are missed.
pub(crate) const INTRODUCTION: &str = include_str!("generator/introduction.md");

/// The other generators, and CasADi, whose operations ours are compared with.
const PACKAGES: &str = "wrenfold==0.5.3\nsymforce==0.12.0\ncasadi==3.8.2\n";

/// All figures of the part; the small ones without what builds packages or installs generators.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = vec![emission::figure()?.timed(context.is_small())];
    figures.extend(plant::lines()?);
    if context.is_small() {
        return Ok(figures);
    }
    figures.extend(emission::of_huge_programs()?);
    figures.extend(plant::builds()?);
    let directory = root().join("target/figures/generator");
    if let Some(python) = python_with(&directory, PACKAGES) {
        figures.extend(operations::figures(&directory, &python)?);
        figures.extend(race::figures(&directory, &python)?);
    } else {
        let reason = "packages of Python cannot be had".to_owned();
        let name = "generators and operations not compared";
        figures.push(Figure::note(name, reason));
    }
    Ok(figures)
}
