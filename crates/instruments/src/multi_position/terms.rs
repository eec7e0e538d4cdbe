//! Terms of the drift law as functions of specific force: columns of a linear regression.

use gyrocal::generated::catalogue::{PARAMETERS, SHAPES, dynamics_at_origin_jacobian};
use serde::Serialize;

/// Letters of the axes.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

/// Power of specific force along the input axis in each nominal term.
const NOMINAL_POWERS: [usize; 3] = [0, 1, 2];

/// One term of the drift of one gyro.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub enum Term {
    /// D_F, D_I or D_II, as the generated drift law has them.
    Nominal(usize),
    /// Proportional to specific force along another axis.
    Cross(usize),
    /// Proportional to a product of two components.
    Product(usize, usize),
    /// Proportional to the third power along the input axis.
    Cubic,
    /// Proportional to time.
    Ramp,
}

impl Term {
    /// The terms of the nominal law.
    pub const NOMINAL: [Self; 3] = [Self::Nominal(0), Self::Nominal(1), Self::Nominal(2)];

    /// The terms that the nominal law of a gyro lacks. The squares along the two other axes are exact
    /// equivalents, since the three squares sum to one: the first of them stands for both.
    #[must_use]
    pub fn catalogue(gyro: usize) -> Vec<Self> {
        let [j, k] = others(gyro);
        let product = |a: usize, b: usize| Self::Product(a.min(b), a.max(b));
        vec![
            Self::Cross(j),
            Self::Cross(k),
            product(j, k),
            product(gyro, j),
            product(gyro, k),
            Self::Product(j, j),
            Self::Cubic,
            Self::Ramp,
        ]
    }

    /// Public name, such as `gyro_x.g_y`.
    #[must_use]
    pub fn id(self, gyro: usize) -> String {
        let i = AXES[gyro];
        match self {
            Self::Nominal(which) => match NOMINAL_POWERS[which] {
                0 => format!("gyro_{i}.bias"),
                power => format!("gyro_{i}.g_{}", i.repeat(power)),
            },
            Self::Cross(j) => format!("gyro_{i}.g_{}", AXES[j]),
            Self::Product(j, k) => format!("gyro_{i}.g_{}{}", AXES[j], AXES[k]),
            Self::Cubic => format!("gyro_{i}.g_{}", i.repeat(3)),
            Self::Ramp => format!("gyro_{i}.ramp"),
        }
    }

    /// Unit of its coefficient.
    #[must_use]
    pub fn unit(self, gyro: usize) -> &'static str {
        self.parameter(gyro)
            .map_or("", |parameter| PARAMETERS[parameter].unit)
    }

    /// Its index among the parameters of the generated catalogue.
    pub(crate) fn parameter(self, gyro: usize) -> Option<usize> {
        let id = self.id(gyro);
        PARAMETERS.iter().position(|parameter| parameter.id == id)
    }

    /// Names of its exact equivalents, which have the opposite sign.
    #[must_use]
    pub fn equivalents(self, gyro: usize) -> Vec<String> {
        match self {
            Self::Product(j, k) if j == k => {
                let other = 3 - gyro - j;
                vec![Self::Product(other, other).id(gyro)]
            }
            _ => Vec::new(),
        }
    }
}

/// Drift of a gyro per unit of each parameter of the generated catalogue \[deg/h\], at a specific force
/// and a time after the first stop.
///
/// It is the Jacobian of the generated rates of the platform angles with respect to the
/// parameters, at zero angles, where W is the identity and the chart's axes are those of the
/// gyros, with the Earth at rest: the drift law alone.
pub(crate) fn response(gyro: usize, force_g: &[f64; 3], time_s: f64) -> [f64; PARAMETERS.len()] {
    // The Jacobian is taken at sizes of zero: onsets and time constants only have to be divisors.
    let shapes = [1.0; SHAPES.len()];
    let jacobian = dynamics_at_origin_jacobian(
        &[0.0; PARAMETERS.len()],
        &[0.0; 3],
        force_g,
        &[1.0, 0.0, 0.0],
        &[0.0; 3],
        &[time_s, 1.0, 0.0],
        &shapes,
    );
    let per_deg_per_h = 3600.0 * 1.0_f64.to_degrees();
    jacobian.theta_dot_d_parameters_dense()[gyro].map(|rate| rate * per_deg_per_h)
}

fn others(gyro: usize) -> [usize; 2] {
    match gyro {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_term_of_every_gyro_is_its_product_of_components() {
        let force_g = [0.2, -0.5, 0.8];
        let half_a_day_s = 43_200.0;
        for gyro in 0..3 {
            let response = response(gyro, &force_g, half_a_day_s);
            for term in Term::NOMINAL.into_iter().chain(Term::catalogue(gyro)) {
                let expected = match term {
                    Term::Nominal(power) => force_g[gyro].powi(power as i32),
                    Term::Cross(j) => force_g[j],
                    Term::Product(j, k) => force_g[j] * force_g[k],
                    Term::Cubic => force_g[gyro].powi(3),
                    Term::Ramp => 0.5,
                };
                let id = term.id(gyro);
                let found = term.parameter(gyro).map(|parameter| response[parameter]);
                // A few operations, and the way to rad/s and back.
                let error = found.map(|found| (found - expected).abs());
                assert!(error.is_some_and(|error| error < 1e-14), "{id} {found:?}");
                assert!(term.unit(gyro).starts_with("deg/h"), "{id}");
            }
        }
    }
}
