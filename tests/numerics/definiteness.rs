use gyrocal::estimation::form::Form;
use gyrocal::estimation::{ArrayStorage, Covariance, Factors, Filter};
use gyrocal::{Anchored, Chart, Integration, Platform, Recentring};

use crate::truth::{DENSITY, STEP_S, Truth, VARIANCE, chart};

const STATES: usize = Platform::STATES;
type PlatformKernel<F> =
    Filter<f64, Anchored<Platform>, Chart<f64>, ArrayStorage<f64, 3, 3, 12>, 3, 3, F>;

/// Rounding error of a sigma that a step does not change: a few units in the last place.
const SIGMA_ROUNDING: f64 = 1e-14;

fn filter<F: Form<f64>>(integration: Integration, sigma: &[f64; STATES]) -> PlatformKernel<F> {
    let (model, storage) = (Anchored(Platform), ArrayStorage::new());
    let state = [0.0; STATES];
    Filter::with_form(
        model,
        chart(),
        integration,
        Recentring::EveryStep,
        storage,
        &state,
        sigma,
    )
    .unwrap()
}

/// The covariance as correlations, after checking that it is one.
fn correlations<F: Form<f64>>(
    filter: &PlatformKernel<F>,
) -> Result<[[f64; STATES]; STATES], String> {
    let sigma: [f64; STATES] = core::array::from_fn(|i| filter.sigma(i));
    if let Some(i) = (0..STATES).find(|&i| !(sigma[i] > 0.0 && sigma[i].is_finite())) {
        return Err(format!(
            "the variance of state {i} is {:e}",
            filter.covariance(i, i)
        ));
    }
    let scaled = |i: usize, j: usize| filter.covariance(i, j) / sigma[i] / sigma[j];
    for i in 0..STATES {
        for j in 0..i {
            // The sum over n products may be taken in another order.
            if (scaled(i, j) - scaled(j, i)).abs() > STATES as f64 * f64::EPSILON {
                return Err(format!("({i}, {j}) differs from ({j}, {i})"));
            }
        }
    }
    Ok(core::array::from_fn(|i| {
        core::array::from_fn(|j| scaled(i, j))
    }))
}

/// Cholesky of the correlations with `shift` on the diagonal.
fn check_positive_definite<F: Form<f64>>(
    filter: &PlatformKernel<F>,
    shift: f64,
) -> Result<(), String> {
    let mut a = correlations(filter)?;
    for j in 0..STATES {
        let pivot = a[j][j] + shift - (0..j).map(|k| a[j][k] * a[j][k]).sum::<f64>();
        if pivot.is_nan() || pivot <= 0.0 {
            return Err(format!("pivot {j} is {pivot:e}"));
        }
        let root = pivot.sqrt();
        a[j][j] = root;
        for i in j + 1..STATES {
            let known: f64 = (0..j).map(|k| a[i][k] * a[j][k]).sum();
            a[i][j] = (a[i][j] - known) / root;
        }
    }
    Ok(())
}

/// Runs a filter and checks it after step 1, 2, 3, … and then every `interval` steps. Returns the
/// first violation.
fn watch<F: Form<f64>>(
    mut filter: PlatformKernel<F>,
    truth: &mut Truth,
    steps: usize,
    interval: usize,
    shift: f64,
) -> Result<(), String> {
    let mut sigma = [f64::INFINITY; STATES];
    let mut since = 0;
    for step in 1..=steps {
        let located = |what: String| format!("step {step}: {what}");
        let sample = truth.sample();
        filter
            .predict(STEP_S, &DENSITY)
            .map_err(|error| located(error.to_string()))?;
        filter
            .update(&sample, &VARIANCE)
            .map_err(|error| located(error.to_string()))?;
        since += 1;
        if step > 100 && step % interval != 0 {
            continue;
        }
        if filter.state().iter().any(|state| state.is_nan()) {
            return Err(located("a state is NaN".to_owned()));
        }
        check_positive_definite(&filter, shift).map_err(located)?;
        for (i, before) in sigma.iter_mut().enumerate().skip(3) {
            let now = filter.sigma(i);
            let bound = *before * (1.0 + SIGMA_ROUNDING * f64::from(since));
            if now > bound {
                return Err(located(format!(
                    "sigma {i} grew from {before:e} to {now:e}"
                )));
            }
            *before = now;
        }
        since = 0;
    }
    Ok(())
}

