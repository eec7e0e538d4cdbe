//! The harness of all evidence: populations that are drawn and diagnosed once, statistics over them with their
//! targets, topics of both, and the pages that they are printed on.
//!
//! - A [`Population`] is a job over seeds. Its results are kept by the hash of the sources that can move them, so
//!   that a killed run, or a run on another machine, goes on ([`Context::records`]).
//! - A [`Row`] is one statistic over the records of a population, with its target and the reason of the target.
//! - A [`Topic`](topic::Topic) has parts; each part makes figures from rows, or measures things that have no
//!   population: times, builds, files.
//! - The sources of a population are the packages that it runs through and the file that declares it (`file!()`).
//! - Development seeds are those that constants may be tuned on. Report seeds are others, and no command but
//!   `cargo figures night` reads them ([`Seeds`]).

mod context;
pub(crate) mod night;
pub(crate) mod pages;
mod population;
mod row;
pub(crate) mod sources;
pub(crate) mod stamp;
pub(crate) mod topic;

pub(crate) use crate::error::Error;
pub(crate) use crate::figure::Figure;
pub(crate) use context::{Context, Seeds, Size};
pub(crate) use population::{Population, Records};
pub(crate) use row::Row;
pub(crate) use sources::{CALIBRATION, DIAGNOSIS, INSTRUMENTS, Listed, PLANTS, Sources, of};
use topic::Measure;

/// The figures of some measurements, one after the other.
pub(crate) fn in_turn(context: &Context, all: &[Measure]) -> Result<Vec<Figure>, Error> {
    let each: Result<Vec<Vec<Figure>>, Error> = all.iter().map(|one| one(context)).collect();
    Ok(each?.concat())
}

/// Range of the coverage of 95 % intervals, and its reason.
pub(crate) const COVERAGE: [f64; 2] = [0.93, 0.97];
pub(crate) const COVERAGE_REASON: &str =
    "intervals of 95 %, two points for what their normal shape leaves out";
