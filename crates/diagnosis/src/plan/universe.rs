//! All unknowns of a record and the run after it, and which of them each question is about.

use gyrocal::Effect;
use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal_calibration::{BIASES, Column, Extended, Run, SiteQuantity};
use nalgebra::{DMatrix, DVector};

use super::piece::Piece;
use super::result::{SetForecast, SetMember};
use super::said::Said;
use super::signature::{Sum, Times, sizes};
use crate::COEFFICIENTS;
use crate::cause::parameter;

/// One unknown: what it is in the columns of the record, and in those of the next run.
#[derive(Clone, Debug)]
pub(crate) struct Unknown {
    /// Standard deviation before both.
    pub(crate) sigma: f64,
    first: Vec<(usize, f64)>,
    next: Vec<(usize, f64)>,
}

/// A cause in question with the onset or time constant that is best in the record.
#[derive(Clone, Debug)]
pub(crate) struct Suspect {
    pub(crate) row: &'static Effect,
    pub(crate) shape: Option<f64>,
    /// How much less likely it makes the record than the cause that is named does, as a
    /// difference of log-likelihoods with searching allowed for.
    pub(crate) deficit: f64,
    /// Effects of its set that no run tells from it.
    pub(crate) equivalents: Vec<&'static str>,
    /// Variance of the increments, if it is a random walk.
    pub(crate) variance: f64,
    /// What its statistic has to be lowered by.
    pub(crate) handicap: f64,
}

/// A suspect with its unknowns.
#[derive(Clone, Debug)]
pub(crate) struct Member {
    pub(crate) suspect: Suspect,
    pub(crate) places: Vec<usize>,
}

/// One named set: the first member is the cause that is named.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    /// Unknowns that the members are judged beside.
    pub(crate) nuisance: Vec<usize>,
    pub(crate) members: Vec<Member>,
}

