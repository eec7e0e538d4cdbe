//! Forward selection of terms with family-wise p-values.

use chacha20::ChaCha12Rng;
use chacha20::rand_core::{Rng, SeedableRng};
use gyrocal_statistics::p_of_least;
use nalgebra::{DMatrix, DVector};

use super::between_stops::BetweenStops;
use super::positions::Positions;
use super::regression::WeightedStops;
use super::terms::Term;
use crate::error::{InstrumentError, Unfit};

/// Settings of the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchSettings {
    /// Probability of a finding in data without effects (family-wise error rate).
    pub false_alarm_probability: f64,
    /// Number of permutations for the p-values; with n of them no p-value is below 1 / (n + 1).
    pub permutations: usize,
    /// Seed of the permutations.
    pub seed: u64,
}

impl Default for SearchSettings {
    fn default() -> Self {
        Self {
            false_alarm_probability: 0.01,
            permutations: FEWEST_PERMUTATIONS,
            seed: 1,
        }
    }
}

const FEWEST_PERMUTATIONS: usize = 999;

/// Least probability of a false alarm that a search accepts: its time grows with the inverse.
pub const LEAST_FALSE_ALARM: f64 = 1e-4;

impl SearchSettings {
    /// Settings with enough permutations for p-values of a tenth of the probability.
    ///
    /// # Errors
    ///
    /// [`Unfit::Setting`] if the probability is below [`LEAST_FALSE_ALARM`] or not below 1.
    pub fn at(false_alarm_probability: f64, seed: u64) -> Result<Self, InstrumentError> {
        if !(LEAST_FALSE_ALARM..1.0).contains(&false_alarm_probability) {
            return Err(InstrumentError::unfit(
                Unfit::Setting,
                format!("a probability of false alarm of {false_alarm_probability:e}"),
                format!("{LEAST_FALSE_ALARM:e} or more, and less than 1"),
                "less would take too many permutations of the stops to count",
            ));
        }
        let needed = (10.0 / false_alarm_probability).ceil() as usize - 1;
        Ok(Self {
            false_alarm_probability,
            permutations: needed.max(FEWEST_PERMUTATIONS),
            seed,
        })
    }
}

/// A step of the search that added a term.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchStep {
    /// The gyro.
    pub gyro: usize,
    /// The term that was added.
    pub term: Term,
    /// F statistic of the term at this step.
    pub f: f64,
    /// Family-wise p-value of `f`.
    pub p_value: f64,
}

/// Current law of one gyro.
struct Law {
    data: WeightedStops,
    terms: Vec<Term>,
    /// Orthonormal columns that span the terms.
    span: DMatrix<f64>,
    /// Residuals of the rates.
    residuals: DVector<f64>,
    /// Directions of all other terms with the law projected out, of length one.
    candidates: Vec<(Term, DVector<f64>)>,
}

/// A term is not distinguishable from the law if the projection leaves less than this fraction of its
/// length.
const SMALLEST_SHARE: f64 = 0.03;

impl Law {
    fn new(data: &WeightedStops, terms: Vec<Term>) -> Self {
        let data = data.with_excess_of(&terms);
        let span = data.columns(&terms).qr().q();
        let outside = |column: DVector<f64>| &column - &span * (span.transpose() * &column);
        let residuals = outside(data.rates.clone());
        let candidates = Term::catalogue(data.gyro)
            .into_iter()
            .filter(|term| !terms.contains(term))
            .filter_map(|term| {
                let column = data.column(term);
                let length = column.norm();
                let rest = outside(column);
                let share = rest.norm() / length;
                (share > SMALLEST_SHARE).then(|| (term, rest.normalize()))
            })
            .collect();
        Self {
            terms,
            residuals,
            candidates,
            span,
            data,
        }
    }

