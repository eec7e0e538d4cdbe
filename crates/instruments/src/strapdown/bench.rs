//! The bench description of an imported record.

use gyrocal::generated::platform::reanchor;
use gyrocal_record::Bench;
use nalgebra::{Matrix3, Vector3};

use super::ImportSettings;
use super::rotation_fit::RotationFit;
use crate::earth_rate::earth_deg_per_h;
use crate::error::InstrumentError;

/// The bench description, made as the text of a bench file and parsed as any other.
pub(super) fn bench(
    fit: &RotationFit,
    latitude_deg: f64,
    heading_deg: f64,
    gyro_noise_deg_per_h: f64,
    settings: &ImportSettings,
) -> Result<Bench, InstrumentError> {
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
    let sigma_deg = uncorrelated_deg(&of_heading, settings.level_sigma_deg);
    // A simulated log may have none, which no bench file can say.
    let positive = |value: f64| value.max(1e-9);
    let bias = settings.bias_sigma_deg_per_h;
    let text = format!(
        "[site]\nlatitude_deg = {latitude_deg:?}\n\n[platform]\ninitial_angles_deg = \
         {angles_deg:?}\ninitial_angles_sigma_deg = {sigma_deg:?}\n\n[noise]\naccel_g = {:?}\n\
         gyro_deg_per_h = {:?}\n\n[prior]\nbias_sigma_deg_per_h = {bias:?}\n\
         g_sigma_deg_per_h_per_g = {bias:?}\ngg_sigma_deg_per_h_per_g2 = {bias:?}\n",
        positive(fit.residual_rms_g),
        positive(gyro_noise_deg_per_h),
    );
    Ok(Bench::parse(&text, "bench")?)
}

/// Uncorrelated sigmas of angles that an error of heading of one sigma moves together by `of_heading`,
/// in addition to errors of the level.
///
/// A bench file has no correlations. Uncorrelated variances e of the angles allow a joint error of one
/// sigma, a_i of angle i, if the sum of a_i² / e_i is 1; of these the least sum of variances has
/// e_i = a_i times the sum of all a.
fn uncorrelated_deg(of_heading: &[f64; 3], level_sigma_deg: f64) -> [f64; 3] {
    let together: f64 = of_heading.iter().sum();
    of_heading.map(|moved| (moved * together).sqrt().min(180.0).hypot(level_sigma_deg))
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

/// Error of each platform angle by an error of heading, a small rotation about the vertical: W takes
/// errors of angles to small rotations in platform axes.
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

#[cfg(test)]
mod tests {
    use super::uncorrelated_deg;

    #[test]
    fn sigmas_grow_with_what_moves_together_and_not_at_a_threshold() {
        // One angle alone is moved: nothing is added but the level.
        assert_eq!(uncorrelated_deg(&[0.0, 0.0, 1.0], 0.0), [0.0, 0.0, 1.0]);
        // All alike: each by the square root of three.
        let alike = uncorrelated_deg(&[1.0; 3], 0.0);
        assert!(
            alike
                .iter()
                .all(|sigma| (sigma - 3_f64.sqrt()).abs() < 1e-12)
        );
        // Beside a degree about z, movements as large as the level are a hundredth: half a
        // percent for each of them.
        for moved in [0.0099, 0.01, 0.0101] {
            let [x, y, z] = uncorrelated_deg(&[moved, moved, 1.0], 0.01);
            assert!((1.0..1.011).contains(&z), "{z}");
            // Still a turn by one sigma, up to the level.
            let turn = (moved / x).powi(2) + (moved / y).powi(2) + (1.0 / z).powi(2);
            assert!((0.98..=1.0).contains(&turn), "{turn}");
        }
    }
}
