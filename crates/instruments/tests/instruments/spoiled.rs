//! Multi-position tests of logs of which a part is spoiled.

use std::fmt::Write as _;

use gyrocal_instruments::multi_position::{PreparedTest, prepare};
use gyrocal_instruments::{Description, InstrumentError, Log, StopSettings, Unfit, find_stops};
use nalgebra::Matrix3;

use crate::common::{Unit, stops_and_turns};

const STOPS: usize = 16;

fn description() -> Description {
    let text = "[time]\nrate_hz = 100\n[gyro]\ncolumns = [\"a\", \"b\", \"c\"]\nunit = \"rad/s\"\n\
                [accel]\ncolumns = [\"d\", \"e\", \"f\"]\nunit = \"g\"\n";
    Description::parse(text, "log.toml").unwrap()
}

fn prepared(log: &Log) -> Result<PreparedTest, InstrumentError> {
    let stops = find_stops(log, &StopSettings::default())?;
    prepare(log, &description(), &stops)
}

fn text(log: &Log) -> String {
    let mut text = "a,b,c,d,e,f\n".to_owned();
    for (gyro, force) in log.gyro.iter().zip(log.accel.as_ref().unwrap()) {
        let [a, b, c] = gyro;
        let [d, e, f] = force;
        let _ = writeln!(text, "{a},{b},{c},{d},{e},{f}");
    }
    text
}

