//! Calibration of accelerometers from few positions, by the norm of specific force at rest.

use gyrocal_record::AXES;
use nalgebra::DMatrix;
use serde::Serialize;

use crate::accel_from_norm::AccelCalibration;
use crate::error::{InstrumentError, Unfit};
use crate::least_squares::minimise;
use crate::stop_means::StopMeans;

/// Standard deviations that errors are expected to have before a test: of a bias \[g\], of a scale, and of
/// a misalignment \[rad\].
const EXPECTED: [f64; 3] = [0.05, 0.05, 0.01];

/// A coefficient is determined if its standard deviation is below this share of the expected one.
const DETERMINED: f64 = 0.3;

/// Least p-value of residuals that the standard errors of the stops explain.
const EXPLAINED: f64 = 0.01;

const UNKNOWNS: usize = 9;

/// Errors of three accelerometers that positions determine.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AccelErrors {
    /// The nine coefficients: biases, errors of the scales, misalignments.
    pub coefficients: Vec<AccelCoefficient>,
    /// Covariance of the nine coefficients in their order.
    pub covariance: Vec<Vec<f64>>,
    /// Sum of squares of the residuals over their standard errors.
    pub chi_square: f64,
    /// Number of stops less that of the determined coefficients.
    pub degrees_of_freedom: usize,
    /// Scatter of the norm beyond the standard errors of the stops \[g\]; it is included in the
    /// covariance.
    pub excess_g: f64,
    /// Calibration by the coefficients.
    #[serde(skip)]
    pub calibration: AccelCalibration,
}

/// Error of one accelerometer.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AccelCoefficient {
    /// Its name, such as `accel_x.bias`, `accel_x.scale` or `accel_x.misalignment_y`: the component along y of the
    /// input axis of x.
    pub name: String,
    /// The estimate.
    pub estimate: f64,
    /// Standard deviation.
    pub sigma: f64,
    /// Unit of `estimate` and `sigma`; empty for a ratio.
    pub unit: &'static str,
    /// `false` if the positions do not determine it; it is then what is expected beforehand.
    pub determined: bool,
}

/// Estimates biases, scales and misalignments of accelerometers in physical units from stops in two or
/// more positions, each with the norm of gravity. Coefficients that the positions do not determine keep
/// their expected size: 0.05 g, 5 % and 0.01 rad.
///
/// # Errors
///
/// [`Unfit::TooShort`] with fewer than two stops.
pub fn accel_from_positions(stops: &[StopMeans]) -> Result<AccelErrors, InstrumentError> {
    if stops.len() < 2 {
        return Err(InstrumentError::unfit(
            Unfit::TooShort,
            format!("{} static stop(s)", stops.len()),
            "at least two for errors of the accelerometers",
            "stop in more attitudes",
        ));
    }
    let mut excess_g = 0.0;
    let (mut fitted, mut determined) = fit(stops, excess_g);
    let chi_square = fitted.chi_square;
    let freedom = stops
        .len()
        .saturating_sub(determined.iter().filter(|is| **is).count());
    let p_value = gyrocal_statistics::chi_square_tail(chi_square, freedom as f64).unwrap_or(1.0);
    if freedom > 0 && p_value < EXPLAINED {
        // The excess at which the residuals are as large as expected (Mandel and Paule 1970).
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..24 {
            let middle = 0.5 * (low + high);
            if fit(stops, middle).0.chi_square > freedom as f64 {
                low = middle;
            } else {
                high = middle;
            }
        }
        excess_g = high;
        (fitted, determined) = fit(stops, excess_g);
    }
    let names = AXES;
    let misalignments = [(0, 1), (0, 2), (1, 2)];
    let coefficients = (0..UNKNOWNS).map(|index| {
        let (name, unit) = match index {
            0..3 => (format!("accel_{}.bias", names[index]), "g"),
            3..6 => (format!("accel_{}.scale", names[index - 3]), ""),
            _ => {
                let (axis, other) = misalignments[index - 6];
                (
                    format!("accel_{}.misalignment_{}", names[axis], names[other]),
                    "rad",
                )
            }
        };
        AccelCoefficient {
            name,
            estimate: fitted.unknowns[index],
            sigma: fitted.covariance[(index, index)].sqrt(),
            unit,
            determined: determined[index],
        }
    });
    Ok(AccelErrors {
        coefficients: coefficients.collect(),
        covariance: (0..UNKNOWNS)
            .map(|row| fitted.covariance.row(row).iter().copied().collect())
            .collect(),
        chi_square,
        degrees_of_freedom: freedom,
        excess_g,
        calibration: AccelCalibration {
            zero: core::array::from_fn(|axis| fitted.unknowns[axis]),
            matrix: matrix(&fitted.unknowns),
            norm_rms_g: rms(stops, &fitted.unknowns),
        },
    })
}