impl Case {
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
            effect: self.members.first()?.suspect.row.id.into(),
            mean_size,
            one_left,
            members: members
                .map(|(index, member)| SetMember {
                    effect: member.suspect.row.id.into(),
                    equivalents: member
                        .suspect
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
pub(crate) struct Universe {
    pub(crate) unknowns: Vec<Unknown>,
    /// Columns of the record.
    pub(crate) first: Vec<Piece>,
    /// Columns of the next run.
    pub(crate) next: Vec<Piece>,
    /// Unknowns of the site, which sigmas take as considered.
    pub(crate) site: [usize; 3],
    /// Turn-ons, and what is in the model without a name.
    pub(crate) common: Vec<usize>,
    pub(crate) cases: Vec<Case>,
}

impl Universe {
    /// Of a fit to a record, with a set for each cause that was named.
    pub(crate) fn new(
        fitted: &Extended<'_>,
        run: &Run<'_>,
        sets: &[Vec<Suspect>],
        times: &Times,
    ) -> Self {
        let prior = &run.bench.prior;
        let differ = prior.turn_on_sigma_deg_per_h.iter().any(|s| *s > 0.0);
        let mut all = Self {
            unknowns: Vec::new(),
            first: Vec::new(),
            next: Vec::new(),
            site: [0; 3],
            common: Vec::new(),
            cases: Vec::new(),
        };
        let both = |index: usize| vec![(Piece::Parameter(index), 1.0)];
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
        for (place, quantity) in SiteQuantity::ALL.into_iter().enumerate() {
            let sum = parameter(quantity.id()).map_or_else(Vec::new, both);
            let sigma = quantity.declared_sigma(run.bench).unwrap_or(0.0);
            all.site[place] = all.add(&sum, &sum, sigma);
        }
        if differ {
            for next in [false, true] {
                for (axis, bias) in BIASES.into_iter().enumerate() {
                    // A gyro whose turn-ons are the same has next to nothing to add.
                    let sigma = prior.turn_on_sigma_deg_per_h[axis].max(1e-9);
                    let (own, none) = (both(bias), Sum::new());
                    let place = if next {
                        all.add(&none, &own, sigma)
                    } else {
                        all.add(&own, &none, sigma)
                    };
                    all.common.push(place);
                }
            }
        }
        // Lines, which have no name.
        for (index, column) in fitted.extension().further.columns().iter().enumerate() {
            if matches!(column, Column::Course { .. }) {
                let own = vec![(Piece::Own(index), 1.0)];
                let place = all.add(&own, &Sum::new(), f64::INFINITY);
                all.common.push(place);
            }
        }
        let members: Vec<Vec<Member>> = sets
            .iter()
            .map(|set| {
                set.iter()
                    .map(|suspect| all.member(suspect, times))
                    .collect()
            })
            .collect();
        for (index, own) in members.iter().enumerate() {
            let mut nuisance: Vec<usize> = (0..COEFFICIENTS).collect();
            let declared = |place: &usize| all.unknowns[*place].sigma > 0.0;
            nuisance.extend(all.site.iter().filter(|place| declared(place)));
            nuisance.extend(&all.common);
            let others = members.iter().enumerate().filter(|(i, _)| *i != index);
            nuisance.extend(
                others
                    .filter_map(|(_, members)| members.first())
                    .flat_map(|named| named.places.iter()),
            );
            all.cases.push(Case {
                nuisance,
                members: own.clone(),
            });
        }
        all
    }

    /// Information on the unknowns, and their score, from what the record says.
    pub(crate) fn of_first(&self, said: &Said) -> Said {
        self.fold(said, |unknown| &unknown.first)
    }

    /// The same from what the next run says.
    pub(crate) fn of_next(&self, said: &Said) -> Said {
        self.fold(said, |unknown| &unknown.next)
    }

    fn fold<'a>(&'a self, said: &Said, of: impl Fn(&'a Unknown) -> &'a Vec<(usize, f64)>) -> Said {
        let count = self.unknowns.len();
        let mut information = DMatrix::zeros(count, count);
        let mut score = DVector::zeros(count);
        for (i, a) in self.unknowns.iter().enumerate() {
            for (piece, factor) in of(a) {
                score[i] += factor * said.score[*piece];
                for (j, b) in self.unknowns.iter().enumerate() {
                    for (other, times) in of(b) {
                        information[(i, j)] += factor * times * said.information[(*piece, *other)];
                    }
                }
            }
        }
        Said { information, score }
    }

    fn member(&mut self, suspect: &Suspect, times: &Times) -> Member {
        // A random walk has a prior: the variance of its increments.
        let sigma = if suspect.variance > 0.0 {
            suspect.variance.sqrt()
        } else {
            f64::INFINITY
        };
        Member {
            places: sizes(suspect.row, suspect.shape, times)
                .iter()
                .map(|size| self.add(&size.first, &size.next, sigma))
                .collect(),
            suspect: suspect.clone(),
        }
    }

    fn add(&mut self, first: &Sum, next: &Sum, sigma: f64) -> usize {
        let unknown = Unknown {
            sigma,
            first: interned(&mut self.first, first),
            next: interned(&mut self.next, next),
        };
        self.unknowns.push(unknown);
        self.unknowns.len() - 1
    }
}

/// A sum by the places of its pieces in a list, which takes those that it does not have.
fn interned(pieces: &mut Vec<Piece>, sum: &Sum) -> Vec<(usize, f64)> {
    debug_assert!(
        sum.iter()
            .all(|(piece, _)| !matches!(piece, Piece::Parameter(p) if *p >= PARAMETERS.len()))
    );
    sum.iter()
        .map(|(piece, factor)| {
            let known = pieces.iter().position(|other| other == piece);
            let place = known.unwrap_or_else(|| {
                pieces.push(piece.clone());
                pieces.len() - 1
            });
            (place, *factor)
        })
        .collect()
}
