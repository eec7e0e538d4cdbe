//! Rounding errors of the kernel and of the dense Joseph form, against 400-bit arithmetic.

use gyrocal::estimation::{Covariance, Factors};

use super::RULES;
use crate::figure::Figure;
use gyrocal_testkit::rounding_errors::{FACTORS_LIMIT, TIE, dense_joseph, structured};

const RUNS: &str = "tests/data/numerics";

pub(crate) fn figures() -> Vec<Figure> {
    let mut figures = Vec::new();
    for (rule, integration) in RULES {
        let dense = dense_joseph(integration);
        let what = format!("{rule}, 1000 steps: rounding errors of dense Joseph");
        figures.push(Figure::note(&what, dense.to_string()).over(8, RUNS));
        let forms = [
            ("covariance", structured::<Covariance>(integration), TIE),
            ("factors", structured::<Factors>(integration), FACTORS_LIMIT),
        ];
        for (form, ours, limit) in forms {
            let what = format!("{rule}, 1000 steps: rounding errors of the {form}");
            figures.push(Figure::note(&what, ours.to_string()).over(8, RUNS));
            let pairs = [
                ("states", ours.state, dense.state),
                ("sigmas", ours.sigma, dense.sigma),
            ];
            for (quantity, ours, dense) in pairs {
                let what =
                    format!("{rule}, 1000 steps: error of {quantity}, {form} / dense Joseph");
                let bounds = [f64::NEG_INFINITY, limit];
                figures.push(Figure::within(&what, bounds, ours / dense).over(8, RUNS));
            }
        }
    }
    figures
}