struct Fitted {
    unknowns: Vec<f64>,
    covariance: DMatrix<f64>,
    chi_square: f64,
}

/// Least squares of the norms with what is expected beforehand as further observations; also which
/// unknowns are determined.
fn fit(stops: &[StopMeans], excess_g: f64) -> (Fitted, [bool; UNKNOWNS]) {
    let sigma: Vec<f64> = stops
        .iter()
        .map(|stop| {
            let norm = norm(stop.accel);
            let variance = (0..3)
                .map(|axis| (stop.accel[axis] / norm * stop.accel_sigma[axis]).powi(2))
                .sum::<f64>();
            (variance + excess_g * excess_g).sqrt()
        })
        .collect();
    let residuals = |unknowns: &[f64], least_g: f64| {
        let mut all: Vec<f64> = stops
            .iter()
            .zip(&sigma)
            .map(|(stop, sigma)| (norm(force(stop.accel, unknowns)) - 1.0) / sigma.hypot(least_g))
            .collect();
        all.extend((0..UNKNOWNS).map(|index| unknowns[index] / EXPECTED[index / 3]));
        all
    };
    // With less and less scatter: what is known to 1e-5 and what is known to 0.05 make a narrow curved
    // valley, along which steps from afar would be tiny.
    let mut start = [0.0; UNKNOWNS].to_vec();
    for least_g in [1e-2, 1e-3, 1e-4] {
        let rough = minimise(&start, &[1e-6; UNKNOWNS], |unknowns| {
            residuals(unknowns, least_g)
        });
        start = rough.unknowns;
    }
    let minimum = minimise(&start, &[1e-6; UNKNOWNS], |unknowns| {
        residuals(unknowns, 0.0)
    });
    // With the expectations the normal matrix is never singular.
    let covariance = minimum.cofactors.clone().unwrap_or_else(|| {
        DMatrix::from_fn(UNKNOWNS, UNKNOWNS, |row, column| {
            if row == column {
                EXPECTED[row / 3].powi(2)
            } else {
                0.0
            }
        })
    });
    let determined = core::array::from_fn(|index| {
        covariance[(index, index)].sqrt() < DETERMINED * EXPECTED[index / 3]
    });
    let chi_square = minimum.residuals[..stops.len()].iter().map(|r| r * r).sum();
    let fitted = Fitted {
        unknowns: minimum.unknowns,
        covariance,
        chi_square,
    };
    (fitted, determined)
}

/// Specific force is this matrix times the output less the bias.
fn matrix(unknowns: &[f64]) -> [[f64; 3]; 3] {
    let scale = |axis: usize| 1.0 / (1.0 + unknowns[3 + axis]);
    let [xy, xz, yz] = [unknowns[6], unknowns[7], unknowns[8]];
    // Inverse of the upper triangle of input axes: output x is (1 + s) (f_x + xy f_y + xz f_z).
    [
        [scale(0), -xy * scale(1), (xy * yz - xz) * scale(2)],
        [0.0, scale(1), -yz * scale(2)],
        [0.0, 0.0, scale(2)],
    ]
}

fn force(output: [f64; 3], unknowns: &[f64]) -> [f64; 3] {
    matrix(unknowns).map(|row| {
        (0..3)
            .map(|axis| row[axis] * (output[axis] - unknowns[axis]))
            .sum()
    })
}

fn norm(force: [f64; 3]) -> f64 {
    force
        .iter()
        .map(|component| component * component)
        .sum::<f64>()
        .sqrt()
}

fn rms(stops: &[StopMeans], unknowns: &[f64]) -> f64 {
    let squares = stops
        .iter()
        .map(|stop| (norm(force(stop.accel, unknowns)) - 1.0).powi(2));
    (squares.sum::<f64>() / stops.len() as f64).sqrt()
}
