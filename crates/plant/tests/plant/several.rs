//! Several records of one oscillator: information adds, initial states are those of each record.

use std::time::{Duration, Instant};

use gyrocal_answer::write_text;
use gyrocal_hypothesis::{FittedModel as _, Stop};
use gyrocal_plant::{
    FittedPlant, LoadedPlant, NamedRecord, PlantError, PlantRecord, SearchOptions, compare,
    diagnose, diagnose_records, fit, simulate,
};
use gyrocal_truth::plant::{Kind, Setting};
use nalgebra::DMatrix;

use crate::{loaded, oscillator};

const ROWS: usize = 400;

/// Initial states of the records.
const STARTS: [[f64; 2]; 3] = [[0.2, -0.4], [-1.1, 0.9], [0.7, 1.5]];

/// Of the oscillator: two states, three parameters.
const STATES: usize = 2;

fn record(plant: &LoadedPlant, index: usize, size: f64) -> NamedRecord {
    let setting = Setting {
        initial: STARTS[index].to_vec(),
        ..oscillator(610 + index as u64, ROWS, size)
    };
    NamedRecord {
        name: format!("record {index}"),
        record: crate::record(plant, &setting),
    }
}

fn records(plant: &LoadedPlant, size: f64) -> Vec<NamedRecord> {
    (0..STARTS.len())
        .map(|index| record(plant, index, size))
        .collect()
}

/// Information on the parameters, initial states unknown.
fn information(fitted: &FittedPlant) -> DMatrix<f64> {
    let covariance = fitted.covariance();
    let count = covariance.nrows() - STATES;
    let own = covariance
        .view((STATES, STATES), (count, count))
        .into_owned();
    own.try_inverse().unwrap()
}

#[test]
fn a_job_that_is_stopped_has_no_answer() {
    let plant = loaded(Kind::Duffing);
    let records = records(&plant, 0.05);
    let options = SearchOptions::default();
    let is_stopped = |error: Option<PlantError>| {
        assert!(matches!(error, Some(PlantError::Stopped(_))), "{error:?}");
    };
    let one = || records[0].clone();
    let of_one = || diagnose(&plant, one().record, None, &options);
    // At once, and while it searches: a whole diagnosis takes far longer.
    for after_s in [0.0, 0.05] {
        let stop = Stop::default();
        std::thread::scope(|scope| {
            let asked = scope.spawn(|| {
                std::thread::sleep(Duration::from_secs_f64(after_s));
                stop.ask();
                Instant::now()
            });
            is_stopped(stop.over(of_one).err());
            assert!(asked.join().unwrap().elapsed() < Duration::from_secs(1));
        });
    }
    let stop = Stop::default();
    stop.ask();
    stop.over(|| {
        is_stopped(diagnose_records(&plant, records.clone(), None, &options).err());
        is_stopped(FittedPlant::nominal(&plant, one().record, &[]).err());
        is_stopped(simulate(&plant, one(), None).err());
        let both = [("one", plant.clone()), ("other", plant.clone())];
        let both = both.map(|(name, plant)| (name.to_owned(), plant));
        let read = |_: &_| Ok((one(), None));
        is_stopped(compare(&both, read, 0, &mut |_, _| ()).err());
    });
    for at in ["parameters", "noise", "left-out parts", "later record"] {
        let stop = Stop::default();
        let mut told = |stage: &'static str, _| {
            if stage == at {
                stop.ask();
            }
        };
        let later = Some(records[1].clone());
        is_stopped(stop.over(|| fit(&plant, one(), later, 0, &mut told)).err());
    }
    let mut found = of_one().unwrap();
    is_stopped(stop.over(|| found.forecast(vec![one()])).err());
}

#[test]
fn the_information_of_the_records_adds() {
    let plant = loaded(Kind::Duffing);
    let records: Vec<PlantRecord> = records(&plant, 0.0)
        .into_iter()
        .map(|one| one.record)
        .collect();
    let alone = records
        .iter()
        .map(|record| FittedPlant::nominal(&plant, record.clone(), &[]).unwrap());
    let alone: Vec<FittedPlant> = alone.collect();
    let joined = PlantRecord::joined(&records);
    assert_eq!(joined.len(), 3 * ROWS);
    assert!((joined.duration_s() - 3.0 * records[0].duration_s()).abs() < 1e-9);
    let together = FittedPlant::nominal(&plant, joined, &[]).unwrap();
    let sum: DMatrix<f64> = alone.iter().map(information).sum();
    let found = information(&together);
    for i in 0..sum.nrows() {
        for j in 0..sum.ncols() {
            let scale = (sum[(i, i)] * sum[(j, j)]).sqrt();
            // The fits linearise about estimates that differ by their sigmas, some 1e-3 of the values.
            let error = (found[(i, j)] - sum[(i, j)]).abs() / scale;
            assert!(error < 0.02, "{i} {j}: {error}");
        }
    }
    for (found, truth) in together.initial_states().iter().zip(STARTS) {
        for ([value, sigma], truth) in found.iter().zip(truth) {
            assert!(
                (value - truth).abs() < 4.5 * sigma,
                "{value} ± {sigma}, {truth}"
            );
        }
    }
}

