//! Clean records whose bench file, or one column, is wrong in one number.

use gyrocal_calibration::{FittedPlatform, NoiseModel, Options, Run};
use gyrocal_record::{Bench, Gravity, Record};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Scenario, Temperature, simulate};
use toml::{Table, Value};

use super::records::{SIGNS, clean};
use super::right::{BENCH, Right, Silent};
use crate::error::EvaluationError;

/// A key of a bench file, or a column of a record, with a wrong number.
pub(super) struct WrongKey {
    /// Table and key of the bench file, or the name of a column, which has no dot.
    pub(super) key: &'static str,
    /// How the number is wrong.
    pub(super) change: Change,
    /// By how much, in the unit of the key.
    pub(super) amount: f64,
    pub(super) right: &'static Right,
}

/// How a number is wrong. All numbers of a list are, if no place is given.
#[derive(Clone, Copy)]
pub(super) enum Change {
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

const SITE: Right = Right::told(&[&["latitude", "clock", "site.latitude"]]).silent(Silent::Faint);
/// A latitude that is far off.
const FAR: Right = Right::told(&[&["latitude", "handedness", "axes"]]);
const ATTITUDE: Right =
    Right::told(&[&["attitude", "angles", "platform.initial_attitude"]]).silent(Silent::Faint);
const GRAVITY: Right = Right::told(&[&["gravity", "scale", "site.gravity", BENCH]])
    .near(&["accel_i.scale"])
    .silent(Silent::Faint);
const ACCEL: Right = Right::told(&[&["accel_i.noise"]])
    .beside(&["accel_i.noise"])
    .silent(Silent::Faint);
const GYRO: Right = Right::told(&[&["gyro_i.noise"]])
    .beside(&["gyro_i.noise"])
    .silent(Silent::Faint);
/// The coefficients are those of the record all the same.
const PRIOR: Right = Right::told(&[&["prior"]]).silent(Silent::Always);
const KELVIN: Right = Right::told(&[&["temperature"]]);
const NONE: Right = Right::NOTHING;

/// One row for each key, change and answer; the amounts are wrong keys each. New rows and amounts come last:
/// places are the seeds of the records.
#[rustfmt::skip]
const TABLE: &[(&str, Change, &[f64], &Right)] = &[
    ("site.latitude_deg", Add, &[0.005, 0.05, 0.5, 2.0, 5.0, 10.0, 20.0], &SITE),
    // The sign; radians.
    ("site.latitude_deg", Times, &[-1.0, 0.017_453_3], &FAR),
    ("site.latitude_sigma_deg", Set, &[1e-5, 0.01, 1.0], &NONE),
    ("site.earth_rate_relative_sigma", Set, &[1e-9, 1e-4], &NONE),
    ("site.gravity_relative_sigma", Set, &[1e-8, 1e-3], &NONE),
    ("site.local_gravity_m_per_s2", Times, &[1.000_01, 1.0001, 1.001, 0.999, 1.01], &GRAVITY),
    ("site.unit_gravity_m_per_s2", Times, &[1.000_01, 1.0003, 0.9975], &GRAVITY),
    ("site.magnetic_field_gauss", Times, &[-1.0, 2.0], &NONE),
    ("site.magnetic_field_gauss", AddTo(2), &[0.2], &NONE),
    ("platform.initial_angles_deg", AddTo(0), &[0.1, 0.3, 1.0, 3.0, 10.0], &ATTITUDE),
    ("platform.initial_angles_deg", AddTo(1), &[0.1, 1.0, 10.0], &ATTITUDE),
    ("platform.initial_angles_deg", AddTo(2), &[0.1, 0.3, 1.0, 3.0, 10.0], &ATTITUDE),
    ("platform.initial_angles_deg", Add, &[0.5], &ATTITUDE),
    ("platform.initial_angles_sigma_deg", Times, &[0.01, 0.1], &ATTITUDE),
    ("platform.initial_angles_sigma_deg", Times, &[10.0, 100.0], &NONE),
    ("noise.accel_g", Times, &[0.1, 0.3, 0.5, 0.9, 1.25, 2.0, 3.0, 10.0], &ACCEL),
    ("noise.gyro_deg_per_h", Times, &[0.1, 0.3, 0.5, 2.0, 3.0, 10.0], &GYRO),
    // Drifts of ten sigmas and of two; a wide prior.
    ("prior.bias_sigma_deg_per_h", Set, &[0.06, 0.3], &PRIOR),
    ("prior.g_sigma_deg_per_h_per_g", Set, &[0.017, 0.09], &PRIOR),
    ("prior.gg_sigma_deg_per_h_per_g2", Set, &[0.009, 0.04], &PRIOR),
    ("prior.bias_sigma_deg_per_h", Set, &[10.0], &NONE),
    ("prior.g_sigma_deg_per_h_per_g", Set, &[10.0], &NONE),
    ("prior.gg_sigma_deg_per_h_per_g2", Set, &[10.0], &NONE),
    ("prior.turn_on_sigma_deg_per_h", Set, &[0.001, 1.0], &NONE),
    // The last are sidereal seconds.
    ("time_s", Times, &[1.0001, 0.9999, 1.001, 1.01, 0.99, 1.002_737_909], &SITE),
    ("time_s", Add, &[3600.0, 1.7e9], &NONE),
    ("temperature_c", Add, &[273.15], &KELVIN),
    // The last are degrees Fahrenheit but for their zero.
    ("temperature_c", Add, &[5.0], &NONE),
    ("temperature_c", Times, &[1.8], &NONE),
];

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
    pub(super) fn all() -> Vec<Self> {
        let rows = TABLE.iter();
        let of = |&(key, change, amounts, right): &(_, _, &'static [f64], _)| {
            amounts.iter().map(move |amount| Self {
                key,
                change,
                amount: *amount,
                right,
            })
        };
        rows.flat_map(of).collect()
    }

    /// Key and change.
    pub(super) fn name(&self) -> String {
        let Self { key, amount, .. } = self;
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
        let by = self.amount * Draw::new(seed, SIGNS).sign();
        let change = |place: usize, value: f64| match self.change {
            Add => value + by,
            AddTo(only) if place == only => value + by,
            AddTo(_) => value,
            Times => value * self.amount,
            Set => self.amount,
        };
        let (record, bench) = (&mut wrong.0, wrong.1);
        let all = |values: &mut Vec<f64>| values.iter_mut().for_each(|one| *one = change(0, *one));
        wrong.1 = match self.key {
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
    let parsed = text.parse::<Table>();
    let mut file = parsed.map_err(|error| error.to_string())?;
    let (table, key) = key.split_once('.').unwrap_or(("", key));
    let table = file.entry(table).or_insert(Value::Table(Table::new()));
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
