//! Comparison of the members of a confidence set.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::joint_unknowns::{ConfidenceSet, Member, Unknown, with_priors};
use gyrocal_hypothesis::{CONFIDENCE_SET_DEVIANCE, NESTED_MODEL_CHI2};

use crate::walk_score::WalkScore;

/// A signature of which less than this share is left cannot be seen.
const VISIBLE: f64 = 1e-9;

/// Map from scores to the statistics of the members.
pub(crate) struct Comparison {
    /// From the scores of all unknowns to those of the members' own, with what the others take up
    /// projected out.
    pub(crate) projection: DMatrix<f64>,
    comparators: Vec<Option<Comparator>>,
}

struct Comparator {
    /// Rows of the projection.
    rows: Vec<usize>,
    statistic: Statistic,
}

enum Statistic {
    Size(Cholesky<f64, Dyn>),
    Variance(WalkScore),
}

impl Comparison {
    /// With this information on all unknowns, their priors not included; `None` if it does not
    /// determine what the members are judged beside.
    pub(crate) fn new(
        case: &ConfidenceSet,
        unknowns: &[Unknown],
        information: &DMatrix<f64>,
    ) -> Option<Self> {
        let nuisance = &case.nuisance;
        let mut own: Vec<usize> = case
            .members
            .iter()
            .flat_map(|member| member.places.iter().copied())
            .collect();
        own.sort_unstable();
        own.dedup();
        let inner = with_priors(information, unknowns, nuisance);
        let cross = DMatrix::from_fn(nuisance.len(), own.len(), |i, j| {
            information[(nuisance[i], own[j])]
        });
        let taken = Cholesky::new(inner)?.solve(&cross);
        let mut projection = DMatrix::zeros(own.len(), information.ncols());
        for (row, place) in own.iter().enumerate() {
            projection[(row, *place)] = 1.0;
            for (i, nuisance) in nuisance.iter().enumerate() {
                projection[(row, *nuisance)] -= taken[(i, row)];
            }
        }
        let left = DMatrix::from_fn(own.len(), own.len(), |i, j| information[(own[i], own[j])])
            - cross.tr_mul(&taken);
        let comparators = case
            .members
            .iter()
            .map(|member| {
                let rows: Option<Vec<usize>> = member
                    .places
                    .iter()
                    .map(|place| own.binary_search(place).ok())
                    .collect();
                let rows = rows?;
                let part = DMatrix::from_fn(rows.len(), rows.len(), |i, j| {
                    0.5 * (left[(rows[i], rows[j])] + left[(rows[j], rows[i])])
                });
                let statistic = if member.is_walk() {
                    Statistic::Variance(WalkScore::new(part))
                } else {
                    let seen = |row: &usize| {
                        let raw = information[(own[*row], own[*row])];
                        raw > 0.0 && left[(*row, *row)] > VISIBLE * raw
                    };
                    if !rows.iter().all(seen) {
                        return None;
                    }
                    Statistic::Size(Cholesky::new(part)?)
                };
                Some(Comparator { rows, statistic })
            })
            .collect();
        Some(Self {
            projection,
            comparators,
        })
    }

    /// The statistic of each member from projected scores, and of a random walk its variance.
    pub(crate) fn statistics(&self, projected: &[f64]) -> Vec<Option<(f64, f64)>> {
        let of = |comparator: &Comparator| {
            let score = DVector::from_iterator(
                comparator.rows.len(),
                comparator.rows.iter().map(|row| projected[*row]),
            );
            match &comparator.statistic {
                Statistic::Size(information) => (information.solve(&score).dot(&score), 0.0),
                Statistic::Variance(walk) => walk.best(&score),
            }
        };
        self.comparators
            .iter()
            .map(|comparator| comparator.as_ref().map(of))
            .collect()
    }

    /// Estimate and standard deviation of each size of a member.
    pub(crate) fn estimates(&self, member: usize, projected: &[f64]) -> Vec<[f64; 2]> {
        let Some(Comparator {
            rows,
            statistic: Statistic::Size(information),
        }) = self.comparators[member].as_ref()
        else {
            return Vec::new();
        };
        let score = DVector::from_iterator(rows.len(), rows.iter().map(|row| projected[*row]));
        let estimate = information.solve(&score);
        let covariance = information.inverse();
        (0..rows.len())
            .map(|i| [estimate[i], covariance[(i, i)].sqrt()])
            .collect()
    }
}

impl Member {
    pub(crate) fn is_walk(&self) -> bool {
        crate::named_cause::is_walk(self.candidate.row)
    }
}

/// Differences of log-likelihoods to the member that would be named, which may be below zero for
/// a richer one, and that member: the rule of the search.
pub(crate) fn deficits(
    members: &[Member],
    statistics: &[Option<(f64, f64)>],
) -> Option<(usize, Vec<f64>)> {
    let penalised: Vec<f64> = members
        .iter()
        .zip(statistics)
        .map(|(member, statistic)| {
            statistic.map_or(f64::NEG_INFINITY, |(statistic, _)| {
                statistic - member.candidate.handicap
            })
        })
        .collect();
    let preferred = |member: usize| {
        let walk = if members[member].is_walk() {
            NESTED_MODEL_CHI2
        } else {
            0.0
        };
        penalised[member] - walk
    };
    let named = (0..members.len())
        .filter(|member| penalised[*member].is_finite())
        .max_by(|a, b| preferred(*a).total_cmp(&preferred(*b)))?;
    let deficits = penalised
        .iter()
        .map(|value| 0.5 * (penalised[named] - value))
        .collect();
    Some((named, deficits))
}

/// Whether a member with that deficit belongs to the set.
pub(crate) fn stays(deficit: f64) -> bool {
    deficit < 0.5 * CONFIDENCE_SET_DEVIANCE
}
