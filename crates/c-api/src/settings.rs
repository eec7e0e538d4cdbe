use gyrocal::{Discretisation, Drift, FilterSettings, InitialAttitude, Integration, Limits, Site};

use crate::status::{GYROCAL_NULL, GYROCAL_OK};

/// Number of drift coefficients: bias, g and g² term of gyro x, then of y and z.
pub const GYROCAL_COEFFICIENTS: usize = 9;

/// Settings of a filter. gyrocal_default_settings fills them. gyrocal_init refuses a number outside its
/// domain, and anything that is no number.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct GyrocalSettings {
    /// Astronomic latitude, rad, north positive; from -pi/2 to pi/2.
    pub latitude_rad: f32,
    /// Sidereal rotation rate of the Earth, rad/s; finite.
    pub earth_rate_rad_per_s: f32,
    /// Local gravity in the unit of the samples; positive, finite.
    pub gravity_g: f32,
    /// Prior means of the coefficients: deg/h, deg/h/g, deg/h/g²; finite.
    pub drift: [f32; 9],
    /// Their standard deviations; positive, as is the square.
    pub drift_sigma: [f32; 9],
    /// Platform angles against East, North, Up at the first sample, about x, then y, then z, rad;
    /// finite.
    pub angles_rad: [f32; 3],
    /// Their standard deviations, rad; positive, as is the square.
    pub angles_sigma_rad: [f32; 3],
    /// Standard deviation of one sample, g; positive, as is the square.
    pub accel_noise_g: f32,
    /// Standard deviation of the white drift noise held over one minute, deg/h; positive,
    /// as is the square.
    pub drift_noise_deg_per_h: f32,
    /// Longest interval that is integrated in one step, s; longer ones are divided. Positive; may be
    /// infinite.
    pub longest_step_s: f32,
    /// Explicit Euler instead of Runge-Kutta if not 0.
    pub euler: u32,
    /// Largest reading of an accelerometer, g; positive, may be infinite.
    pub largest_force_g: f32,
    /// Longest interval of a call, s; positive, may be infinite.
    pub longest_interval_s: f32,
    /// Largest normalised innovation squared of a sample that is taken; positive, and infinite to take all.
    pub largest_nis: f32,
}

impl GyrocalSettings {
    pub(crate) fn filter(&self) -> FilterSettings<f32> {
        FilterSettings {
            site: Site {
                latitude_rad: self.latitude_rad,
                earth_rate_rad_per_s: self.earth_rate_rad_per_s,
                gravity_g: self.gravity_g,
            },
            drift: Drift::from_array(self.drift),
            drift_sigma: Drift::from_array(self.drift_sigma),
            accel_noise_g: self.accel_noise_g,
            drift_noise_deg_per_h: self.drift_noise_deg_per_h,
            discretisation: Discretisation {
                integration: if self.euler == 0 {
                    Integration::RK4
                } else {
                    Integration::EULER
                },
                longest_step_s: self.longest_step_s,
                ..Discretisation::default()
            },
        }
    }

    pub(crate) fn attitude(&self) -> InitialAttitude<f32> {
        InitialAttitude::Angles {
            angles_rad: self.angles_rad,
            sigma_rad: self.angles_sigma_rad,
        }
    }

    pub(crate) fn limits(&self) -> Limits<f32> {
        Limits {
            largest_force_g: self.largest_force_g,
            longest_interval_s: self.longest_interval_s,
            largest_nis: self.largest_nis,
        }
    }
}

/// Fills the settings of a platform that is aligned with East, North, Up to 0.01 deg at a latitude
/// in rad: coefficients of zero known to 1 deg/h (per g, per g²), noise of 1e-5 g and 0.002 deg/h,
/// samples to 2 g, intervals to an hour, a NIS to 34.08: a sound record exceeds it once in ten years at
/// one sample a minute.
///
/// # Safety
/// `settings` must be null or point to settings.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gyrocal_default_settings(
    settings: *mut GyrocalSettings,
    latitude_rad: f32,
) -> i32 {
    if settings.is_null() {
        return GYROCAL_NULL;
    }
    let filter = FilterSettings::at_site(Site::at_latitude_rad(latitude_rad));
    let limits = Limits::<f32>::default();
    let aligned = match InitialAttitude::aligned() {
        InitialAttitude::Angles { sigma_rad, .. }
        | InitialAttitude::Orientation { sigma_rad, .. } => sigma_rad,
    };
    let defaults = GyrocalSettings {
        latitude_rad,
        earth_rate_rad_per_s: filter.site.earth_rate_rad_per_s,
        gravity_g: filter.site.gravity_g,
        drift: filter.drift.to_array(),
        drift_sigma: filter.drift_sigma.to_array(),
        angles_rad: [0.0; 3],
        angles_sigma_rad: aligned,
        accel_noise_g: filter.accel_noise_g,
        drift_noise_deg_per_h: filter.drift_noise_deg_per_h,
        longest_step_s: filter.discretisation.longest_step_s,
        euler: 0,
        largest_force_g: limits.largest_force_g,
        longest_interval_s: limits.longest_interval_s,
        largest_nis: limits.largest_nis,
    };
    // SAFETY: not null, and the caller vouches for the rest.
    unsafe { settings.write(defaults) };
    GYROCAL_OK
}
