//! The law of one gyro: its base terms as far as the logs determine them, and significant effects.

use gyrocal_statistics::f_tail;
use nalgebra::{DMatrix, DVector};

use super::blocks::Blocks;
use super::noise_model::{Fit, NoiseModel, PARTS, Variances, first_variances};
use super::terms::RateTerm;
use crate::multi_position::Term;

/// Largest condition number of the columns, each scaled to length one, of determined terms.
const WORST_CONDITION: f64 = 300.0;

/// Most effects of one gyro that are added to its base law.
const MOST_EFFECTS: usize = 4;

/// Terms of a round of the search whose noise is fitted anew; the others are far behind.
const REFITTED: usize = 3;

/// Half the play of a hysteresis over the range of temperature, for which it is sought: each half as large again.
const HALF_PLAYS: [f64; 9] = [0.02, 0.03, 0.045, 0.065, 0.1, 0.15, 0.21, 0.3, 0.42];

/// Halvings of a quarter of a block in which the instant of a step is sought.
const HALVINGS: usize = 6;

/// Largest loss of log-likelihood of an alternative to an effect, the 95 % limit of one parameter.
const ALTERNATIVE_NATS: f64 = 1.92;

/// A term that was found beyond the base law.
pub(super) struct Found {
    pub(super) term: RateTerm,
    pub(super) p_value: f64,
    pub(super) alternatives: Vec<RateTerm>,
}

/// A fitted law.
pub(super) struct Law {
    pub(super) terms: Vec<RateTerm>,
    pub(super) found: Vec<Found>,
    pub(super) undetermined: Vec<RateTerm>,
    pub(super) fit: Fit,
    /// Degrees of freedom of each standard deviation.
    pub(super) degrees_of_freedom: Vec<f64>,
}

/// Rates of one gyro with their noise.
pub(super) struct Data<'a> {
    pub(super) gyro: usize,
    pub(super) logs: &'a [Blocks],
    /// Outputs less what is known of them \[deg/h\].
    pub(super) rates: DVector<f64>,
    pub(super) noise: NoiseModel,
}

