//! A fleet of records from end to end: simulated, diagnosed, its scores sent as bytes, and looked at.

use gyrocal_answer::read_text;
use gyrocal_evaluation::{diagnosed, inject};
use gyrocal_fleet::{FleetOptions, FleetRecord, RecordName, summarise, to_bytes};
use gyrocal_record::SourceText;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Scenario, simulate};
use serde::{Deserialize, Serialize};

use super::fleets;
use super::recurring::scenario;
use crate::harness::{Context, Error, Figure};

/// Share of the units that have the cause, its strength, and the cause.
const SHARE: f64 = 0.2;
const STRENGTH: f64 = 2.5;
const CAUSE: &str = "gyro_y.g_z";

/// First record, and their number; those of the scores that other fleets are drawn from are below.
const FIRST: u64 = 1000;
const UNITS: u64 = 200;

/// What a diagnosed record sends.
#[derive(Clone, Serialize, Deserialize)]
struct Sent {
    unit: String,
    result: String,
    scores: Vec<u8>,
}

fn sent(number: u64, with_cause: bool) -> Result<Sent, Error> {
    let mut scenario = scenario(number);
    let mut draw = Draw::new(number, 0);
    if with_cause && draw.uniform() < SHARE {
        let effect = gyrocal::EFFECTS.iter().find(|effect| effect.id == CAUSE);
        let effect = effect.ok_or("no such effect")?;
        let injected = inject(&scenario, &[(effect, None)], STRENGTH, 1.0, &mut draw)?;
        let hidden = injected.iter().flatten().map(|one| one.to_hidden());
        scenario = Scenario {
            hidden: hidden.collect::<Result<_, _>>()?,
            ..scenario
        };
    }
    let simulated = simulate(&scenario)?;
    let found = diagnosed(&simulated)?;
    let result = serde_json::to_string(&found.result)?;
    let scores = to_bytes(&found.scores);
    // What arrives is what was sent.
    read_text(&SourceText::new(&result, "result")?)?;
    Ok(Sent {
        unit: number.to_string(),
        result,
        scores,
    })
}

/// Whether each cause that recurs in a fleet is the hidden one.
fn recurring<'a>(sent: impl Iterator<Item = &'a Sent>) -> Result<Vec<bool>, Error> {
    let records = sent.map(|one| {
        let name = RecordName {
            unit: one.unit.clone(),
            ..RecordName::default()
        };
        FleetRecord::read(name, &one.result, Some(&one.scores))
    });
    let records: Vec<FleetRecord> = records.collect::<Result<_, _>>()?;
    let found = summarise(&records, &FleetOptions::default())?.recurring;
    let named = found.iter().map(|one| {
        let mut names = one.alternatives.iter().chain([&one.effect]);
        names.any(|name| name == CAUSE)
    });
    Ok(named.collect())
}

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let job = |number| Ok([sent(number, true)?, sent(number, false)?]);
    let population = fleets("whole", [FIRST, UNITS, 0], job);
    let fleet = context.records(&population)?;
    if fleet.records.is_empty() {
        return Ok(Vec::new());
    }
    let all = || fleet.records.iter().flatten();
    let bytes = all().map(|one| one.result.len() + one.scores.len()).max();
    let with = recurring(fleet.records.iter().map(|[with, _]| with))?;
    let without = recurring(fleet.records.iter().map(|[_, without]| without))?;
    let alone =
        "200 simulated records, `gyro_y.g_z` of 2.5 sigmas in a fifth of them: it alone recurs";
    let nothing = "the same records without it: nothing recurs";
    let most = "result and scores of a record: most bytes that travel";
    let kilobytes = bytes.unwrap_or_default() as f64 / 1e3;
    let figures = [
        Figure::truth(alone, with == [true]),
        Figure::truth(nothing, without.is_empty()),
        Figure::at_most(most, 200.0, kilobytes, "kB"),
    ];
    // Fewer units than these need not show the cause.
    let judged = figures.map(|figure| figure.judged(fleet.full));
    let over = |figure: Figure| figure.over(fleet.records.len(), fleet.seeds.as_str());
    Ok(judged.map(over).into())
}
