//! Records and bench descriptions as they are read, held against each other.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use gyrocal::Platform;
use gyrocal_calibration::{GyroAxes, Run, attitude_walk_share, average_record};
use gyrocal_instruments::strapdown::read_axes;
use gyrocal_record::{AveragedReport, Bench, Record, SourceText};
use miette::miette;

use crate::Failure;

/// Two records share rows if so many that follow each other are equal to the last bit: as many
/// noisy values do not repeat by chance, not even coarse ones.
const SHARED_ROWS: usize = 24;

/// One record with the bench that it was taken on.
pub(super) struct Measurement {
    pub(super) path: PathBuf,
    pub(super) bench_path: PathBuf,
    pub(super) record: Record,
    pub(super) bench: Bench,
    pub(super) averaged: Option<AveragedReport>,
}

impl Measurement {
    pub(super) fn run(&self) -> Run<'_> {
        Run {
            record: &self.record,
            bench: &self.bench,
        }
    }

    /// Share of the variance of a mean that is the platform's own random turning meanwhile.
    pub(super) fn walk_share(&self) -> f64 {
        self.averaged.map_or(0.0, |averaged| {
            attitude_walk_share(&self.bench, averaged.interval_s)
        })
    }
}

/// Reads everything, averages if that is wanted, and refuses what cannot belong together. There
/// is one bench for all records or one for each.
pub(super) fn read(
    records: &[PathBuf],
    benches: &[PathBuf],
    average_s: Option<f64>,
) -> Result<Vec<Measurement>, Failure> {
    refuse_twins(records)?;
    let read: Vec<Bench> = benches
        .iter()
        .map(|path| Bench::read(path))
        .collect::<Result<_, _>>()?;
    refuse_differing(benches, &read)?;
    let mut measurements = Vec::with_capacity(records.len());
    for (index, path) in records.iter().enumerate() {
        let bench = if benches.len() == 1 { 0 } else { index };
        measurements.push(Measurement {
            path: path.clone(),
            bench_path: benches[bench].clone(),
            record: Record::read_at_least(path, Platform::STATES)?,
            bench: read[bench].clone(),
            averaged: None,
        });
    }
    for (index, one) in measurements.iter().enumerate() {
        for other in &measurements[index + 1..] {
            refuse_shared_rows(one, other)?;
        }
    }
    if let Some(interval_s) = average_s {
        for measurement in &mut measurements {
            take_means(measurement, interval_s)?;
        }
    }
    Ok(measurements)
}

/// How the gyros lie in each record, if that is given.
pub(super) fn gyro_axes(
    paths: &[PathBuf],
    measurements: &[Measurement],
) -> Result<Vec<GyroAxes>, Failure> {
    let pairs = paths.iter().zip(measurements);
    let read = pairs.map(|(path, measurement)| {
        let quaternions = read_axes(&SourceText::read(path)?, &measurement.record)?;
        Ok(GyroAxes::new(&quaternions))
    });
    read.collect()
}

fn refuse_twins(records: &[PathBuf]) -> Result<(), Failure> {
    let places: Vec<PathBuf> = records
        .iter()
        .map(|path| path.canonicalize().unwrap_or_else(|_| path.clone()))
        .collect();
    for (index, place) in places.iter().enumerate() {
        if let Some(first) = places[..index].iter().position(|other| other == place) {
            return Err(Failure::Usage(format!(
                "{} and {} are the same file: a record counts once",
                records[first].display(),
                records[index].display()
            )));
        }
    }
    Ok(())
}

/// The coefficients are shared, so their prior is; a site that is given twice is one site.
fn refuse_differing(paths: &[PathBuf], benches: &[Bench]) -> Result<(), Failure> {
    let differ = |path: &Path, what: &str, other: &Path, advice: &str| {
        Err(Failure::Work(miette!(
            help = advice,
            "{}: found {what} other than in {}, expected the same",
            path.display(),
            other.display(),
        )))
    };
    for (index, bench) in benches.iter().enumerate() {
        for (other, earlier) in benches[..index].iter().enumerate() {
            if bench.prior != earlier.prior {
                let advice = "the coefficients are those of one platform: give [prior] the same \
                              values in each bench file";
                return differ(&paths[index], "a [prior]", &paths[other], advice);
            }
            let site = |bench: &Bench| (bench.latitude_deg, bench.gravity);
            if site(bench) == site(earlier) && bench.uncertainty != earlier.uncertainty {
                let advice = "both give the same latitude and gravity: give them the same sigmas";
                let what = "uncertainties of the same site";
                return differ(&paths[index], what, &paths[other], advice);
            }
        }
    }
    Ok(())
}

