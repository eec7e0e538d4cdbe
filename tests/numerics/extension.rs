use gyrocal::scalar::{Model, RatesJacobian};
use gyrocal_testkit::extended_platform::ExtendedPlatform;

use crate::truth::{DRIFT, chart};

const MOVING: [f64; 3] = [0.2, -0.4, 0.7];
const STEP: f64 = 1e-4;

/// Fourth-order central differences: error of STEP⁴ and eps / STEP, about 1e-12 relative.
fn difference(at: impl Fn(f64) -> [f64; 3]) -> [f64; 3] {
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k| at(k * STEP));
    core::array::from_fn(|i| (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * STEP))
}

#[test]
fn derivatives_of_the_extended_platform_are_those_of_its_rates() {
    let model = ExtendedPlatform { additional: 8 };
    let mut parameters = DRIFT.to_vec();
    parameters.extend((0..8).map(|k| 0.3 - 0.07 * f64::from(k)));
    for moving in [MOVING, [0.0; 3]] {
        let p = parameters.len();
        let mut columns = vec![0.0; 3 * p];
        let mut jacobian = RatesJacobian {
            moving: [[0.0; 3]; 3],
            noise: [[0.0; 3]; 3],
            parameters: &mut columns,
        };
        let rates = model.rates_jacobian(&moving, &parameters, &chart(), &mut jacobian);
        assert_eq!(rates, model.rates(&moving, &parameters, &chart()));
        // Rates are 1e-4 rad/s, so differences are good to 1e-4 eps / STEP = 2e-16; those by a
        // parameter are 5e-6 rad/s per deg/h.
        let close = |a: f64, b: f64| (a - b).abs() < 1e-14;
        for j in 0..3 {
            let by_angle = difference(|change| {
                let mut moving = moving;
                moving[j] += change;
                model.rates(&moving, &parameters, &chart())
            });
            for (i, expected) in by_angle.into_iter().enumerate() {
                let exact = jacobian.moving[i][j];
                assert!(close(exact, expected), "{i} {j}: {exact:e} {:e}", expected);
            }
        }
        for k in 0..p {
            let by_parameter = difference(|change| {
                let mut parameters = parameters.clone();
                parameters[k] += change;
                model.rates(&moving, &parameters, &chart())
            });
            for (i, expected) in by_parameter.into_iter().enumerate() {
                let exact = jacobian.parameters[i * p + k];
                assert!(close(exact, expected), "{i} {k}: {exact:e} {:e}", expected);
            }
        }
        if moving == [0.0; 3] {
            let mut shorter = vec![0.0; 3 * p];
            let mut at_origin = RatesJacobian {
                moving: [[0.0; 3]; 3],
                noise: [[0.0; 3]; 3],
                parameters: &mut shorter,
            };
            model.rates_jacobian_at_origin(&parameters, &chart(), &mut at_origin);
            for (a, b) in at_origin
                .moving
                .iter()
                .flatten()
                .zip(jacobian.moving.iter().flatten())
            {
                assert!(close(*a, *b));
            }
            assert!(shorter.iter().zip(&columns).all(|(a, b)| close(*a, *b)));
        }
    }
}
