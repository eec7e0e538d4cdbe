//! The watch beside the filter: it finds the effects of an independent simulator with their size and
//! onset.
#![cfg(test)]

use gyrocal::watch::{Candidate, EFFECTS_BY_DEFAULT, PlatformWatch, WatchSettings};
use gyrocal::{ControllerError, FilterSettings, InitialAttitude, Limits, SavedNumber, Site};
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude as Declared, Scenario, simulate};

const INTERVAL_S: f64 = 60.0;
const ANGLES_DEG: [f64; 3] = [12.0, -25.0, 40.0];

fn scenario(days: f64, noise: f64, hidden: Vec<Hidden>) -> Scenario {
    Scenario {
        latitude_deg: 48.2,
        duration_s: days * 86_400.0,
        initial: Declared::AnglesDeg(ANGLES_DEG),
        coefficients: Coefficients {
            bias_deg_per_h: [0.3, -0.2, 0.1],
            ..Coefficients::NONE
        },
        accel_noise_g: noise * 1e-5,
        gyro_noise_deg_per_h: noise * 0.002,
        hidden,
        ..Scenario::default()
    }
}

fn started<T: SavedNumber>(scenario: &Scenario) -> PlatformWatch<T> {
    let number = T::from_f64;
    let mut watched = PlatformWatch::default();
    let angles_rad = scenario
        .declared_angles_deg()
        .map(|angle| number(angle.to_radians()));
    let attitude = InitialAttitude::Angles {
        angles_rad,
        sigma_rad: [number(0.01_f64.to_radians()); 3],
    };
    watched
        .start(
            &FilterSettings::at_site(Site::at_latitude_deg(scenario.latitude_deg)),
            &attitude,
            Limits::default(),
            &WatchSettings::default(),
        )
        .unwrap();
    watched
}

/// Runs a record; gives the row of the first alarm.
fn run<T: SavedNumber>(watched: &mut PlatformWatch<T>, scenario: &Scenario) -> Option<usize> {
    let record = simulate(scenario).unwrap().record;
    let samples: Vec<[T; 3]> = record.accel_g.iter().map(|g| g.map(T::from_f64)).collect();
    watched.update(&samples[0]).unwrap();
    let mut alarm = None;
    for (row, sample) in samples.iter().enumerate().skip(1) {
        let step = watched.step(T::from_f64(INTERVAL_S), sample).unwrap();
        if step.alarm.is_some() && alarm.is_none() {
            alarm = Some(row);
        }
    }
    alarm
}

fn candidate<T: SavedNumber>(watched: &PlatformWatch<T>, id: &str) -> Candidate<T> {
    let index = EFFECTS_BY_DEFAULT.iter().position(|effect| effect.id == id);
    watched.candidate(index.unwrap()).unwrap()
}

#[test]
fn sizes_are_those_of_the_simulator() {
    // Without noise the score over the information is the size, but for what is nonlinear or
    // approximated: courses are straight over an hour.
    let step = |size| Hidden::new("gyro_x.step", &[("size", size), ("onset_s", 345_600.0)]);
    let cases = [
        ("gyro_x.step", step(1e-3).unwrap(), 1e-3),
        (
            "gyro_y.g_x",
            Hidden::new("gyro_y.g_x", &[("size", 3e-3)]).unwrap(),
            3e-3,
        ),
        (
            "gyro_z.ramp",
            Hidden::new("gyro_z.ramp", &[("size", 1e-3)]).unwrap(),
            1e-3,
        ),
        (
            "accel_y.bias",
            Hidden::new("accel_y.bias", &[("size", 2e-5)]).unwrap(),
            2e-5,
        ),
    ];
    for (id, hidden, size) in cases {
        let plain = scenario(6.0, 0.0, vec![]);
        let mut sound = started::<f64>(&plain);
        run(&mut sound, &plain);
        let nothing = candidate(&sound, id);
        let with = scenario(6.0, 0.0, vec![hidden]);
        let mut watched = started::<f64>(&with);
        run(&mut watched, &with);
        let found = candidate(&watched, id);
        println!("{id} {found:?} {nothing:?}");
        assert!(found.deviance > 100.0 * nothing.deviance.max(0.1), "{id}");
        let ratio = found.estimate / size;
        assert!((ratio - 1.0).abs() < 0.02, "{id}: {ratio}");
    }
}

