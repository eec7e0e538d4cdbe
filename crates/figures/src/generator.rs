//! The generator against others: time and instructions of emitted functions, time of emission, edges
//! of operations, random graphs, and what a new plant takes.

mod emission;
mod operations;
mod plant;
mod race;

use crate::error::Error;
use crate::figure::Figure;
use crate::kernel::instructions::root;

/// How to read the page of the topic, and why targets are missed.
pub(crate) const INTRODUCTION: &str = include_str!("generator/introduction.md");

/// All figures of the topic. With `small`, nothing that builds packages or installs generators.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    if small {
        figures.push(emission::figure()?);
        figures.extend(plant::lines()?);
        return Ok(figures);
    }
    let directory = root().join("target/figures/generator");
    figures.extend(race::figures(&directory)?);
    figures.push(emission::figure()?);
    figures.extend(operations::figures(&directory)?);
    figures.extend(emission::of_huge_programs()?);
    figures.extend(plant::lines()?);
    figures.push(plant::clean_build()?);
    figures.push(plant::packages()?);
    Ok(figures)
}
