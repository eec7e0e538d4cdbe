//! The turn of gravity over a whole record, against that of the Earth.

use gyrocal::EARTH_RATE_RAD_PER_S;
use gyrocal_statistics::mean;

use crate::prior::{horizontal_sigma_deg_per_h, vertical_sigma_deg_per_h};
use crate::rate::{Rate, WINDOW_S, rates};
use crate::samples::{Complete, Samples};
use crate::text::number;

/// Rate of the Earth, deg/h.
pub(crate) const EARTH_DEG_PER_H: f64 =
    3600.0 * EARTH_RATE_RAD_PER_S * 180.0 / core::f64::consts::PI;

/// A component of the rate is wrong beyond so many standard deviations of the prior's drift.
const VERTICAL_SIGMAS: f64 = 4.6;
const HORIZONTAL_SIGMAS: f64 = 4.0;

/// By how much a standard deviation of the drift, over the horizontal rate of the Earth, widens these.
const FAST_DRIFT: f64 = 1.5;

/// Over a shorter record the mean drift about the vertical is less known.
const DAY_S: f64 = 86_400.0;

/// What the rows say of the turn of gravity; rates in deg/h.
pub(crate) struct Turn {
    /// Along the vertical, trimmed mean over all windows.
    pub(crate) vertical_deg_per_h: f64,
    /// Across the vertical, trimmed mean over all windows.
    pub(crate) horizontal_deg_per_h: f64,
    /// By how much these may be off.
    pub(crate) vertical_tolerance_deg_per_h: f64,
    pub(crate) horizontal_tolerance_deg_per_h: f64,
    /// Time from the first row to the last, s.
    pub(crate) span_s: f64,
    /// The rate in the first window.
    pub(crate) first: Rate,
}

impl Turn {
    /// `None` if the rows do not determine the rate.
    pub(crate) fn of(samples: &Samples<'_>, complete: &[Complete]) -> Option<Self> {
        let found = rates(complete, WINDOW_S);
        let first = *found.first()?;
        let deg_per_h = |of: fn(&Rate) -> f64| {
            let all: Vec<f64> = found.iter().map(of).collect();
            trimmed_mean(all).to_degrees() * 3600.0
        };
        let span_s = complete.last()?.time_s - complete.first()?.time_s;
        let shortness = (DAY_S / span_s).max(1.0).sqrt();
        let sigma = vertical_sigma_deg_per_h(samples.bench, complete);
        let horizontal_sigma = horizontal_sigma_deg_per_h(samples.bench);
        let cosine = samples.bench.latitude_deg.to_radians().cos();
        // A platform that drifts fast beside the turn of gravity changes the rate within a window.
        let inexact = 1.0_f64.hypot(FAST_DRIFT * horizontal_sigma / (EARTH_DEG_PER_H * cosine));
        Some(Self {
            vertical_deg_per_h: deg_per_h(|rate| rate.vertical_rad_per_s),
            horizontal_deg_per_h: deg_per_h(|rate| rate.horizontal_rad_per_s),
            vertical_tolerance_deg_per_h: VERTICAL_SIGMAS * sigma * shortness * inexact,
            horizontal_tolerance_deg_per_h: HORIZONTAL_SIGMAS
                * horizontal_sigma
                * shortness
                * inexact,
            span_s,
            first,
        })
    }

    /// Whether the vertical rate is that at a latitude.
    pub(crate) fn fits_vertical(&self, sign: f64, latitude_rad: f64) -> bool {
        self.vertical_misfit(sign, latitude_rad) <= self.vertical_tolerance_deg_per_h
    }

    pub(crate) fn vertical_misfit(&self, sign: f64, latitude_rad: f64) -> f64 {
        (sign * self.vertical_deg_per_h - EARTH_DEG_PER_H * latitude_rad.sin()).abs()
    }

    pub(crate) fn fits_horizontal(&self, latitude_rad: f64) -> bool {
        (self.horizontal_deg_per_h - EARTH_DEG_PER_H * latitude_rad.cos()).abs()
            <= self.horizontal_tolerance_deg_per_h
    }

    /// The rates in words.
    pub(crate) fn evidence(&self, latitude_rad: f64) -> String {
        format!(
            "gravity turns by {} deg/h about the vertical and {} deg/h across it, at {} deg the \
             Earth by {} and {}; the drift of the gyros may be {} and {}",
            number(self.vertical_deg_per_h),
            number(self.horizontal_deg_per_h),
            number(latitude_rad.to_degrees()),
            number(EARTH_DEG_PER_H * latitude_rad.sin()),
            number(EARTH_DEG_PER_H * latitude_rad.cos()),
            number(self.vertical_tolerance_deg_per_h),
            number(self.horizontal_tolerance_deg_per_h),
        )
    }
}

/// Mean without the smallest and the largest fifth: the drift about the vertical averages out over a
/// day, and a window in which gravity hardly moved is far off.
fn trimmed_mean(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let cut = values.len() / 5;
    mean(&values[cut..values.len() - cut])
}

/// A latitude that was given in radians as if these were degrees; rad.
pub(crate) fn in_degrees(latitude_deg: f64) -> Option<f64> {
    (latitude_deg.abs() <= core::f64::consts::FRAC_PI_2 && latitude_deg != 0.0)
        .then_some(latitude_deg)
}
