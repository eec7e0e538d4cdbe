//! Reports: the answer of a command as one HTML file, and its charts as pictures.

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal_pages::{PageError, Part, page, pictures as charts};
use gyrocal_record::Outputs;
use gyrocal_report::to_html;
use miette::miette;

use crate::outputs::{refuse_overlap, refuse_unwritable};
use crate::{Failure, Reply, pictures};

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
    let html = to_html(&page(parts))
        .map_err(|reason| Failure::Work(miette!("{}: no report: {reason}", path.display())))?;
    outputs.stage(path, html.as_bytes())?;
    Ok(())
}

/// The part of an input, or the reason why there is none.
pub(crate) fn part(of: &Path, part: Result<Part, PageError>) -> Result<Part, Failure> {
    part.map_err(|reason| Failure::Work(miette!("{}: no report: {reason}", of.display())))
}

/// Files to look at: the report, and its charts as pictures.
#[derive(Debug, Default, Args)]
pub(crate) struct Views {
    #[arg(long, value_name = "OUT.html", help = HELP)]
    report: Option<PathBuf>,
    #[arg(long, value_name = "DIR", help = pictures::HELP)]
    figures: Option<PathBuf>,
}

impl Views {
    /// The folder of pictures.
    pub(crate) fn figures(&self) -> Option<&Path> {
        self.figures.as_deref()
    }

    /// The report.
    pub(crate) fn report(&self) -> Option<&Path> {
        self.report.as_deref()
    }

    /// Whether there is anything to write.
    pub(crate) fn are_asked(&self) -> bool {
        self.report.is_some() || self.figures.is_some()
    }

    /// Refuses, before the computation, files that could not be written or would overwrite others.
    pub(crate) fn check(
        &self,
        inputs: &[&Path],
        others: &[(&str, Option<&Path>)],
    ) -> Result<(), Failure> {
        let mut others = others.to_vec();
        others.push(("--figures", self.figures()));
        check(inputs, &others, self.report(), self.figures())
    }

    /// Stages report and pictures of an input, and tells of them.
    pub(crate) fn stage(
        &self,
        of: &Path,
        part: Part,
        outputs: &mut Outputs,
        answer: &mut Reply,
    ) -> Result<(), Failure> {
        let drawn = |parts: &[Part]| parts.iter().cloned().flat_map(charts).collect();
        self.stage_parts(of, vec![part], drawn, outputs, answer)
    }

    /// Stages a report of several parts and the pictures that are drawn of them, and tells of both.
    pub(crate) fn stage_parts(
        &self,
        of: &Path,
        parts: Vec<Part>,
        drawn: impl FnOnce(&[Part]) -> Vec<pictures::Named>,
        outputs: &mut Outputs,
        answer: &mut Reply,
    ) -> Result<(), Failure> {
        if let Some(folder) = &self.figures {
            let drawn = drawn(&parts);
            answer.wrote(folder, &pictures::stage(of, &drawn, folder, outputs)?);
        }
        if let Some(path) = &self.report {
            stage(path, parts, outputs)?;
            answer.wrote(path, WHAT);
        }
        Ok(())
    }
}
