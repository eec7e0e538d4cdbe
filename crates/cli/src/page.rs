//! Reports: the answer of a command as one HTML file, and its charts as pictures.

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal_pages::{PageError, Part, page, pictures as charts};
use gyrocal_report::to_html;
use miette::miette;

use crate::outputs::{self, refuse_overlap, refuse_unwritable};
use crate::{Failure, Reply, pictures};

/// Stages a report, if it is asked for, and tells of it.
pub(crate) fn write(
    path: Option<&Path>,
    parts: Vec<Part>,
    reply: &mut Reply,
) -> Result<(), Failure> {
    reply.write(path, "the report, for a browser", |path| {
        to_html(&page(parts))
            .map_err(|reason| Failure::Work(miette!("{}: no report: {reason}", path.display())))
    })
}

/// The part of an input, or the reason why there is none.
pub(crate) fn part(of: &Path, part: Result<Part, PageError>) -> Result<Part, Failure> {
    part.map_err(|reason| Failure::Work(miette!("{}: no report: {reason}", of.display())))
}

/// Files to look at: the report, and its charts as pictures.
#[derive(Debug, Default, Args)]
pub(crate) struct Views {
    /// Write a report to look at: one HTML file that opens in any browser, offline.
    #[arg(long, value_name = "OUT.html")]
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

    /// Refuses, before the computation, files that could not be written or would overwrite others: these, the
    /// result for programs, and the others with their options.
    pub(crate) fn check(
        &self,
        inputs: &[&Path],
        json: Option<&Path>,
        others: &[(&str, Option<&Path>)],
    ) -> Result<(), Failure> {
        outputs::check(inputs, json, self.figures())?;
        let all = [("--json", json)].into_iter().chain(others.iter().copied());
        self.refuse_overlap(inputs, all)?;
        let others = others.iter().map(|(_, path)| *path);
        let written: Vec<_> = [self.report()].into_iter().chain(others).collect();
        refuse_unwritable(&written, self.figures())
    }

    /// Refuses files that would overwrite an input or one another.
    pub(crate) fn refuse_overlap<'a>(
        &'a self,
        inputs: &[&Path],
        others: impl IntoIterator<Item = (&'a str, Option<&'a Path>)>,
    ) -> Result<(), Failure> {
        let own = [("--figures", self.figures()), ("--report", self.report())];
        refuse_overlap(inputs, &others.into_iter().chain(own).collect::<Vec<_>>())
    }

    /// Stages report and pictures of an input, and tells of them.
    pub(crate) fn stage(&self, of: &Path, part: Part, reply: &mut Reply) -> Result<(), Failure> {
        let drawn = |parts: &[Part]| parts.iter().cloned().flat_map(charts).collect();
        self.stage_parts(of, vec![part], drawn, reply)
    }

    /// Tells that there are no pictures, and why.
    pub(crate) fn leave_out_figures(&self, why: &str, reply: &mut Reply) -> Result<(), Failure> {
        let Some(folder) = &self.figures else {
            return Ok(());
        };
        // Other outputs may go there.
        outputs::make_folder("--figures ", folder, &mut reply.outputs)?;
        let earlier = match folder.is_dir() {
            true => "; what is there is of earlier runs",
            false => "",
        };
        reply.wrote(folder, &format!("no pictures, {why}{earlier}"));
        Ok(())
    }

    /// Stages a report of several parts and the pictures that are drawn of them, and tells of both.
    pub(crate) fn stage_parts(
        &self,
        of: &Path,
        parts: Vec<Part>,
        drawn: impl FnOnce(&[Part]) -> Vec<pictures::Named>,
        reply: &mut Reply,
    ) -> Result<(), Failure> {
        if let Some(folder) = &self.figures {
            let drawn = pictures::stage(of, &drawn(&parts), folder, &mut reply.outputs)?;
            reply.wrote(folder, &drawn);
        }
        write(self.report(), parts, reply)
    }
}
