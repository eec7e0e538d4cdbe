//! The platform with any number of additional constant drift parameters, known at run time.

use gyrocal::scalar::{Model, RatesJacobian, Recentre};
use gyrocal::{Anchored, Chart, Platform};

const INNER: Anchored<Platform> = Anchored(Platform);
/// Nominal parameters.
const NOMINAL: usize = Platform::PARAMETERS;
/// The biases among them: additional drift enters the rates as they do.
const BIAS: [usize; 3] = [0, 3, 6];
/// Direction whose specific force the shapes are functions of; a unit vector.
const DIRECTION: [f64; 3] = [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0];

/// Additional parameter k, in deg/h, is drift of gyro k % 3 with the shape
/// T_(1 + k / 3)(x), a Chebyshev polynomial of the specific force x along a fixed direction:
/// smooth, bounded, no two alike.
#[derive(Clone, Copy, Debug)]
pub struct ExtendedPlatform {
    /// Number of additional parameters.
    pub additional: usize,
}

/// Specific force along the direction, and its derivative by the angles.
struct Along {
    force: f64,
    d_theta: [f64; 3],
}

impl Along {
    fn at(moving: &[f64; 3], parameters: &[f64], chart: &Chart<f64>, origin: bool) -> Self {
        let mut d_theta = [[0.0; 3]; 3];
        let nominal = &parameters[..NOMINAL];
        let a = match origin {
            true => INNER.output_jacobian_at_origin(nominal, chart, &mut d_theta, &mut []),
            false => INNER.output_jacobian(moving, nominal, chart, &mut d_theta, &mut []),
        };
        let along = |column: [f64; 3]| (0..3).map(|i| DIRECTION[i] * column[i]).sum();
        Self {
            force: along(a),
            d_theta: core::array::from_fn(|j| along(core::array::from_fn(|i| d_theta[i][j]))),
        }
    }

    /// Calls `visit(k, shape, d shape / d force)` for each of `count` shapes T_1, T_2, ….
    fn shapes(&self, count: usize, mut visit: impl FnMut(usize, f64, f64)) {
        let x = self.force;
        let (mut before, mut d_before) = (1.0, 0.0);
        let (mut shape, mut d_shape) = (x, 1.0);
        for k in 0..count {
            visit(k, shape, d_shape);
            let next = 2.0 * x * shape - before;
            let d_next = 2.0 * (shape + x * d_shape) - d_before;
            (before, d_before) = (shape, d_shape);
            (shape, d_shape) = (next, d_next);
        }
    }
}

impl ExtendedPlatform {
    /// Nominal parameters with the additional drift added to the biases, and the derivative of
    /// that drift by the force along the direction.
    fn effective(&self, parameters: &[f64], along: &Along) -> ([f64; NOMINAL], [f64; 3]) {
        let mut nominal = [0.0; NOMINAL];
        nominal.copy_from_slice(&parameters[..NOMINAL]);
        let additional = &parameters[NOMINAL..];
        let mut d_force = [0.0; 3];
        along.shapes(additional.len().div_ceil(3), |k, shape, d_shape| {
            for (gyro, size) in additional[3 * k..].iter().take(3).enumerate() {
                nominal[BIAS[gyro]] += size * shape;
                d_force[gyro] += size * d_shape;
            }
        });
        (nominal, d_force)
    }

