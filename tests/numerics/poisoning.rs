use std::marker::PhantomData;

use gyrocal::estimation::form::Form;
use gyrocal::estimation::{
    ArrayStorage, Buffers, Covariance, Factors, Filter, Integration, Recentring, Storage,
    VecStorage, View,
};
use gyrocal::scalar::Recentre;
use gyrocal::{Anchored, Chart, Platform};
use gyrocal_testkit::extended_platform::ExtendedPlatform;

use crate::truth::{DENSITY, STEP_S, Truth, VARIANCE, chart};

const MOVING: usize = 3;

/// A form whose buffers can be poisoned.
trait Poison: Form<f64> {
    /// Fills with NaN the numbers that this form must not read between two calls.
    fn poison(buffers: &mut Buffers<'_, f64>);
}

impl Poison for Covariance {
    fn poison(buffers: &mut Buffers<'_, f64>) {
        Factors::poison(buffers);
        buffers.pivots.fill(f64::NAN);
        // The moving columns of the parameters' rows are not used.
        let n = buffers.pivots.len();
        for row in buffers.matrix[MOVING * n..].chunks_exact_mut(n) {
            row[..MOVING].fill(f64::NAN);
        }
    }
}

impl Poison for Factors {
    fn poison(buffers: &mut Buffers<'_, f64>) {
        buffers.gain.fill(f64::NAN);
        buffers.sweep.fill(f64::NAN);
        buffers.cross.fill(f64::NAN);
        buffers.transition.fill(f64::NAN);
    }
}

/// Returns buffers in which all numbers that a step must write before reading are NaN.
///
/// `stages` and `output` keep structural zeros and stay as they are.
struct Poisoned<S, F> {
    inner: S,
    form: PhantomData<F>,
}

impl<S, F> Poisoned<S, F> {
    fn new(inner: S) -> Self {
        let form = PhantomData;
        Self { inner, form }
    }
}

impl<S: Storage<f64>, F: Poison> Storage<f64> for Poisoned<S, F> {
    fn states(&self) -> usize {
        self.inner.states()
    }

    fn buffers(&mut self) -> Buffers<'_, f64> {
        let mut buffers = self.inner.buffers();
        F::poison(&mut buffers);
        buffers
    }

    fn view(&self) -> View<'_, f64> {
        self.inner.view()
    }
}

/// All results of a run, as bits: innovations, states and covariances.
fn trace<F, D, S>(
    model: D,
    integration: Integration,
    recentring: Recentring<f64>,
    storage: S,
) -> Vec<u64>
where
    F: Form<f64>,
    D: Recentre<f64, 3, 3, Inputs = Chart<f64>>,
    S: Storage<f64>,
{
    let n = storage.states();
    let mut sigma = vec![1.0; n];
    sigma[..3].fill(2e-4);
    let state = vec![0.0; n];
    let mut filter = Filter::<_, _, _, _, 3, 3, F>::with_form(
        model,
        chart(),
        integration,
        recentring,
        storage,
        &state,
        &sigma,
    )
    .unwrap();
    let mut truth = Truth::at([0.0; 3], 14);
    let mut bits = Vec::new();
    for step in 0..60 {
        let mut sample = truth.sample();
        if step % 7 == 3 {
            sample[step % 3] = f64::NAN;
        }
        filter.predict(STEP_S, &DENSITY).unwrap();
        let innovation = if step % 5 == 4 {
            sample[0] += if step % 10 == 4 { 0.1 } else { 0.0 };
            filter.update_gated(&sample, &VARIANCE, 30.0).unwrap().0
        } else {
            filter.update(&sample, &VARIANCE).unwrap()
        };
        bits.push(innovation.nis.to_bits());
        bits.extend(filter.state().iter().map(|state| state.to_bits()));
        for i in 0..n {
            bits.extend((0..=i).map(|j| filter.covariance(i, j).to_bits()));
        }
    }
    assert!(bits.iter().all(|bits| !f64::from_bits(*bits).is_nan()));
    bits
}

fn poisoned_and_clean_agree<F: Poison>(form: &str) {
    for integration in [
        Integration::EULER,
        Integration::RK4,
        Integration::Rk4 { substeps: 2 },
    ] {
        for recentring in [
            Recentring::EveryStep,
            Recentring::Beyond(0.05),
            Recentring::Never,
        ] {
            let what = format!("{form}, {integration:?}, {recentring:?}");
            let nominal = Anchored(Platform);
            let array = ArrayStorage::<f64, 3, 3, 12>::new;
            let clean = trace::<F, _, _>(nominal, integration, recentring, array());
            let storage = Poisoned::<_, F>::new(array());
            let poisoned = trace::<F, _, _>(nominal, integration, recentring, storage);
            assert_eq!(poisoned, clean, "arrays, {what}");
            // Counts of parameters with every remainder of a division into blocks of four.
            for additional in 0..4 {
                let model = ExtendedPlatform { additional };
                let vector = || VecStorage::new(12 + additional, 3, 3);
                let clean = trace::<F, _, _>(model, integration, recentring, vector());
                let storage = Poisoned::<_, F>::new(vector());
                let poisoned = trace::<F, _, _>(model, integration, recentring, storage);
                assert_eq!(
                    poisoned, clean,
                    "{additional} additional parameters, {what}"
                );
            }
        }
    }
}

#[test]
fn what_a_step_on_the_covariance_must_not_read_does_not_matter() {
    poisoned_and_clean_agree::<Covariance>("covariance");
}

#[test]
fn what_a_step_on_the_factors_must_not_read_does_not_matter() {
    poisoned_and_clean_agree::<Factors>("factors");
}
