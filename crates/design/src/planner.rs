//! The search for the best attitude of a run.

use std::borrow::Cow;

use gyrocal_calibration::{CalibrationError, FittedPlatform};
use gyrocal_hypothesis::Stop;
use rayon::prelude::*;

use crate::attitude::{apart_deg, beside, first};
use crate::candidates::{candidates, times};
use crate::error::DesignError;
use crate::evaluator::{Detail, Evaluation, Evaluator, interval_s};
use crate::joint_unknowns::{Candidate, JointUnknowns};
use crate::named_cause::NamedCause;
use crate::options::PlanOptions;
use crate::past::Past;
use crate::result::{Aim, Outlook, Proposal};
use crate::run_information::RunInformation;

/// Resolution during the search, and of the result.
const COARSE: Detail = Detail {
    rows: 160,
    draws: 96,
};
pub(crate) const FINE: Detail = Detail {
    rows: 720,
    draws: 1024,
};

/// Number of attitudes from which a local search starts, and their least distance.
const FOLLOWED: usize = 5;
const DISTINCT_DEG: f64 = 20.0;

/// Steps of the local search, deg, and the most repetitions of each.
const STEPS_DEG: [f64; 3] = [12.0, 5.0, 2.0];
const ROUNDS: usize = 3;

/// Least number of rows of a run: the number of states of the filter.
const LEAST_ROWS: f64 = 12.0;

/// Weight of the mean ratio of standard deviations against the expected number of members: where a set
/// is nearly resolved, standard deviations decide.
const SIGMAS_IN_SETS: f64 = 0.2;

/// Everything but attitude and duration.
pub(crate) struct Planner<'a, 'b> {
    fitted: &'b FittedPlatform<'a>,
    past: &'b Past<'b>,
    pub(crate) options: &'b PlanOptions,
    sets: Vec<Vec<Candidate>>,
    /// Information of the records on the columns, which are the same for all durations.
    information: RunInformation,
    pub(crate) aim: Aim,
}

impl<'a, 'b> Planner<'a, 'b> {
    pub(crate) fn new(
        fitted: &'b FittedPlatform<'a>,
        past: &'b Past<'b>,
        named: &[NamedCause],
        options: &'b PlanOptions,
    ) -> Result<Self, DesignError> {
        let sets = candidates(fitted, past, named)?;
        let run = past.run();
        let own = times(past, run.record.duration_s());
        let unknowns = JointUnknowns::new(fitted, &run, &sets, &own);
        let information = RunInformation::of_record(fitted, run.record, &unknowns.first)?;
        let aim = options
            .aim
            .unwrap_or(if sets.iter().any(|set| set.len() > 1) {
                Aim::Set
            } else {
                Aim::Sigmas
            });
        Ok(Self {
            fitted,
            past,
            options,
            sets,
            information,
            aim,
        })
    }

