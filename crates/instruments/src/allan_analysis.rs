//! Allan deviations of columns of a log.

use std::path::Path;

use gyrocal_record::InputErrorKind;
use gyrocal_statistics::allan::{
    AllanEstimator, AllanPoint, NoiseFit, allan_deviation, fit_noise, hadamard_deviation, octaves,
    total_deviation,
};
use serde::Serialize;

use crate::bad_samples::{BadSample, WithoutBadSamples};
use crate::cell::Wanted;
use crate::columns::FileColumns;
use crate::description::Description;
use crate::error::{InstrumentError, Unfit};
use crate::log::{Log, refuse_still};
use crate::row_time::RowTime;

/// Settings of the analysis of columns of a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AllanSettings {
    /// Samples per second \[Hz\].
    pub rate_hz: f64,
    /// Factor of the values.
    pub scale: f64,
    /// Confidence level of the intervals.
    pub confidence: f64,
    /// Estimator of the printed deviations. The parts of the noise are fitted to the samples.
    pub estimator: AllanEstimator,
}

/// Allan deviations of one column.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AllanColumn {
    /// Name of the column.
    pub name: String,
    /// Deviation at each averaging time.
    pub points: Vec<AllanColumnPoint>,
    /// Parts of the noise; `None` with too few samples for a fit.
    pub noise: Option<NoiseFit>,
    /// Samples that no noise explains, which deviations and parts leave out; `None` without any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub left_out: Option<LeftOut>,
}

/// Samples that no noise explains: more than eight robust standard deviations from the median of those about them, and at
/// most one of a hundred. The median takes their place.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LeftOut {
    /// Number of these samples.
    pub count: usize,
    /// The first hundred of them.
    pub samples: Vec<BadSample>,
    /// Parts of the noise with these samples among the others; `None` with too few for a fit.
    pub noise_with_them: Option<NoiseFit>,
}

/// Result of `gyrocal allan`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AllanReport {
    /// Unit of the scaled values.
    pub unit: String,
    /// Confidence level of the intervals of deviations.
    pub confidence: f64,
    /// Estimator of the deviations, in words.
    pub estimator: &'static str,
    /// The columns.
    pub columns: Vec<AllanColumn>,
}

/// Allan deviation at one averaging time.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AllanColumnPoint {
    /// Averaging time \[s\].
    pub tau_s: f64,
    /// The deviation, in the unit of the scaled values.
    pub deviation: f64,
    /// Lower end of its confidence interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Equivalent degrees of freedom.
    pub degrees_of_freedom: f64,
    /// Dominant noise type.
    pub noise: &'static str,
}

impl From<&AllanPoint> for AllanColumnPoint {
    fn from(point: &AllanPoint) -> Self {
        let [low, high] = point.interval;
        Self {
            tau_s: point.tau_s,
            deviation: point.deviation,
            low,
            high,
            degrees_of_freedom: point.degrees_of_freedom,
            noise: point.noise.description(),
        }
    }
}

/// Deviations of columns of a log at octaves of the sampling interval, and the parts of their noise. The file is a text
/// with a header, separated by commas, or one whose columns have types.
///
/// # Errors
///
/// [`InstrumentError::File`] for a column that is absent, not of numbers, never changes, or repeats a value while those
/// about it scatter; [`InstrumentError`] for values that `scale` makes infinite; [`gyrocal_record::Error::Unreadable`].
pub fn allan_file(
    path: &Path,
    names: &[&str],
    settings: &AllanSettings,
) -> Result<Vec<AllanColumn>, InstrumentError> {
    let description = Description::parse("[time]\nrate_hz = 1\n", "columns by their names")?;
    let wanted = Wanted {
        names,
        sparse: 0..0,
    };
    let time = RowTime::new(&description);
    let file = FileColumns::read(path, &description.file, &wanted, time)?;
    of_file(&file, names, settings)
}

