//! The ground that a diagnosis stands on: the noise audit, and the signatures of effects.

mod audit;
mod records;
mod signatures;
mod whole;

// Support of the diagnosis package's tests, which has no other reader.
#[path = "../../diagnosis/tests/signatures/difference.rs"]
mod difference;
#[allow(clippy::unwrap_used, dead_code)] // the tests have kinds of faults that no figure asks for
#[path = "../../diagnosis/tests/noise/population.rs"]
mod population;

use std::hash::{DefaultHasher, Hash, Hasher};

use gyrocal_campaign::{Campaign, Fingerprint};

use crate::figure::Figure;

/// Why a figure could not be measured.
type Error = Box<dyn std::error::Error + Send + Sync>;

/// All figures of the topic.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let mut figures = signatures::figures(small)?;
    figures.extend(audit::figures(small)?);
    figures.extend(whole::figures(small)?);
    Ok(figures)
}

/// A campaign over the records of a cell that goes on where it was stopped. Results are those of
/// this very program: another build starts afresh.
fn campaign(cell: &str, seeds: core::ops::Range<u64>, small: bool) -> Result<Campaign, Error> {
    let program = std::fs::read(std::env::current_exe()?)?;
    let mut hasher = DefaultHasher::new();
    program.hash(&mut hasher);
    let program = format!("{:016x}", hasher.finish());
    let fingerprint = Fingerprint::new("figures diagnosis-ground")
        .with("program", &program)
        .with("cell", cell);
    let campaign = Campaign::new(seeds, fingerprint);
    if small {
        return Ok(campaign);
    }
    let directory = gyrocal_freshness::workspace().join("target/figures");
    std::fs::create_dir_all(&directory)?;
    let file: String = cell
        .chars()
        .map(|letter| {
            if letter.is_alphanumeric() {
                letter
            } else {
                '-'
            }
        })
        .collect();
    Ok(campaign.results(directory.join(format!("diagnosis-ground-{file}-{program}.jsonl"))))
}
