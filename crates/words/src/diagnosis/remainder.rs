//! What a residual test found.

use crate::files::joined;
use crate::format::time;
use gyrocal_answer::{ResidualTest, ResidualVerdict, UnmodelledPattern, UnmodelledTerm};

/// The structure that a residual test found, or the tests that it could not make; empty if the
/// innovations are white.
#[must_use]
pub fn residual_description(test: &ResidualTest) -> String {
    match test.verdict {
        ResidualVerdict::White => String::new(),
        ResidualVerdict::NotTested => {
            let lines = test.line.is_none().then_some("spectral lines");
            let correlation = test.correlation.is_none();
            let correlation = correlation.then_some("correlation of neighbouring rows");
            joined(lines.into_iter().chain(correlation), " and ")
        }
        ResidualVerdict::Unexplained => {
            let line = test.line.as_ref().filter(|line| line.significant);
            let line = line.map(|line| {
                format!(
                    "a spectral line in the innovations of channel {} with a period of {} and \
                     an amplitude of {:.2} sigma",
                    line.channel,
                    time(3600.0 * line.period_h),
                    line.amplitude
                )
            });
            let correlation = test.correlation.filter(|found| found.significant);
            let correlation = correlation.map(|found| {
                format!(
                    "innovations of neighbouring rows are correlated (Ljung-Box {:.0} for {} degrees \
                     of freedom)",
                    found.ljung_box, found.degrees_of_freedom
                )
            });
            let terms = test.unmodelled.iter().map(unmodelled);
            joined(line.into_iter().chain(correlation).chain(terms), "; ")
        }
    }
}

/// A term that the catalogue does not hold.
fn unmodelled(term: &UnmodelledTerm) -> String {
    let channel = match term.channel.split_once('_') {
        Some(("gyro", axis)) => format!("drift of gyro {axis}"),
        Some(("accel", axis)) => format!("reading of accelerometer {axis}"),
        _ => term.channel.clone(),
    };
    let (size, unit) = (term.size, &term.unit);
    match (term.pattern, term.period_h, &term.depends_on) {
        (UnmodelledPattern::Line, Some(period_h), _) => format!(
            "a line in the {channel} with a period of {} and an amplitude of {size:.2e} \
             {unit}",
            time(3600.0 * period_h)
        ),
        (UnmodelledPattern::Curve, _, Some(axis)) => format!(
            "the {channel} depends on specific force along {axis} as no polynomial of the catalogue \
             does, {size:.2e} {unit} rms"
        ),
        _ => format!("a term in the {channel} of {size:.2e} {unit}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_period_is_in_a_unit_that_serves_it() {
        let words = |period_h| {
            let of_gyro = UnmodelledTerm {
                channel: "gyro_x".to_owned(),
                pattern: UnmodelledPattern::Line,
                period_h: Some(period_h),
                depends_on: None,
                size: 0.01,
                unit: "deg/h".to_owned(),
                p_value: 1e-6,
            };
            unmodelled(&of_gyro)
        };
        for (period_h, told) in [(0.001, "3.60 s"), (0.5, "30.0 min"), (5.3, "5.30 h")] {
            let words = words(period_h);
            let expected = format!("gyro x with a period of {told} and an");
            assert!(words.contains(&expected), "{words}");
        }
    }
}
