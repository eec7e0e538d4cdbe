//! The search for causes: what it is asked, how far it is, and what it gives.

use gyrocal_calibration::{CalibrationError, Extended, Extension};
use gyrocal_record::{Bench, Record};

use super::family::{Plan, Unavailable, extend};
use super::finding::{Accepted, Finding, Stage};
use super::forward::{Tested, forward};
use super::null::Normals;
use super::score::Ranked;
use super::settle::settle;
use super::unnamed::Unnamed;

/// How causes are looked for.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchOptions {
    /// Probability that a record of the nominal model shows anything.
    pub false_alarm_probability: f64,
    /// Probability that such a record shows anything that has no name.
    pub unnamed_probability: f64,
    /// Effects beside those of the default search.
    pub also: Vec<String>,
    /// Seed of the draws that thresholds come from.
    pub seed: u64,
}

impl Default for SearchOptions {
    fn default() -> Self {
        Self {
            false_alarm_probability: 0.01,
            unnamed_probability: 0.001,
            also: Vec::new(),
            seed: 0,
        }
    }
}

/// More causes than this in one record mean that the catalogue does not hold the one there is.
pub(super) const MOST_EFFECTS: usize = 6;

/// What a search found.
pub struct Searched<'a> {
    /// The model with all that was found, at its best fit.
    pub fitted: Extended<'a>,
    /// The causes, strongest first.
    pub findings: Vec<Finding>,
    /// What no effect of the catalogue explains; it is in the model.
    pub unnamed: Vec<Unnamed>,
    /// All families in the first search, largest first.
    pub ranking: Vec<Ranked>,
    /// What their largest statistic must exceed.
    pub threshold: f64,
    /// What could not be looked for.
    pub unavailable: Vec<Unavailable>,
    base: Extension,
    plan: Plan,
    accepted: Vec<Accepted>,
}

impl Searched<'_> {
    /// The extension with what has no name and some of the findings: those that are `kept`.
    pub(crate) fn extension_with(&self, record: &Record, kept: &[bool]) -> Extension {
        let accepted = self.accepted.iter().zip(kept);
        let accepted: Vec<Accepted> = accepted
            .filter(|(_, kept)| **kept)
            .map(|(accepted, _)| accepted.clone())
            .collect();
        extension(&self.base, &self.plan, record, &accepted, &self.unnamed)
    }
}

/// Looks for causes in a record, from the nominal model at its best fit.
///
/// # Errors
/// As [`Extended::refitted`].
pub fn search<'a>(
    nominal: Extended<'a>,
    record: &Record,
    bench: &Bench,
    options: &SearchOptions,
) -> Result<Searched<'a>, CalibrationError> {
    let also: Vec<&str> = options.also.iter().map(String::as_str).collect();
    let task = Task {
        plan: Plan::new(record, bench, &also),
        base: nominal.extension().clone(),
        record,
        options,
    };
    let mut normals = Normals::new(options.seed);
    let state = State::new(Stage::new(nominal, &task.plan, record, &[])?);
    let (mut state, Tested { ranking, threshold }) = forward(&task, state, &mut normals)?;
    let findings = settle(&task, &mut state, threshold, &mut normals)?;
    Ok(Searched {
        fitted: state.stage.fitted,
        findings,
        unnamed: state.unnamed,
        ranking,
        threshold,
        unavailable: task.plan.unavailable.clone(),
        base: task.base,
        plan: task.plan,
        accepted: state.accepted,
    })
}

/// What is looked for, and where.
pub(super) struct Task<'t> {
    pub(super) plan: Plan,
    /// What the nominal model has beyond the nine coefficients.
    pub(super) base: Extension,
    pub(super) record: &'t Record,
    pub(super) options: &'t SearchOptions,
}

impl Task<'_> {
    /// The model with these effects, fitted from where another one is.
    pub(super) fn fitted<'a>(
        &self,
        from: &Extended<'a>,
        accepted: &[Accepted],
        unnamed: &[Unnamed],
    ) -> Result<Extended<'a>, CalibrationError> {
        from.refitted(&extension(
            &self.base,
            &self.plan,
            self.record,
            accepted,
            unnamed,
        ))
    }

    /// The same with all its signatures.
    pub(super) fn stage<'a>(
        &self,
        from: &Extended<'a>,
        accepted: &[Accepted],
        unnamed: &[Unnamed],
    ) -> Result<Stage<'a>, CalibrationError> {
        let fitted = self.fitted(from, accepted, unnamed)?;
        Stage::new(fitted, &self.plan, self.record, accepted)
    }
}

/// How far a search is.
#[derive(Clone)]
pub(super) struct State<'a> {
    pub(super) stage: Stage<'a>,
    pub(super) accepted: Vec<Accepted>,
    /// Families that cannot be fitted beside the accepted ones.
    pub(super) inseparable: Vec<usize>,
    pub(super) unnamed: Vec<Unnamed>,
    /// Whether what has no name is still looked for.
    pub(super) seeking: bool,
}

impl<'a> State<'a> {
    fn new(stage: Stage<'a>) -> Self {
        Self {
            stage,
            accepted: Vec::new(),
            inseparable: Vec::new(),
            unnamed: Vec::new(),
            seeking: true,
        }
    }
}

/// The model that all accepted effects make up.
fn extension(
    base: &Extension,
    plan: &Plan,
    record: &Record,
    accepted: &[Accepted],
    unnamed: &[Unnamed],
) -> Extension {
    let mut extension = base.clone();
    for found in unnamed {
        let columns = found.columns.iter().cloned();
        extension.further.extend(columns, f64::INFINITY);
    }
    for accepted in accepted {
        extend(
            plan,
            record,
            &mut extension,
            accepted.family,
            accepted.shape,
        );
    }
    extension
}
