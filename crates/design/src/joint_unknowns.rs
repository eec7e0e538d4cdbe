//! All unknowns of a record and the run after it.

use gyrocal::Effect;
use gyrocal::effect::Continuation;
use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal_calibration::{BIASES, FittedPlatform, Run, SiteQuantity};
use gyrocal_hypothesis::Column;
use gyrocal_record::{Bench, Prior};
use nalgebra::{DMatrix, DVector};

use crate::COEFFICIENTS;
use crate::design_column::DesignColumn;
use crate::effect_columns::{Combination, SizeColumns, Times, size_columns};
use crate::result::{SetForecast, SetMember};
use crate::run_information::RunInformation;

/// One unknown: what it is in the columns of the record, and in those of the next run.
#[derive(Clone, Debug)]
pub(crate) struct Unknown {
    /// Standard deviation before both.
    pub(crate) sigma: f64,
    first: Vec<(usize, f64)>,
    next: Vec<(usize, f64)>,
}

/// Information on the unknowns in some places, their priors included.
pub(crate) fn with_priors(
    information: &DMatrix<f64>,
    unknowns: &[Unknown],
    places: &[usize],
) -> DMatrix<f64> {
    DMatrix::from_fn(places.len(), places.len(), |i, j| {
        let prior = if i == j {
            unknowns[places[i]].sigma.powi(-2)
        } else {
            0.0
        };
        information[(places[i], places[j])] + prior
    })
}

/// A candidate cause with the onset or time constant that fits best in the record.
#[derive(Clone, Debug)]
pub(crate) struct Candidate {
    pub(crate) row: &'static Effect,
    pub(crate) shape: Option<f64>,
    /// Log-likelihood of the named cause less its own, search penalties subtracted.
    pub(crate) deficit: f64,
    /// Effects of its set that no run tells from it.
    pub(crate) equivalents: Vec<&'static str>,
    /// Variance of the increments, if it is a random walk.
    pub(crate) variance: f64,
    /// Penalty subtracted from its statistic.
    pub(crate) handicap: f64,
    /// Standard deviations of its sizes over turn-ons; empty if they are the same in each record.
    pub(crate) turn_on_sigmas: Vec<f64>,
}

/// A candidate with its unknowns.
#[derive(Clone, Debug)]
pub(crate) struct Member {
    pub(crate) candidate: Candidate,
    pub(crate) places: Vec<usize>,
}

/// One named set: the first member is the cause that is named.
#[derive(Clone, Debug)]
pub(crate) struct ConfidenceSet {
    /// Unknowns that the members are judged beside.
    pub(crate) nuisance: Vec<usize>,
    pub(crate) members: Vec<Member>,
}

impl ConfidenceSet {
    /// The forecast of the set; `apart` is the probability that a member is distinguished from the
    /// first. `None` of an empty set.
    pub(crate) fn forecast(
        &self,
        mean_size: f64,
        one_left: f64,
        apart: impl Fn(usize) -> f64,
    ) -> Option<SetForecast> {
        let members = self.members.iter().enumerate();
        Some(SetForecast {
            effect: self.members.first()?.candidate.row.id.into(),
            mean_size,
            one_left,
            members: members
                .map(|(index, member)| SetMember {
                    effect: member.candidate.row.id.into(),
                    equivalents: member
                        .candidate
                        .equivalents
                        .iter()
                        .map(|id| (*id).into())
                        .collect(),
                    told_apart: apart(index),
                })
                .collect(),
        })
    }
}

/// All unknowns, and the columns that they are sums of.
#[derive(Clone, Debug)]
pub(crate) struct JointUnknowns {
    pub(crate) list: Vec<Unknown>,
    /// Columns of the record.
    pub(crate) first: Vec<DesignColumn>,
    /// Columns of the next run.
    pub(crate) next: Vec<DesignColumn>,
    /// Unknowns of the site, which sigmas take as considered.
    pub(crate) site: [usize; 3],
    /// Turn-ons, what is in the model without a name, and sizes of the next run alone.
    pub(crate) common: Vec<usize>,
    pub(crate) cases: Vec<ConfidenceSet>,
}

/// A parameter by itself.
fn both(index: usize) -> Combination {
    vec![(DesignColumn::Parameter(index), 1.0)]
}

impl JointUnknowns {
    /// Of a fit to a record, with a set for each cause that was named.
    pub(crate) fn new(
        fitted: &FittedPlatform<'_>,
        run: &Run<'_>,
        sets: &[Vec<Candidate>],
        times: &Times,
    ) -> Self {
        let prior = &run.bench.prior;
        let differ = prior.turn_on_sigma_deg_per_h.iter().any(|s| *s > 0.0);
        let mut all = Self {
            list: Vec::new(),
            first: Vec::new(),
            next: Vec::new(),
            site: [0; 3],
            common: Vec::new(),
            cases: Vec::new(),
        };
        let mut sigmas = fitted.prior_sigma();
        if differ {
            // The fit has the prior of one turn-on; this is that of their mean.
            for (axis, bias) in BIASES.into_iter().enumerate() {
                sigmas[bias] = prior.bias_sigma_deg_per_h[axis];
            }
        }
        for (index, sigma) in sigmas.into_iter().take(COEFFICIENTS).enumerate() {
            all.add(&both(index), &both(index), sigma);
        }
        all.add_site(run.bench);
        if differ {
            all.add_turn_ons(prior);
        }
        all.add_unmodelled(fitted);
        all.add_sets(sets, times, fitted.records() > 1);
        all
    }

