//! Terms of the drift law as functions of specific force: columns of a linear regression.

use gyrocal::generated::catalogue::{
    PARAMETERS, SHAPES, dynamics_at_origin_jacobian, parameters_index as parameter,
};
use serde::Serialize;

/// Indices of the terms of one gyro among the parameters of the generated catalogue.
struct Indices {
    nominal: [usize; 3],
    /// Linear terms by axis.
    linear: [usize; 3],
    /// Products of the components along x and x, x and y, x and z, y and y, y and z, z and z.
    products: [usize; 6],
    cubic: usize,
    ramp: usize,
}

const INDICES: [Indices; 3] = [
    Indices {
        nominal: [
            parameter::GYRO_X_BIAS,
            parameter::GYRO_X_G_X,
            parameter::GYRO_X_G_XX,
        ],
        linear: [
            parameter::GYRO_X_G_X,
            parameter::GYRO_X_G_Y,
            parameter::GYRO_X_G_Z,
        ],
        products: [
            parameter::GYRO_X_G_XX,
            parameter::GYRO_X_G_XY,
            parameter::GYRO_X_G_XZ,
            parameter::GYRO_X_G_YY,
            parameter::GYRO_X_G_YZ,
            parameter::GYRO_X_G_ZZ,
        ],
        cubic: parameter::GYRO_X_G_XXX,
        ramp: parameter::GYRO_X_RAMP,
    },
    Indices {
        nominal: [
            parameter::GYRO_Y_BIAS,
            parameter::GYRO_Y_G_Y,
            parameter::GYRO_Y_G_YY,
        ],
        linear: [
            parameter::GYRO_Y_G_X,
            parameter::GYRO_Y_G_Y,
            parameter::GYRO_Y_G_Z,
        ],
        products: [
            parameter::GYRO_Y_G_XX,
            parameter::GYRO_Y_G_XY,
            parameter::GYRO_Y_G_XZ,
            parameter::GYRO_Y_G_YY,
            parameter::GYRO_Y_G_YZ,
            parameter::GYRO_Y_G_ZZ,
        ],
        cubic: parameter::GYRO_Y_G_YYY,
        ramp: parameter::GYRO_Y_RAMP,
    },
    Indices {
        nominal: [
            parameter::GYRO_Z_BIAS,
            parameter::GYRO_Z_G_Z,
            parameter::GYRO_Z_G_ZZ,
        ],
        linear: [
            parameter::GYRO_Z_G_X,
            parameter::GYRO_Z_G_Y,
            parameter::GYRO_Z_G_Z,
        ],
        products: [
            parameter::GYRO_Z_G_XX,
            parameter::GYRO_Z_G_XY,
            parameter::GYRO_Z_G_XZ,
            parameter::GYRO_Z_G_YY,
            parameter::GYRO_Z_G_YZ,
            parameter::GYRO_Z_G_ZZ,
        ],
        cubic: parameter::GYRO_Z_G_ZZZ,
        ramp: parameter::GYRO_Z_RAMP,
    },
];

/// One term of the drift of one gyro.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Term {
    /// D_F, D_I or D_II of the nominal law: proportional to this power of specific force along the input
    /// axis.
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
    pub fn id(self, gyro: usize) -> &'static str {
        PARAMETERS[self.parameter(gyro)].id
    }

    /// Unit of its coefficient.
    #[must_use]
    pub fn unit(self, gyro: usize) -> &'static str {
        PARAMETERS[self.parameter(gyro)].unit
    }

    /// Axes of the components of specific force that it is the product of; empty for the ramp.
    #[must_use]
    pub fn factors(self, gyro: usize) -> Vec<usize> {
        match self {
            Self::Nominal(power) => vec![gyro; power],
            Self::Cross(j) => vec![j],
            Self::Product(j, k) => vec![j, k],
            Self::Cubic => vec![gyro; 3],
            Self::Ramp => Vec::new(),
        }
    }

    /// Its index among the parameters of the generated catalogue.
    pub(crate) fn parameter(self, gyro: usize) -> usize {
        let indices = &INDICES[gyro];
        match self {
            Self::Nominal(power) => indices.nominal[power],
            Self::Cross(j) => indices.linear[j],
            Self::Product(j, k) => {
                let (first, second) = (j.min(k), j.max(k));
                // Starts of the rows of the upper triangle, less the column of the diagonal.
                indices.products[[0, 2, 3][first] + second]
            }
            Self::Cubic => indices.cubic,
            Self::Ramp => indices.ramp,
        }
    }

    /// Names of its exact equivalents, which have the opposite sign.
    #[must_use]
    pub fn equivalents(self, gyro: usize) -> Vec<&'static str> {
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
        &[time_s, 1.0, 0.0, 0.0, 0.0],
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
                let found = response[term.parameter(gyro)];
                // A few operations, and the way to rad/s and back.
                assert!((found - expected).abs() < 1e-14, "{id} {found:?}");
                assert!(term.unit(gyro).starts_with("deg/h"), "{id}");
            }
        }
    }
}
