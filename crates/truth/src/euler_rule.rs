//! The paper's own way to make data: explicit Euler steps on three Euler angles.

use libm::{cos, sin};

use crate::attitude::Attitude;
use crate::error::Error;
use crate::gyro_noise::GyroNoise;
use crate::sampling::Sampling;
use crate::scenario::Scenario;
use crate::simulation::{Simulation, Truth};

const RAD_PER_S_PER_DEG_PER_H: f64 = core::f64::consts::PI / 180.0 / 3600.0;

/// Simulates a scenario by one explicit Euler step for each interval on the angles of the
/// platform against local east, north, up: eq. (14) of Li Zhong (2015) with Δt the interval.
///
/// It takes the noise of [`simulate`](crate::simulate) with the same seed. The platform turns a
/// quarter of a degree a minute, so the rule is wrong by 1e-5 rad a step; data made by it can
/// only be explained by a filter with the same rule. It fails where the angle about y comes
/// near a quarter turn.
///
/// # Errors
///
/// [`Error::InvalidScenario`] if a value of the scenario makes no sense, or if it hides
/// anything, which only the exact simulation can do.
pub fn euler_rule(scenario: &Scenario) -> Result<Simulation, Error> {
    scenario.check()?;
    if let Some(hidden) = scenario.hidden.first() {
        return Err(Error::InvalidScenario {
            name: "hidden",
            found: hidden.id().to_owned(),
            expected: "nothing: the Euler rule knows no hidden effects".to_owned(),
        });
    }
    let platform = scenario.platform();
    let earth_rate_enu = platform.earth_rate_enu_rad_per_s();
    let up_enu_g = [0.0, 0.0, platform.specific_force_at_rest_g];
    let mut angles_rad = platform.initial_platform_c_enu.angles_rad();
    let mut gyro_noise = GyroNoise::new(scenario);
    let mut sampling = Sampling::new(scenario, &[], scenario.temperature_course());
    let mut truth = Truth {
        coefficients: scenario.coefficients,
        hidden: Vec::new(),
        platform_c_enu: Vec::new(),
        drift_deg_per_h: Vec::new(),
        outliers: Vec::new(),
    };
    for (row, clock_s) in scenario.grid_s().enumerate() {
        if row > 0 {
            let noise = gyro_noise.next_deg_per_h(scenario.interval_s);
            let platform_c_enu = Attitude::from_angles_rad(angles_rad);
            let drift = scenario
                .coefficients
                .drift_deg_per_h(platform_c_enu.resolve(up_enu_g));
            let earth_rate = platform_c_enu.resolve(earth_rate_enu);
            let relative_rate = core::array::from_fn(|axis| {
                (drift[axis] + noise[axis]) * RAD_PER_S_PER_DEG_PER_H - earth_rate[axis]
            });
            let rates = angle_rates(angles_rad, relative_rate);
            angles_rad =
                core::array::from_fn(|axis| angles_rad[axis] + scenario.interval_s * rates[axis]);
        }
        let platform_c_enu = Attitude::from_angles_rad(angles_rad);
        let accel_g = platform_c_enu.resolve(up_enu_g);
        if sampling.log(row, clock_s, accel_g) {
            truth.platform_c_enu.push(platform_c_enu);
            let drift = scenario.coefficients.drift_deg_per_h(accel_g);
            truth.drift_deg_per_h.push(drift);
        }
    }
    let (record, outliers) = sampling.into_record();
    truth.outliers = outliers;
    Ok(Simulation {
        record,
        bench: scenario.bench(),
        truth,
    })
}

/// Rates of the angles about x, y, z of a frame that turns at a rate in its own axes.
///
/// The turn about z is about the frame's own z axis; that about y is about an axis in its x–y
/// plane, which the angle about z turns away from y; that about x has, in the frame before the
/// turn about z, the components (cos y, 0, sin y).
fn angle_rates([_, y, z]: [f64; 3], rate: [f64; 3]) -> [f64; 3] {
    let (sin_z, cos_z) = (sin(z), cos(z));
    let before_z = [
        cos_z * rate[0] - sin_z * rate[1],
        sin_z * rate[0] + cos_z * rate[1],
    ];
    let about_x = before_z[0] / cos(y);
    [about_x, before_z[1], rate[2] - about_x * sin(y)]
}