const ANGLE_SIGMA_RAD: f64 = 2e-4;

fn a_year<F: Form<f64>>(integration: Integration) {
    let mut sigma = [1.0; STATES];
    sigma[..3].fill(ANGLE_SIGMA_RAD);
    let mut truth = Truth::at([0.0; 3], 11);
    let watched = watch(
        filter::<F>(integration, &sigma),
        &mut truth,
        525_600,
        1000,
        0.0,
    );
    assert_eq!(watched, Ok(()), "{integration:?}");
}

#[test]
fn positive_definite_over_a_year_of_runge_kutta_steps() {
    a_year::<Covariance>(Integration::RK4);
    a_year::<Factors>(Integration::RK4);
}

#[test]
fn positive_definite_over_a_year_of_euler_steps() {
    a_year::<Covariance>(Integration::EULER);
    a_year::<Factors>(Integration::EULER);
}

/// Violations by form, as `watch` returns them; none expected.
fn badly_scaled_priors<F: Form<f64>>() -> Vec<String> {
    let uniform = |angle: f64, coefficient: f64| {
        core::array::from_fn(|i| if i < 3 { angle } else { coefficient })
    };
    let mixed = |angle: f64, exponents: [i32; 9]| {
        core::array::from_fn(|i| {
            if i < 3 {
                angle
            } else {
                10.0_f64.powi(exponents[i - 3])
            }
        })
    };
    let priors: [(&str, [f64; STATES]); 8] = [
        ("coefficients 1e6, angles 1 rad", uniform(1.0, 1e6)),
        ("coefficients 1e6, angles 1e-9 rad", uniform(1e-9, 1e6)),
        ("coefficients 1e3, angles 1 rad", uniform(1.0, 1e3)),
        ("coefficients 1e-9, angles 1 rad", uniform(1.0, 1e-9)),
        ("coefficients 1e-9, angles 1e-9 rad", uniform(1e-9, 1e-9)),
        (
            "gyros of 1e6, 1, 1e-6",
            mixed(1e-3, [6, 6, 6, 0, 0, 0, -6, -6, -6]),
        ),
        (
            "terms of 1e6, 1, 1e-6",
            mixed(1e-3, [6, 0, -6, 6, 0, -6, 6, 0, -6]),
        ),
        (
            "twelve orders over the terms",
            mixed(1.0, [3, -9, 0, -6, 3, -9, -3, 0, -6]),
        ),
    ];
    // The first samples leave combinations known 1e8 times better than their terms, hence
    // correlations of 1 - 1e-16: what a covariance is rounded to when it is read is not exactly
    // positive definite. Rounding n × n correlations by n eps moves an eigenvalue by n² eps.
    let shift = (STATES * STATES) as f64 * f64::EPSILON;
    let mut wrong = Vec::new();
    for integration in [Integration::EULER, Integration::RK4] {
        for (name, sigma) in &priors {
            let mut truth = Truth::at([0.0; 3], 12);
            if let Err(what) = watch(filter::<F>(integration, sigma), &mut truth, 3000, 20, shift) {
                wrong.push(format!("{integration:?}, {name}: {what}"));
            }
        }
    }
    wrong
}

#[test]
fn factors_are_positive_definite_from_badly_scaled_priors() {
    let wrong = badly_scaled_priors::<Factors>();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_covariance_is_positive_definite_or_refuses_a_prior_that_is_too_wide() {
    let wrong = badly_scaled_priors::<Covariance>();
    // Coefficients of 1e6 deg/h turn the platform by hundreds of radians in the first minute:
    // against samples of 1e-5 g an update would cancel more digits than there are.
    let refused = |what: &String| what.contains("step 1: the prior is too wide against the noise");
    assert!(wrong.iter().all(refused), "{}", wrong.join("\n"));
    assert!(
        wrong.iter().all(|what| what.contains("1e6")),
        "{}",
        wrong.join("\n")
    );
    assert!(
        !wrong.is_empty(),
        "no prior of the list is at the limit any more"
    );
}
