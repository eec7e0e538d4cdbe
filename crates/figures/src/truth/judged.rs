//! What of a diagnosis is right.

use gyrocal::Effect;
use gyrocal::effect::EffectKind;
use gyrocal_answer::{Answer, Finding};
use gyrocal_evaluation::effect_of;
use gyrocal_record::AXES;
use gyrocal_statistics::{NORMAL_97_5, Proportion};
use gyrocal_truth::Simulation;

use crate::harness::Row;

/// This file, as a source of populations.
pub(super) const FILE: &str = file!();

/// Least coverage of the coefficients, all together, and why.
const COEFFICIENTS: f64 = 0.93;
const COEFFICIENTS_REASON: &str =
    "intervals of 95 %, two points for noise and causes that are not known";

/// Whether a set holds a random walk: of this gyro, or of any without one.
pub(super) fn may_walk(finding: &Finding, gyro: Option<usize>) -> bool {
    let mut set = finding.set().filter_map(effect_of);
    set.any(|of| of.kind == EffectKind::RandomWalk && (gyro.is_none() || of.rate() == gyro))
}

/// Causes without a random walk of their own gyro in the set; those that enter no gyro count without any walk in
/// the set.
pub(super) fn surely_not_walks(found: &Answer) -> impl Iterator<Item = &Finding> {
    let own = |cause: &Finding| effect_of(&cause.effect).and_then(Effect::rate);
    let causes = found.causes();
    causes.filter(move |cause| !may_walk(cause, own(cause)))
}

/// Whether one of the pieces of an interval holds a value.
pub(super) fn within(pieces: &[[f64; 2]], value: f64) -> bool {
    let mut pieces = pieces.iter();
    pieces.any(|[low, high]| (*low..=*high).contains(&value))
}

/// A coefficient against its true value.
pub(super) struct Stated {
    /// Whether its 95 % interval over the sets holds it, and that with what is named first.
    pub(super) covered: bool,
    pub(super) first: bool,
    /// Width of the former.
    pub(super) width: f64,
}

/// The nine coefficients, gyro by gyro; none without a fit.
pub(super) fn coefficients(found: &Answer, simulation: &Simulation) -> Vec<Stated> {
    let Some(of) = &found.coefficients else {
        return Vec::new();
    };
    let best = of.extended.as_ref().unwrap_or(&of.nominal).iter();
    let all = best.zip(simulation.truth.coefficients.named()).enumerate();
    let stated = all.map(|(index, (best, (_, truth, _)))| {
        let first = [-NORMAL_97_5, NORMAL_97_5].map(|z| best.estimate + z * best.sigma);
        let over_set = of.over_set.as_ref();
        let over_set = over_set.map_or(first, |all| all[index].interval);
        Stated {
            covered: within(&[over_set], truth),
            first: within(&[first], truth),
            width: over_set[1] - over_set[0],
        }
    });
    stated.collect()
}

/// Coverage of the coefficients: of all together, whose intervals err together within a record, and of each.
pub(super) fn coefficient_rows<R: 'static>(
    name: &str,
    of: fn(&R) -> &[bool],
) -> Vec<Row<'static, R>> {
    let share = move |one: &R| {
        let held = of(one);
        (!held.is_empty()).then(|| Proportion::of(held.iter().copied()).share())
    };
    let mut rows = vec![Row::mean(name, share).at_least(COEFFICIENTS, COEFFICIENTS_REASON)];
    for index in 0..9 {
        let (order, gyro) = (["F", "I", "II"][index % 3], AXES[index / 3]);
        let name = format!("{name}: D_{order} of gyro {gyro}");
        rows.push(Row::share(name, move |one| of(one).get(index).copied()));
    }
    rows
}
