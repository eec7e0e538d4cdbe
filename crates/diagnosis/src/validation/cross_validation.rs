//! Selection of the causes of the extended model by blocked cross-validation.

use gyrocal::EFFECTS;
use gyrocal::effect::EffectKind;
use gyrocal_calibration::{CalibrationError, FittedPlatform, work};
use gyrocal_hypothesis::Searched;

use super::block_scores::{block_log_scores, forward_log_scores};
use gyrocal_answer::Prediction;

/// Work of the elimination over that of one pass over the record with all signatures, beyond which no further
/// model is scored. That of one cause beside walks takes eight passes in the mean.
const PASSES: u64 = 10;

/// Decision of the cross-validation on one cause.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct KeepDecision {
    /// Predictive log score of the blocks with the cause less that without it, the other causes in
    /// the model, nats; `None` if the work for it was too much.
    pub(crate) gain_nats: Option<f64>,
    /// Whether the cause is in the extended model: whether the gain is positive, or not judged.
    pub(crate) accepted: bool,
}

/// The extended model with the decision on each cause.
pub(crate) struct CrossValidated<'a> {
    /// The extended model; `None` if no cause gains.
    pub(crate) extended: Option<FittedPlatform<'a>>,
    /// Log scores of the blocks with the nominal model, and with the extended one or, if no cause
    /// gains, with all causes; `None` without causes.
    pub(crate) scores: Option<[Vec<f64>; 2]>,
    /// Rows that the scores predict a block from.
    pub(crate) prediction: Prediction,
    /// In the order of the findings.
    pub(crate) decisions: Vec<KeepDecision>,
}

/// Backward elimination: removes causes without gain, the least useful first, with a full fit after
/// each. Random walks are noise and stay; the gain is then that of forward prediction, and an effect
/// whose set has a walk stays too.
pub(crate) fn cross_validate<'a>(
    nominal: &FittedPlatform<'a>,
    searched: &Searched<FittedPlatform<'a>>,
) -> Result<CrossValidated<'a>, CalibrationError> {
    let findings = &searched.findings;
    let count = findings
        .iter()
        .filter(|found| !is_walk(found.effect))
        .count();
    let walks = findings.len() - count;
    if findings.is_empty() {
        return Ok(CrossValidated {
            extended: None,
            scores: None,
            prediction: Prediction::default(),
            decisions: Vec::new(),
        });
    }
    let fit = |kept: &[bool]| {
        if kept.iter().all(|kept| *kept) {
            return Ok(searched.fitted.clone());
        }
        searched.fitted.refitted(&searched.extension_with(kept))
    };
    let (prediction, log_scores) = scoring(walks > 0);
    let end = work().saturating_add(PASSES.saturating_mul(searched.pass_work));
    let is_spent = || searched.pass_work > 0 && work() > end;
    let before = log_scores(nominal)?;
    let mut scored: Vec<(Vec<bool>, Vec<f64>)> = Vec::new();
    if searched.unmodelled.is_empty() && walks == 0 {
        scored.push((vec![false; count], before.clone()));
    }
    let stays: Vec<bool> = findings[..count]
        .iter()
        .map(|found| found.alternatives.iter().any(|other| is_walk(other.effect)))
        .collect();
    let mut decisions = backward_elimination(&stays, is_spent, |kept| {
        let known = scored.iter().find(|(other, _)| other == kept);
        let scores = match known {
            Some((_, scores)) => scores.clone(),
            // A model that cannot be fitted has the score of the nominal one.
            None => match fit(kept) {
                Ok(fit) => log_scores(&fit)?,
                Err(_) => before.clone(),
            },
        };
        if known.is_none() {
            scored.push((kept.to_vec(), scores.clone()));
        }
        Ok::<f64, CalibrationError>(scores.iter().sum())
    })?;
    let mut kept: Vec<bool> = decisions.iter().map(|a| a.accepted).collect();
    let extended = if walks > 0 || kept.contains(&true) {
        Some(fit(&kept)?)
    } else {
        kept.fill(true);
        None
    };
    let after = match scored.into_iter().find(|(other, _)| *other == kept) {
        Some((_, after)) => Some(after),
        None => extended.as_ref().map(log_scores).transpose()?,
    };
    if let Some(extended) = extended.as_ref().filter(|_| walks > 0) {
        let with: f64 = after.as_ref().map_or(0.0, |after| after.iter().sum());
        let decision = KeepDecision {
            gain_nats: match is_spent() {
                true => None,
                false => Some(with - score_without_walks(extended)?),
            },
            accepted: true,
        };
        decisions.resize(findings.len(), decision);
    }
    Ok(CrossValidated {
        extended,
        scores: after.map(|after| [before, after]),
        prediction,
        decisions,
    })
}

