//! Whether effects that were asked for exist, and can be looked for.

use gyrocal::effect::Need;
use gyrocal::{EFFECTS, Effect};
use gyrocal_calibration::{PLATFORM, check_record};
use gyrocal_hypothesis::{Selection, select};
use gyrocal_record::{Bench, Record, any_of, nearest_names};

use crate::error::DiagnosisError;

/// Number of ids that are suggested for an unknown one.
const NEAREST: usize = 3;

/// Refuses effects that are in no catalogue, effects whose input is missing, and a record with
/// fewer rows than a filter has states.
pub(crate) fn check(
    effects: &[String],
    record: &Record,
    bench: &Bench,
) -> Result<(), DiagnosisError> {
    for id in effects {
        let Some(effect) = EFFECTS.iter().find(|effect| effect.id == id) else {
            return Err(DiagnosisError::UnknownEffect {
                id: id.clone(),
                nearest: nearest(id),
            });
        };
        if let Some(why) = missing_input(effect, record, bench) {
            return Err(DiagnosisError::Unavailable {
                effect: effect.id,
                why,
            });
        }
    }
    Ok(check_record(record)?)
}

/// The data that an effect needs and the record or its bench lacks.
#[must_use]
pub fn missing_input(effect: &Effect, record: &Record, bench: &Bench) -> Option<String> {
    for need in effect.needs {
        match need {
            Need::Column(name) if record.temperature_c.is_none() => {
                return Some(format!("the record has no column `{name}`"));
            }
            Need::Column(name) if !record.temperature_changes() => {
                return Some(format!("the column `{name}` never changes"));
            }
            Need::Key(key) if bench.magnetic_field_gauss.is_none() => {
                return Some(format!("the bench file has no `{key}` in `[site]`"));
            }
            _ => {}
        }
    }
    None
}

/// The effects that are tested in a record: those of the default search, and those in `also`.
#[must_use]
pub fn selection(record: &Record, bench: &Bench, also: &[&str]) -> Selection {
    select(&PLATFORM, also, |effect| {
        missing_input(effect, record, bench)
    })
}

/// The nearest ids as the end of a sentence.
fn nearest(typed: &str) -> String {
    let known: Vec<&str> = EFFECTS.iter().map(|effect| effect.id).collect();
    let nearest = nearest_names(typed, &known, NEAREST);
    format!("; the nearest are {}", any_of(&nearest))
}

#[cfg(test)]
mod tests {
    use gyrocal_calibration::CalibrationError;

    use super::*;

    fn record() -> Record {
        Record {
            time_s: (0..20).map(|row| 60.0 * f64::from(row)).collect(),
            accel_g: vec![[0.0, 0.0, 1.0]; 20],
            temperature_c: None,
        }
    }

    fn refused(id: &str) -> String {
        let bench = Bench::parse(
            "[site]\nlatitude_deg = 39.1\n[platform]\n[noise]\naccel_g = 1e-5\ngyro_deg_per_h = 0.002\n",
            "bench",
        );
        let Ok(bench) = bench else {
            return "no bench".to_owned();
        };
        check(&[id.to_owned()], &record(), &bench)
            .err()
            .map_or_else(String::new, |error| error.to_string())
    }

    #[test]
    fn what_cannot_be_looked_for_is_refused_with_its_reason() {
        let unknown = refused("gyro_y.gz");
        assert!(
            unknown.starts_with("there is no effect `gyro_y.gz`")
                && unknown.contains("`gyro_y.g_z`"),
            "{unknown}"
        );
        assert!(refused("gyro_x.temperature").contains("no column `temperature_c`"));
        assert!(refused("gyro_x.magnetic").contains("no `magnetic_field_gauss`"));
        assert_eq!(refused("gyro_xy.axis_misalignment"), "");
    }

    #[test]
    fn a_record_shorter_than_the_state_is_refused() {
        let mut short = record();
        short.accel_g.truncate(11);
        short.time_s.truncate(11);
        let bench = Bench::parse(
            "[site]\nlatitude_deg = 39.1\n[platform]\n[noise]\naccel_g = 1e-5\ngyro_deg_per_h = 0.002\n",
            "bench",
        );
        let error = bench
            .ok()
            .and_then(|bench| check(&[], &short, &bench).err());
        assert!(matches!(
            error,
            Some(DiagnosisError::Calibration(CalibrationError::TooShort {
                found: 11,
                ..
            }))
        ));
    }
}
