//! Work of a diagnosis on hostile records, over that on a sound record of the same size.

mod records;

use std::time::Instant;

use gyrocal_calibration::work;
use gyrocal_diagnosis::{DiagnoseOptions, DiagnosisError, diagnose};
use gyrocal_statistics::median;
use gyrocal_truth::Simulation;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;
use records::{KINDS, record, sound};

/// First seed and number of the records, as many of each kind; kinds of the small version.
const FIRST: u64 = 3_220_000;
const RECORDS: u64 = 200;
const SMALL_KINDS: [usize; 5] = [4, 9, 15, 18, 20];

/// Sound records that the work is compared with.
const SOUND: u64 = 3_230_000;
const SOUND_RECORDS: u64 = 5;

/// Largest work over that of a sound record.
const LIMIT: f64 = 20.0;

/// Cost of one diagnosis.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Cost {
    kind: String,
    answer: String,
    rows: usize,
    work: u64,
    seconds: f64,
}

fn cost(kind: &str, simulation: &Simulation) -> Cost {
    let (before, start) = (work(), Instant::now());
    let options = DiagnoseOptions::default();
    let answer = match diagnose(&simulation.record, &simulation.bench, &options) {
        Ok(found) => {
            let result = found.result;
            let cut = if result.search_complete { "" } else { ", cut" };
            let count = result.findings.len();
            format!("{:?}, {count} findings{cut}", result.verdict)
        }
        Err(DiagnosisError::Setup { result }) => format!("{:?}", result.verdict),
        Err(error) => error.to_string(),
    };
    Cost {
        kind: kind.to_owned(),
        answer,
        rows: simulation.record.len(),
        work: work() - before,
        seconds: start.elapsed().as_secs_f64(),
    }
}

/// Cost of a row of sound records of a size: median work, and median time.
fn of_a_sound_row(rows: usize) -> Result<[f64; 2], Error> {
    let costs = (SOUND..SOUND + SOUND_RECORDS).map(|seed| Ok(cost("sound", &sound(seed, rows)?)));
    let costs: Vec<Cost> = costs.collect::<Result<_, Error>>()?;
    let per_row = |value: fn(&Cost) -> f64| {
        let all: Vec<f64> = costs
            .iter()
            .map(|cost| value(cost) / cost.rows as f64)
            .collect();
        median(&all)
    };
    Ok([
        per_row(|cost| cost.work as f64),
        per_row(|cost| cost.seconds),
    ])
}

pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let records = if small {
        SMALL_KINDS.len() as u64
    } else {
        RECORDS
    };
    let seeds = FIRST..FIRST + records;
    let campaign = resumable::campaign("truth", "hostile", seeds.clone(), small)?;
    let job = |seed: u64| {
        let place = (seed - FIRST) as usize;
        let kind = if small {
            SMALL_KINDS[place]
        } else {
            place % KINDS
        };
        let (kind, simulation) = record(kind, seed)?;
        Ok::<_, Error>(cost(kind, &simulation))
    };
    let outcome = campaign.run(job, |_| ())?;
    let mut sizes: Vec<(usize, [f64; 2])> = Vec::new();
    let mut ratios: Vec<([f64; 2], Cost)> = Vec::new();
    for (_, cost) in outcome.successes() {
        let known = sizes.iter().find(|(rows, _)| *rows == cost.rows);
        let [work, seconds] = match known {
            Some((_, of_row)) => *of_row,
            None => {
                let of_row = of_a_sound_row(cost.rows)?;
                sizes.push((cost.rows, of_row));
                of_row
            }
        };
        let rows = cost.rows as f64;
        ratios.push((
            [
                cost.work as f64 / rows / work,
                cost.seconds / rows / seconds,
            ],
            cost.clone(),
        ));
    }
    ratios.sort_by(|a, b| b.0[0].total_cmp(&a.0[0]));
    let (largest, kind) = ratios
        .first()
        .map_or((f64::NAN, "none"), |(ratio, cost)| (ratio[0], &cost.kind));
    let slowest = ratios.iter().map(|(ratio, _)| ratio[1]).fold(0.0, f64::max);
    let longest_s = ratios
        .iter()
        .map(|(_, cost)| cost.seconds)
        .fold(0.0, f64::max);
    let name = "work of `diagnose` on hostile records over a sound one of that size";
    let seeds = format!("{seeds:?}");
    let worst = Figure::within(name, [0.0, LIMIT], largest).over(ratios.len(), seeds.clone());
    let note = format!("{slowest:.1} times, {longest_s:.1} s; most work: {kind}");
    Ok(vec![
        Figure {
            target: format!("<= {LIMIT}"),
            ..worst
        },
        Figure::note("the same in time, largest", note).over(ratios.len(), seeds),
    ])
}
