//! A fleet of records from end to end: simulated, diagnosed, its scores sent as bytes, and looked at.

use gyrocal_diagnosis::result::read_text;
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_evaluation::inject;
use gyrocal_fleet::{FleetOptions, FleetRecord, RecordName, summarise, to_bytes};
use gyrocal_record::SourceText;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Scenario, simulate};
use serde::{Deserialize, Serialize};

use super::recurring::scenario;
use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;
use crate::truth::Extent;

const UNITS: u64 = 200;

/// Share of the units that have the cause, and its strength.
const SHARE: f64 = 0.2;
const STRENGTH: f64 = 2.5;

/// The cause.
const CAUSE: &str = "gyro_y.g_z";

/// First record; those of the scores that other fleets are drawn from are below.
const FIRST: u64 = 1000;

/// What a diagnosed record sends.
#[derive(Clone, Serialize, Deserialize)]
struct Sent {
    result: String,
    scores: Vec<u8>,
}

fn sent(number: u64, with_cause: bool) -> Result<Sent, Error> {
    let mut scenario = scenario(FIRST + number);
    let mut draw = Draw::new(FIRST + number, 0);
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
    let options = DiagnoseOptions::default();
    let diagnosed = diagnose(&simulated.record, &simulated.bench, &options)?;
    let result = serde_json::to_string(&diagnosed.result)?;
    let scores = to_bytes(&diagnosed.scores);
    // What arrives is what was sent.
    read_text(&SourceText::new(&result, "result")?)?;
    Ok(Sent { result, scores })
}

impl Sent {
    fn record(&self, number: u64) -> Result<FleetRecord, Error> {
        let name = RecordName {
            unit: format!("{number}"),
            record: "1".to_owned(),
            ..RecordName::default()
        };
        Ok(FleetRecord::read(name, &self.result, Some(&self.scores))?)
    }
}

pub(super) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let units = extent.records(UNITS, UNITS);
    let fleet = |cell: &str, with_cause: bool| -> Result<Vec<(u64, Sent)>, Error> {
        let campaign = resumable::campaign("fleet", cell, 0..units, extent.small)?;
        let outcome = campaign.run(|number| sent(number, with_cause), |_| ())?;
        let all = outcome.successes();
        Ok(all.map(|(number, one)| (number, one.clone())).collect())
    };
    let (with, without) = (
        fleet("whole with a cause", true)?,
        fleet("whole without", false)?,
    );
    let bytes = with.iter().chain(&without);
    let bytes = bytes.map(|(_, one)| one.result.len() + one.scores.len());
    let bytes = bytes.max().unwrap_or_default();
    let recurring = |sent: Vec<(u64, Sent)>| -> Result<Vec<(String, Vec<String>)>, Error> {
        let records = sent.iter().map(|(number, one)| one.record(*number));
        let records: Vec<FleetRecord> = records.collect::<Result<_, _>>()?;
        let found = summarise(&records, &FleetOptions::default())?.recurring;
        Ok(found
            .into_iter()
            .map(|one| (one.effect, one.alternatives))
            .collect())
    };
    let (with, without) = (recurring(with)?, recurring(without)?);
    let named = |(effect, alternatives): &(String, Vec<String>)| {
        effect == CAUSE || alternatives.iter().any(|other| other == CAUSE)
    };
    let seeds = format!("{FIRST}..{}", FIRST + units);
    let of = |figure: Figure| figure.over(units as usize, seeds.clone());
    Ok(vec![
        of(Figure::truth(
            "200 simulated records, `gyro_y.g_z` of 2.5 sigmas in a fifth of them: it alone recurs",
            with.len() == 1 && with.iter().all(named),
        )),
        of(Figure::truth(
            "the same records without it: nothing recurs",
            without.is_empty(),
        )),
        of(Figure::at_most(
            "result and scores of a record: most bytes that travel",
            200.0,
            bytes as f64 / 1e3,
            "kB",
        )),
    ])
}
