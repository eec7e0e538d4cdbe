//! Which causes go into the extended model: those without which blocks of the record are
//! predicted worse.

use gyrocal_calibration::{CalibrationError, FittedPlatform};
use gyrocal_hypothesis::Searched;

use super::score::{BLOCKS, block_log_scores};

/// What cross-validation says of a cause.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Acceptance {
    /// By how much blocks of the record are predicted better with the cause in the model than
    /// without it, beside the other causes, nats.
    pub(crate) gain_nats: f64,
    /// Whether the cause is in the extended model: whether that is more than nothing.
    pub(crate) accepted: bool,
}

/// A model with all causes that gain, and what became of each.
pub(crate) struct Judged<'a> {
    /// The extended model; `None` if no cause gains.
    pub(crate) extended: Option<FittedPlatform<'a>>,
    /// Log scores of the blocks with the nominal model, and with the extended one or, if no cause
    /// gains, with all causes; `None` without causes.
    pub(crate) scores: Option<[[f64; BLOCKS]; 2]>,
    /// In the order of the findings.
    pub(crate) acceptances: Vec<Acceptance>,
}

/// Takes causes without gain out of the model, the least useful first, with a full fit after
/// each.
pub(crate) fn judge<'a>(
    nominal: &FittedPlatform<'a>,
    searched: &Searched<FittedPlatform<'a>>,
) -> Result<Judged<'a>, CalibrationError> {
    let count = searched.findings.len();
    let fit = |kept: &[bool]| {
        if kept.iter().all(|kept| *kept) {
            return Ok(searched.fitted.clone());
        }
        searched.fitted.refitted(&searched.extension_with(kept))
    };
    if count == 0 {
        return Ok(Judged {
            extended: None,
            scores: None,
            acceptances: Vec::new(),
        });
    }
    let before = block_log_scores(nominal)?;
    let mut told: Vec<(Vec<bool>, [f64; BLOCKS])> = Vec::new();
    if searched.unmodelled.is_empty() {
        told.push((vec![false; count], before));
    }
    let acceptances = sieve(count, |kept| {
        let known = told.iter().find(|(other, _)| other == kept);
        let scores = match known {
            Some((_, scores)) => *scores,
            // What cannot be fitted without a cause is held against the nominal model.
            None => match fit(kept) {
                Ok(fit) => block_log_scores(&fit)?,
                Err(_) => before,
            },
        };
        if known.is_none() {
            told.push((kept.to_vec(), scores));
        }
        Ok::<f64, CalibrationError>(scores.iter().sum())
    })?;
    let mut kept: Vec<bool> = acceptances.iter().map(|a| a.accepted).collect();
    let extended = if kept.contains(&true) {
        Some(fit(&kept)?)
    } else {
        kept.fill(true);
        None
    };
    let told = told.into_iter().find(|(other, _)| *other == kept);
    Ok(Judged {
        extended,
        scores: told.map(|(_, after)| [before, after]),
        acceptances,
    })
}

/// Leaves out causes without which the score is as high, the least useful first.
fn sieve<E>(
    count: usize,
    mut score: impl FnMut(&[bool]) -> Result<f64, E>,
) -> Result<Vec<Acceptance>, E> {
    let mut kept = vec![true; count];
    let mut gains = vec![0.0; count];
    while kept.contains(&true) {
        let with_all = score(&kept)?;
        let mut least: Option<usize> = None;
        for index in (0..count).filter(|index| kept[*index]) {
            let mut others = kept.clone();
            others[index] = false;
            gains[index] = with_all - score(&others)?;
            if least.is_none_or(|least| gains[index] < gains[least]) {
                least = Some(index);
            }
        }
        match least {
            Some(least) if gains[least] <= 0.0 => kept[least] = false,
            _ => break,
        }
    }
    Ok(gains
        .into_iter()
        .zip(kept)
        .map(|(gain_nats, accepted)| Acceptance {
            gain_nats,
            accepted,
        })
        .collect())
}

#[cfg(test)]
mod tests {
    use core::convert::Infallible;

    use super::{Acceptance, sieve};

    fn sieved(count: usize, score: impl Fn(&[bool]) -> f64) -> Vec<(f64, bool)> {
        let found = sieve(count, |kept| Ok::<f64, Infallible>(score(kept)));
        let found: Vec<Acceptance> = found.unwrap_or_default();
        found.iter().map(|a| (a.gain_nats, a.accepted)).collect()
    }

    #[test]
    fn what_gains_nothing_is_left_out_and_told() {
        let worth = [5.0, -1.0, 0.0];
        let sum = |kept: &[bool]| -> f64 {
            kept.iter()
                .zip(worth)
                .map(|(kept, w)| if *kept { w } else { 0.0 })
                .sum()
        };
        assert_eq!(sieved(3, sum), [(5.0, true), (-1.0, false), (0.0, false)]);
        assert_eq!(sieved(0, sum), []);
    }

    #[test]
    fn of_two_that_do_the_same_one_stays() {
        let either = |kept: &[bool]| f64::from(u8::from(kept.contains(&true)));
        assert_eq!(sieved(2, either), [(0.0, false), (1.0, true)]);
    }
}