fn refuse_shared_rows(one: &Measurement, other: &Measurement) -> Result<(), Failure> {
    let Some((first, rows)) = shared_rows(&one.record, &other.record) else {
        return Ok(());
    };
    Err(Failure::Work(miette!(
        help = "leave one of them out, or cut the rows that both have from one",
        "{}: found {rows} rows in succession that {} has too, from row {} of the data (t = {} s) \
         on, expected rows of its own: they would count twice",
        other.path.display(),
        one.path.display(),
        first + 1,
        other.record.time_s[first],
    )))
}

/// First row in `other` of the longest stretch of samples that both have, and its length.
fn shared_rows(one: &Record, other: &Record) -> Option<(usize, usize)> {
    let bits = |row: &[f64; 3]| row.map(|value| if value.is_nan() { 0 } else { value.to_bits() });
    let mut places: HashMap<[u64; 3], Vec<usize>> = HashMap::new();
    for (row, sample) in one.accel_g.iter().enumerate() {
        if sample.iter().all(|value| !value.is_nan()) {
            places.entry(bits(sample)).or_default().push(row);
        }
    }
    let enough = SHARED_ROWS.min(one.len()).min(other.len());
    let mut longest: Option<(usize, usize)> = None;
    let mut row = 0;
    while row < other.len() {
        let starts = places.get(&bits(&other.accel_g[row]));
        // Values of a coarse converter stand in many places: the first few will do.
        let length = starts
            .into_iter()
            .flatten()
            .take(64)
            .map(|start| {
                let pairs = one.accel_g[*start..].iter().zip(&other.accel_g[row..]);
                pairs.take_while(|(a, b)| bits(a) == bits(b)).count()
            })
            .max()
            .unwrap_or(0);
        if length >= enough && longest.is_none_or(|(_, rows)| length > rows) {
            longest = Some((row, length));
        }
        // A stretch that is long enough need not be looked at from its middle again.
        row += if length >= enough { length } else { 1 };
    }
    longest
}

fn take_means(measurement: &mut Measurement, interval_s: f64) -> Result<(), Failure> {
    let averaged = average_record(&measurement.record, interval_s).map_err(|error| {
        Failure::Work(miette!(
            help = "choose --average between these, or leave it out",
            "{}: {error}",
            measurement.path.display()
        ))
    })?;
    measurement.averaged = Some(AveragedReport {
        interval_s,
        rows_read: measurement.record.len(),
        left_out: averaged.left_out,
        noise_ratio: averaged.noise_ratio,
    });
    measurement.bench = averaged.bench(&measurement.bench);
    measurement.record = averaged.record;
    Ok(())
}

#[cfg(test)]
mod tests {
    use gyrocal_record::Record;

    use super::shared_rows;

    fn record(rows: core::ops::Range<u32>) -> Record {
        Record {
            time_s: rows.clone().map(f64::from).collect(),
            accel_g: rows
                .map(|row| {
                    let row = f64::from(row);
                    [
                        row.sin(),
                        if row == 40.0 { f64::NAN } else { row.cos() },
                        0.5,
                    ]
                })
                .collect(),
            temperature_c: None,
        }
    }

    #[test]
    fn a_stretch_of_equal_rows_is_found_wherever_it_is() {
        assert_eq!(
            shared_rows(&record(0..100), &record(30..200)),
            Some((0, 70))
        );
        assert_eq!(
            shared_rows(&record(30..200), &record(0..100)),
            Some((30, 70))
        );
        assert_eq!(shared_rows(&record(0..100), &record(100..200)), None);
        // 23 rows are one too few.
        assert_eq!(shared_rows(&record(0..100), &record(77..200)), None);
        assert_eq!(
            shared_rows(&record(0..100), &record(76..200)),
            Some((0, 24))
        );
    }
}