#[test]
fn a_record_that_is_cut_is_the_record_but_for_what_begins_anew() {
    // The states at the cut are free: no fit to the parts is worse, and with two more unknowns it is better by
    // chi-square with two degrees of freedom.
    let plant = loaded(Kind::Duffing);
    let whole = record(&plant, 0, 0.0).record;
    let middle = ROWS / 2;
    let part = |rows: std::ops::Range<usize>| PlantRecord {
        time_s: whole.time_s[rows.clone()].to_vec(),
        inputs: whole.inputs[rows.clone()].to_vec(),
        outputs: whole.outputs[rows].to_vec(),
        ..PlantRecord::default()
    };
    let cut = PlantRecord::joined(&[part(0..middle), part(middle..ROWS)]);
    let cut = FittedPlant::nominal(&plant, cut, &[]).unwrap();
    let whole = FittedPlant::nominal(&plant, whole.clone(), &[]).unwrap();
    let gain = whole.deviance() - cut.deviance();
    // The prior of the second part's initial states adds at most some tenths; 18 is exceeded in 1e-4.
    assert!((-1.0..18.0).contains(&gain), "{gain}");
    let states = |fitted: &FittedPlant| fitted.points()[STATES * (ROWS - 1)..].to_vec();
    for (one, other) in states(&whole).iter().zip(states(&cut)) {
        // The sensor's noise is 0.01.
        assert!((one - other).abs() < 0.02, "{one} {other}");
    }
}

#[test]
fn an_effect_is_found_together_and_told_for_each() {
    let plant = loaded(Kind::Duffing);
    let records = records(&plant, -0.05);
    let options = SearchOptions::default();
    let found = diagnose_records(&plant, records.clone(), None, &options).unwrap();
    let answer = &found.together.answer;
    assert_eq!(
        answer.findings.len(),
        1,
        "{:?}",
        gyrocal_words::plant::all(answer)
    );
    let own = &answer.findings[0];
    assert_eq!(own.effect, "v_rate.x^3");
    let size = &own.parameters[0];
    assert!(
        (size.estimate + 0.05).abs() < 4.0 * size.sigma.unwrap(),
        "{size:?}"
    );
    // Information on an effect with the parameters projected out is at least the sum of that of each record: what
    // parameters take up in one is known from another. In the third the oscillator moves too little to show it.
    let alone: Vec<f64> = found
        .alone
        .iter()
        .flat_map(|one| &one.as_ref().unwrap().answer.findings)
        .map(|one| one.z)
        .collect();
    assert_eq!(alone.len(), 2);
    let sum: f64 = alone.iter().map(|z| z * z).sum();
    // A tenth for the errors of the sizes alone, some sigmas of 82.
    assert!(own.z * own.z > 0.9 * sum, "{} {alone:?}", own.z);
    assert_eq!(answer.records.len(), 3);
    write_text(answer).unwrap();
    for one in &answer.records {
        assert_eq!(one.initial.as_ref().unwrap().nominal.len(), STATES);
        // The noise of the sensor, 0.01 m, is left.
        assert!(one.open_loop[0].extended.unwrap() < 0.0115, "{one:?}");
    }
    let verdicts = answer.records.iter().map(gyrocal_words::plant::alone);
    let found_alone: Vec<bool> = verdicts
        .map(|one| one.contains("lacks one effect"))
        .collect();
    assert_eq!(found_alone, [true, true, false]);
    assert_eq!(
        answer.coefficients.as_ref().unwrap().nominal.len(),
        3,
        "initial states are those of each record"
    );
    assert_eq!(found.together.series().len(), 3);
}

#[test]
fn one_record_is_as_alone_and_a_change_belongs_to_its_record() {
    let plant = loaded(Kind::Duffing);
    let mut one = record(&plant, 0, 0.0);
    let options = SearchOptions::default();
    let alone = diagnose(&plant, one.record.clone(), None, &options).unwrap();
    let single = diagnose_records(&plant, vec![one.clone()], None, &options).unwrap();
    assert_eq!(single.together.answer, alone.answer);
    // A sensor that jumps within the second record.
    let first = record(&plant, 1, 0.0);
    for value in &mut one.record.outputs[ROWS / 2..] {
        *value += 0.05;
    }
    let onset_s = one.record.time_s[ROWS / 2] - one.record.time_s[0];
    let answer = diagnose_records(&plant, vec![first, one], None, &options)
        .unwrap()
        .together
        .answer;
    let found = &answer.findings[0];
    assert_eq!(
        (found.effect.as_str(), found.in_record),
        ("y.step", Some(2)),
        "{found:?}"
    );
    let onset = found.parameter("onset_s").unwrap();
    // A step of five standard deviations of a reading is seen within a few rows.
    assert!(
        (onset.estimate - onset_s).abs() < 0.5,
        "{onset:?} {onset_s}"
    );
}

#[test]
fn records_with_common_rows_are_refused() {
    let plant = loaded(Kind::Duffing);
    let one = record(&plant, 0, 0.0);
    let copy = NamedRecord {
        name: "copy".to_owned(),
        ..one.clone()
    };
    let options = SearchOptions::default();
    let refused = diagnose_records(&plant, vec![one, copy], None, &options);
    let Err(error) = refused else {
        panic!("two equal records are diagnosed");
    };
    assert!(error.to_string().contains("would count twice"), "{error}");
}
