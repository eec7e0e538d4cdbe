//! Forecasts of runs of an oscillator, and the gain within records, beside what other fits give.

use gyrocal_answer::{Answer, Coefficients, Finding, NextRun, write_text};
use gyrocal_hypothesis::FittedModel as _;
use gyrocal_plant::{
    ColumnMap, Diagnosed, FittedPlant, LoadedPlant, NamedRecord, PlantRecord, SearchOptions,
    diagnose, diagnose_records,
};
use gyrocal_truth::plant::Kind;

use crate::{loaded, oscillator};

const ROWS: usize = 400;

/// The oscillator from one initial state; the seed is that of its input and of its noise.
fn record(plant: &LoadedPlant, seed: u64, size: f64) -> PlantRecord {
    crate::record(plant, &oscillator(seed, ROWS, size))
}

fn named(name: &str, record: PlantRecord) -> NamedRecord {
    NamedRecord {
        name: name.to_owned(),
        record,
    }
}

fn alone(plant: &LoadedPlant, record: &PlantRecord) -> Diagnosed {
    diagnose(plant, record.clone(), None, &SearchOptions::default()).unwrap()
}

fn together(plant: &LoadedPlant, records: [&PlantRecord; 2]) -> Answer {
    let records = records.map(|record| named("", record.clone())).to_vec();
    let found = diagnose_records(plant, records, None, &SearchOptions::default());
    found.unwrap().together.answer
}

/// The forecast of one run.
fn forecast(diagnosed: &mut Diagnosed, run: &PlantRecord) -> NextRun {
    diagnosed
        .forecast(vec![named("next", run.clone())])
        .unwrap();
    diagnosed.answer.next_runs[0].clone()
}

#[test]
fn standard_deviations_after_the_run_are_as_forecast() {
    let plant = loaded(Kind::Duffing);
    let [first, second] = [41, 42].map(|seed| record(&plant, seed, -0.05));
    let mut diagnosed = alone(&plant, &first);
    let forecast = forecast(&mut diagnosed, &second);
    let found = together(&plant, [&first, &second]);
    assert_eq!(
        found.findings[0].effect,
        diagnosed.answer.findings[0].effect
    );
    for (one, predicted) in found
        .coefficients
        .iter()
        .flat_map(Coefficients::best)
        .zip(&forecast.sigmas)
    {
        assert_eq!(one.name, predicted.name);
        assert!(predicted.after < predicted.now);
        let ratio = one.sigma / predicted.after;
        // Noise levels are estimated from 400 rows, to 4 % each time, and sensitivities are about estimates.
        assert!((0.88..1.12).contains(&ratio), "{} {ratio}", one.name);
    }
    let size = forecast.sigmas.last().unwrap();
    let found = found.findings[0].parameters[0].sigma.unwrap();
    assert!(
        (0.88..1.12).contains(&(found / size.after)),
        "{size:?} {found}"
    );
}

#[test]
fn the_run_that_moves_more_comes_first() {
    let plant = loaded(Kind::Duffing);
    let first = record(&plant, 41, -0.05);
    let mut diagnosed = alone(&plant, &first);
    let scaled = |factor: f64| {
        let mut run = record(&plant, 43, -0.05);
        run.inputs.iter_mut().for_each(|input| *input *= factor);
        run
    };
    let runs = [("less", 0.1), ("more", 1.0)];
    let runs = runs.map(|(name, factor)| named(name, scaled(factor)));
    diagnosed.forecast(runs.to_vec()).unwrap();
    let [best, other] = diagnosed.answer.next_runs.as_slice() else {
        panic!("two runs")
    };
    assert_eq!((best.name.as_str(), other.name.as_str()), ("more", "less"));
    assert!(gyrocal_words::plant::mean_ratio(best) < gyrocal_words::plant::mean_ratio(other));
    write_text(&diagnosed.answer).unwrap();
    let last = gyrocal_words::plant::all(&diagnosed.answer).pop().unwrap();
    assert!(last.starts_with("less (400 rows,"), "{last}");
}

#[test]
fn rivals_leave_as_often_as_forecast() {
    let plant = loaded(Kind::Duffing);
    let (mut expected, mut variance, mut seen, mut pairs) = (0.0, 0.0, 0.0, 0);
    for seed in 0..24 {
        let [first, second] = [800 + seed, 900 + seed].map(|seed| record(&plant, seed, SMALL));
        let mut diagnosed = alone(&plant, &first);
        let forecast = forecast(&mut diagnosed, &second);
        if forecast.told_apart.is_empty() {
            continue;
        }
        let found = together(&plant, [&first, &second]);
        for pair in &forecast.told_apart {
            let both = |one: &Finding| {
                let names = [&pair.effect, &pair.alternative];
                names.iter().all(|name| one.set().any(|id| id == *name))
            };
            seen += f64::from(u8::from(!found.findings.iter().any(both)));
            expected += pair.probability;
            variance += pair.probability * (1.0 - pair.probability);
            pairs += 1;
        }
    }
    println!("{pairs} pairs: {seen} told apart, {expected:.1} expected");
    assert!(pairs >= 10, "{pairs}");
    // Pairs of one record go together: three at a time, so that their variance is three times that of single
    // ones. One in a thousand is farther off.
    assert!(
        (seen - expected).abs() < 3.3 * (3.0 * variance).sqrt().max(1.0),
        "{seen} {expected}"
    );
}