    fn jacobian(
        &self,
        moving: &[f64; 3],
        parameters: &[f64],
        chart: &Chart<f64>,
        jacobian: &mut RatesJacobian<'_, f64, 3>,
        origin: bool,
    ) -> [f64; 3] {
        assert_eq!(parameters.len(), self.parameters());
        let along = Along::at(moving, parameters, chart, origin);
        let (nominal, d_force) = self.effective(parameters, &along);
        let mut columns = [0.0; 3 * NOMINAL];
        let mut inner = RatesJacobian {
            moving: jacobian.moving,
            noise: jacobian.noise,
            parameters: &mut columns,
        };
        let rates = match origin {
            true => INNER.rates_jacobian_at_origin(&nominal, chart, &mut inner),
            false => INNER.rates_jacobian(moving, &nominal, chart, &mut inner),
        };
        (jacobian.moving, jacobian.noise) = (inner.moving, inner.noise);
        for i in 0..3 {
            let row = &mut jacobian.parameters[i * parameters.len()..][..parameters.len()];
            let inner = &columns[i * NOMINAL..][..NOMINAL];
            row[..NOMINAL].copy_from_slice(inner);
            let by_drift = BIAS.map(|bias| inner[bias]);
            for (gyro, by_drift) in by_drift.into_iter().enumerate() {
                for j in 0..3 {
                    jacobian.moving[i][j] += by_drift * d_force[gyro] * along.d_theta[j];
                }
            }
            let row = &mut row[NOMINAL..];
            along.shapes(self.additional.div_ceil(3), |k, shape, _| {
                for (element, by_drift) in row[3 * k..].iter_mut().zip(by_drift) {
                    *element = by_drift * shape;
                }
            });
        }
        rates
    }
}

impl Model<f64, 3, 3> for ExtendedPlatform {
    type Inputs = Chart<f64>;

    fn parameters(&self) -> usize {
        NOMINAL + self.additional
    }

    fn output_parameters(&self) -> usize {
        Model::<f64, 3, 3>::output_parameters(&INNER)
    }

    fn noise_parameters(&self) -> Option<[usize; 3]> {
        Model::<f64, 3, 3>::noise_parameters(&INNER)
    }

    fn rates(&self, moving: &[f64; 3], parameters: &[f64], chart: &Chart<f64>) -> [f64; 3] {
        let along = Along::at(moving, parameters, chart, false);
        INNER.rates(moving, &self.effective(parameters, &along).0, chart)
    }

    fn rates_jacobian(
        &self,
        moving: &[f64; 3],
        parameters: &[f64],
        chart: &Chart<f64>,
        jacobian: &mut RatesJacobian<'_, f64, 3>,
    ) -> [f64; 3] {
        self.jacobian(moving, parameters, chart, jacobian, false)
    }

    fn rates_jacobian_at_origin(
        &self,
        parameters: &[f64],
        chart: &Chart<f64>,
        jacobian: &mut RatesJacobian<'_, f64, 3>,
    ) -> [f64; 3] {
        self.jacobian(&[0.0; 3], parameters, chart, jacobian, true)
    }

    fn output(&self, moving: &[f64; 3], parameters: &[f64], chart: &Chart<f64>) -> [f64; 3] {
        INNER.output(moving, &parameters[..NOMINAL], chart)
    }

    fn output_jacobian(
        &self,
        moving: &[f64; 3],
        parameters: &[f64],
        chart: &Chart<f64>,
        d_moving: &mut [[f64; 3]; 3],
        d_parameters: &mut [f64],
    ) -> [f64; 3] {
        let nominal = &parameters[..NOMINAL];
        INNER.output_jacobian(moving, nominal, chart, d_moving, d_parameters)
    }

    fn output_jacobian_at_origin(
        &self,
        parameters: &[f64],
        chart: &Chart<f64>,
        d_moving: &mut [[f64; 3]; 3],
        d_parameters: &mut [f64],
    ) -> [f64; 3] {
        let nominal = &parameters[..NOMINAL];
        INNER.output_jacobian_at_origin(nominal, chart, d_moving, d_parameters)
    }
}

impl Recentre<f64, 3, 3> for ExtendedPlatform {
    fn has_chart(&self) -> bool {
        Recentre::<f64, 3, 3>::has_chart(&INNER)
    }

    fn recentre(&self, moving: &mut [f64; 3], chart: &mut Chart<f64>) -> Option<[[f64; 3]; 3]> {
        INNER.recentre(moving, chart)
    }

    fn correct(&self, moving: &mut [f64; 3], chart: &mut Chart<f64>, correction: &[f64; 3]) {
        INNER.correct(moving, chart, correction);
    }
}
