//! Reports: the answer of a command as one HTML file, and its charts as pictures.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal_pages::{PageError, Part, page, pictures as charts};
use gyrocal_record::{Outputs, file_behind, printable_path};
use gyrocal_report::to_html;
use serde::Serialize;

use crate::outputs::{self, refuse_overlap, refuse_unwritable};
use crate::{Failure, Reply, pictures};

/// Why there is an answer without tables and pictures.
const WRONG_SET_UP: &str = "as the set-up is wrong";

/// Stages a report, if it is asked for, and tells of it.
pub(crate) fn write(
    path: Option<&Path>,
    parts: Vec<Part>,
    reply: &mut Reply,
) -> Result<(), Failure> {
    reply.write(path, "the report, for a browser", |path| {
        to_html(&page(parts)).map_err(|reason| no_report(path, reason))
    })
}

/// The part of an input, or the reason why there is none.
pub(crate) fn part(of: &Path, part: Result<Part, PageError>) -> Result<Part, Failure> {
    part.map_err(|reason| no_report(of, reason))
}

fn no_report(of: &Path, reason: impl Display) -> Failure {
    Failure::of(of, format_args!("no report: {reason}"))
}

/// Files of an answer: the result for programs, the report, and its charts as pictures.
#[derive(Debug, Default, Args)]
pub(crate) struct Views {
    /// Write the result for programs (JSON).
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,
    /// Write a report to look at: one HTML file that opens in any browser, offline.
    #[arg(long, value_name = "OUT.html")]
    report: Option<PathBuf>,
    #[arg(long, value_name = "DIR", help = pictures::HELP)]
    figures: Option<PathBuf>,
}

impl Views {
    /// The result for programs.
    pub(crate) fn json(&self) -> Option<&Path> {
        self.json.as_deref()
    }

    /// The report.
    pub(crate) fn report(&self) -> Option<&Path> {
        self.report.as_deref()
    }

    /// Whether there is anything to look at.
    pub(crate) fn are_asked(&self) -> bool {
        self.report.is_some() || self.figures.is_some()
    }

    /// Refuses, before the computation, files that would overwrite an input or one another, or could not be written:
    /// these, and others with their options.
    pub(crate) fn check(
        &self,
        inputs: &[&Path],
        others: &[(&str, Option<&Path>)],
    ) -> Result<(), Failure> {
        self.refuse_overlap(inputs, others)?;
        let (json, figures) = (self.json(), self.figures.as_deref());
        if let (Some(json), Some(figures)) = (json, figures)
            && file_behind(json).parent() == Some(&file_behind(figures))
            && pictures::is_picture(json)
        {
            return Err(Failure::Usage(format!(
                "--json {} is among the pictures of --figures {}",
                printable_path(json),
                printable_path(figures)
            )));
        }
        if let Some(figures) = figures {
            outputs::make_folder("--figures ", figures, &mut Outputs::new())?;
        }
        let others = others.iter().map(|(_, path)| *path);
        let written: Vec<_> = others.chain([json, self.report()]).collect();
        refuse_unwritable(&written, figures)
    }

    /// Refuses files that would overwrite an input or one another.
    pub(crate) fn refuse_overlap(
        &self,
        inputs: &[&Path],
        others: &[(&str, Option<&Path>)],
    ) -> Result<(), Failure> {
        let mut all = vec![("--figures", self.figures.as_deref())];
        all.extend(others);
        all.extend([("--json", self.json()), ("--report", self.report())]);
        refuse_overlap(inputs, &all)
    }

    /// The answer of a page of an input, and of the result that it is of, with their files.
    pub(crate) fn answered(
        &self,
        of: &Path,
        part: Part,
        result: &impl Serialize,
    ) -> Result<Reply, Failure> {
        let mut reply = Reply::of_part(&part);
        // The folder of pictures first: the result for programs may go there too.
        self.stage(of, part, &mut reply)?;
        reply.write_json(self.json(), result)?;
        Ok(reply)
    }

    /// Stages report and pictures of an input, and tells of them.
    pub(crate) fn stage(&self, of: &Path, part: Part, reply: &mut Reply) -> Result<(), Failure> {
        let drawn = |parts: &[Part]| parts.iter().cloned().flat_map(charts).collect();
        self.stage_parts(of, vec![part], drawn, reply)
    }

    /// Stages the report of a record whose set-up is wrong; tells that there are neither pictures nor these tables.
    pub(crate) fn leave_out<'a>(
        &self,
        part: Part,
        tables: impl IntoIterator<Item = &'a Option<PathBuf>>,
        reply: &mut Reply,
    ) -> Result<(), Failure> {
        if let Some(folder) = &self.figures {
            let earlier = match pictures::are_in(folder) {
                true => "; pictures that are there are older",
                false => "",
            };
            // Other outputs may go there.
            outputs::make_folder("--figures ", folder, &mut reply.outputs)?;
            reply.wrote(folder, &format!("no pictures, {WRONG_SET_UP}{earlier}"));
        }
        for path in tables.into_iter().flatten() {
            reply.leave_out(path, WRONG_SET_UP);
        }
        write(self.report(), vec![part], reply)
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