impl Data<'_> {
    /// The law at a family-wise false-alarm probability for each gyro; `None` if its noise cannot be fitted.
    pub(super) fn law(&self, false_alarm: f64) -> Option<Law> {
        let (mut terms, undetermined) = self.base();
        let mut found: Vec<Found> = Vec::new();
        let mut start = first_variances(self.logs, &self.rates);
        while found.len() < MOST_EFFECTS {
            let here = self.fit(&terms, start, false)?;
            start = here.variances;
            let ranked = self.ranked(&terms, &here);
            let refitted = ranked.iter().take(REFITTED).filter_map(|term| {
                let fit = self.with(&terms, *term, start)?;
                Some((*term, fit.twice_ln_likelihood - here.twice_ln_likelihood))
            });
            let mut refitted: Vec<(RateTerm, f64)> = refitted.collect();
            refitted.sort_by(|a, b| b.1.total_cmp(&a.1));
            let Some(&(term, gain)) = refitted.first() else {
                break;
            };
            // The noise is estimated: the gain of a likelihood whose scale is fitted is that of an F.
            let freedom = self.rates.len() as f64 - (terms.len() + 1 + PARTS) as f64;
            let f = (gain.max(0.0) / self.rates.len() as f64).exp_m1() * freedom;
            let p_value = (self.tests(term) * f_tail(f, [1.0, freedom]).unwrap_or(1.0)).min(1.0);
            if p_value > false_alarm {
                break;
            }
            let near = refitted[1..]
                .iter()
                .filter(|(_, other)| gain - other < 2.0 * ALTERNATIVE_NATS);
            found.push(Found {
                term,
                p_value,
                alternatives: near.map(|(term, _)| *term).collect(),
            });
            terms.push(term);
        }
        let fit = self.fit(&terms, start, true)?;
        let degrees_of_freedom =
            self.noise
                .degrees_of_freedom(&self.columns(&terms)?, &self.rates, fit.variances)?;
        Some(Law {
            degrees_of_freedom,
            terms,
            found,
            undetermined,
            fit,
        })
    }

    /// Bias, terms in the table's rate and in specific force, as far as they are determined together.
    fn base(&self) -> (Vec<RateTerm>, Vec<RateTerm>) {
        let mut terms = vec![RateTerm::Drift(Term::Nominal(0))];
        let mut undetermined = Vec::new();
        let along = |axis: usize| match axis == self.gyro {
            true => Term::Nominal(1),
            false => Term::Cross(axis),
        };
        let of_table = self.logs.iter().any(|log| log.table.is_some());
        let own_first: [usize; 3] = core::array::from_fn(|step| (self.gyro + step) % 3);
        let turns = own_first
            .map(RateTerm::Turn)
            .into_iter()
            .filter(|_| of_table);
        let forces = own_first.map(|axis| RateTerm::Drift(along(axis)));
        for term in turns.chain(forces) {
            let mut more = terms.clone();
            more.push(term);
            match self.columns(&more).filter(are_independent) {
                Some(_) => terms = more,
                None => undetermined.push(term),
            }
        }
        (terms, undetermined)
    }

    /// Effects in temperature and time.
    fn candidates(&self) -> Vec<RateTerm> {
        let mut candidates = vec![
            RateTerm::Temperature(1),
            RateTerm::Temperature(2),
            RateTerm::Temperature(3),
            RateTerm::TemperatureRate,
            RateTerm::Drift(Term::Ramp),
        ];
        candidates.extend(HALF_PLAYS.map(RateTerm::Hysteresis));
        candidates.retain(|term| term.column(self.gyro, self.logs).is_some());
        candidates
    }

    /// Tests that a p-value is corrected for: twice those of its kind, courses or steps.
    fn tests(&self, term: RateTerm) -> f64 {
        2.0 * match term {
            RateTerm::Step { .. } => self.rates.len() as f64,
            _ => self.candidates().len() as f64,
        }
    }

    /// Candidates by their significance with the noise of a fit, of the steps the most significant one.
    fn ranked(&self, terms: &[RateTerm], fit: &Fit) -> Vec<RateTerm> {
        let Some(columns) = self.columns(terms) else {
            return Vec::new();
        };
        let Some((_, inverse)) = self.noise.solve(&columns, &self.rates, fit.variances) else {
            return Vec::new();
        };
        let left = &inverse * (&self.rates - &columns * &fit.estimates);
        let across = &inverse * &columns;
        let score = |term: RateTerm| {
            let mut more = terms.to_vec();
            more.push(term);
            self.columns(&more).filter(are_independent)?;
            let column = term.column(self.gyro, self.logs)?;
            let shared = across.transpose() * &column;
            let variance =
                column.dot(&(&inverse * &column)) - shared.dot(&(&fit.covariance * &shared));
            (variance > 0.0).then(|| left.dot(&column).powi(2) / variance)
        };
        let steps = self.logs.iter().enumerate().flat_map(|(log, blocks)| {
            let ends = blocks.time_s.windows(2).skip(1);
            let quarters = |pair: &[f64]| {
                let [from, to] = [pair[0], pair[1]];
                [0.5, 0.75, 1.0, 1.25].map(|share| from + share * (to - from))
            };
            let times = ends.flat_map(quarters);
            times.map(move |time_s| RateTerm::Step { log, time_s })
        });
        let scored = |term: RateTerm| Some((term, score(term)?));
        let step = steps.filter_map(scored).max_by(|a, b| a.1.total_cmp(&b.1));
        let step = step.map(|best| self.refined(best, &scored));
        let is_new = |term: &RateTerm| !terms.iter().any(|one| one.is_of_kind(*term));
        let candidates = self.candidates().into_iter().filter(is_new);
        let mut ranked: Vec<(RateTerm, f64)> = candidates.filter_map(scored).collect();
        ranked.extend(step);
        ranked.sort_by(|a, b| b.1.total_cmp(&a.1));
        // Of each effect the best shape.
        let mut best: Vec<RateTerm> = Vec::new();
        for (term, _) in ranked {
            if !best.iter().any(|one| one.is_of_kind(term)) {
                best.push(term);
            }
        }
        best
    }

    /// A step at the instant of the largest score near it.
    fn refined(
        &self,
        mut best: (RateTerm, f64),
        scored: &dyn Fn(RateTerm) -> Option<(RateTerm, f64)>,
    ) -> (RateTerm, f64) {
        let RateTerm::Step { log, time_s } = best.0 else {
            return best;
        };
        let (mut time_s, mut width_s) = (time_s, 0.125 * self.logs[log].block_s);
        for _ in 0..HALVINGS {
            for side in [-width_s, width_s] {
                let time_s = time_s + side;
                let other = scored(RateTerm::Step { log, time_s });
                best = other.filter(|other| other.1 > best.1).unwrap_or(best);
            }
            if let RateTerm::Step {
                time_s: found_s, ..
            } = best.0
            {
                time_s = found_s;
            }
            width_s *= 0.5;
        }
        best
    }

    fn with(&self, terms: &[RateTerm], term: RateTerm, start: Variances) -> Option<Fit> {
        let mut more = terms.to_vec();
        more.push(term);
        self.fit(&more, start, false)
    }

    fn fit(&self, terms: &[RateTerm], start: Variances, restricted: bool) -> Option<Fit> {
        self.noise
            .fit(&self.columns(terms)?, &self.rates, start, restricted)
    }

    fn columns(&self, terms: &[RateTerm]) -> Option<DMatrix<f64>> {
        let columns: Option<Vec<DVector<f64>>> = terms
            .iter()
            .map(|term| term.column(self.gyro, self.logs))
            .collect();
        Some(DMatrix::from_columns(&columns?))
    }
}

fn are_independent(columns: &DMatrix<f64>) -> bool {
    let mut scaled = columns.clone();
    for mut column in scaled.column_iter_mut() {
        let length = column.norm();
        if length == 0.0 {
            return false;
        }
        column /= length;
    }
    let values = scaled.singular_values();
    values.max() <= WORST_CONDITION * values.min()
}
