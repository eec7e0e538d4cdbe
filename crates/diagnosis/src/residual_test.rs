//! Residual test: whiteness of the innovations with all causes in the model.

use gyrocal_calibration::{CalibrationError, FittedPlatform};
use gyrocal_hypothesis::{Pattern, Unmodelled};
use gyrocal_record::{AXES, Record};
use gyrocal_statistics::{autocorrelation, p_of_least, periodogram, strongest_line};

use crate::error_budget::RESIDUAL_TESTS;
use gyrocal_answer::{
    ResidualCorrelation, ResidualLine, ResidualTest, ResidualVerdict, UnmodelledPattern,
    UnmodelledTerm,
};
use gyrocal_words::residual_description;

/// Lags of the portmanteau test: structure shorter than these many rows.
const LAGS: usize = 20;

/// The innovations of a fit, whitened.
///
/// # Errors
/// As [`FittedPlatform::signatures`].
pub(crate) fn whitened(
    fitted: &FittedPlatform<'_>,
    record: &Record,
) -> Result<Vec<[f64; 3]>, CalibrationError> {
    let mut whitened = vec![[f64::NAN; 3]; record.len()];
    fitted.signatures(&[], |value| {
        whitened[value.row][value.output] = value.columns[0]
    })?;
    Ok(whitened)
}

/// Innovations without the correlation ρ of the accelerometer noise that the audit found, which is a
/// finding of its own: (eₜ − ρ eₜ₋₁)/√(1 − ρ²). `NaN` where one of the two is missing.
pub(crate) fn decorrelated(whitened: &[[f64; 3]], correlation: f64) -> Vec<[f64; 3]> {
    if correlation == 0.0 {
        return whitened.to_vec();
    }
    let scale = (1.0 - correlation * correlation).sqrt().recip();
    let missing = core::iter::once([f64::NAN; 3]);
    let differences = whitened.windows(2).map(|pair| {
        core::array::from_fn(|axis| scale * (pair[1][axis] - correlation * pair[0][axis]))
    });
    missing.chain(differences).collect()
}

/// Tests whitened innovations; `unmodelled` holds the terms that the search found beside the catalogue,
/// and `alpha` is the probability of a false alarm of all residual tests.
pub(crate) fn residual_test(
    time_s: &[f64],
    whitened: &[[f64; 3]],
    unmodelled: &[Unmodelled],
    alpha: f64,
) -> ResidualTest {
    let line = largest_line(time_s, whitened, alpha);
    let correlation =
        autocorrelation(whitened, LAGS, alpha)
            .ok()
            .map(|found| ResidualCorrelation {
                ljung_box: found.ljung_box,
                degrees_of_freedom: found.degrees_of_freedom,
                p_value: found.p_value,
                significant: p_of_least(found.p_value, RESIDUAL_TESTS) < alpha,
            });
    let of_line = line.as_ref().map(|line| line.p_value);
    let of_correlation = correlation.as_ref().map(|found| found.p_value);
    let tested = of_line.into_iter().chain(of_correlation);
    let count = tested.clone().count();
    let least = tested.fold(1.0, f64::min);
    let of_tests = (count > 0).then(|| p_of_least(least, count as f64));
    let unmodelled: Vec<UnmodelledTerm> = unmodelled.iter().map(term).collect();
    let of_terms = unmodelled.iter().map(|term| term.p_value);
    let p_value = of_terms.chain(of_tests).reduce(f64::min);
    let verdict = if p_of_least(least, RESIDUAL_TESTS) < alpha || !unmodelled.is_empty() {
        ResidualVerdict::Unexplained
    } else if line.is_none() || correlation.is_none() {
        ResidualVerdict::NotTested
    } else {
        ResidualVerdict::White
    };
    let mut test = ResidualTest {
        verdict,
        p_value,
        description: String::new(),
        line,
        correlation,
        outputs: Vec::new(),
        unmodelled,
    };
    test.description = residual_description(&test);
    test
}

/// The largest line in the spectra of all channels; `None` if they are too short for one.
fn largest_line(time_s: &[f64], whitened: &[[f64; 3]], alpha: f64) -> Option<ResidualLine> {
    let [x, y, z] = core::array::from_fn(|axis| {
        let series: Vec<f64> = whitened.iter().map(|row| row[axis]).collect();
        periodogram(time_s, &series, alpha)
    });
    let lines = [x.ok()?.line, y.ok()?.line, z.ok()?.line];
    let (axis, p_value) = strongest_line(&lines);
    Some(ResidualLine {
        channel: AXES[axis].to_owned(),
        period_h: 1.0 / (3600.0 * lines[axis].frequency_hz),
        amplitude: lines[axis].amplitude,
        p_value,
        significant: p_of_least(p_value, RESIDUAL_TESTS) < alpha,
    })
}

fn term(found: &Unmodelled) -> UnmodelledTerm {
    let (pattern, period_h, depends_on) = match found.pattern {
        Pattern::Line { period_h } => (UnmodelledPattern::Line, Some(period_h), None),
        Pattern::Curve { covariate, .. } => {
            let axis = AXES[covariate].to_owned();
            (UnmodelledPattern::Curve, None, Some(axis))
        }
    };
    UnmodelledTerm {
        channel: found.describes.id.to_owned(),
        pattern,
        period_h,
        depends_on,
        size: found.size,
        unit: found.describes.unit.to_owned(),
        p_value: found.ln_probability.exp(),
    }
}
