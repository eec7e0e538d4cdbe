//! Several records of one platform: diagnosed together, planned, and predicted from an earlier one.

pub(crate) mod later;
mod oracle;
pub(crate) mod planning;
pub(crate) mod several;

use gyrocal_calibration::Run;
use gyrocal_truth::Simulation;

fn run(simulation: &Simulation) -> Run<'_> {
    Run {
        record: &simulation.record,
        bench: &simulation.bench,
    }
}
