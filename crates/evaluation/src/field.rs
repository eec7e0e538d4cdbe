//! Records that a user could have and the simulator does not make, each with the answer that is right for it.
//!
//! A [`FieldPopulation`] is a family of records: clean ones with one wrong number in the bench file or in a column
//! ([`FieldPopulation::wrong_keys`]), kinds of records ([`FieldPopulation::kinds`]), or kinds of records of a servo
//! ([`FieldPopulation::plants`]). Its job makes the record of a seed, diagnoses it and judges the answer: the
//! right ones are data.

mod injected;
mod judge;
mod keys;
mod kinds;
mod plants;
mod records;
mod right;

use gyrocal_answer::Answer;
use gyrocal_calibration::Run;
use gyrocal_diagnosis::{
    DiagnoseOptions, Diagnosis, DiagnosisError, Gate, RecordToDiagnose, diagnose, diagnose_together,
};
use gyrocal_plant::LoadedPlant;
use gyrocal_record::{Bench, Record};
use gyrocal_setup::PlatformKind;
use serde::{Deserialize, Serialize};

use crate::error::EvaluationError;
pub use judge::Judgement;
use judge::{Told, judge};
use keys::WrongKey;
use kinds::FieldKind;
use plants::PlantKind;
use right::{Right, VISIBLE};

/// First seeds of wrong keys, of kinds and of plants, and the distance of populations: all below a billion, where the
/// seeds of reports begin.
const KEYS: u64 = 100_000_000;
const KINDS: u64 = 400_000_000;
const PLANTS: u64 = 500_000_000;
const SHORT: u64 = 600_000_000;
const APART: u64 = 1_000_000;

/// Records of a population, and of the one of short records.
const RECORDS: u64 = 20;
const SHORT_RECORDS: u64 = 2_600;

/// A family of records.
pub struct FieldPopulation<'a> {
    /// Its name, which no other has.
    pub name: String,
    /// The first of its seeds: no other population has one of the million that begins here.
    pub first_seed: u64,
    /// Number of its records.
    pub records: u64,
    /// The answer that is right for its records, in words.
    pub right: String,
    /// Makes the record of a seed, diagnoses it and judges the answer. A diagnosis that fails is an outcome; a record
    /// that cannot be made is an error.
    pub job: Job<'a>,
}

/// The outcome of a seed, and the whole answer; `None` if the diagnosis failed.
type Job<'a> = Box<dyn Fn(u64) -> Result<Judged, EvaluationError> + Send + Sync + 'a>;
type Judged = (FieldOutcome, Option<Answer>);

/// The judged diagnosis of one record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FieldOutcome {
    /// The judgement.
    pub judgement: Judgement,
    /// What was told: names of causes, of noise and of errors of the set-up, `unlisted`, or the error of the diagnosis.
    pub told: Vec<String>,
    /// Strength of a wrong number: the root of twice the log-likelihood that it costs. `None` where no fit
    /// converges with it, and of kinds.
    pub strength: Option<f64>,
}

impl FieldPopulation<'static> {
    /// Clean records with one wrong number in the bench file or in a column.
    #[must_use]
    pub fn wrong_keys() -> Vec<Self> {
        let of = |key: WrongKey, first_seed| Self {
            name: key.name(),
            first_seed,
            records: RECORDS,
            right: key.right.words(),
            job: Box::new(move |seed| {
                let both = key.record(seed)?;
                let strength = keys::strength(&both)?;
                let [_, (record, bench)] = both;
                let told = match bench {
                    Ok(bench) => told(&[(record, bench)]),
                    Err(_) => Told::set_up(right::BENCH),
                };
                let is_faint = strength.is_some_and(|strength| strength < VISIBLE);
                let (outcome, answer) = outcome(key.right, None, is_faint, told);
                Ok((
                    FieldOutcome {
                        strength,
                        ..outcome
                    },
                    answer,
                ))
            }),
        };
        let keys = WrongKey::all().into_iter().zip(seeds(KEYS));
        keys.map(|(key, first)| of(key, first)).collect()
    }

    /// Kinds of records, from irregular rows to records of two platforms.
    #[must_use]
    pub fn kinds() -> Vec<Self> {
        let of = |(kind, first_seed): (&'static FieldKind, u64)| Self {
            name: kind.name.to_owned(),
            first_seed,
            records: RECORDS,
            right: kind.right.words(),
            job: Box::new(|seed| {
                let made = (kind.make)(seed)?;
                Ok(outcome(kind.right, made.axis, false, told(&made.records)))
            }),
        };
        FieldKind::ALL.iter().zip(seeds(KINDS)).map(of).collect()
    }

    /// Records of few rows, with gaps and missing values, as declared or with a wrong number.
    #[must_use]
    pub fn short() -> Self {
        Self {
            name: "2 to 400 rows".to_owned(),
            first_seed: SHORT,
            records: SHORT_RECORDS,
            right: Right::NOTHING.words(),
            job: Box::new(|seed| {
                let made = records::short(seed)?;
                Ok(outcome(&Right::NOTHING, None, false, told(&made.records)))
            }),
        }
    }
}

impl<'a> FieldPopulation<'a> {
    /// Kinds of records of the servo `examples/servo`, diagnosed with its plant.
    #[must_use]
    pub fn plants(servo: &'a LoadedPlant) -> Vec<Self> {
        let of = |(kind, first_seed): (&'static PlantKind, u64)| Self {
            name: kind.name.to_owned(),
            first_seed,
            records: RECORDS,
            right: kind.right.words(),
            job: Box::new(|seed| {
                let told = Told::of_plant(kind.diagnosed(servo, seed));
                Ok(outcome(kind.right, None, false, told))
            }),
        };
        PlantKind::ALL.iter().zip(seeds(PLANTS)).map(of).collect()
    }
}

/// First seeds of populations.
fn seeds(first: u64) -> impl Iterator<Item = u64> {
    (0..).map(move |place| first + APART * place)
}

fn outcome(right: &Right, axis: Option<usize>, faint: bool, told: Told) -> Judged {
    let outcome = FieldOutcome {
        judgement: judge(right, axis, faint, &told),
        told: told.words(),
        strength: None,
    };
    (outcome, told.answer)
}

/// The diagnosis of a record, or of several together.
fn told(records: &[(Record, Bench)]) -> Told {
    if let [(record, bench)] = records {
        let found = diagnose(record, bench, &DiagnoseOptions::default());
        return Told::of(found.map(|found| found.result));
    }
    let runs = records.iter().map(|(record, bench)| Run { record, bench });
    let together = diagnosed_together(&runs.collect::<Vec<_>>());
    Told::of(together.map(|found| found.result))
}

/// The diagnosis of several runs of one platform together by default options.
///
/// # Errors
/// As [`diagnose_together`].
pub fn diagnosed_together(runs: &[Run<'_>]) -> Result<Diagnosis<'static>, DiagnosisError> {
    let options = DiagnoseOptions::default();
    let named = (1..).zip(runs).map(|(number, run)| RecordToDiagnose {
        name: format!("record {number}"),
        gate: Gate::new(PlatformKind::Stabilised, run, &options.calibration),
        bench: run.bench,
    });
    diagnose_together(named.collect(), &options, |_| ())
}

#[cfg(test)]
mod tests;
