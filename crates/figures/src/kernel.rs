//! The structured kernel: cost of a step relative to the textbook filter and by number of states,
//! rounding errors, and instruction counts.

mod accuracy;
mod against_crates;
pub(crate) mod instructions;
mod scaling;
pub(crate) mod speed;

use gyrocal::Integration;
use gyrocal_testkit::timing;

use crate::error::Error;
use crate::figure::Figure;

const RULES: [(&str, Integration); 2] = [("euler", Integration::EULER), ("rk4", Integration::RK4)];

/// Why ratios of builds for wide vectors are below their targets.
pub(crate) const INTRODUCTION: &str = include_str!("kernel/introduction.md");

/// All figures of the part. With `write`, the committed instruction counts are renewed.
pub(crate) fn figures(small: bool, write: bool) -> Result<Vec<Figure>, Error> {
    if write {
        return instructions::renewed();
    }
    let rounds = if small { 101 } else { 501 };
    let mut figures = vec![Figure::note(
        "target features of this build",
        timing::target_features(),
    )];
    let mut timed = speed::figures(rounds)?;
    if !small {
        timed.extend(speed::of_other_builds(rounds)?);
    }
    timed.extend(against_crates::figures(rounds)?);
    timed.extend(scaling::figures(rounds)?);
    if small {
        // Ratios of times on a machine that does other work as well say little: shown, not judged.
        for figure in &mut timed {
            figure.holds = None;
        }
    }
    figures.extend(timed);
    figures.extend(accuracy::figures());
    figures.extend(instructions::figures()?);
    Ok(figures)
}
