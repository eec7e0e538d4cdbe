//! The generator against others: time and instructions of emitted functions, time of emission, edges
//! of operations, random graphs, and what a new plant takes.

mod emission;
mod operations;
mod plant;
mod race;

use gyrocal_testkit::python_with;

use crate::error::Error;
use crate::figure::Figure;
use crate::kernel::instructions::root;

/// How to read the page of the topic, and why targets are missed.
pub(crate) const INTRODUCTION: &str = include_str!("generator/introduction.md");

/// The other generators, and CasADi, whose operations ours are compared with.
const PACKAGES: &str = "wrenfold==0.5.3\nsymforce==0.12.0\ncasadi==3.8.2\n";

/// All figures of the topic. With `small`, nothing that builds packages or installs generators.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    if small {
        figures.push(emission::figure()?);
        figures.extend(plant::lines()?);
        return Ok(figures);
    }
    let directory = root().join("target/figures/generator");
    let python = python_with(&directory, PACKAGES);
    match &python {
        Some(python) => figures.extend(race::figures(&directory, python)?),
        None => {
            let reason = "packages of Python cannot be had".to_owned();
            figures.push(Figure::note(
                "generators and operations not compared",
                reason,
            ));
        }
    }
    figures.push(emission::figure()?);
    if let Some(python) = &python {
        figures.extend(operations::figures(&directory, python)?);
    }
    figures.extend(emission::of_huge_programs()?);
    figures.extend(plant::lines()?);
    figures.push(plant::clean_build()?);
    figures.push(plant::packages()?);
    Ok(figures)
}
