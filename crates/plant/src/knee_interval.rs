//! Intervals of the size and the knee of an effect by the profile likelihood of its knee.
//!
//! The likelihood of a knee is not quadratic: rows pass the knee where it moves, and those that are beyond it at one
//! place of it say nothing at another. So the model is fitted with the knee held at places farther and farther from
//! the estimate, until the deviance passes the limit on both sides.

use gyrocal_answer::Parameter;
use gyrocal_hypothesis::FittedModel as _;

use crate::catalogue::KNEE;
use crate::description::{EffectEntry, Knee};
use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::solve::{Iterate, Solver};

/// 95 % point of chi-square with one degree of freedom, and its root.
const LIMIT: f64 = 3.841;
const NORMAL_95: f64 = 1.96;

/// The first distance from the estimate over its standard deviation by the curvature, and each over the one before:
/// the limit of a quadratic likelihood lies between the fourth and the fifth.
const FIRST: f64 = 0.35;
const GROWTH: f64 = 1.6;
const MOST: usize = 12;

/// Ratio of the halves of an interval above which no standard deviation describes it.
const SYMMETRIC: f64 = 1.5;

/// A model with the knee held.
struct Held {
    knee: f64,
    cost: f64,
    size: f64,
    sigma: f64,
    at: Iterate,
}

/// Puts the intervals of an effect with a knee into its parameters, whose values are in units of the plant. A standard
/// deviation stays where the interval is nearly symmetric. Parameters of other effects stay as they are, and so do
/// those of an effect that the model does not have or that is nowhere excluded.
///
/// # Errors
/// Those of a pass over the record.
pub(crate) fn profile(
    fitted: &FittedPlant,
    entry: Option<&EffectEntry>,
    parameters: &mut [Parameter],
) -> Result<(), PlantError> {
    let description = &fitted.loaded().description;
    let Some(knee) = entry.and_then(|entry| description.knee_of(entry)) else {
        return Ok(());
    };
    let Some(Unknowns { size, place }) = unknowns(fitted, knee) else {
        return Ok(());
    };
    let limit = LIMIT * fitted.inflation()?;
    let values = fitted.values();
    let own = fitted.covariance()[(place, place)].sqrt().min(knee.sigma);
    let best = Held {
        knee: values[place],
        cost: fitted.cost(),
        size: values[size],
        sigma: 0.0,
        at: fitted.solution.at.clone(),
    };
    let sides = [-1.0, 1.0].map(|sign| side(fitted, knee, (&best, limit), sign * FIRST * own));
    let mut all = vec![&best];
    all.extend(sides.iter().flatten());
    let least = all.iter().map(|one| one.cost).fold(f64::INFINITY, f64::min);
    let knees = sides
        .each_ref()
        .map(|side| side.last().unwrap_or(&best).knee);
    let mut sizes = [best.size; 2];
    for one in all {
        let reach = (limit - (one.cost - least)).max(0.0).sqrt() * one.sigma;
        sizes = [
            sizes[0].min(one.size - reach),
            sizes[1].max(one.size + reach),
        ];
    }
    for own in parameters.iter_mut() {
        let (declared, [low, high], estimate) = match own.name.as_str() {
            KNEE => (knee.value, knees, best.knee),
            _ => (0.0, sizes, best.size),
        };
        let halves = [estimate - low, high - estimate];
        let ratio = f64::max(halves[0] / halves[1], halves[1] / halves[0]);
        own.interval = Some(vec![[declared + low, declared + high]]);
        own.sigma = (ratio < SYMMETRIC)
            .then_some((high - low) / (2.0 * NORMAL_95 * (limit / LIMIT).sqrt()));
    }
    Ok(())
}

/// Models with the knee farther and farther off, the last where the deviance is the limit.
fn side(fitted: &FittedPlant, knee: &Knee, (best, limit): (&Held, f64), first: f64) -> Vec<Held> {
    let limit = limit.sqrt();
    let root = |of: &Held| (of.cost - best.cost).max(0.0).sqrt();
    let mut held: Vec<Held> = Vec::new();
    let mut distance = first;
    while held.len() < MOST {
        let last = held.last().unwrap_or(best);
        let Some(next) = held_at(fitted, knee, best.knee + distance, &last.at) else {
            break;
        };
        let [before, beyond] = [last, &next].map(root);
        if beyond > limit {
            // Near its least a deviance is a square.
            let share = (limit - before) / (beyond - before);
            let end = last.knee + share * (next.knee - last.knee);
            held.extend(held_at(fitted, knee, end, &last.at));
            break;
        }
        held.push(next);
        distance *= GROWTH;
    }
    held
}

/// The places of size and knee among the unknowns of a model.
struct Unknowns {
    size: usize,
    place: usize,
}

fn unknowns(fitted: &FittedPlant, knee: &Knee) -> Option<Unknowns> {
    let states = fitted.loaded().description.states.len();
    let own = &fitted.extension().parameters;
    let of = |constant: usize| {
        let own = own.iter().position(|(own, _)| *own == states + constant)?;
        Some(fitted.problem.nominal() + own)
    };
    Some(Unknowns {
        size: of(knee.size)?,
        place: of(knee.constant)?,
    })
}

/// The model with the knee held at a difference from where it is declared; `None` where it has no fit.
fn held_at(fitted: &FittedPlant, knee: &Knee, value: f64, start: &Iterate) -> Option<Held> {
    let Unknowns { size, place } = unknowns(fitted, knee)?;
    let states = fitted.loaded().description.states.len();
    let mut extension = fitted.extension().clone();
    extension
        .parameters
        .retain(|(own, _)| *own != states + knee.constant);
    let mut solver = Solver::new(&fitted.problem, &extension, fitted.noise.clone());
    solver.base.constant[knee.constant] += value;
    let mut start = start.clone();
    if start.values.len() > solver.lines.len() {
        start.values.remove(place);
    }
    let solution = solver.solve(start).ok()?;
    let size = size - usize::from(size > place);
    Some(Held {
        knee: value,
        cost: solution.cost + (value / knee.sigma).powi(2),
        size: solution.at.values[size],
        sigma: solution.covariance[(size, size)].sqrt(),
        at: solution.at,
    })
}