#[test]
fn a_saturated_turn_is_left_out_and_told() {
    let unit = Unit {
        gyro_matrix: Matrix3::new(1.004, 2e-3, 0.0, 0.0, 0.997, 1e-3, -3e-3, 0.0, 1.002),
        ..Unit::mems()
    };
    // The fastest turn about x clips at nine tenths, and the others are slower: a seed of such turns.
    let with_one_fast = |seed: u64| {
        let log = stops_and_turns(STOPS, &unit, seed);
        let size = |sample: &usize| log.gyro[*sample][0];
        let fastest = (0..log.len()).max_by(|a, b| size(a).total_cmp(&size(b)))?;
        let end = 0.9 * size(&fastest);
        let mut others = (0..log.len()).filter(|sample| sample.abs_diff(fastest) > 200);
        others
            .all(|other| size(&other) < end)
            .then_some((log, fastest, end))
    };
    let (mut log, fastest, end) = (0..100).find_map(with_one_fast).unwrap();
    let size = |sample: &usize| log.gyro[*sample][0];
    let clipped = (0..log.len()).filter(|sample| size(sample) >= end).count();
    for rate in &mut log.gyro {
        rate[0] = rate[0].min(end);
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    std::fs::write(&path, text(&log)).unwrap();
    assert!(Log::read(&path, &description()).is_err());
    let read = Log::read_for_stops(&path, &description()).unwrap();
    let test = prepared(&read).unwrap();
    assert_eq!(test.stops.len(), STOPS);
    let [turn] = &test.saturated_turns[..] else {
        panic!("{:?}", test.saturated_turns);
    };
    assert_eq!((&*turn.column, turn.end, turn.samples), ("a", end, clipped));
    let [from_s, to_s] = [turn.from_s, turn.to_s];
    let fastest_s = read.time_s[fastest];
    // Two seconds of a turn and half a second at the end of each stop, which begin and end slowly.
    assert!(
        from_s < fastest_s && fastest_s < to_s && to_s - from_s < 3.5,
        "{turn:?}"
    );
    assert!(turn.first_sample <= fastest + 1 && fastest < turn.first_sample + clipped);
    let turns = test.turns.as_ref().unwrap();
    assert_eq!(turns.turns, STOPS - 2);
    let truth = unit.gyro_matrix.try_inverse().unwrap();
    for row in 0..3 {
        for column in 0..3 {
            // Nine estimates: the largest is below 4 sigma with 99.9 %.
            let error = turns.matrix[row][column] - truth[(row, column)];
            assert!(
                error.abs() < 4.0 * turns.sigma[row][column],
                "{row} {column}"
            );
        }
    }
    // Written as a result for programs, too.
    let json = serde_json::to_value(test.sensors()).unwrap();
    assert_eq!(json["saturated_turns"][0]["samples"], clipped);
    // A stop with such samples has no mean.
    let mut in_stop = read;
    in_stop.saturated[0].samples = 1000..1020;
    let error = prepared(&in_stop).unwrap_err();
    assert_eq!(error.kind(), Some(Unfit::Saturated), "{error}");
    assert!(error.to_string().contains("in the stop from"), "{error}");
}

#[test]
fn axes_that_few_turns_contradict_are_told() {
    // Three turns.
    let log = stops_and_turns(4, &Unit::mems(), 6);
    let kind = |log: &Log| prepared(log).err().and_then(|error| error.kind());
    assert_eq!(kind(&log), None);
    let mut reversed = log.clone();
    for rate in &mut reversed.gyro {
        *rate = rate.map(|component| -component);
    }
    assert_eq!(kind(&reversed), Some(Unfit::Axes));
    let mut one = log;
    for force in one.accel.as_mut().unwrap() {
        force[1] = -force[1];
    }
    assert_eq!(kind(&one), Some(Unfit::Axes));
}

#[test]
fn wild_samples_of_stops_are_left_out_and_told() {
    let log = stops_and_turns(STOPS, &Unit::mems(), 4);
    let mut wild = log.clone();
    // In the second stop.
    wild.gyro[900][1] = -34.9;
    wild.gyro[910][2] = 20.0;
    let sound = prepared(&log.clone().without_bad_samples(true)).unwrap();
    assert!(sound.bad_samples.is_empty(), "{:?}", sound.bad_samples);
    let test = prepared(&wild.without_bad_samples(true)).unwrap();
    let told = test.bad_samples.iter();
    let told: Vec<_> = told
        .map(|one| (&*one.gyro, one.samples[0].sample))
        .collect();
    assert_eq!(told, [("gyro_y", 901), ("gyro_z", 911)]);
    assert_eq!(test.stops.len(), STOPS);
    for (stop, sound) in test.stops.iter().zip(&sound.stops) {
        for axis in 0..3 {
            // A median in the place of one sample of 400.
            let off = (stop.gyro[axis] - sound.gyro[axis]).abs();
            assert!(off < 0.5 * sound.gyro_sigma[axis], "{off}");
        }
    }
    let [of_wild, of_sound] = [test, sound].map(|test| test.turns.unwrap());
    assert!(of_wild.gravity_rms_g < 1.1 * of_sound.gravity_rms_g);
    let json = serde_json::to_value(prepared(&log).unwrap().sensors()).unwrap();
    assert!(json.get("bad_samples").is_none());
}

#[test]
fn a_gyro_that_stands_still_at_a_stop_is_told() {
    let log = stops_and_turns(STOPS, &Unit::mems(), 3);
    let stops = find_stops(&log, &StopSettings::default()).unwrap();
    // 80 samples in the middle of the sixth stop.
    let first = stops[5].start + 100;
    let mut still = log.clone();
    for sample in first + 1..first + 80 {
        still.gyro[sample][1] = still.gyro[first][1];
    }
    let error = prepare(&still, &description(), &stops).unwrap_err();
    assert_eq!(error.kind(), Some(Unfit::Stuck));
    let told = error.to_string();
    let place = format!(
        "gyro_y with the same output in 80 samples from sample {}",
        first + 1
    );
    assert!(
        told.contains(&place) && told.contains("at stop 6"),
        "{told}"
    );
    // A gyro whose steps are as large as its noise repeats values at every stop.
    let mut coarse = log.clone();
    for rate in &mut coarse.gyro {
        rate[1] = (rate[1] / 0.02).round() * 0.02;
    }
    assert!(prepare(&coarse, &description(), &stops).is_ok());
    assert!(prepare(&log, &description(), &stops).is_ok());
}
