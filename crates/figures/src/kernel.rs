//! The structured kernel: rounding errors, instructions of a step, and its time beside other filters and by number
//! of states.

pub(crate) mod instructions;
pub(crate) mod times;

use gyrocal::Integration;
use gyrocal::estimation::{Covariance, Factors};
use gyrocal_testkit::rounding_errors::{FACTORS_LIMIT, TIE, dense_joseph, structured};

use crate::harness::{Context, Error, Figure};

const RULES: [(&str, Integration); 2] = [("euler", Integration::EULER), ("rk4", Integration::RK4)];

/// Why ratios of builds for wide vectors are below their targets.
pub(crate) const INTRODUCTION: &str = include_str!("kernel/introduction.md");

/// All figures of the part: of times only at full size, as those of a machine that does other work say little. With
/// leave to write, the committed instruction counts are renewed and nothing else is measured.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = instructions::figures(context.write)?;
    if context.write {
        return Ok(figures);
    }
    figures.extend(rounding_errors());
    if !context.is_small() {
        figures.extend(times::figures()?);
    }
    Ok(figures)
}

/// Rounding errors of the kernel and of the dense Joseph form, against 400-bit arithmetic.
fn rounding_errors() -> Vec<Figure> {
    let mut figures = Vec::new();
    for (rule, integration) in RULES {
        let name = |what: &str| format!("{rule}, 1000 steps: {what}");
        let dense = dense_joseph(integration);
        let what = name("rounding errors of dense Joseph");
        figures.push(Figure::note(&what, dense.to_string()));
        for (form, ours, limit) in [
            ("covariance", structured::<Covariance>(integration), TIE),
            ("factors", structured::<Factors>(integration), FACTORS_LIMIT),
        ] {
            let what = name(&format!("rounding errors of the {form}"));
            figures.push(Figure::note(&what, ours.to_string()));
            for (quantity, ratio) in [
                ("states", ours.state / dense.state),
                ("sigmas", ours.sigma / dense.sigma),
            ] {
                let what = name(&format!("error of {quantity}, {form} / dense Joseph"));
                figures.push(Figure::within(&what, [f64::NEG_INFINITY, limit], ratio));
            }
        }
    }
    let over = |figure: Figure| figure.over(8, "tests/data/numerics");
    figures.into_iter().map(over).collect()
}
