//! Time and memory of a diagnosis, and its reproducibility.

use std::borrow::Cow;

use gyrocal_calibration::{Options, Run};
use gyrocal_diagnosis::{
    Blocks, CalibratedRecord, CalibrationRequest, calibrate_and_diagnose, manifest,
};
use gyrocal_evaluation::{diagnosed, run_of};
use gyrocal_record::{CalibrationMethod, CalibrationReport};
use gyrocal_truth::{Coefficients, Hidden, Scenario, Simulation, simulate};

use crate::cost::{Peak, on_one_core};
use crate::harness::{Error, Figure};

/// Records of known cost: what they are, their interval, s, length in days and most time on one core, s, and what is
/// hidden. Those at one row a second are diagnosed as means of blocks; the last is read by `calibrate`.
const DIAGNOSED: [(&str, [f64; 3], Option<Term>); 5] = [
    ("three days at 60 s, clean", [60.0, 3.0, 0.5], None),
    (
        "three days at 60 s, a cause of 14 sigma",
        [60.0, 3.0, 1.2],
        CAUSE,
    ),
    (
        "three days at 1 s, a cause of 14 sigma",
        [1.0, 3.0, 4.0],
        CAUSE,
    ),
    ("five days at 1 s, clean", [1.0, 5.0, 6.0], None),
    ("five days at 1 s, a cause", [1.0, 5.0, 12.0], CAUSE),
];
const CALIBRATED: (&str, usize, f64) = ("calibration of 1 000 000 rows at 1 s", 1_000_000, 4.0);

/// Largest memory of the process in each, MB.
const MOST_MB: f64 = 400.0;

/// A term in the drift of gyro y, and its size.
type Term = (&'static str, f64);
const CAUSE: Option<Term> = Some(("gyro_y.g_z", 1e-3));

/// Records that the small version measures: times on a machine that does other work as well say little, and are shown
/// and not judged.
const SMALL: usize = 2;

pub(super) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    let records = if small { SMALL } else { DIAGNOSED.len() };
    for (name, [interval_s, days, most_s], hidden) in DIAGNOSED.into_iter().take(records) {
        let record = simulation(interval_s, days * 86_400.0 - interval_s, hidden)?;
        let name = format!("{name}, {} rows, on one core", record.record.len());
        let peak = Peak::reset();
        let (first, seconds) = told(&record)?;
        if interval_s > 1.0 {
            let (second, again_s) = told(&record)?;
            let time = Figure::at_most(&name, most_s, seconds.min(again_s), "s").over(2, "1");
            let same = format!("{name}: twice the same to the last bit");
            figures.extend([time.timed(small), Figure::truth(&same, first == second)]);
        } else {
            figures.extend(costs(&name, most_s, seconds, peak));
        }
    }
    if !small {
        let (name, rows, most_s) = CALIBRATED;
        let record = simulation(1.0, (rows - 1) as f64, None)?;
        let peak = Peak::reset();
        let (found, seconds) = on_one_core(|| calibrated(&record));
        found?;
        figures.extend(costs(name, most_s, seconds, peak));
    }
    Ok(figures)
}

/// Time and memory.
fn costs(name: &str, most_s: f64, seconds: f64, peak: Peak) -> [Figure; 2] {
    let memory = format!("{name}: peak memory of the process");
    [
        Figure::at_most(name, most_s, seconds, "s"),
        Figure::at_most(&memory, MOST_MB, peak.read_mb(), "MB"),
    ]
}

fn simulation(interval_s: f64, duration_s: f64, hidden: Option<Term>) -> Result<Simulation, Error> {
    let hidden = hidden.map(|(effect, size)| Hidden::new(effect, &[("size", size)]));
    Ok(simulate(&Scenario {
        seed: 1,
        coefficients: Coefficients::PAPER_LIKE,
        interval_s,
        duration_s,
        hidden: hidden.transpose()?.into_iter().collect(),
        ..Scenario::default()
    })?)
}

/// What `calibrate` makes of a record, with the diagnosis that its result has.
fn calibrated(simulation: &Simulation) -> Result<CalibrationReport, Error> {
    let (record, bench) = (Cow::Borrowed(&simulation.record), &simulation.bench);
    let (record, bench, averaged) = Blocks::or_rows(record, bench, None);
    let run = Run {
        record: &record,
        bench: &bench,
    };
    let request = CalibrationRequest {
        method: CalibrationMethod::Batch,
        options: Options::default(),
        records: vec![CalibratedRecord {
            name: "record".to_owned(),
            bench_name: "bench".to_owned(),
            run,
            diagnosed: run_of(simulation),
            rows: simulation.record.len(),
            averaged,
            setup: &[],
        }],
        axes: &[],
        with_effects: None,
        manifest: manifest(0),
    };
    Ok(calibrate_and_diagnose(request, |_| ())?)
}

/// All numbers of a diagnosis, and its time, s.
fn told(simulation: &Simulation) -> Result<(String, f64), Error> {
    let (found, seconds) = on_one_core(|| diagnosed(simulation));
    let found = found?;
    // Numbers are written with as many digits as tell them from all others.
    let all = format!("{:?}", (&found.result, found.nominal.values()));
    Ok((all, seconds))
}
