//! Records whose noise is not white: what a search in white noise names is judged beside all noise.

use gyrocal_answer::{Answer, NoiseKind};
use gyrocal_plant::{LoadedPlant, PlantRecord, SearchOptions, diagnose};
use gyrocal_truth::plant::{Kind, Setting, Stream, simulate, with_strength};

use crate::{loaded, prepared, record};

/// Seeds that nothing was tuned on.
const FIRST_SEED: u64 = 73_000;

const ROWS: usize = 600;

fn diagnosed(plant: &LoadedPlant, record: PlantRecord) -> Answer {
    let options = SearchOptions::default();
    diagnose(plant, record, None, &options).unwrap().answer
}

#[test]
fn sound_plants_with_correlated_readings_lack_nothing() {
    for (kind, correlation) in [(Kind::Duffing, 0.5), (Kind::Servo, 0.9)] {
        let plant = loaded(kind);
        for seed in FIRST_SEED..FIRST_SEED + 3 {
            let mut setting = Setting::random(kind, seed, ROWS);
            setting.hidden = ("noise.correlation", correlation);
            let answer = diagnosed(&plant, record(&plant, &setting));
            let names: Vec<&str> = answer.findings.iter().map(|one| &*one.effect).collect();
            assert!(names.is_empty(), "{kind:?} {seed}: {names:?}");
            let mut told = answer.undeclared_noise.iter();
            let told = told.find(|one| one.kind == NoiseKind::Correlated);
            let told = told.expect("correlation of readings is told");
            let facts = kind.facts();
            // Five standard deviations of each: (1 - φ²) / n of the square of a correlation estimated from n rows,
            // and (1 + φ²) / (1 - φ²) / 2 n of the square of the logarithm of a deviation.
            let rows = ROWS as f64;
            let kept = (-facts.step_s / told.time_s.unwrap()).exp();
            let squared = correlation * correlation;
            let far = 5.0 * ((1.0 - squared) / rows).sqrt();
            assert!((kept - correlation).abs() < far, "{kind:?} {seed}: {kept}");
            let ratio = (told.sigma / facts.sigmas[0]).ln().abs();
            let far = 5.0 * ((1.0 + squared) / (1.0 - squared) / (2.0 * rows)).sqrt();
            assert!(ratio < far, "{kind:?} {seed}: {}", told.sigma);
            let words = gyrocal_words::plant::all(&answer).join(" ");
            assert!(words.contains("correlated over"), "{words}");
        }
    }
}

#[test]
fn an_effect_is_named_beside_correlated_readings() {
    let plant = loaded(Kind::Duffing);
    let mut setting = Setting::random(Kind::Duffing, FIRST_SEED + 10, ROWS);
    setting.hidden = ("v_rate.x u", 0.02);
    let setting = with_strength(&setting, 40.0);
    let quiet = Setting {
        noise: 0.0,
        ..setting.clone()
    };
    let mut run = simulate(&quiet, None);
    let (correlation, mut error) = (0.8_f64, 0.0);
    let mut noise = Stream::new(setting.seed, 12);
    for reading in run.outputs.iter_mut().flatten() {
        error = correlation * error + (1.0 - correlation * correlation).sqrt() * noise.normal();
        *reading += setting.kind.facts().sigmas[0] * error;
    }
    let answer = diagnosed(&plant, prepared(&plant, run));
    let [found] = &answer.findings[..] else {
        panic!("{:?}", gyrocal_words::plant::all(&answer));
    };
    assert!(found.set().any(|id| id == setting.hidden.0), "{found:?}");
    // Of 40 deviations of white noise a correlation of 0.8 leaves at most as much as its spectrum lets through.
    assert!(found.z < 40.0, "{}", found.z);
    assert!(!answer.undeclared_noise.is_empty());
}