/// Runs rows of a record; gives the bits that filter and watch show after each.
fn shown<T: SavedNumber>(watched: &mut PlatformWatch<T>, samples: &[[T; 3]]) -> Vec<u64> {
    let mut bits = Vec::new();
    for sample in samples {
        let step = watched.step(T::from_f64(INTERVAL_S), sample).unwrap();
        let [effects, jumps] = watched.evidence();
        for number in [step.innovation.nis, effects, jumps] {
            bits.push(number.to_f64().to_bits());
        }
    }
    watched.candidates(|_, candidate| {
        bits.push(candidate.estimate.to_f64().to_bits());
        bits.push(candidate.sigma.to_f64().to_bits());
        bits.push(u64::from(candidate.steps_since));
    });
    bits
}

fn goes_on_after_a_reset<T: SavedNumber>() {
    let scenario = Scenario {
        duration_s: 1.3 * 86_400.0,
        ..Scenario::default()
    };
    let record = simulate(&scenario).unwrap().record;
    let samples: Vec<[T; 3]> = record
        .accel_g
        .iter()
        .map(|row| row.map(T::from_f64))
        .collect();
    let mut watched = started::<T>(&scenario);
    watched.update(&samples[0]).unwrap();
    // Not at the end of a block, and a walk is under way.
    let (before, after) = samples[1..].split_at(1_003);
    shown(&mut watched, before);
    let mut saved = vec![0; PlatformWatch::<T>::SAVED_BYTES];
    watched.save(&mut saved).unwrap();
    let mut other = started::<T>(&scenario);
    other.restore(&saved).unwrap();
    assert_eq!(shown(&mut watched, after), shown(&mut other, after));
    // A bit of any byte, and nothing has changed.
    let mut refused = started::<T>(&scenario);
    refused.restore(&saved).unwrap();
    for place in (0..saved.len()).step_by(97) {
        saved[place] ^= 4;
        let answer = refused.restore(&saved);
        assert!(answer.is_err_and(|error| error.is_refusal()), "{place}");
        saved[place] ^= 4;
    }
    assert!(refused.restore(&saved[1..]).is_err());
    let mut fresh = started::<T>(&scenario);
    fresh.restore(&saved).unwrap();
    assert_eq!(
        shown(&mut refused, &after[..200]),
        shown(&mut fresh, &after[..200])
    );
    let mut unset = PlatformWatch::<T>::unset(&EFFECTS_BY_DEFAULT);
    assert_eq!(unset.restore(&saved), Err(ControllerError::NotRunning));
    // The filter alone: the watch begins anew.
    let filter = &saved[..PlatformWatch::<T>::FILTER_BYTES];
    other.restore_filter(filter).unwrap();
    assert_eq!(other.evidence().map(|share| share.to_f64()), [0.0; 2]);
}

#[test]
fn filter_and_watch_go_on_after_a_reset_bit_by_bit() {
    goes_on_after_a_reset::<f32>();
    goes_on_after_a_reset::<f64>();
}

#[test]
fn the_grids_of_effects_and_of_jumps_share_one_probability() {
    let settings = WatchSettings::<f64>::default();
    let test = settings.of_test([1.0; 18]);
    // Halves are exact. The sum bounds the probability that either of both alarms.
    let both = test.budget.alpha + test.jump_budget.alpha;
    assert_eq!(both, settings.false_alarms_per_year);
    // Each threshold is that of its onsets in a year over its share.
    let onsets = [test.budget, test.jump_budget].map(|budget| budget.onsets_per_year);
    let (hours, steps) = (8_766.0, test.block_steps);
    assert_eq!(onsets[0], hours * 60.0 / f64::from(steps));
    assert_eq!(onsets[1], hours * 60.0 / f64::from(test.span_steps));
}
