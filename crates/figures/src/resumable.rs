//! Resumable campaigns of the full versions.

use core::ops::Range;
use std::path::PathBuf;

use gyrocal_evaluation::{Campaign, Fingerprint, program};

use crate::error::Error;

/// A campaign over the records of a cell of a topic; the small version keeps no results. Results belong
/// to this build of the program: another build starts anew.
pub(crate) fn campaign(
    topic: &str,
    cell: &str,
    seeds: Range<u64>,
    small: bool,
) -> Result<Campaign, Error> {
    let fingerprint = Fingerprint::new(&format!("figures {topic}"))
        .with("program", program())
        .with("cell", cell);
    let campaign = Campaign::new(seeds, fingerprint);
    if small {
        return Ok(campaign);
    }
    Ok(campaign.results(results(topic, cell)?))
}

/// File of the results of a cell.
pub(crate) fn results(topic: &str, cell: &str) -> Result<PathBuf, Error> {
    let directory = gyrocal_testkit::workspace().join("target/figures");
    std::fs::create_dir_all(&directory)?;
    let letters = cell.chars();
    let cell: String = letters
        .map(|letter| {
            if letter.is_alphanumeric() {
                letter
            } else {
                '-'
            }
        })
        .collect();
    Ok(directory.join(format!("{topic}-{cell}-{}.jsonl", program())))
}
