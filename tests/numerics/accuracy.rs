use gyrocal::Integration;
use gyrocal::estimation::form::Form;
use gyrocal::estimation::{Covariance, Factors};
use gyrocal_testkit::rounding_errors::{FACTORS_LIMIT, TIE, dense_joseph, structured};

/// Errors of a form must be at most `limit` times those of the dense Joseph filter.
fn compare<F: Form<f64>>(name: &str, limit: f64) {
    for integration in [Integration::EULER, Integration::RK4] {
        let (ours, dense) = (structured::<F>(integration), dense_joseph(integration));
        println!("{integration:?}\n  {name} {ours}\n  dense Joseph {dense}");
        // The reference was written from the equations: a disagreement about them would be
        // many orders larger than the rounding errors that are compared here.
        assert!(
            dense.worst_state < 1e-5,
            "{integration:?}: the reference is of another filter"
        );
        let (state, sigma) = (ours.state / dense.state, ours.sigma / dense.sigma);
        assert!(
            state <= limit,
            "{name}, {integration:?}: states {state:.2} times worse"
        );
        assert!(
            sigma <= limit,
            "{name}, {integration:?}: sigmas {sigma:.2} times worse"
        );
    }
}

#[test]
fn the_covariance_is_no_worse_than_the_dense_joseph_filter_against_400_bits() {
    compare::<Covariance>("covariance", TIE);
}

#[test]
fn the_factors_are_far_better_than_the_dense_joseph_filter_against_400_bits() {
    compare::<Factors>("factors", FACTORS_LIMIT);
}
