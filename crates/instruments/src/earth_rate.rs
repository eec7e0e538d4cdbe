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

/// Whether a rate about specific force with its standard deviation \[deg/h\] is that of an Earth that turns the other way
/// round; `None` if it does not tell.
pub(crate) fn is_against([rate, sigma]: [f64; 2], vertical_deg_per_h: f64) -> Option<bool> {
    /// Share of Earth rate that tilt and scale may take.
    const OF_EARTH: f64 = 0.02;
    let earth = vertical_deg_per_h.abs();
    let off = (3.0 * sigma).max(OF_EARTH * earth);
    (10.0 * sigma < earth).then_some((rate + vertical_deg_per_h).abs() < off)
}