    fn add_site(&mut self, bench: &Bench) {
        for (place, quantity) in SiteQuantity::ALL.into_iter().enumerate() {
            let sum = PARAMETERS
                .iter()
                .position(|element| element.id == quantity.id())
                .map_or_else(Vec::new, both);
            let sigma = quantity.declared_sigma(bench).unwrap_or(0.0);
            self.site[place] = self.add(&sum, &sum, sigma);
        }
    }

    /// The turn-ons of the last record and of the next run beside the mean.
    fn add_turn_ons(&mut self, prior: &Prior) {
        for next in [false, true] {
            for (axis, bias) in BIASES.into_iter().enumerate() {
                // A gyro whose turn-ons are equal has next to nothing to add.
                let sigma = prior.turn_on_sigma_deg_per_h[axis].max(1e-9);
                let none = Combination::new();
                let place = if next {
                    self.add(&none, &both(bias), sigma)
                } else {
                    // Those of earlier records are eliminated from their information.
                    self.add(&vec![(DesignColumn::OfLast(bias), 1.0)], &none, sigma)
                };
                self.common.push(place);
            }
        }
    }

    /// Unmodelled terms of the fit.
    fn add_unmodelled(&mut self, fitted: &FittedPlatform<'_>) {
        for (index, column) in fitted.extension().columns.columns().iter().enumerate() {
            if matches!(column, Column::TimeProfile { .. }) {
                let own = vec![(DesignColumn::Fitted(index), 1.0)];
                let place = self.add(&own, &Combination::new(), f64::INFINITY);
                self.common.push(place);
            }
        }
    }

    fn add_sets(&mut self, sets: &[Vec<Candidate>], times: &Times, several: bool) {
        let members: Vec<Vec<Member>> = sets
            .iter()
            .map(|set| {
                set.iter()
                    .map(|candidate| self.member(candidate, times, several))
                    .collect()
            })
            .collect();
        for (index, own) in members.iter().enumerate() {
            let mut nuisance: Vec<usize> = (0..COEFFICIENTS).collect();
            let declared = |place: &usize| self.list[*place].sigma > 0.0;
            nuisance.extend(self.site.iter().filter(|place| declared(place)));
            nuisance.extend(&self.common);
            let others = members.iter().enumerate().filter(|(i, _)| *i != index);
            nuisance.extend(
                others
                    .filter_map(|(_, members)| members.first())
                    .flat_map(|named| named.places.iter()),
            );
            self.cases.push(ConfidenceSet {
                nuisance,
                members: own.clone(),
            });
        }
    }

    /// Information on the unknowns, and their score, from what the record says.
    pub(crate) fn of_first(&self, information: &RunInformation) -> RunInformation {
        self.fold(information, |unknown| &unknown.first)
    }

    /// The same from what the next run says.
    pub(crate) fn of_next(&self, information: &RunInformation) -> RunInformation {
        self.fold(information, |unknown| &unknown.next)
    }

    fn fold<'a>(
        &'a self,
        run: &RunInformation,
        of: impl Fn(&'a Unknown) -> &'a Vec<(usize, f64)>,
    ) -> RunInformation {
        let count = self.list.len();
        let mut information = DMatrix::zeros(count, count);
        let mut score = DVector::zeros(count);
        for (i, a) in self.list.iter().enumerate() {
            for (column, factor) in of(a) {
                score[i] += factor * run.score[*column];
                for (j, b) in self.list.iter().enumerate() {
                    for (other, times) in of(b) {
                        information[(i, j)] += factor * times * run.information[(*column, *other)];
                    }
                }
            }
        }
        RunInformation { information, score }
    }

    fn member(&mut self, candidate: &Candidate, times: &Times, several: bool) -> Member {
        // A random walk has a prior: the variance of its increments.
        let sigma = if candidate.variance > 0.0 {
            candidate.variance.sqrt()
        } else {
            f64::INFINITY
        };
        let mut sizes = size_columns(candidate.row, candidate.shape, times);
        if several {
            let sizes = sizes.iter_mut();
            sizes.for_each(|size| in_another_record(size, candidate.row));
        }
        for (size, sigma) in sizes.iter_mut().zip(&candidate.turn_on_sigmas) {
            let own = core::mem::take(&mut size.next);
            let place = self.add(&Combination::new(), &own, *sigma);
            self.common.push(place);
        }
        Member {
            places: sizes
                .iter()
                .map(|size| self.add(&size.first, &size.next, sigma))
                .collect(),
            candidate: candidate.clone(),
        }
    }

    fn add(&mut self, first: &Combination, next: &Combination, sigma: f64) -> usize {
        let unknown = Unknown {
            sigma,
            first: interned(&mut self.first, first),
            next: interned(&mut self.next, next),
        };
        self.list.push(unknown);
        self.list.len() - 1
    }
}

/// Makes the columns of the next run those of one more record with a clock of its own: what begins at one time
/// begins in one record. Increments of a walk that are the next run's own stay.
fn in_another_record(size: &mut SizeColumns, effect: &Effect) {
    if size.first.is_empty() {
        return;
    }
    size.next.clear();
    if effect.continuation != Continuation::ThisRecord {
        let again = size.first.iter().filter(|(column, _)| column.recurs());
        size.next.extend(again.cloned());
    }
}

/// A combination by the places of its columns in a list, to which missing ones are added.
fn interned(columns: &mut Vec<DesignColumn>, combination: &Combination) -> Vec<(usize, f64)> {
    combination
        .iter()
        .map(|(column, factor)| {
            let known = columns.iter().position(|other| other == column);
            let place = known.unwrap_or_else(|| {
                columns.push(column.clone());
                columns.len() - 1
            });
            (place, *factor)
        })
        .collect()
}
