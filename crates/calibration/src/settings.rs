//! Settings of the filter and prior of the attitude from a bench description.

use gyrocal::{Discretisation, Drift, FilterSettings, InitialAttitude, Site};
use gyrocal_record::Bench;

/// Settings of the streaming filter according to a bench description.
#[must_use]
pub fn filter_settings(bench: &Bench, discretisation: Discretisation<f64>) -> FilterSettings<f64> {
    let site = Site {
        gravity_g: bench.specific_force_at_rest(),
        ..Site::at_latitude_deg(bench.latitude_deg)
    };
    FilterSettings {
        drift_sigma: drift_prior_sigma(bench),
        accel_noise_g: bench.accel_noise_g,
        drift_noise_deg_per_h: bench.gyro_noise_deg_per_h,
        discretisation,
        ..FilterSettings::at_site(site)
    }
}

/// Attitude that a bench description declares for the first row; `None` if it declares none.
#[must_use]
pub fn declared_attitude(bench: &Bench) -> Option<InitialAttitude<f64>> {
    Some(InitialAttitude::Angles {
        angles_rad: bench.initial_angles_deg?.map(f64::to_radians),
        sigma_rad: bench.initial_angles_sigma_deg.map(f64::to_radians),
    })
}

/// Prior standard deviations of the coefficients for one turn-on.
pub(crate) fn drift_prior_sigma(bench: &Bench) -> Drift<f64> {
    let prior = &bench.prior;
    let [x, y, z] = core::array::from_fn(|i| {
        [
            prior.bias_sigma_deg_per_h[i].hypot(prior.turn_on_sigma_deg_per_h[i]),
            prior.g_sigma_deg_per_h_per_g[i],
            prior.gg_sigma_deg_per_h_per_g2[i],
        ]
    });
    Drift {
        gyro_x_bias: x[0],
        gyro_x_g_x: x[1],
        gyro_x_g_xx: x[2],
        gyro_y_bias: y[0],
        gyro_y_g_y: y[1],
        gyro_y_g_yy: y[2],
        gyro_z_bias: z[0],
        gyro_z_g_z: z[1],
        gyro_z_g_zz: z[2],
    }
}
