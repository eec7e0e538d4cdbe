use gyrocal::{Drift, Settings, Site};
use gyrocal_record::Bench;

/// What the streaming filter starts from according to a bench description; `None` if that does
/// not say how the platform lies.
#[must_use]
pub fn filter_settings(bench: &Bench) -> Option<Settings<f64>> {
    let angles_deg = bench.initial_angles_deg?;
    Some(Settings {
        angles_rad: angles_deg.map(f64::to_radians),
        angles_sigma_rad: bench.initial_angles_sigma_deg.map(f64::to_radians),
        ..level(bench)
    })
}

/// The same for a platform whose attitude is still to be set.
pub(crate) fn level(bench: &Bench) -> Settings<f64> {
    let prior = &bench.prior;
    let [x, y, z] = core::array::from_fn(|i| {
        [
            prior.bias_sigma_deg_per_h[i].hypot(prior.turn_on_sigma_deg_per_h[i]),
            prior.g_sigma_deg_per_h_per_g[i],
            prior.gg_sigma_deg_per_h_per_g2[i],
        ]
    });
    let site = Site {
        gravity_g: bench.specific_force_at_rest(),
        ..Site::at_latitude_deg(bench.latitude_deg)
    };
    Settings {
        drift_sigma: Drift {
            gyro_x_bias: x[0],
            gyro_x_g_x: x[1],
            gyro_x_g_xx: x[2],
            gyro_y_bias: y[0],
            gyro_y_g_y: y[1],
            gyro_y_g_yy: y[2],
            gyro_z_bias: z[0],
            gyro_z_g_z: z[1],
            gyro_z_g_zz: z[2],
        },
        accel_noise_g: bench.accel_noise_g,
        drift_noise_deg_per_h: bench.gyro_noise_deg_per_h,
        ..Settings::level_at(site)
    }
}
