//! The drift coefficients and the drift law.

/// Drift coefficients of the three gyros; each array is that of gyros x, y, z.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Coefficients {
    /// Constant drift.
    pub bias_deg_per_h: [f64; 3],
    /// Drift proportional to the specific force along the gyro's axis.
    pub g_deg_per_h_per_g: [f64; 3],
    /// Drift proportional to its square.
    pub gg_deg_per_h_per_g2: [f64; 3],
}

impl Coefficients {
    /// No drift.
    pub const NONE: Self = Self {
        bias_deg_per_h: [0.0; 3],
        g_deg_per_h_per_g: [0.0; 3],
        gg_deg_per_h_per_g2: [0.0; 3],
    };

    /// The coefficients of Table 1 of Li Zhong (2015), with the signs of specific force, up
    /// positive.
    ///
    /// The clean record `tests/data/cases/S11.csv`, which another simulator made with them, gives
    /// them back within 1e-3. With them, at latitude 39.1° and aligned to east, north, up at first,
    /// the platform passes half a degree from an angle about y of 90° on the fourth day.
    pub const PAPER_LIKE: Self = Self {
        bias_deg_per_h: [0.5, -0.5, 0.5],
        g_deg_per_h_per_g: [-0.2, 0.2, 0.2],
        gg_deg_per_h_per_g2: [-0.1, 0.1, -0.1],
    };

    /// Drift of the three gyros under a specific force in platform axes \[deg/h\].
    #[must_use]
    pub fn drift_deg_per_h(&self, accel_g: [f64; 3]) -> [f64; 3] {
        core::array::from_fn(|gyro| {
            let along = accel_g[gyro];
            self.bias_deg_per_h[gyro]
                + along * (self.g_deg_per_h_per_g[gyro] + along * self.gg_deg_per_h_per_g2[gyro])
        })
    }

    /// Name, value and unit of each coefficient, gyro by gyro.
    #[must_use]
    pub fn named(&self) -> [(&'static str, f64, &'static str); 9] {
        const NAMES: [[&str; 3]; 3] = [
            ["gyro_x.bias", "gyro_x.g_x", "gyro_x.g_xx"],
            ["gyro_y.bias", "gyro_y.g_y", "gyro_y.g_yy"],
            ["gyro_z.bias", "gyro_z.g_z", "gyro_z.g_zz"],
        ];
        const UNITS: [&str; 3] = ["deg/h", "deg/h/g", "deg/h/g^2"];
        let kinds = [
            self.bias_deg_per_h,
            self.g_deg_per_h_per_g,
            self.gg_deg_per_h_per_g2,
        ];
        core::array::from_fn(|index| {
            let (gyro, kind) = (index / 3, index % 3);
            (NAMES[gyro][kind], kinds[kind][gyro], UNITS[kind])
        })
    }
}
