//! Fleets of short records on an engine: records a second, equal results under kills, memory, and the cost of
//! each stage.

use super::{Measured, measured_once};
use crate::harness::{Context, Error, Figure};

/// Short records whose workers are killed, and records of three days whose stages are timed.
const KILLED: &str = "600";
const STAGED: &str = "100";

/// Short records on two workers, and the variable for another number of them.
const MANY: &str = "100000";
const RECORDS: &str = "GYROCAL_FLEET_RECORDS";

/// Most growth of a worker's memory between the halves of the records, MB. Of 1e5 records on two workers,
/// 25 000 of a worker lie between the centres of the halves: this is 0.4 kB a record, and a result that is kept
/// would be some hundred times as much.
const GROWTH_MB: f64 = 10.0;

/// Fewest kills.
const KILLS: f64 = 20.0;

/// A million records, and what is assumed of them: prices of an hour of a core and of a gigabyte of storage in a
/// month, in any currency (results are proportional to them), and the rate at which a shared store serves all
/// workers together, bytes/s.
const MILLION: f64 = 1e6;
const CORE_HOUR: f64 = 0.05;
const GIGABYTE_MONTH: f64 = 0.02;
const STORE_RATE: f64 = 1e9;

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let records = std::env::var(RECORDS).unwrap_or_else(|_| MANY.to_owned());
    let found = measured_once(context, &["many", &records])?;
    let turns = format!(", in turns, {} parts", found.of("blocks"));
    let mut figures = over(many(&found), found.of("records"), &turns);
    let found = measured_once(context, &["fleet", KILLED, STAGED])?;
    figures.extend(over(killed(&found), found.of("killed_records"), ""));
    figures.extend(over(stages(&found), found.of("records"), ""));
    Ok(figures)
}

fn over(figures: Vec<Figure>, records: f64, how: &str) -> Vec<Figure> {
    let over = |one: Figure| one.over(records as usize, format!("0..{records}{how}"));
    figures.into_iter().map(over).collect()
}

fn many(found: &Measured) -> Vec<Figure> {
    let ratio = "two workers: records a second over the library in one process with one thread";
    let overhead =
        "one worker over the library, partitions of a second: overhead of the engine a record";
    let growth = "memory of a worker, second half of the records over the first";
    let largest = "memory of a worker, most";
    let these = "these records: rows of each, records of a partition, cost by the library";
    let [rows, records] = ["rows_of_a_record", "rows_of_a_partition"].map(|key| found.of(key));
    let cost_ms = 1e3 * found.of("library_s");
    vec![
        Figure::within(ratio, [1.6, f64::INFINITY], found.of("ratio")),
        Figure::at_most(overhead, 5.0, 100.0 * found.of("overhead"), "%"),
        Figure::at_most(largest, 1000.0, found.of("worker_mb"), "MB"),
        Figure::at_most(growth, GROWTH_MB, found.of("growth_mb"), "MB"),
        Figure::note(these, format!("{rows}, {records}, {cost_ms:.2} ms")),
    ]
}

fn killed(found: &Measured) -> Vec<Figure> {
    let [runs, kills, lost, repeated] =
        ["runs", "kills", "lost", "repeated"].map(|key| found.of(key));
    let equal = "1, 2, 4 workers, three partitionings, killed workers: equal bits";
    let mut equal = Figure::truth(equal, found.is("equal"));
    equal.measured += &format!(", {runs} runs");
    let name = "workers killed with SIGKILL: records lost, and repeated after it";
    let measured = format!("{lost} and {repeated}, {kills} kills");
    let killed = Figure::told(name, "<= 0", measured, lost + repeated <= 0.0);
    let mut killed = killed.judged(kills >= KILLS);
    killed.too_few = kills < KILLS;
    vec![equal, killed]
}

/// Costs of a record, and what follows from them for a million.
fn stages(found: &Measured) -> Vec<Figure> {
    const STAGES: [(&str, &str); 4] = [
        ("read Parquet", "read_s"),
        ("columns to a record", "records_s"),
        ("diagnosis, with its result as JSON", "diagnosis_s"),
        ("write Parquet", "write_s"),
    ];
    let each = |key: &str| found.of(key) / found.of("records");
    let total_s: f64 = STAGES.iter().map(|(_, key)| each(key)).sum();
    let (name, bytes) = (
        "records of three days: most bytes of result and scores",
        found.of("largest_sent_bytes"),
    );
    let mut figures = vec![
        Figure::at_most(name, 200.0, bytes / 1e3, "kB"),
        Figure::note("rows of a record", found.of("rows_of_a_record").to_string()),
    ];
    let mut note = |name: &str, measured| figures.push(Figure::note(name, measured));
    for (stage, key) in STAGES {
        let (milliseconds, share) = (1e3 * each(key), 100.0 * each(key) / total_s);
        let measured = format!("{milliseconds:.2} ms a record, {share:.1} % of a worker's time");
        note(&format!("stage: {stage}"), measured);
    }
    let [bytes_in, bytes_out] = ["bytes_in", "bytes_out"].map(each);
    let [gigabytes_in, gigabytes_out] = [bytes_in, bytes_out].map(|bytes| bytes * MILLION / 1e9);
    let (summary_ms, summary_mb) = (1e3 * each("summary_s"), each("summary_mb"));
    let hours = total_s * MILLION / 3600.0;
    let summary = format!("{summary_ms:.2} ms a record, {summary_mb:.2} MB of memory a record");
    note("stage: summary of the fleet, one process", summary);
    let bytes = format!("{:.1} kB and {:.1} kB", bytes_in / 1e3, bytes_out / 1e3);
    note("bytes of a record in and out, as Parquet", bytes);
    let all = format!("{hours:.2} h, {gigabytes_in:.1} GB and {gigabytes_out:.1} GB");
    note("a million such records: core-hours, bytes in and out", all);
    let name = format!(
        "a million such records: price at {CORE_HOUR} a core-hour, and of a month of their results \
         at {GIGABYTE_MONTH} a GB"
    );
    let [price, of_results] = [CORE_HOUR * hours, GIGABYTE_MONTH * gigabytes_out];
    note(&name, format!("{price:.2} and {of_results:.2}"));
    // Beyond them, more do not help.
    let (rate, workers) = (
        STORE_RATE / 1e9,
        STORE_RATE / ((bytes_in + bytes_out) / total_s),
    );
    let name = format!("workers that a store of {rate} GB/s feeds: beyond, no linear scaling");
    note(&name, format!("{workers:.0}"));
    let records = format!("{:.0}", 16e3 / summary_mb);
    note("records whose summary fits into 16 GB of memory", records);
    figures
}
