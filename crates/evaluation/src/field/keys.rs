//! Clean records whose bench file, or one column, is wrong in one number.

use gyrocal_calibration::{FittedPlatform, NoiseModel, Options, Run};
use gyrocal_record::{Bench, Gravity, Record};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Scenario, Temperature, simulate};
use serde::Deserialize;
use toml::Value;

use super::records::{SIGNS, clean};
use super::right::Table;
use crate::error::EvaluationError;

/// A key of a bench file, or a column of a record, with wrong numbers.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WrongKey {
    /// Table and key of the bench file, or the name of a column, which has no dot.
    pub(super) key: String,
    /// How the number is wrong.
    change: Change,
    /// By how much, in the unit of the key: each is a wrong key of its own, in [`WrongKey::all`] the only one.
    amounts: Vec<f64>,
    /// Name of the right answer.
    pub(super) right: String,
}

/// How a number is wrong. All numbers of a list are, if no place is given.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Change {
    /// It is more or less by the amount, with equal probability.
    Add,
    /// The same of the number at a place of a list, counted from 0.
    AddTo(usize),
    /// It is so many times as large.
    Times,
    /// It is the amount, given before or not.
    Set,
}
use Change::{Add, AddTo, Set, Times};

/// Keys without a row, with the reason.
#[cfg(test)]
pub(super) const EXEMPT: &[(&str, &str)] = &[
    ("gimbal_limits_deg.x", GIMBALS),
    ("gimbal_limits_deg.y", GIMBALS),
    ("gimbal_limits_deg.z", GIMBALS),
];
#[cfg(test)]
const GIMBALS: &str = "read by the design of experiments and by no diagnosis";

/// A record and its bench description, or the refusal of its reader.
type WithBench = (Record, Result<Bench, String>);

impl WrongKey {
    /// Those of a table, each with one amount.
    pub(super) fn all(table: &Table) -> Vec<Self> {
        let of = |row: &Self| {
            let row = row.clone();
            let amounts = row.amounts.clone().into_iter();
            amounts.map(move |amount| Self {
                amounts: vec![amount],
                ..row.clone()
            })
        };
        table.key.iter().flat_map(of).collect()
    }

    fn amount(&self) -> f64 {
        self.amounts.first().copied().unwrap_or(f64::NAN)
    }

    /// Key and change.
    pub(super) fn name(&self) -> String {
        let (key, amount) = (&self.key, self.amount());
        match self.change {
            Add => format!("{key} +- {amount}"),
            AddTo(place) => format!("{key}[{place}] +- {amount}"),
            Times => format!("{key} x {amount}"),
            Set => format!("{key} = {amount}"),
        }
    }

    /// The record of a seed with its bench description, and both with the wrong number.
    ///
    /// # Errors
    /// [`EvaluationError::Simulation`].
    pub(super) fn record(&self, seed: u64) -> Result<[WithBench; 2], EvaluationError> {
        let simulation = simulate(&Scenario {
            gravity: Some(Gravity {
                local_m_per_s2: 9.812,
                unit_m_per_s2: 9.806_65,
            }),
            magnetic_field_gauss: Some([0.02, 0.2, -0.4]),
            temperature: Some(Temperature::default()),
            ..clean(seed, 0)
        })?;
        let right = (simulation.record, Ok(simulation.bench));
        let mut wrong = right.clone();
        let by = self.amount() * Draw::new(seed, SIGNS).sign();
        let change = |place: usize, value: f64| match self.change {
            Add => value + by,
            AddTo(only) if place == only => value + by,
            AddTo(_) => value,
            Times => value * self.amount(),
            Set => self.amount(),
        };
        let (record, bench) = (&mut wrong.0, wrong.1);
        let all = |values: &mut Vec<f64>| values.iter_mut().for_each(|one| *one = change(0, *one));
        wrong.1 = match &*self.key {
            "time_s" => bench.inspect(|_| all(&mut record.time_s)),
            "temperature_c" => bench.inspect(|_| record.temperature_c.iter_mut().for_each(all)),
            key => bench.and_then(|bench| edited(&bench, key, change)),
        };
        Ok([right, wrong])
    }
}

/// The bench description of the edited file, or the words of its reader.
fn edited(bench: &Bench, key: &str, change: impl Fn(usize, f64) -> f64) -> Result<Bench, String> {
    let words = |error: gyrocal_record::Error| error.to_string();
    let text = bench.to_toml("bench.toml".as_ref()).map_err(words)?;
    let parsed = text.parse::<toml::Table>();
    let mut file = parsed.map_err(|error| error.to_string())?;
    let (table, key) = key.split_once('.').unwrap_or(("", key));
    let empty = Value::Table(toml::Table::new());
    let table = file.entry(table).or_insert(empty);
    let table = table.as_table_mut().ok_or("no table")?;
    match table.entry(key).or_insert(Value::Float(0.0)) {
        Value::Array(numbers) => {
            for (place, one) in numbers.iter_mut().enumerate() {
                *one = Value::Float(change(place, one.as_float().ok_or("no number")?));
            }
        }
        one => *one = Value::Float(change(0, one.as_float().ok_or("no number")?)),
    }
    Bench::parse(&file.to_string(), "bench.toml").map_err(words)
}

/// Root of twice the log-likelihood that the wrong number costs; `None` if no fit converges with it, and of a
/// bench file that is refused.
pub(super) fn strength([right, wrong]: &[WithBench; 2]) -> Result<Option<f64>, EvaluationError> {
    let of = |(record, bench): &WithBench| {
        let bench = bench.as_ref().ok()?;
        let run = Run { record, bench };
        let fit = FittedPlatform::nominal(&run, &Options::default(), &NoiseModel::default());
        Some(fit.and_then(|fit| fit.log_evidence_without(0..0)))
    };
    let right = of(right).transpose()?.unwrap_or(f64::INFINITY);
    let wrong = of(wrong).and_then(Result::ok);
    Ok(wrong.map(|wrong| (2.0 * (right - wrong)).max(0.0).sqrt()))
}
