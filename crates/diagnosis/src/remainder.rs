//! What is left when every cause that was found is in the model.

use gyrocal_calibration::{CalibrationError, Extended};
use gyrocal_record::Record;
use gyrocal_statistics::{autocorrelation, periodogram, strongest_line};

use crate::cause::Unnamed;

/// Lags of the portmanteau test: structure shorter than these many rows.
const LAGS: usize = 20;

/// Tests of what is left: of innovations two here, of lines and curves one of the search.
pub(crate) const TESTS: f64 = 3.0;

/// Channels by name.
const CHANNELS: [&str; 3] = ["x", "y", "z"];

/// Whether the innovations that are left are white.
#[derive(Clone, Debug, PartialEq)]
pub struct Remainder {
    /// Probability of as much structure in white innovations, all tests together.
    pub p_value: f64,
    /// Whether that is below the share of false alarms that the remainder has.
    pub unexplained: bool,
    /// What there is: channel, frequency, size; empty if nothing.
    pub description: String,
    /// What the record is too short to be tested for; empty if all tests were made.
    pub untested: Vec<&'static str>,
    /// The whitened innovations, row by row; NaN where there is no value.
    pub whitened: Vec<[f64; 3]>,
}

impl Remainder {
    /// Adds what the search met and the catalogue does not hold.
    pub(crate) fn add(&mut self, found: &Unnamed) {
        if !self.description.is_empty() {
            self.description.push_str("; ");
        }
        self.description.push_str(&found.description());
        self.p_value = self.p_value.min(found.ln_probability.exp());
        self.unexplained = true;
    }
}

/// Tests the innovations of a fit.
///
/// # Errors
/// As [`Extended::signatures`].
pub fn remainder(
    fitted: &Extended<'_>,
    record: &Record,
    false_alarm: f64,
) -> Result<Remainder, CalibrationError> {
    let mut whitened = vec![[f64::NAN; 3]; record.len()];
    fitted.signatures(&[], |value| {
        whitened[value.row][value.output] = value.columns[0]
    })?;
    let lines = [0, 1, 2].map(|axis| {
        let series: Vec<f64> = whitened.iter().map(|row| row[axis]).collect();
        periodogram(&record.time_s, &series, false_alarm)
    });
    let mut p_value = 1.0_f64;
    let mut description = String::new();
    let mut untested = Vec::new();
    if let [Ok(x), Ok(y), Ok(z)] = &lines {
        let of = [x.line, y.line, z.line];
        let (axis, p) = strongest_line(&of);
        p_value = p_value.min(TESTS * p);
        if TESTS * p < false_alarm {
            let line = of[axis];
            description = format!(
                "a line in channel {} with a period of {:.2} h, {:.2} standard deviations of an \
                 innovation in amplitude",
                CHANNELS[axis],
                1.0 / (3600.0 * line.frequency_hz),
                line.amplitude
            );
        }
    } else {
        untested.push("lines of a spectrum");
    }
    if let Ok(correlation) = autocorrelation(&whitened, LAGS, false_alarm) {
        p_value = p_value.min(TESTS * correlation.p_value);
        if TESTS * correlation.p_value < false_alarm {
            if !description.is_empty() {
                description.push_str("; ");
            }
            description.push_str(&format!(
                "innovations of neighbouring rows are correlated (Ljung-Box {:.0} for {} degrees \
                 of freedom)",
                correlation.ljung_box, correlation.degrees_of_freedom
            ));
        }
    } else {
        untested.push("correlation of neighbouring rows");
    }
    Ok(Remainder {
        p_value: p_value.min(1.0),
        unexplained: p_value < false_alarm,
        description,
        untested,
        whitened,
    })
}
