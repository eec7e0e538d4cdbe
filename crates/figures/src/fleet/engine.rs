//! Fleets of short records on an engine: records a second, equal results under kills, memory, and the cost of
//! each stage.

use serde::Deserialize;

use super::measured_once;
use crate::error::Error;
use crate::figure::Figure;

/// Short records whose workers are killed, and records of three days whose stages are timed.
const KILLED: usize = 600;
const STAGED: usize = 100;

/// Short records on two workers.
const MANY: usize = 100_000;

/// Another number of them.
const RECORDS: &str = "GYROCAL_FLEET_RECORDS";

/// Most growth of a worker's memory between the halves of the records, MB. Of 1e5 records on two workers,
/// 25 000 of a worker lie between the centres of the halves: this is 0.4 kB a record, and a result that is kept
/// would be some hundred times as much.
const GROWTH_MB: f64 = 10.0;

/// Fewest kills.
const KILLS: usize = 20;

/// A fleet whose workers are killed, and the cost of each stage.
#[derive(Deserialize)]
struct Fleet {
    records: usize,
    killed_records: usize,
    rows_of_a_record: usize,
    equal: bool,
    runs: usize,
    largest_sent_bytes: f64,
    kills: usize,
    lost: usize,
    repeated: usize,
    read_s: f64,
    records_s: f64,
    diagnosis_s: f64,
    write_s: f64,
    summary_s: f64,
    summary_mb: f64,
    bytes_in: f64,
    bytes_out: f64,
}

/// Many short records.
#[derive(Deserialize)]
struct Many {
    records: usize,
    rows_of_a_record: usize,
    rows_of_a_partition: usize,
    library_s: f64,
    blocks: usize,
    ratio: f64,
    overhead: f64,
    worker_mb: f64,
    growth_mb: f64,
}

pub(super) fn figures() -> Result<Vec<Figure>, Error> {
    let records = std::env::var(RECORDS).unwrap_or_else(|_| MANY.to_string());
    let mut figures = many(&measured_once(&["many", &records])?);
    let found: Fleet = measured_once(&["fleet", &KILLED.to_string(), &STAGED.to_string()])?;
    figures.extend(killed(&found));
    let seeds = format!("0..{}", found.records);
    let stages = scale(&found).into_iter();
    figures.extend(stages.map(|figure| figure.over(found.records, seeds.clone())));
    Ok(figures)
}

fn many(found: &Many) -> Vec<Figure> {
    let overhead = 100.0 * found.overhead;
    let figures = vec![
        Figure::within(
            "two workers: records a second over the library in one process with one thread",
            [1.6, f64::INFINITY],
            found.ratio,
        ),
        Figure {
            target: "<= 5 %".to_owned(),
            measured: format!("{overhead:.1} %"),
            ..Figure::within(
                "one worker over the library, partitions of a second: overhead of the engine a record",
                [f64::NEG_INFINITY, 5.0],
                overhead,
            )
        },
        Figure::at_most("memory of a worker, most", 1000.0, found.worker_mb, "MB"),
        Figure::at_most(
            "memory of a worker, second half of the records over the first",
            GROWTH_MB,
            found.growth_mb,
            "MB",
        ),
        Figure::note(
            "these records: rows of each, records of a partition, cost by the library",
            format!(
                "{}, {}, {:.2} ms",
                found.rows_of_a_record,
                found.rows_of_a_partition,
                1e3 * found.library_s
            ),
        ),
    ];
    let seeds = format!("0..{}, in turns, {} parts", found.records, found.blocks);
    let figures = figures.into_iter();
    figures
        .map(|figure| figure.over(found.records, seeds.clone()))
        .collect()
}