    /// Exact equivalents in the sets, the named one of each class first.
    pub(crate) fn inseparable(&self) -> Vec<Vec<Cow<'static, str>>> {
        let candidates = self.sets.iter().flatten();
        let classes = candidates.filter(|candidate| !candidate.equivalents.is_empty());
        classes
            .map(|candidate| {
                let others = candidate.equivalents.iter().copied();
                let class = core::iter::once(candidate.row.id).chain(others);
                class.map(Into::into).collect()
            })
            .collect()
    }

    /// The shortest run, s.
    pub(crate) fn least_s(&self) -> f64 {
        LEAST_ROWS * interval_s(self.past.last().record)
    }

    /// With everything but the attitude.
    pub(crate) fn with<R>(
        &self,
        duration_s: f64,
        detail: Detail,
        ask: impl FnOnce(&Evaluator<'_>) -> Result<R, DesignError>,
    ) -> Result<R, DesignError> {
        let times = times(self.past, duration_s);
        let unknowns = JointUnknowns::new(self.fitted, &self.past.run(), &self.sets, &times);
        let evaluator = Evaluator::new(
            &unknowns,
            self.fitted,
            self.past,
            self.fitted.noise_model(),
            &self.information,
            self.options.limits,
            self.options.calibration,
            (duration_s, detail, self.options.seed),
        )
        .ok_or(CalibrationError::NotPositiveDefinite)?;
        ask(&evaluator)
    }

    /// The best runs of a duration, the best first.
    pub(crate) fn search(&self, duration_s: f64) -> Result<Vec<Proposal>, DesignError> {
        let ends = self.with(duration_s, COARSE, |evaluator| {
            let tried = first(&self.options.limits);
            let mut seen = self.evaluate(evaluator, tried, duration_s)?;
            sort(&mut seen);
            let starts = distinct(seen, FOLLOWED);
            let stop = Stop::here();
            let ends = starts
                .into_par_iter()
                .map(|start| stop.over(|| self.local_search(evaluator, start)));
            Ok(ends.collect::<Vec<_>>())
        })?;
        self.with(duration_s, FINE, |evaluator| {
            let angles = ends.into_iter().map(|(angles_deg, _)| angles_deg).collect();
            let mut best = self.evaluate(evaluator, angles, duration_s)?;
            sort(&mut best);
            Ok(distinct(best, self.options.proposals)
                .into_iter()
                .map(|(angles_deg, (_, outlook))| Proposal {
                    angles_deg: Some(angles_deg),
                    duration_s,
                    outlook,
                })
                .collect())
        })
    }

    /// All attitudes that the limits allow, with their costs.
    fn evaluate(
        &self,
        evaluator: &Evaluator<'_>,
        tried: Vec<[f64; 3]>,
        duration_s: f64,
    ) -> Result<Vec<Seen>, DesignError> {
        if tried.is_empty() {
            return Err(DesignError::NoAttitude);
        }
        let stop = Stop::here();
        let looked: Vec<_> = tried
            .into_par_iter()
            .map(|angles_deg| {
                let found = stop.over(|| evaluator.evaluate(angles_deg));
                (angles_deg, found)
            })
            .collect();
        stop.check()?;
        let mut seen = Vec::new();
        let (mut longest, mut failed) = ((0.0, [0.0; 3]), None);
        for (angles_deg, looked) in looked {
            match looked {
                Ok(Evaluation::At(outlook)) => {
                    seen.push((angles_deg, (self.cost(&outlook), outlook)))
                }
                Ok(Evaluation::Stopped(after_s)) if after_s > longest.0 => {
                    longest = (after_s, angles_deg);
                }
                Ok(Evaluation::Stopped(_)) => {}
                Err(error) => failed = Some(error),
            }
        }
        match failed {
            _ if !seen.is_empty() => Ok(seen),
            Some(error) => Err(error.into()),
            // No time moves a unit that rests.
            None if self.fitted.is_strapdown() => Err(CalibrationError::NotPositiveDefinite.into()),
            None => Err(DesignError::Limits {
                wanted_h: duration_s / 3600.0,
                longest_h: longest.0 / 3600.0,
                angles_deg: longest.1,
            }),
        }
    }

    /// Local search from one attitude.
    fn local_search(&self, evaluator: &Evaluator<'_>, mut best: Seen) -> Seen {
        for step_deg in STEPS_DEG {
            for _ in 0..ROUNDS {
                let beside = beside(best.0, step_deg);
                let allowed = beside
                    .into_iter()
                    .filter(|angles| self.options.limits.hold(*angles));
                let better = allowed
                    .filter_map(|angles_deg| match evaluator.evaluate(angles_deg) {
                        Ok(Evaluation::At(outlook)) => {
                            Some((angles_deg, (self.cost(&outlook), outlook)))
                        }
                        _ => None,
                    })
                    .min_by(|a: &Seen, b| a.1.0.total_cmp(&b.1.0));
                match better {
                    Some(better) if better.1.0 < best.1.0 => best = better,
                    _ => break,
                }
            }
        }
        best
    }

    fn cost(&self, outlook: &Outlook) -> f64 {
        match self.aim {
            Aim::Set => outlook.surplus() + SIGMAS_IN_SETS * outlook.sigma_ratio,
            Aim::Sigmas => outlook.sigma_ratio,
        }
    }
}

/// Angles with cost and forecast.
type Seen = ([f64; 3], (f64, Outlook));

fn sort(seen: &mut [Seen]) {
    seen.sort_by(|a, b| a.1.0.total_cmp(&b.1.0));
}

/// The first ones at the least distance from each other.
fn distinct(seen: Vec<Seen>, most: usize) -> Vec<Seen> {
    let mut taken: Vec<Seen> = Vec::with_capacity(most);
    for one in seen {
        if taken.len() == most {
            break;
        }
        if taken
            .iter()
            .all(|other| apart_deg(other.0, one.0) > DISTINCT_DEG)
        {
            taken.push(one);
        }
    }
    taken
}
