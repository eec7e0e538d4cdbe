//! A model that has nothing to do with gyros: a pendulum with an angle sensor.

use gyrocal_scalar::{Model, RatesJacobian, Recentre, Scalar};

/// Moving: angle and rate of a damped pendulum. Parameters: bias and scale error of the
/// sensor (they enter the output), stiffness and damping. Outputs: biased angle, and rate.
/// Noise: a torque, so no parameter enters the rates as the noise does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pendulum;

pub(crate) const BIAS: usize = 2;
pub(crate) const STIFFNESS: usize = 4;

impl<T: Scalar> Model<T, 2, 2> for Pendulum {
    type Inputs = ();

    fn parameters(&self) -> usize {
        4
    }

    fn output_parameters(&self) -> usize {
        2
    }

    fn noise_parameters(&self) -> Option<[usize; 2]> {
        None
    }

    fn rates(&self, moving: &[T; 2], parameters: &[T], (): &()) -> [T; 2] {
        let [angle, rate] = *moving;
        let (sine, _) = angle.sin_cos();
        [rate, -(parameters[2] * sine) - parameters[3] * rate]
    }

    fn rates_jacobian(
        &self,
        moving: &[T; 2],
        parameters: &[T],
        inputs: &(),
        jacobian: &mut RatesJacobian<'_, T, 2>,
    ) -> [T; 2] {
        let [angle, rate] = *moving;
        let (sine, cosine) = angle.sin_cos();
        jacobian.moving[0][1] = T::from_f64(1.0);
        jacobian.moving[1][0] = -(parameters[2] * cosine);
        jacobian.moving[1][1] = -parameters[3];
        jacobian.parameters[4 + 2] = -sine;
        jacobian.parameters[4 + 3] = -rate;
        jacobian.noise[1][0] = T::from_f64(1.0);
        self.rates(moving, parameters, inputs)
    }

    fn output(&self, moving: &[T; 2], parameters: &[T], (): &()) -> [T; 2] {
        let one = T::from_f64(1.0);
        [parameters[0] + (one + parameters[1]) * moving[0], moving[1]]
    }

    fn output_jacobian(
        &self,
        moving: &[T; 2],
        parameters: &[T],
        inputs: &(),
        d_moving: &mut [[T; 2]; 2],
        d_parameters: &mut [T],
    ) -> [T; 2] {
        let one = T::from_f64(1.0);
        d_moving[0][0] = one + parameters[1];
        d_moving[1][1] = one;
        d_parameters[0] = one;
        d_parameters[1] = moving[0];
        self.output(moving, parameters, inputs)
    }
}

impl<T: Scalar> Recentre<T, 2, 2> for Pendulum {}
