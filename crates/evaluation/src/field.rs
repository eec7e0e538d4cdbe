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
use right::{Right, Table, VISIBLE};

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
    ///
    /// # Errors
    /// [`EvaluationError::RightAnswers`].
    pub fn wrong_keys() -> Result<Vec<Self>, EvaluationError> {
        let table = Table::read()?;
        let keys = WrongKey::all(&table).into_iter();
        let keys = keys.map(|key| (key.name(), key.right.clone(), key));
        Self::each(&table, KEYS, keys, |key, right, seed| {
            let both = key.record(seed)?;
            let strength = keys::strength(&both)?;
            let [_, (record, bench)] = both;
            let told = match bench {
                Ok(bench) => told(&[(record, bench)]),
                Err(_) => Told::set_up(right::BENCH),
            };
            let is_faint = strength.is_some_and(|strength| strength < VISIBLE);
            let (mut outcome, answer) = outcome(right, None, is_faint, told);
            outcome.strength = strength;
            Ok((outcome, answer))
        })
    }

    /// Kinds of records, from irregular rows to records of two platforms.
    ///
    /// # Errors
    /// [`EvaluationError::RightAnswers`].
    pub fn kinds() -> Result<Vec<Self>, EvaluationError> {
        let kinds = FieldKind::ALL.iter();
        let kinds = kinds.map(|kind| (kind.name, kind.right, kind));
        Self::each(&Table::read()?, KINDS, kinds, |kind, right, seed| {
            let made = (kind.make)(seed)?;
            Ok(outcome(right, made.axis, false, told(&made.records)))
        })
    }

    /// Records of few rows, with gaps and missing values, as declared or with a wrong number.
    #[must_use]
    pub fn short() -> Self {
        let seeds = (SHORT, SHORT_RECORDS);
        Self::new("2 to 400 rows", seeds, Right::nothing(), |right, seed| {
            let made = records::short(seed)?;
            Ok(outcome(right, None, false, told(&made.records)))
        })
    }
}

impl<'a> FieldPopulation<'a> {
    /// Kinds of records of the servo `examples/servo`, diagnosed with its plant.
    ///
    /// # Errors
    /// [`EvaluationError::RightAnswers`].
    pub fn plants(servo: &'a LoadedPlant) -> Result<Vec<Self>, EvaluationError> {
        let kinds = PlantKind::ALL.iter();
        let kinds = kinds.map(|kind| (kind.name, kind.right, kind));
        Self::each(&Table::read()?, PLANTS, kinds, |kind, right, seed| {
            let told = Told::of_plant(kind.diagnosed(servo, seed));
            Ok(outcome(right, None, false, told))
        })
    }

    /// A population of each kind with its name and that of its right answer; seeds begin at the first.
    fn each<T: AsRef<str>, K: Send + Sync + 'a>(
        table: &Table,
        first_seed: u64,
        kinds: impl Iterator<Item = (T, T, K)>,
        job: impl Fn(&K, &Right, u64) -> Result<Judged, EvaluationError> + Copy + Send + Sync + 'a,
    ) -> Result<Vec<Self>, EvaluationError> {
        let of = |((name, right, kind), place): ((T, T, K), u64)| {
            let seeds = (first_seed + APART * place, RECORDS);
            let right = table.right(right.as_ref())?;
            let job = move |right: &Right, seed| job(&kind, right, seed);
            Ok(Self::new(name.as_ref(), seeds, right, job))
        };
        kinds.zip(0..).map(of).collect()
    }

    /// A population of a first seed and a number of records that have one right answer, which the job gets.
    fn new(
        name: &str,
        (first_seed, records): (u64, u64),
        right: Right,
        job: impl Fn(&Right, u64) -> Result<Judged, EvaluationError> + Send + Sync + 'a,
    ) -> Self {
        Self {
            name: name.to_owned(),
            first_seed,
            records,
            right: right.words(),
            job: Box::new(move |seed| job(&right, seed)),
        }
    }
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