fn of_file(
    file: &FileColumns,
    names: &[&str],
    settings: &AllanSettings,
) -> Result<Vec<AllanColumn>, InstrumentError> {
    let columns = names.iter().zip(&file.values).enumerate();
    columns
        .map(|(column, (name, values))| {
            if values.len() > 1 && values.windows(2).all(|pair| pair[0] == pair[1]) {
                return Err(file.error_at(
                    0,
                    InputErrorKind::Stuck,
                    Unfit::Stuck,
                    [
                        &format!("a column `{name}` that never changes"),
                        "samples of a rate, which has noise",
                        "check the sensor and the logger",
                    ],
                ));
            }
            refuse_still(file, column, name, false)?;
            allan_values(name, values, settings)
        })
        .collect()
}

/// Deviations and parts of the values of one column.
///
/// # Errors
///
/// [`InstrumentError`] for too few samples, and for values that `scale` makes infinite.
pub fn allan_values(
    name: &str,
    values: &[f64],
    settings: &AllanSettings,
) -> Result<AllanColumn, InstrumentError> {
    let interval_s = 1.0 / settings.rate_hz;
    let values: Vec<f64> = values.iter().map(|value| value * settings.scale).collect();
    if values.iter().any(|value| !value.is_finite()) {
        return Err(overflow(name, settings.scale));
    }
    let cleaned = WithoutBadSamples::of(&values);
    let (points, noise) = deviations(&cleaned.values, interval_s, settings)?;
    let left_out = match cleaned.places.len() {
        0 => None,
        count => Some(LeftOut {
            count,
            samples: cleaned.told(&values, interval_s),
            noise_with_them: fit_noise(&values, interval_s).ok(),
        }),
    };
    Ok(AllanColumn {
        name: name.to_owned(),
        noise,
        points,
        left_out,
    })
}

/// Deviations of values, and the parts of their noise.
fn deviations(
    values: &[f64],
    interval_s: f64,
    settings: &AllanSettings,
) -> Result<(Vec<AllanColumnPoint>, Option<NoiseFit>), InstrumentError> {
    let confidence = settings.confidence;
    let averaging = octaves(values.len().max(3));
    let points = match settings.estimator {
        AllanEstimator::Total => total_deviation(values, interval_s, &averaging, confidence)?,
        AllanEstimator::Hadamard => {
            let most = values.len() / 4;
            let shorter: Vec<usize> = averaging
                .into_iter()
                .filter(|count| *count <= most)
                .collect();
            hadamard_deviation(values, interval_s, &shorter, confidence)?
        }
        _ => allan_deviation(values, interval_s, &averaging, confidence)?,
    };
    let noise = fit_noise(values, interval_s).ok();
    Ok((points.iter().map(AllanColumnPoint::from).collect(), noise))
}

/// The same of the gyros of a log in the unit of its description, with its clock; `names` are those of its
/// columns.
///
/// # Errors
///
/// As [`allan_file`]; [`InstrumentError`] for gyros in counts without a scale.
pub fn allan_log(
    log: &Log,
    names: [&str; 3],
    settings: &AllanSettings,
) -> Result<Vec<AllanColumn>, InstrumentError> {
    let settings = AllanSettings {
        rate_hz: 1.0 / log.interval_s,
        ..*settings
    };
    (0..3)
        .map(|axis| {
            let values: Vec<f64> = log.gyro.iter().map(|rate| rate[axis]).collect();
            let name = names[axis];
            if values.windows(2).all(|pair| pair[0] == pair[1]) {
                return Err(InstrumentError::unfit(
                    Unfit::Setting,
                    format!("a column `{name}` that never changes"),
                    "samples of a rate, which has noise",
                    "check the sensor and the logger",
                ));
            }
            allan_values(name, &values, &settings)
        })
        .collect()
}

fn overflow(name: &str, scale: f64) -> InstrumentError {
    InstrumentError::Unfit {
        kind: Unfit::Setting,
        found: format!("values of `{name}` that are too large when multiplied by {scale:e}"),
        expected: "finite numbers".to_owned(),
        advice: "give a smaller --scale".to_owned(),
    }
}
