//! Which causes go into the extended model: those without which blocks of the record are
//! predicted worse.

use gyrocal_calibration::{CalibrationError, Extended};
use gyrocal_record::Record;

use super::score::block_log_scores;
use crate::cause::Searched;

/// What cross-validation says of a cause.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Acceptance {
    /// By how much blocks of the record are predicted better with the cause in the model than
    /// without it, beside the other causes, nats.
    pub gain_nats: f64,
    /// Whether the cause is in the extended model: whether that is more than nothing.
    pub accepted: bool,
}

/// A model with all causes that gain, and what became of each.
pub(crate) struct Judged<'a> {
    /// The extended model; `None` if no cause gains.
    pub(crate) extended: Option<Extended<'a>>,
    /// In the order of the findings.
    pub(crate) acceptances: Vec<Acceptance>,
}

/// Takes causes without gain out of the model, the least useful first, with a full fit after
/// each.
pub(crate) fn judge<'a>(
    nominal: &Extended<'a>,
    searched: &Searched<'a>,
    record: &Record,
) -> Result<Judged<'a>, CalibrationError> {
    let total = |fit: &Extended<'_>| block_log_scores(fit).map(|scores| scores.iter().sum::<f64>());
    let mut kept = vec![true; searched.findings.len()];
    let mut gains = vec![0.0; kept.len()];
    let mut model = searched.fitted.clone();
    let nominal_score = total(nominal)?;
    while kept.contains(&true) {
        let score = total(&model)?;
        let mut least: Option<(usize, f64, Option<Extended<'a>>)> = None;
        for index in (0..kept.len()).filter(|index| kept[*index]) {
            let others: Vec<bool> = (0..kept.len()).map(|i| kept[i] && i != index).collect();
            // What cannot be fitted without a cause is held against the nominal model.
            let without = model
                .refitted(&searched.extension_with(record, &others))
                .ok();
            let other = match &without {
                Some(fit) => total(fit)?,
                None => nominal_score,
            };
            gains[index] = score - other;
            if least
                .as_ref()
                .is_none_or(|(_, smallest, _)| gains[index] < *smallest)
            {
                least = Some((index, gains[index], without));
            }
        }
        match least {
            Some((index, gain, without)) if gain <= 0.0 => {
                kept[index] = false;
                model = without.unwrap_or_else(|| nominal.clone());
            }
            _ => break,
        }
    }
    Ok(Judged {
        extended: kept.contains(&true).then_some(model),
        acceptances: gains
            .into_iter()
            .zip(kept)
            .map(|(gain_nats, accepted)| Acceptance {
                gain_nats,
                accepted,
            })
            .collect(),
    })
}
