//! Records that no model fits: what is said of them, and what that may cost.

use gyrocal_answer::{Answer, Verdict};
use gyrocal_calibration::work;
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, simulate};
use gyrocal_words::{first_screen, may_also_be};

/// The diagnosis of a day of two-minute means with effects hidden, and its work.
fn diagnosed(seed: u64, hidden: Vec<Hidden>) -> (Answer, u64) {
    let simulation = simulate(&Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::Random,
        duration_s: 86_400.0,
        interval_s: 120.0,
        hidden,
        ..Scenario::default()
    })
    .unwrap();
    let before = work();
    let options = DiagnoseOptions::default();
    let found = diagnose(&simulation.record, &simulation.bench, &options);
    (found.unwrap().result, work() - before)
}

/// Knocks from a thousandth of a degree to a degree, at random times.
fn knocks(count: usize) -> Vec<Hidden> {
    let mut random = Draw::new(7, 0);
    let knock = |_| {
        let size = random.log_uniform([1e-3, 1.0]);
        let [x, y, z] = [0; 3].map(|_| size * random.normal());
        let onset_s = 86_400.0 * random.uniform();
        Hidden::new(
            "platform.knock",
            &[
                ("x_deg", x),
                ("y_deg", y),
                ("z_deg", z),
                ("onset_s", onset_s),
            ],
        )
        .unwrap()
    };
    (0..count).map(knock).collect()
}

/// Most work over that of a sound record: the limit of the figures.
const LIMIT: u64 = 20;

#[test]
fn thirty_knocks_take_no_more_than_the_limit() {
    let (_, of_sound) = diagnosed(1, Vec::new());
    let found = [1, 2, 3, 4].map(|seed| diagnosed(seed, knocks(30)));
    for (found, work) in &found {
        assert!(*work <= LIMIT * of_sound, "{work} over {of_sound}");
        assert!(found.causes().count() > 0);
    }
}

/// It is said where the search ended before it was complete, and the coverage of its sets is then not stated.
#[test]
fn a_cut_search_is_told() {
    let (mut cut, _) = diagnosed(1, knocks(30));
    cut.search_complete = false;
    cut.verdict = Verdict::NotSettled;
    let cut = &cut;
    let set = may_also_be(cut);
    assert!(!set.contains(" at 9"), "{set}");
    let facts = first_screen(cut).facts;
    assert!(facts.iter().any(|fact| fact.label == "search"), "{facts:?}");
}

/// A cut search that named nothing is not settled, whatever its residuals.
#[test]
fn a_cut_search_without_a_name_contradicts_nothing() {
    let (mut found, _) = diagnosed(1, Vec::new());
    assert_eq!(found.verdict, Verdict::Clean);
    found.search_complete = false;
    found.verdict = Answer::judged(&found.findings, &found.remainder, found.search_complete);
    let screen = first_screen(&found);
    assert_eq!(screen.verdict, "NOT SETTLED");
    assert!(!screen.what.contains("contradicts"), "{}", screen.what);
}

#[test]
fn walks_of_all_gyros_are_found_without_effects_that_stand_for_them() {
    let (_, of_sound) = diagnosed(1, Vec::new());
    let walks = [
        "gyro_x.random_walk",
        "gyro_y.random_walk",
        "gyro_z.random_walk",
    ];
    for seed in 1..5 {
        let hidden = walks.map(|walk| Hidden::new(walk, &[("size", 2e-3)]).unwrap());
        let (found, work) = diagnosed(seed, hidden.to_vec());
        let names: Vec<&str> = found.causes().map(|cause| cause.effect.as_str()).collect();
        assert!(!names.is_empty(), "seed {seed}");
        assert!(names.iter().all(|name| walks.contains(name)), "{names:?}");
        assert!(work <= LIMIT * of_sound, "{work} over {of_sound}");
    }
}
