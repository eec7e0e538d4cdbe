//! Terms that bend where the catalogue does not say.

use gyrocal_plant::{Extension, SearchOptions, diagnose};
use gyrocal_truth::plant::{Kind, Setting};

use crate::{loaded, oscillator, record};

/// A seed that nothing was tuned on.
const SEED: u64 = 74_000;

/// A stop of the oscillator at 0.8 m, where the search takes it to be at 0.5 m.
const STOP_M: f64 = 0.8;
const STIFFNESS: f64 = -2.0;

#[test]
fn a_stop_is_found_with_its_place() {
    let setting = Setting {
        hidden: ("v_rate.above(x)", STIFFNESS),
        knee: STOP_M,
        ..oscillator(SEED, 800, 0.0)
    };
    let plant = loaded(Kind::Duffing);
    let options = SearchOptions::default();
    let found = diagnose(&plant, record(&plant, &setting), None, &options);
    let answer = found.unwrap().answer;
    let words = gyrocal_words::plant::all(&answer);
    let [found] = answer.findings.as_slice() else {
        panic!("{words:?}");
    };
    assert_eq!(found.effect, "v_rate.above(x)", "{words:?}");
    // Twice the 95 % interval: a right one misses the truth in one of 10 000 records.
    for (name, truth) in [("size", STIFFNESS), ("knee", STOP_M)] {
        let own = found.parameters.iter().find(|own| own.name == name);
        let own = own.unwrap();
        let [low, high] = own.interval.as_ref().unwrap()[0];
        let twice = [low, high].map(|end| 2.0 * end - own.estimate);
        assert!(
            twice[0] < truth && truth < twice[1],
            "{name} {} {low} to {high}: {words:?}",
            own.estimate
        );
        // A stop that few rows reach may be of any stiffness, but at one place and of one sign.
        assert!(low * high > 0.0, "{name} {low} to {high}");
        assert!(
            name != "knee" || high - low < 0.3 * truth,
            "{low} to {high}"
        );
    }
    let extension = Extension::of(&plant, &answer);
    let script = extension.script("plant.write()\n", "plant.py").unwrap();
    let call = script.lines().next().unwrap_or_default();
    assert!(
        call.starts_with("plant.extend(\"v_rate.above(x)\", -") && call.contains(", knee=0."),
        "{script}"
    );
}
