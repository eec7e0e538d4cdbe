//! Cost of a step against the number of states.

use std::hint::black_box;

use super::{Error, RULES};
use crate::figure::Figure;
use gyrocal_testkit::extended_filter::{SIZES, samples, start, step};
use gyrocal_testkit::timing::{medians, seconds};

/// Steps of one round: two hours.
const STEPS: usize = 120;
/// Largest cost of a step relative to proportionality to n². One-sided: at n = 12 most of a step does
/// not depend on n (sines, divisions of the update), so larger ones cost less than in proportion.
const ALLOWED: f64 = 1.3;

pub(crate) fn figures(rounds: usize) -> Result<Vec<Figure>, Error> {
    let samples = samples(STEPS)?;
    let mut figures = Vec::new();
    for (rule, integration) in RULES {
        let mut starts = Vec::new();
        for states in SIZES {
            starts.push(start(states, integration)?);
        }
        let (times, ratios) = medians(rounds, || {
            let mut times = [0.0; SIZES.len()];
            for (time, start) in times.iter_mut().zip(&starts) {
                let mut filter = black_box(start.clone());
                *time = seconds(|| {
                    samples
                        .iter()
                        .try_for_each(|sample| step(&mut filter, sample))
                })?;
                black_box(&filter);
            }
            Ok::<_, gyrocal::EstimationError>(times)
        })?;
        let ns = times
            .map(|time| format!("{:.0}", time / STEPS as f64 * 1e9))
            .join(" ");
        let sizes = SIZES.map(|states| states.to_string()).join(" ");
        let what = format!("{rule} step: ns at n = {sizes}");
        figures.push(Figure::note(&what, ns).over(rounds, ""));
        for (states, ratio) in SIZES.iter().zip(ratios).skip(1) {
            let proportional = (*states as f64 / SIZES[0] as f64).powi(2);
            let what = format!("{rule} step: cost({states}) / cost(12) / ({states}/12)^2");
            let bounds = [f64::NEG_INFINITY, ALLOWED];
            figures.push(Figure::within(&what, bounds, ratio / proportional).over(rounds, ""));
        }
    }
    Ok(figures)
}
