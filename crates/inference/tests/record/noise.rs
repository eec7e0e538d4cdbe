//! Score and information of the noise against the joint Gaussian density.

use chacha20::ChaCha12Rng;
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};

use crate::chain::{Chain, none};
use crate::density::Density;

#[test]
fn the_score_of_the_noise_is_the_gradient_of_its_likelihood() {
    let chain = Chain::measured(9);
    let trajectory = chain.trajectory();
    let parameters = chain.parameters();
    let score = |factors: &[f64; 4]| {
        chain
            .linearised(&trajectory, &parameters, &[], &none())
            .noise_score(factors)
            .unwrap()
    };
    let at = [1.3, 0.6, 2.0, 1.0];
    let found = score(&at);
    // The second noise input drives nothing: nothing can be said of it.
    let gradient = found.gradient();
    assert_eq!(gradient[3], 0.0);
    for k in 0..3 {
        let likelihood = |logarithm: f64| {
            let mut factors = at;
            factors[k] *= logarithm.exp();
            score(&factors).log_likelihood()
        };
        let step = 1e-3;
        let by_difference = (8.0 * (likelihood(step) - likelihood(-step)) - likelihood(2.0 * step)
            + likelihood(-2.0 * step))
            / (12.0 * step);
        // Rounding of a likelihood of some hundreds over the step: 1e-10.
        assert!(
            (gradient[k] - by_difference).abs() < 1e-7 * (1.0 + by_difference.abs()),
            "{k}: {} {by_difference}",
            gradient[k]
        );
    }
}

#[test]
fn the_information_on_the_noise_is_that_of_the_joint_gaussian() {
    let mut chain = Chain::measured(2);
    let trajectory = chain.trajectory();
    let parameters = chain.parameters();
    let problem = Density { chain: &chain };
    let (_, covariance) = problem.outputs_given_parameters();
    let shares = problem.shares_of_the_noise();
    let cholesky = covariance.clone().cholesky().unwrap();
    // I = tr(S⁻¹ S_k S⁻¹ S_l) / 2 of normal data with covariance S.
    let whitened: Vec<DMatrix<f64>> = shares.iter().map(|share| cholesky.solve(share)).collect();
    let expected = |k: usize, l: usize| 0.5 * (&whitened[k] * &whitened[l]).trace();
    let draws = 400;
    let mut rng = ChaCha12Rng::seed_from_u64(1);
    let mut sums = [[[0.0; 2]; 3]; 3];
    let mut gradients = [[0.0; 2]; 3];
    for _ in 0..draws {
        let normals = DVector::from_fn(covariance.nrows(), |_, _| normal(&mut rng));
        chain.set_residuals(&trajectory, &(cholesky.l() * normals));
        let score = chain
            .linearised(&trajectory, &parameters, &[], &none())
            .noise_score(&[1.0; 4])
            .unwrap();
        for k in 0..3 {
            add(&mut gradients[k], score.gradient()[k]);
            for l in 0..3 {
                let found = score.information[k * 4 + l];
                assert_eq!(found, score.information[l * 4 + k]);
                add(&mut sums[k][l], found);
            }
        }
    }
    for k in 0..3 {
        // The mean score vanishes, its variance is the information; 5 standard errors.
        let allowed = 5.0 * (expected(k, k) / f64::from(draws)).sqrt();
        let mean = gradients[k][0] / f64::from(draws);
        assert!(mean.abs() < allowed, "{k}: {mean} beyond {allowed}");
        for l in 0..3 {
            let mean = sums[k][l][0] / f64::from(draws);
            let variance = sums[k][l][1] / f64::from(draws) - mean * mean;
            // 5 standard errors, and rounding where the information does not depend on the data.
            let allowed = 5.0 * (variance.max(0.0) / f64::from(draws)).sqrt() + 1e-7;
            let off = mean - expected(k, l);
            assert!(off.abs() < allowed, "{k}, {l}: {off} beyond {allowed}");
            // The test tells a missing term: the expectation is known to a tenth.
            assert!(k != l || allowed < 0.1 * expected(k, k));
        }
    }
}

fn add(sums: &mut [f64; 2], value: f64) {
    sums[0] += value;
    sums[1] += value * value;
}

/// Box and Muller.
pub(crate) fn normal(rng: &mut ChaCha12Rng) -> f64 {
    let [a, b]: [f64; 2] = [rng.random(), rng.random()];
    (-2.0 * (1.0 - a).ln()).sqrt() * (core::f64::consts::TAU * b).cos()
}