/// Of the cube of the displacement: some eight standard deviations in a record.
const SMALL: f64 = -0.006;

/// Logarithm of the density of what a fit is to, up to what two models with the same noise have in common.
fn log_evidence(fitted: &FittedPlant) -> f64 {
    0.5 * (fitted.covariance().determinant().ln() - fitted.deviance())
}

#[test]
fn the_gain_in_a_left_out_record_is_that_of_fits_without_it() {
    let plant = loaded(Kind::Duffing);
    let records = [41, 42].map(|seed| record(&plant, seed, -0.05));
    let both = records.clone().map(|record| named("", record)).to_vec();
    let found = diagnose_records(&plant, both, None, &SearchOptions::default()).unwrap();
    let Diagnosed {
        answer, searched, ..
    } = found.together;
    let noise = searched.fitted.rate_noise();
    let with = log_evidence(&searched.fitted);
    let without = log_evidence(&searched.nominal.with_rate_noise(&noise).unwrap());
    let gains = answer.gain.unwrap().block_log_score_nats;
    for (gain, other) in gains.iter().zip(records.into_iter().rev()) {
        let nominal = FittedPlant::nominal(&plant, other, &[]).unwrap();
        let nominal = nominal.with_rate_noise(&noise).unwrap();
        let extended = nominal.refitted(searched.fitted.extension()).unwrap();
        let expected = with - log_evidence(&extended) - without + log_evidence(&nominal);
        // One is linearised about the fit to both: the nominal one moves by several sigmas without the other.
        let ratio = gain.unwrap() / expected;
        assert!((0.9..1.1).contains(&ratio), "{gain:?} {expected}");
    }
}

#[test]
fn parts_of_a_record_gain_by_what_is_there_and_nothing_is_said_of_nothing() {
    let plant = loaded(Kind::Duffing);
    let Diagnosed {
        answer, searched, ..
    } = alone(&plant, &record(&plant, 41, -0.05));
    let parts = answer.gain.as_ref().unwrap();
    assert_eq!(parts.block_log_score_nats.len(), 6);
    // What is left out is farther from the nominal model than what it was fitted to.
    let nominal = searched
        .nominal
        .with_rate_noise(&searched.fitted.rate_noise());
    let in_fit = 0.5 * (nominal.unwrap().deviance() - searched.fitted.deviance());
    assert!(
        parts.cross_validated_log_score_nats > in_fit,
        "{parts:?} {in_fit}"
    );
    assert!(
        parts
            .block_log_score_nats
            .iter()
            .flatten()
            .all(|gain| *gain > 0.0)
    );
    let words = gyrocal_words::plant::parts(parts);
    assert!(words.contains("what was found holds there"), "{words}");
    let clean = alone(&plant, &record(&plant, 41, 0.0)).answer;
    assert_eq!(clean.gain, None);
}

#[test]
fn a_run_needs_no_outputs_and_one_that_the_plant_does_not_bear_is_told() {
    let plant = loaded(Kind::Duffing);
    let folder = tempfile::tempdir().unwrap();
    let map = folder.path().join("columns.toml");
    std::fs::write(
        &map,
        "[time]\ncolumn = \"t\"\n[inputs]\nu = \"f\"\n[outputs]\ny = \"x\"\n",
    )
    .unwrap();
    let write = |force: f64| {
        let file = folder.path().join("run.csv");
        let rows = (0..ROWS).map(|row| format!("{},{force}\n", 0.05 * row as f64));
        std::fs::write(&file, format!("t,f\n{}", rows.collect::<String>())).unwrap();
        file
    };
    let map = ColumnMap::read(&map).unwrap();
    let mut diagnosed = alone(&plant, &record(&plant, 41, -0.05));
    let run = map.run(plant.description(), &write(0.5)).unwrap();
    assert_eq!(run.outputs.len(), ROWS);
    diagnosed.forecast(vec![named("steady", run)]).unwrap();
    let run = map.run(plant.description(), &write(1e200)).unwrap();
    let error = diagnosed.forecast(vec![named("huge", run)]).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("huge: the model gives no finite numbers"),
        "{error}"
    );
}
