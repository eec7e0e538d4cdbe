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
    // Four standard deviations: a right interval misses it in one of 16 000 records.
    for (name, truth) in [("size", STIFFNESS), ("knee", STOP_M)] {
        let own = found.parameters.iter().find(|own| own.name == name);
        let own = own.unwrap();
        let sigma = own.sigma.unwrap();
        let off = (own.estimate - truth).abs();
        assert!(
            off < 4.0 * sigma,
            "{name} {} ± {sigma}: {words:?}",
            own.estimate
        );
        assert!(
            sigma < 0.2 * truth.abs(),
            "{name} {} ± {sigma}: {words:?}",
            own.estimate
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
