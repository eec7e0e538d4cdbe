//! Records that a user could have and the simulator does not make, each with the answer that is right for it.
//!
//! A [`FieldPopulation`] is a family of records: clean ones with one wrong number in the bench file or in a
//! column ([`WrongKey`]), or those of one [`FieldKind`]; a [`PlantKind`] has records of a servo. [`FieldPopulation::run`] makes the record of a seed,
//! diagnoses it and judges the answer by a [`Right`]; a [`FieldRow`] counts the judgements.

mod injected;
mod judge;
mod keys;
mod kinds;
mod plants;
mod records;
mod right;

use gyrocal_calibration::{Options, Run};
use gyrocal_diagnosis::{
    DiagnoseOptions, DiagnosisError, DiagnosisResult, Gate, RecordToDiagnose, diagnose,
    diagnose_together,
};
use gyrocal_record::{Bench, Record};
use gyrocal_setup::PlatformKind;
use serde::{Deserialize, Serialize};

use crate::error::EvaluationError;
pub use judge::{Answer, Judgement};
use judge::{Told, judge};
pub use keys::{Change, EXEMPT, WrongKey};
pub use kinds::FieldKind;
pub use plants::PlantKind;
pub use right::{Right, Silent, VISIBLE};

/// First seeds of wrong keys and of kinds, and the distance of populations: all below a billion, where the seeds of
/// reports begin.
const KEYS: u64 = 100_000_000;
const KINDS: u64 = 400_000_000;
const APART: u64 = 1_000_000;

/// A family of records.
#[derive(Clone, Copy, Debug)]
pub struct FieldPopulation {
    /// The first of its seeds: no other population has one of the million that begins here.
    pub first_seed: u64,
    /// The answer that is right for its records.
    pub right: &'static Right,
    records: Records,
}

#[derive(Clone, Copy, Debug)]
enum Records {
    WrongKey(WrongKey),
    Kind(&'static FieldKind),
}

/// The judged diagnosis of one record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FieldOutcome {
    /// The judgement.
    pub judgement: Judgement,
    /// The answer in short.
    pub answer: Answer,
    /// False names, those beside the answer among them.
    pub beside: Vec<String>,
    /// Strength of a wrong number: the root of twice the log-likelihood that it costs. `None` where no fit
    /// converges with it, and of kinds.
    pub strength: Option<f64>,
}

/// Counts of one population: a row of the table.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FieldRow {
    /// Name of the population.
    pub name: String,
    /// The right answer in words.
    pub right_answer: String,
    /// Number of records.
    pub records: u64,
    /// Number of records in which the wrong number shows less than [`VISIBLE`].
    pub faint: u64,
    /// Number of records that are judged [`Judgement::Right`].
    pub right: u64,
    /// The same of [`Judgement::NotSettled`].
    pub not_settled: u64,
    /// The same of [`Judgement::Wrong`].
    pub wrong: u64,
    /// The same of [`Judgement::PhysicalAlone`].
    pub physical_alone: u64,
}

impl FieldPopulation {
    /// All populations.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let keys = (0..).zip(WrongKey::all()).map(|(place, key)| Self {
            first_seed: KEYS + APART * place,
            right: key.right,
            records: Records::WrongKey(key),
        });
        let kinds = (0..).zip(FieldKind::ALL).map(|(place, kind)| Self {
            first_seed: KINDS + APART * place,
            right: kind.right,
            records: Records::Kind(kind),
        });
        keys.chain(kinds).collect()
    }

    /// Its name, which no other has.
    #[must_use]
    pub fn name(&self) -> String {
        match self.records {
            Records::WrongKey(key) => key.name(),
            Records::Kind(kind) => kind.name.to_owned(),
        }
    }

    /// Makes the record of a seed, diagnoses it and judges the answer. A diagnosis that fails is an outcome.
    ///
    /// # Errors
    /// [`EvaluationError`] if the record cannot be made.
    pub fn run(&self, seed: u64) -> Result<FieldOutcome, EvaluationError> {
        match self.records {
            Records::WrongKey(key) => {
                let both = key.record(seed)?;
                let strength = keys::strength(&both)?;
                let [_, (record, bench)] = both;
                let told = match bench {
                    Ok(bench) => told(&[(record, bench)]),
                    Err(_) => Told::set_up(right::BENCH),
                };
                let is_faint = strength.is_some_and(|strength| strength < VISIBLE);
                Ok(FieldOutcome {
                    strength,
                    ..judge(key.right, None, is_faint, &told)
                })
            }
            Records::Kind(kind) => {
                let made = (kind.make)(seed)?;
                Ok(judge(kind.right, made.axis, false, &told(&made.records)))
            }
        }
    }

    /// Counts outcomes of its records.
    pub fn row<'a>(&self, outcomes: impl IntoIterator<Item = &'a FieldOutcome>) -> FieldRow {
        FieldRow::of(self.name(), self.right, outcomes)
    }
}

impl FieldRow {
    /// Counts outcomes of records of a name.
    pub fn of<'a>(
        name: String,
        right: &Right,
        outcomes: impl IntoIterator<Item = &'a FieldOutcome>,
    ) -> Self {
        let mut row = Self {
            name,
            right_answer: right.words(),
            ..Self::default()
        };
        for outcome in outcomes {
            row.records += 1;
            row.faint += u64::from(outcome.strength.is_some_and(|strength| strength < VISIBLE));
            *match outcome.judgement {
                Judgement::Right => &mut row.right,
                Judgement::NotSettled => &mut row.not_settled,
                Judgement::Wrong => &mut row.wrong,
                Judgement::PhysicalAlone => &mut row.physical_alone,
            } += 1;
        }
        row
    }
}

/// The diagnosis of a record, or of several together.
fn told(records: &[(Record, Bench)]) -> Told {
    let options = DiagnoseOptions::default();
    let of = |found: Result<DiagnosisResult, DiagnosisError>| Told::of(found.as_ref());
    if let [(record, bench)] = records {
        return of(diagnose(record, bench, &options).map(|found| found.result));
    }
    let gate = |record, bench| {
        let run = Run { record, bench };
        Gate::new(PlatformKind::Stabilised, &run, &Options::default())
    };
    let named = (1..)
        .zip(records)
        .map(|(number, (record, bench))| RecordToDiagnose {
            name: format!("record {number}"),
            gate: gate(record, bench),
            bench,
        });
    let together = diagnose_together(named.collect(), &options, |_| ());
    of(together.map(|found| found.result))
}

#[cfg(test)]
mod tests;