    /// The term with the largest F against these residuals of the law.
    fn best(&self, residuals: &DVector<f64>) -> Option<(Term, f64)> {
        let freedom = self.data.len() as f64 - self.terms.len() as f64 - 1.0;
        if freedom < 1.0 {
            return None;
        }
        let total = residuals.norm_squared();
        self.candidates
            .iter()
            .map(|(term, direction)| {
                let explained = direction.dot(residuals).powi(2);
                (*term, explained * freedom / (total - explained))
            })
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Permuted residuals with the law projected out again.
    fn permuted(&self, order: &[usize]) -> DVector<f64> {
        let moved = DVector::from_iterator(order.len(), order.iter().map(|i| self.residuals[*i]));
        &moved - &self.span * (self.span.transpose() * &moved)
    }
}

/// Adds terms to the nominal laws of the gyros while the best term is significant.
///
/// The statistic of a step is the maximum F over all gyros and terms. Its null distribution is that of
/// the same maximum after the residuals of the current laws are permuted among the stops, in the same
/// order for all gyros (Freedman and Lane 1983), so that p-values are family-wise. Stops of a walk are not
/// exchangeable in time: a ramp has to be significant beside walks and flicker too, integrated over their levels, and
/// its p-value is the larger one. `which` are the stops
/// that are used, weighted with the excess scatter of the current law: with the standard errors alone
/// a long stop would dominate where the law is wrong.
#[must_use]
pub fn search(
    positions: &Positions,
    which: &[usize],
    settings: &SearchSettings,
) -> Vec<SearchStep> {
    // ChaCha12: see `gyrocal_statistics::deviates`.
    let mut generator = ChaCha12Rng::seed_from_u64(settings.seed);
    let mut laws: Vec<Law> = (0..3)
        .map(|gyro| {
            Law::new(
                &WeightedStops::of(positions, gyro, which),
                Term::NOMINAL.to_vec(),
            )
        })
        .collect();
    let mut steps = Vec::new();
    loop {
        let best = laws
            .iter()
            .filter_map(|law| Some((law.data.gyro, law.best(&law.residuals)?)))
            .max_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let Some((gyro, (term, f))) = best else {
            return steps;
        };
        let Some(mut p_value) = significance(&laws, f, settings, &mut generator) else {
            return steps;
        };
        if term == Term::Ramp {
            p_value = p_value.max(beside_walks(&positions.only(which), &laws, gyro));
            if p_value > settings.false_alarm_probability {
                laws[gyro].candidates.retain(|(other, _)| *other != term);
                continue;
            }
        }
        steps.push(SearchStep {
            gyro,
            term,
            f,
            p_value,
        });
        let mut terms = laws[gyro].terms.clone();
        terms.push(term);
        laws[gyro] = Law::new(&laws[gyro].data, terms);
    }
}

/// Most stops of which the covariance of walks is factored at all levels: of more, as many in equal steps serve.
const MOST_STOPS: usize = 48;

/// Family-wise p-value of the ramp of a gyro in noise that may walk between stops.
fn beside_walks(positions: &Positions, laws: &[Law], gyro: usize) -> f64 {
    let terms: Vec<Vec<Term>> = laws.iter().map(|law| law.terms.clone()).collect();
    let tests: usize = laws.iter().map(|law| law.candidates.len()).sum();
    let stops = positions.time_s.len();
    let count = stops.min(MOST_STOPS);
    let some: Vec<usize> = (0..count).map(|place| place * stops / count).collect();
    let between = BetweenStops::of(&positions.only(&some), &terms);
    let evidence = between
        .terms(gyro, &terms, &[Term::Ramp])
        .into_iter()
        .flatten()
        .next();
    evidence.map_or(1.0, |own| p_of_least(own.p_value, tests as f64))
}

/// Family-wise p-value of `f`; `None` if it exceeds the probability of a false alarm.
fn significance(
    laws: &[Law],
    f: f64,
    settings: &SearchSettings,
    generator: &mut ChaCha12Rng,
) -> Option<f64> {
    let stops = laws.first()?.residuals.len();
    let mut order: Vec<usize> = (0..stops).collect();
    let mut p_value = 1.0 / (1 + settings.permutations) as f64;
    let mut as_large = 0;
    for _ in 0..settings.permutations {
        shuffle(&mut order, generator);
        let largest = laws
            .iter()
            .filter_map(|law| law.best(&law.permuted(&order)))
            .fold(0.0, |largest: f64, (_, f)| largest.max(f));
        as_large += usize::from(largest >= f);
        p_value = (1 + as_large) as f64 / (1 + settings.permutations) as f64;
        // All further permutations can only increase it.
        if p_value > settings.false_alarm_probability {
            return None;
        }
    }
    (p_value <= settings.false_alarm_probability).then_some(p_value)
}

/// Terms of one gyro after a search.
pub(crate) fn terms_of(steps: &[SearchStep], gyro: usize) -> Vec<Term> {
    let found = steps.iter().filter(|step| step.gyro == gyro);
    Term::NOMINAL
        .into_iter()
        .chain(found.map(|step| step.term))
        .collect()
}

/// Random permutation (Fisher and Yates).
pub(crate) fn shuffle(order: &mut [usize], generator: &mut ChaCha12Rng) {
    for last in (1..order.len()).rev() {
        // For the number of stops of a log the bias of the remainder is below 1e-17.
        let other = (generator.next_u64() % (last as u64 + 1)) as usize;
        order.swap(last, other);
    }
}
