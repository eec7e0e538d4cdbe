//! Reports: the answer of a command as one HTML file.

use std::path::Path;

use gyrocal_pages::{PageError, Part, page};
use gyrocal_record::Outputs;
use miette::miette;

use crate::Failure;
use crate::outputs::{refuse_overlap, refuse_unwritable};

/// The help of `--report`.
pub(crate) const HELP: &str =
    "Write a report to look at: one HTML file that opens in any browser, offline";

/// What the file holds.
pub(crate) const WHAT: &str = "the report, for a browser";

/// Refuses, before the computation, a report that could not be written or would overwrite another file.
pub(crate) fn check(
    inputs: &[&Path],
    others: &[(&str, Option<&Path>)],
    report: Option<&Path>,
    made: Option<&Path>,
) -> Result<(), Failure> {
    let mut outputs = others.to_vec();
    outputs.push(("--report", report));
    refuse_overlap(inputs, &outputs)?;
    refuse_unwritable(&[report], made)
}

/// Stages a report, to be committed with the other outputs.
pub(crate) fn stage(path: &Path, parts: Vec<Part>, outputs: &mut Outputs) -> Result<(), Failure> {
    let html = page(parts)
        .to_html()
        .map_err(|reason| Failure::Work(miette!("{}: no report: {reason}", path.display())))?;
    outputs.stage(path, html.as_bytes())?;
    Ok(())
}

/// The part of an input, or the reason why there is none.
pub(crate) fn part(of: &Path, part: Result<Part, PageError>) -> Result<Part, Failure> {
    part.map_err(|reason| Failure::Work(miette!("{}: no report: {reason}", of.display())))
}