fn killed(found: &Fleet) -> Vec<Figure> {
    let equal = format!(
        "1, 2, 4 workers, three partitionings, killed workers ({} runs): equal bits",
        found.runs
    );
    let lost = found.lost + found.repeated;
    let enough = found.kills >= KILLS;
    let killed = Figure::within("", [0.0, 0.0], lost as f64);
    let figures = [
        Figure::truth(&equal, found.equal),
        Figure {
            name: format!(
                "workers killed {} times with SIGKILL: lost, and repeated after it",
                found.kills
            ),
            target: "0 and 0".to_owned(),
            measured: format!("{} and {}", found.lost, found.repeated),
            holds: killed.holds.filter(|_| enough),
            too_few: !enough,
            ..killed
        },
    ];
    let seeds = format!("0..{}", found.killed_records);
    let figures = figures.into_iter();
    figures
        .map(|figure| figure.over(found.killed_records, seeds.clone()))
        .collect()
}

/// A million records.
const MILLION: f64 = 1e6;

/// An assumed price of an hour of a core, in any currency: results are proportional to it.
const CORE_HOUR: f64 = 0.05;

/// An assumed price of a gigabyte of storage in a month.
const GIGABYTE_MONTH: f64 = 0.02;

/// An assumed rate at which a shared store serves all workers together, bytes/s.
const STORE_RATE: f64 = 1e9;

/// Costs of a record, and what follows from them for a million.
fn scale(found: &Fleet) -> Vec<Figure> {
    let records = found.records as f64;
    let total_s = found.read_s + found.records_s + found.diagnosis_s + found.write_s;
    let each = |name: &str, seconds: f64| {
        let milliseconds = 1e3 * seconds / records;
        let share = 100.0 * seconds / total_s;
        Figure::note(
            name,
            format!("{milliseconds:.2} ms a record, {share:.1} % of a worker's time"),
        )
    };
    let (bytes_in, bytes_out) = (found.bytes_in / records, found.bytes_out / records);
    let hours = total_s / records * MILLION / 3600.0;
    let gigabytes = |bytes: f64| bytes * MILLION / 1e9;
    // Workers that the store feeds: beyond them, more do not help.
    let workers = STORE_RATE / ((bytes_in + bytes_out) / (total_s / records));
    let summary = 1e3 * found.summary_s / records;
    let summary_mb = found.summary_mb / records;
    let sent = found.largest_sent_bytes / 1e3;
    vec![
        Figure::at_most(
            "records of three days: most bytes of result and scores",
            200.0,
            sent,
            "kB",
        ),
        Figure::note("rows of a record", format!("{}", found.rows_of_a_record)),
        each("stage: read Parquet", found.read_s),
        each("stage: columns to a record", found.records_s),
        each(
            "stage: diagnosis, with its result as JSON",
            found.diagnosis_s,
        ),
        each("stage: write Parquet", found.write_s),
        Figure::note(
            "stage: summary of the fleet, one process",
            format!("{summary:.2} ms a record, {summary_mb:.2} MB of memory a record"),
        ),
        Figure::note(
            "bytes of a record in and out, as Parquet",
            format!("{:.1} kB and {:.1} kB", bytes_in / 1e3, bytes_out / 1e3),
        ),
        Figure::note(
            "a million such records: core-hours, bytes in and out",
            format!(
                "{hours:.2} h, {:.1} GB and {:.1} GB",
                gigabytes(bytes_in),
                gigabytes(bytes_out)
            ),
        ),
        Figure::note(
            &format!(
                "a million such records: price at {CORE_HOUR} a core-hour, and of a month of their results \
                 at {GIGABYTE_MONTH} a GB"
            ),
            format!(
                "{:.2} and {:.2}",
                CORE_HOUR * hours,
                GIGABYTE_MONTH * gigabytes(bytes_out)
            ),
        ),
        Figure::note(
            &format!(
                "workers that a store of {} GB/s feeds: beyond, no linear scaling",
                STORE_RATE / 1e9
            ),
            format!("{workers:.0}"),
        ),
        Figure::note(
            "records whose summary fits into 16 GB of memory",
            format!("{:.0}", 16e3 / summary_mb),
        ),
    ]
}
