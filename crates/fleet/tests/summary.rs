//! Records of a fleet, from their diagnosis to what they show together.
#![cfg(test)]

use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_document::Standing;
use gyrocal_evaluation::inject_into;
use gyrocal_fleet::{
    Coefficient, FleetError, FleetOptions, FleetRecord, FleetResult, RecordName, from_bytes, prose,
    summarise, to_bytes,
};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Population, Scenario, simulate};

fn scenario() -> Scenario {
    let mut population = Population::new(5);
    population.duration_days = [2.0, 2.0];
    population.common.interval_s = 600.0;
    population.scenario(3)
}

/// What a record sends is small, is read back, and has the information of a projection of its own.
#[test]
fn scores_of_a_record_are_small_and_those_of_an_independent_projection() {
    let simulated = simulate(&scenario()).unwrap();
    let options = DiagnoseOptions::default();
    let diagnosed = diagnose(&simulated.record, &simulated.bench, &options).unwrap();
    let table = &diagnosed.scores;
    let bytes = to_bytes(table);
    let result = serde_json::to_string(&diagnosed.result).unwrap();
    assert!(
        bytes.len() + result.len() < 200_000,
        "{} {}",
        bytes.len(),
        result.len()
    );

    let read = from_bytes(&bytes).unwrap();
    assert_eq!(read.effects, table.effects);
    let difference = (&read.correlation - &table.correlation).amax();
    // Rounding of values below one to single precision.
    assert!(difference < 1e-7, "{difference}");

    let own = table
        .effects
        .iter()
        .find(|own| own.id == "gyro_y.g_z")
        .unwrap();
    assert!(own.persists && own.variants.len() == 1);
    let column = own.variants[0][0];
    // The size that another projection, with the same noise, finds to be of two sigmas.
    let effect = gyrocal::EFFECTS
        .iter()
        .find(|effect| effect.id == "gyro_y.g_z")
        .unwrap();
    let fitted = &diagnosed.nominal;
    let mut draw = Draw::new(1, 0);
    let cause = inject_into(&simulated, fitted, &[(effect, None)], 2.0, 1.0, &mut draw).unwrap();
    let size = cause.unwrap().remove(0).sizes[0];
    let strength = table.root_information[column] * size.abs();
    // Both are one number but for rounding of a projection.
    assert!((strength - 2.0).abs() < 1e-3, "{strength}");
    // Without a cause: five sigmas have a chance of 6e-7.
    assert!(table.z.iter().all(|z| z.abs() < 5.0));

    // A step has its onsets.
    let step = table
        .effects
        .iter()
        .find(|own| own.id == "gyro_x.step")
        .unwrap();
    assert!(!step.persists && step.variants.len() > 30);
    let name = RecordName::default();
    let again = FleetRecord::read(name.clone(), &result, Some(&bytes)).unwrap();
    let first = FleetRecord::new(name, &diagnosed.result, Some(read));
    assert_eq!(again, first);
    assert_eq!(again.coefficients.len(), 9);
}

fn record(unit: &str, record: &str, estimate: f64) -> FleetRecord {
    FleetRecord {
        name: RecordName {
            unit: unit.to_owned(),
            record: record.to_owned(),
            ..RecordName::default()
        },
        coefficients: vec![Coefficient {
            name: "gyro_x.bias".to_owned(),
            estimate,
            sigma: 0.1,
            unit: "deg/h".to_owned(),
        }],
        causes: vec!["gyro_x.g_y".to_owned()],
        is_settled: true,
        scores: None,
    }
}

fn three() -> Vec<FleetRecord> {
    vec![
        record("a", "1", 1.0),
        record("b", "1", 2.0),
        record("c", "1", 3.0),
    ]
}

#[test]
fn the_order_of_records_changes_nothing() {
    let options = FleetOptions::default();
    let mut records = three();
    let first = summarise(&records, &options).unwrap();
    records.reverse();
    assert_eq!(summarise(&records, &options).unwrap(), first);
    assert_eq!(first.found_in_units[0].units, ["a", "b", "c"]);
    let words = format!("{:?} {:?}", prose::all(&first), prose::coefficients(&first));
    // What is not settled or left out makes the first screen less sure.
    let screen = prose::first_screen(&first);
    assert_eq!(screen.standing, Standing::Good, "{screen:?}");
    let open = FleetResult {
        not_settled: 1,
        ..first.clone()
    };
    let screen = prose::first_screen(&open);
    assert_eq!(screen.standing, Standing::Doubtful, "{screen:?}");
    assert!(
        words.contains("3 units with 3 records") && words.contains("gyro_x.bias"),
        "{words}"
    );
}

#[test]
fn wrong_records_are_named_and_the_others_go_on() {
    let mut records = three();
    // The same name twice, a value that is none, a batch that changes, a unit with one record.
    records.push(record("a", "1", 9.0));
    records.push(record("d", "1", f64::NAN));
    let mut other = record("b", "2", 2.0);
    other.name.batch = Some("7".to_owned());
    records.push(other);
    let fleet = summarise(&records, &FleetOptions::default()).unwrap();
    let problems: Vec<(&str, &str)> = fleet
        .problems
        .iter()
        .map(|one| (one.unit.as_str(), one.record.as_str()))
        .collect();
    assert_eq!(problems, [("a", "1"), ("b", "2"), ("d", "1")]);
    assert!(
        fleet.problems[0]
            .problem
            .contains("two units with one name")
    );
    assert_eq!((fleet.units, fleet.records), (3, 3));
    let none = summarise(&records[4..5], &FleetOptions::default());
    assert!(matches!(none, Err(FleetError::NoRecords)));
    let options = FleetOptions {
        false_discovery_rate: 0.0,
        ..FleetOptions::default()
    };
    assert!(matches!(
        summarise(&records, &options),
        Err(FleetError::Probability { .. })
    ));
    // A single unit has no spread, and no error either.
    let one = summarise(&records[..1], &FleetOptions::default()).unwrap();
    assert!(one.coefficients[0].mean.is_none() && one.coefficients[0].levels.len() == 1);
}
