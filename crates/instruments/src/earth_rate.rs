//! Earth rate, and units of rates.

use gyrocal::EARTH_RATE_RAD_PER_S;

/// Horizontal and vertical component of Earth rate \[deg/h\].
pub(crate) fn earth_deg_per_h(latitude_deg: f64) -> [f64; 2] {
    let (sine, cosine) = latitude_deg.to_radians().sin_cos();
    [cosine, sine].map(|part| part * deg_per_h(EARTH_RATE_RAD_PER_S))
}

/// A rate in rad/s converted to deg/h.
pub(crate) fn deg_per_h(rad_per_s: f64) -> f64 {
    rad_per_s.to_degrees() * 3600.0
}