/// A log score of the blocks of a fit.
type LogScores = fn(&FittedPlatform<'_>) -> Result<Vec<f64>, CalibrationError>;

/// The log score with or without walks in the model, and the rows that it predicts a block from.
fn scoring(has_walks: bool) -> (Prediction, LogScores) {
    if has_walks {
        (Prediction::Forward, forward_log_scores)
    } else {
        (Prediction::CrossValidated, block_log_scores)
    }
}

fn is_walk(effect: &str) -> bool {
    let mut effects = EFFECTS.iter();
    effects.any(|row| row.id == effect && row.kind == EffectKind::RandomWalk)
}

/// Score in forward prediction of a model with the best noise without walks in the place of its own.
fn score_without_walks(fit: &FittedPlatform<'_>) -> Result<f64, CalibrationError> {
    let white = fit.fit_rate_noise(&[], &[])?.noise;
    let without = fit.with_rate_noise(&white)?;
    Ok(forward_log_scores(&without)?.iter().sum())
}

/// Removes causes without which the score is as high, the least useful first; not those that `stay`. Nothing
/// more is judged once the work is spent.
fn backward_elimination<E>(
    stays: &[bool],
    is_spent: impl Fn() -> bool,
    mut score: impl FnMut(&[bool]) -> Result<f64, E>,
) -> Result<Vec<KeepDecision>, E> {
    let count = stays.len();
    let mut kept = vec![true; count];
    let mut gains = vec![None; count];
    while kept.contains(&true) {
        let with_all = score(&kept)?;
        let mut least: Option<(usize, f64)> = None;
        for index in (0..count).filter(|index| kept[*index]) {
            if is_spent() {
                least = None;
                break;
            }
            let mut others = kept.clone();
            others[index] = false;
            let gain = with_all - score(&others)?;
            gains[index] = Some(gain);
            if stays[index] {
                continue;
            }
            if least.is_none_or(|(_, least)| gain < least) {
                least = Some((index, gain));
            }
        }
        match least {
            Some((least, gain)) if gain <= 0.0 => kept[least] = false,
            _ => break,
        }
    }
    Ok(gains
        .into_iter()
        .zip(kept)
        .map(|(gain_nats, accepted)| KeepDecision {
            gain_nats,
            accepted,
        })
        .collect())
}

#[cfg(test)]
mod tests {
    use core::cell::Cell;
    use core::convert::Infallible;

    use super::{KeepDecision, backward_elimination};

    fn eliminated_within(
        models: usize,
        count: usize,
        score: impl Fn(&[bool]) -> f64,
    ) -> Vec<(Option<f64>, bool)> {
        let scored = Cell::new(0);
        let is_spent = || scored.get() >= models;
        let found = backward_elimination(&vec![false; count], is_spent, |kept| {
            scored.set(scored.get() + 1);
            Ok::<f64, Infallible>(score(kept))
        });
        let found: Vec<KeepDecision> = found.unwrap_or_default();
        found.iter().map(|a| (a.gain_nats, a.accepted)).collect()
    }

    fn eliminated(count: usize, score: impl Fn(&[bool]) -> f64) -> Vec<(f64, bool)> {
        let found = eliminated_within(usize::MAX, count, score).into_iter();
        found
            .map(|(gain, accepted)| (gain.unwrap_or(f64::NAN), accepted))
            .collect()
    }

    #[test]
    fn what_is_not_judged_stays() {
        let without_gain = |_: &[bool]| 1.0;
        let [first, second] = [(Some(0.0), true), (None, true)];
        assert_eq!(eliminated_within(2, 2, without_gain), [first, second]);
    }

    #[test]
    fn a_cause_without_gain_is_removed_and_reported() {
        let worth = [5.0, -1.0, 0.0];
        let sum = |kept: &[bool]| -> f64 {
            kept.iter()
                .zip(worth)
                .map(|(kept, w)| if *kept { w } else { 0.0 })
                .sum()
        };
        assert_eq!(
            eliminated(3, sum),
            [(5.0, true), (-1.0, false), (0.0, false)]
        );
        assert_eq!(eliminated(0, sum), []);
    }

    #[test]
    fn of_two_equal_causes_one_stays() {
        let either = |kept: &[bool]| f64::from(u8::from(kept.contains(&true)));
        assert_eq!(eliminated(2, either), [(0.0, false), (1.0, true)]);
    }
}
