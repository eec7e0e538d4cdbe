//! Variance added along a direction, in both forms, against the definition; clipped innovations.
#![cfg(test)]

use gyrocal_estimation::form::Form;
use gyrocal_estimation::{ArrayStorage, Covariance, Factors, Filter, Integration, Recentring};
use gyrocal_scalar::{Model, RatesJacobian, Recentre};

/// A position that drifts at a rate which is the sum of two constants; its chart never moves.
#[derive(Clone, Copy)]
struct Drift;

impl Model<f64, 1, 1> for Drift {
    type Inputs = ();
    fn parameters(&self) -> usize {
        2
    }
    fn output_parameters(&self) -> usize {
        0
    }
    fn noise_parameters(&self) -> Option<[usize; 1]> {
        Some([0])
    }
    fn rates(&self, _: &[f64; 1], parameters: &[f64], _: &()) -> [f64; 1] {
        [parameters[0] + 0.5 * parameters[1]]
    }
    fn rates_jacobian(
        &self,
        moving: &[f64; 1],
        parameters: &[f64],
        inputs: &(),
        jacobian: &mut RatesJacobian<'_, f64, 1>,
    ) -> [f64; 1] {
        jacobian.parameters.copy_from_slice(&[1.0, 0.5]);
        jacobian.noise[0][0] = 1.0;
        self.rates(moving, parameters, inputs)
    }
    fn output(&self, moving: &[f64; 1], _: &[f64], _: &()) -> [f64; 1] {
        *moving
    }
    fn output_jacobian(
        &self,
        moving: &[f64; 1],
        _: &[f64],
        _: &(),
        d_moving: &mut [[f64; 1]; 1],
        _: &mut [f64],
    ) -> [f64; 1] {
        d_moving[0][0] = 1.0;
        *moving
    }
}

impl Recentre<f64, 1, 1> for Drift {
    fn has_chart(&self) -> bool {
        true
    }
}

/// Larger than what the state is uncertain by, so that a clip applies.
const NOISE: f64 = 5.0;

type Small<F> = Filter<f64, Drift, (), ArrayStorage<f64, 1, 1, 3>, 1, 1, F>;

fn started<F: Form<f64>>() -> Small<F> {
    let storage = ArrayStorage::new();
    let (rule, chart) = (Integration::RK4, Recentring::EveryStep);
    let prior = ([0.1, 0.2, 0.3], [1.0, 2.0, 3.0]);
    let mut filter =
        Small::<F>::with_form(Drift, (), rule, chart, storage, &prior.0, &prior.1).unwrap();
    for step in 1..5 {
        filter.predict(1.0, &[0.1]).unwrap();
        filter.update(&[0.3 * f64::from(step)], &[0.5]).unwrap();
    }
    filter
}

fn variance_is_added_along_a_direction<F: Form<f64> + Clone>() {
    for direction in [[0.0, 1.0, 0.0], [0.3, -2.0, 0.7]] {
        let mut filter = started::<F>();
        let before = filter.clone();
        filter.displace(&direction, 0.2, 0.4).unwrap();
        for i in 0..3 {
            let moved = before.state()[i] + 0.2 * direction[i];
            assert!((filter.state()[i] - moved).abs() < 1e-15);
            for j in 0..3 {
                let expected = before.covariance(i, j) + 0.4 * direction[i] * direction[j];
                // Some ten roundings.
                assert!(
                    (filter.covariance(i, j) - expected).abs() < 1e-14,
                    "{i} {j}"
                );
            }
        }
    }
    let mut filter = started::<F>();
    assert!(filter.displace(&[1.0, 0.0], 0.0, 0.1).is_err());
    assert!(filter.displace(&[0.0; 3], 0.0, -0.1).is_err());
}

#[test]
fn both_forms_take_a_displacement() {
    variance_is_added_along_a_direction::<Covariance>();
    variance_is_added_along_a_direction::<Factors>();
}

fn outliers_are_clipped<F: Form<f64>>() {
    // A filter whose chart moves takes the outputs at the origin.
    let (sigma, predicted) = {
        let mut filter = started::<F>();
        let innovation = filter
            .update_clipped(&[0.5], &[NOISE], 3.0, f64::INFINITY)
            .unwrap();
        let residual = innovation.residual[0];
        (residual / innovation.standardised()[0], 0.5 - residual)
    };
    let after = |measured: f64, clip: Option<f64>| {
        let mut filter = started::<F>();
        let innovation = match clip {
            Some(clip) => filter
                .update_clipped(&[measured], &[NOISE], clip, f64::INFINITY)
                .unwrap(),
            None => filter
                .update_at_origin(&[measured], &[NOISE], f64::INFINITY)
                .unwrap(),
        };
        (filter.state().to_vec(), innovation)
    };
    // Beyond the largest NIS nothing changes, not a bit.
    let mut filter = started::<F>();
    let before = filter.view();
    let before = [before.state, before.matrix, before.pivots].map(<[f64]>::to_vec);
    for (measured, largest_nis) in [(predicted + 20.0 * sigma, 34.0), (predicted, -1.0)] {
        let innovation = filter
            .update_at_origin(&[measured], &[NOISE], largest_nis)
            .unwrap();
        assert!(innovation.nis > largest_nis);
        let view = filter.view();
        assert_eq!([view.state, view.matrix, view.pivots], before);
    }
    // Inside of the clip nothing changes, not a bit.
    let inside = predicted + 2.9 * sigma;
    assert_eq!(after(inside, Some(3.0)).0, after(inside, None).0);
    // Beyond it the correction is that of the clip, and the NIS that of the sample.
    let (state, innovation) = after(predicted + 20.0 * sigma, Some(3.0));
    let (limit, _) = after(predicted + 3.0 * sigma, None);
    for (state, limit) in state.iter().zip(&limit) {
        assert!((state - limit).abs() < 1e-13);
    }
    assert!((innovation.standardised()[0] - 3.0).abs() < 1e-12);
    assert!((innovation.nis - 400.0).abs() < 1e-9);
    assert!((innovation.whitening()[0][0] * sigma - 1.0).abs() < 1e-12);
}

#[test]
fn both_forms_clip() {
    outliers_are_clipped::<Covariance>();
    outliers_are_clipped::<Factors>();
}
