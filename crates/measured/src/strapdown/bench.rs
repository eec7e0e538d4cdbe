//! The bench description of an imported record.

use gyrocal::generated::platform::reanchor;
use gyrocal_record::Bench;
use nalgebra::{Matrix3, Vector3};

use super::{ImportSettings, RotationFit, earth_deg_per_h};
use crate::error::MeasuredError;

/// The bench file's text, read back as any bench file is.
pub(super) fn bench(
    fit: &RotationFit,
    latitude_deg: f64,
    heading_deg: f64,
    gyro_noise_deg_per_h: f64,
    settings: &ImportSettings,
) -> Result<Bench, MeasuredError> {
    let horizontal = earth_deg_per_h(latitude_deg)[0];
    let (turn_deg, heading_sigma_deg) = match settings.heading_deg {
        Some([given_deg, sigma_deg]) => (given_deg - heading_deg, sigma_deg),
        // A gyro that errs toward east by its bias turns north by bias over horizontal rate.
        None => (
            0.0,
            (settings.bias_sigma_deg_per_h / horizontal)
                .to_degrees()
                .min(180.0),
        ),
    };
    let angles_deg = angles_deg(&fit.turned_platform_c_enu(turn_deg.to_radians()));
    let of_heading = sigma_deg(&angles_deg, &fit.up, heading_sigma_deg);
    // A bench file knows no correlations: a turn about the vertical by one sigma would be as many
    // as it moves angles.
    let moved = of_heading
        .iter()
        .filter(|sigma| **sigma > settings.level_sigma_deg);
    let share = (moved.count().max(1) as f64).sqrt();
    let sigma_deg = of_heading.map(|of_heading| {
        (share * of_heading)
            .min(180.0)
            .hypot(settings.level_sigma_deg)
    });
    // A simulated log may have none, which no bench file can say.
    let positive = |value: f64| value.max(1e-9);
    let bias = settings.bias_sigma_deg_per_h;
    let text = format!(
        "[site]\nlatitude_deg = {latitude_deg:?}\n\n[platform]\ninitial_angles_deg = \
         {angles_deg:?}\ninitial_angles_sigma_deg = {sigma_deg:?}\n\n[noise]\naccel_g = {:?}\n\
         gyro_deg_per_h = {:?}\n\n[prior]\nbias_sigma_deg_per_h = {bias:?}\n\
         g_sigma_deg_per_h_per_g = {bias:?}\ngg_sigma_deg_per_h_per_g2 = {bias:?}\n",
        positive(fit.residual_rms),
        positive(gyro_noise_deg_per_h),
    );
    Ok(Bench::parse(&text, "bench")?)
}

/// Platform angles, rotations about x, then y, then z, of equation (4) in docs/model.md.
fn angles_deg(platform_c_enu: &[[f64; 3]; 3]) -> [f64; 3] {
    let c = platform_c_enu;
    [
        (-c[2][1]).atan2(c[2][2]),
        c[2][0].clamp(-1.0, 1.0).asin(),
        (-c[1][0]).atan2(c[0][0]),
    ]
    .map(f64::to_degrees)
}

/// What an error of heading, a small turn about the vertical, is to each platform angle: W takes
/// errors of angles to small turns in platform axes.
fn sigma_deg(angles_deg: &[f64; 3], up: &[f64; 3], heading_sigma_deg: f64) -> [f64; 3] {
    let rate_matrix = reanchor(&angles_deg.map(f64::to_radians)).rotation_d_theta_dense();
    let turn = Vector3::from(*up) * heading_sigma_deg;
    let rows = rate_matrix.map(nalgebra::RowVector3::from);
    match Matrix3::from_rows(&rows).try_inverse() {
        // Near 90 deg about y no angle is known.
        Some(inverse) => (inverse * turn).map(|error| error.abs().min(180.0)).into(),
        None => [180.0; 3],
    }
}
