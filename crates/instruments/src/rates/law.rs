//! The law of one gyro: its base terms as far as the logs determine them, and significant effects.

use gyrocal_statistics::f_tail;
use nalgebra::{DMatrix, DVector};

use super::between_logs::{are_independent, free_differences, with_free_biases};
use super::blocks::Blocks;
use super::noise_model::{BETWEEN_LOGS, Fit, NoiseModel, PARTS, Variances, first_variances};
use super::terms::RateTerm;
use crate::multi_position::Term;

/// Most effects of one gyro that are added to its base law.
const MOST_EFFECTS: usize = 4;

/// Terms of a round of the search whose noise is fitted anew; the others are far behind.
const REFITTED: usize = 3;

/// Half the play of a hysteresis over the range of temperature, for which it is sought: each half as large again.
const HALF_PLAYS: [f64; 9] = [0.02, 0.03, 0.045, 0.065, 0.1, 0.15, 0.21, 0.3, 0.42];

/// Halvings of the ratio of two of them in which the play is sought.
const PLAY_HALVINGS: usize = 4;

/// Halvings of a quarter of a block in which the instant of a step is sought.
const HALVINGS: usize = 6;

/// Blocks to either side in which the instant of a step is sought again beside the other effects of a law; the most
/// rounds of that, and the gain of twice the log-likelihood below which a shape stays.
const NEAR: f64 = 2.0;
const ROUNDS: usize = 4;
const LEAST_MOVE: f64 = 0.05;

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
    /// Differences of the biases of logs that the terms leave free.
    pub(super) free_differences: usize,
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
            let ranked = self.ranked(&terms, here.variances);
            let refitted = ranked.iter().take(REFITTED).filter_map(|term| {
                let fit = self.with(&terms, *term, start)?;
                Some((*term, fit.twice_ln_likelihood - here.twice_ln_likelihood))
            });
            let mut refitted: Vec<(RateTerm, f64)> = refitted.collect();
            refitted.sort_by(|a, b| b.1.total_cmp(&a.1));
            let tested = refitted.iter().take(self.tried());
            let tested = tested.map(|&(term, gain)| {
                let p_value = self.p_value(&terms, term, gain, start);
                (term, gain, p_value)
            });
            let mut significant = tested.filter(|(_, _, p_value)| *p_value <= false_alarm);
            let Some((term, gain, p_value)) = significant.next() else {
                break;
            };
            let near = refitted.iter().filter(|(other, of_other)| {
                *other != term && gain - of_other < 2.0 * ALTERNATIVE_NATS
            });
            found.push(Found {
                term,
                p_value,
                alternatives: near.map(|(term, _)| *term).collect(),
            });
            terms.push(term);
            self.settle(&mut terms, &mut found, start)?;
        }
        let columns = self.columns(&terms)?;
        let free_differences = free_differences(&columns, self.logs);
        let fit = self.restricted(&columns, start, free_differences)?;
        let likely = self
            .noise
            .with_likely_change(fit.variances, free_differences);
        let fitted = self.noise.fitted_parts();
        let degrees_of_freedom =
            self.noise
                .degrees_of_freedom(&columns, &self.rates, likely, fitted)?;
        Some(Law {
            degrees_of_freedom,
            free_differences,
            terms,
            found,
            undetermined,
            fit,
        })
    }

    /// Terms of a round that may be significant. Of several logs the one that gains most may be a change of the bias between
    /// them, in front of one that shows within them.
    fn tried(&self) -> usize {
        match self.logs.len() {
            1 => 1,
            _ => REFITTED,
        }
    }

    /// Family-wise p-value of a term beside others by twice the log-likelihood that it gains.
    fn p_value(&self, terms: &[RateTerm], term: RateTerm, gain: f64, start: Variances) -> f64 {
        // The noise is estimated: the gain of a likelihood whose scale is fitted is that of an F.
        let freedom = self.rates.len() as f64 - (terms.len() + 1 + PARTS) as f64;
        let f = (gain.max(0.0) / self.rates.len() as f64).exp_m1() * freedom;
        let of_gain = f_tail(f, [1.0, freedom]).unwrap_or(1.0);
        let p_value = match self.logs.len() {
            1 => of_gain,
            // The likelihood takes a few logs for more than they are.
            _ => of_gain.max(self.p_value_between_logs(terms, term, start).unwrap_or(1.0)),
        };
        (self.tests(term) * p_value).min(1.0)
    }

    /// p-value of a term by its estimate over its standard deviation, whose degrees of freedom are those of the change of
    /// the bias from log to log; with a bias for each log where the logs leave none.
    fn p_value_between_logs(
        &self,
        terms: &[RateTerm],
        term: RateTerm,
        start: Variances,
    ) -> Option<f64> {
        let mut all = vec![term];
        all.extend(terms);
        let mut columns = self.columns(&all)?;
        let free = free_differences(&columns, self.logs);
        if free == 0 {
            let others = with_free_biases(&self.columns(terms)?, self.logs);
            columns = others.insert_column(0, 0.0);
            columns.set_column(0, &term.column(self.gyro, self.logs)?);
            if !are_independent(&columns) {
                return None;
            }
        }
        let fit = self.restricted(&columns, start, free)?;
        let likely = self.noise.with_likely_change(fit.variances, free);
        let uncertain = BETWEEN_LOGS..PARTS;
        let freedom = self
            .noise
            .degrees_of_freedom(&columns, &self.rates, likely, uncertain)?[0];
        f_tail(
            fit.estimates[0].powi(2) / fit.covariance[(0, 0)],
            [1.0, freedom],
        )
    }

    /// Fit by restricted likelihood, without a change of the bias from log to log where no difference tells it.
    fn restricted(
        &self,
        columns: &DMatrix<f64>,
        mut start: Variances,
        free_differences: usize,
    ) -> Option<Fit> {
        if free_differences == 0 {
            start[BETWEEN_LOGS] = 0.0;
        }
        self.noise.fit(columns, &self.rates, start, true)
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

    /// Candidates by their significance with the noise of a fit, of each effect the most significant shape.
    fn ranked(&self, terms: &[RateTerm], variances: Variances) -> Vec<RateTerm> {
        let Some(scores) = Scores::of(self, terms, variances) else {
            return Vec::new();
        };
        let logs = self.logs.iter().enumerate();
        let steps =
            logs.flat_map(|(log, blocks)| quarters(log, blocks, f64::NEG_INFINITY, f64::INFINITY));
        let is_new = |term: &RateTerm| !terms.iter().any(|one| one.is_of_kind(*term));
        let candidates = self.candidates().into_iter().filter(is_new);
        let mut ranked: Vec<(RateTerm, f64)> =
            candidates.filter_map(|term| scores.scored(term)).collect();
        ranked.extend(scores.best_step(steps));
        ranked.sort_by(|a, b| b.1.total_cmp(&a.1));
        let mut best: Vec<RateTerm> = Vec::new();
        for (term, _) in ranked {
            if !best.iter().any(|one| one.is_of_kind(term)) {
                best.push(term);
            }
        }
        best
    }

    /// Gives each effect of a law the shape that is best beside the others: one that was found first had their
    /// changes in its noise. Alternatives and p-values stay those of the shape that was found.
    fn settle(&self, terms: &mut [RateTerm], found: &mut [Found], start: Variances) -> Option<()> {
        for _ in 0..ROUNDS {
            let variances = self.fit(terms, start, false)?.variances;
            let mut has_moved = false;
            for one in &mut *found {
                let own = terms.iter().position(|term| *term == one.term)?;
                let mut others = terms.to_vec();
                others.remove(own);
                let scores = Scores::of(self, &others, variances)?;
                let best = match one.term {
                    RateTerm::Step { log, time_s } => {
                        let blocks = &self.logs[log];
                        let [from_s, to_s] =
                            [-NEAR, NEAR].map(|near| time_s + near * blocks.block_s);
                        scores.best_step(quarters(log, blocks, from_s, to_s))
                    }
                    RateTerm::Hysteresis(_) => scores.best_hysteresis(),
                    _ => None,
                };
                let (_, before) = scores.scored(one.term)?;
                if let Some((term, _)) = best.filter(|(_, score)| *score > before + LEAST_MOVE) {
                    (one.term, terms[own]) = (term, term);
                    has_moved = true;
                }
            }
            if !has_moved {
                break;
            }
        }
        Some(())
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

/// Scores of terms beside a law, in given noise.
struct Scores<'a> {
    data: &'a Data<'a>,
    terms: &'a [RateTerm],
    covariance: DMatrix<f64>,
    inverse: DMatrix<f64>,
    /// Residuals over the covariance of the noise, and the columns of the law over it.
    left: DVector<f64>,
    across: DMatrix<f64>,
}

impl<'a> Scores<'a> {
    fn of(data: &'a Data<'a>, terms: &'a [RateTerm], variances: Variances) -> Option<Self> {
        let columns = data.columns(terms)?;
        let (fit, inverse) = data.noise.solve(&columns, &data.rates, variances)?;
        Some(Self {
            data,
            terms,
            left: &inverse * (&data.rates - &columns * &fit.estimates),
            across: &inverse * &columns,
            covariance: fit.covariance,
            inverse,
        })
    }

    /// A term with its score, twice the log-likelihood that it gains; `None` if the law has it already.
    fn scored(&self, term: RateTerm) -> Option<(RateTerm, f64)> {
        let mut more = self.terms.to_vec();
        more.push(term);
        self.data.columns(&more).filter(are_independent)?;
        let column = term.column(self.data.gyro, self.data.logs)?;
        let shared = self.across.tr_mul(&column);
        let variance =
            column.dot(&(&self.inverse * &column)) - shared.dot(&(&self.covariance * &shared));
        (variance > 0.0).then(|| (term, self.left.dot(&column).powi(2) / variance))
    }

    /// The hysteresis of the largest score, its play sought between the given ones.
    fn best_hysteresis(&self) -> Option<(RateTerm, f64)> {
        let of = |half: f64| Some((half, self.scored(RateTerm::Hysteresis(half))?.1));
        let scored = HALF_PLAYS.into_iter().filter_map(of);
        let mut best = scored.max_by(|a, b| a.1.total_cmp(&b.1))?;
        // Half of the way to the next play, then half of that.
        let mut ratio = 1.5_f64.sqrt();
        for _ in 0..PLAY_HALVINGS {
            for half in [best.0 / ratio, best.0 * ratio] {
                best = of(half).filter(|other| other.1 > best.1).unwrap_or(best);
            }
            ratio = ratio.sqrt();
        }
        Some((RateTerm::Hysteresis(best.0), best.1))
    }

    /// The step of the largest score, its instant sought beyond the given ones.
    fn best_step(&self, steps: impl Iterator<Item = RateTerm>) -> Option<(RateTerm, f64)> {
        let scored = steps.filter_map(|term| self.scored(term));
        let mut best = scored.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let mut width = 0.125;
        for _ in 0..HALVINGS {
            let RateTerm::Step { log, time_s } = best.0 else {
                return Some(best);
            };
            for side in [-width, width] {
                let time_s = time_s + side * self.data.logs[log].block_s;
                let other = self.scored(RateTerm::Step { log, time_s });
                best = other.filter(|other| other.1 > best.1).unwrap_or(best);
            }
            width *= 0.5;
        }
        Some(best)
    }
}

/// Steps at each quarter of the blocks of a log between two times, from the middle of the second block to the end of
/// the last but one.
fn quarters(log: usize, blocks: &Blocks, from_s: f64, to_s: f64) -> impl Iterator<Item = RateTerm> {
    let (first_s, block_s) = (blocks.time_s[0], blocks.block_s);
    let last_s = first_s + block_s * (blocks.len() as f64 - 1.5);
    let times = (4..4 * blocks.len()).map(move |quarter| first_s + 0.25 * block_s * quarter as f64);
    times
        .filter(move |at| (from_s..=to_s).contains(at) && *at <= last_s)
        .map(move |time_s| RateTerm::Step { log, time_s })
}
