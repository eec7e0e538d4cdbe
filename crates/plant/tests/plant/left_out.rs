//! Records whose rest is not white: parts that are left out of the fit judge names.

use gyrocal_plant::{SearchOptions, diagnose};
use gyrocal_truth::plant::{Kind, Setting, simulate, with_strength};

use crate::{loaded, prepared, record};

/// Seeds that nothing was tuned on.
const FIRST_SEED: u64 = 75_000;

const ROWS: usize = 600;

/// Adds an offset of the sensor that changes at four times, which no function of the catalogue follows.
fn add_offsets(outputs: &mut [Vec<f64>], sigma: f64) {
    let rows = outputs.len();
    for (row, outputs) in outputs.iter_mut().enumerate() {
        let level = match 10 * row / rows {
            0 | 1 => 0.0,
            2 | 3 => 12.0,
            4 | 5 => -9.0,
            6 | 7 => 10.0,
            _ => -3.0,
        };
        outputs[0] += level * sigma;
    }
}

#[test]
fn changes_that_no_function_of_time_follows_are_not_named() {
    let kind = Kind::Duffing;
    let plant = loaded(kind);
    let mut run = simulate(&Setting::random(kind, FIRST_SEED, ROWS), None);
    add_offsets(&mut run.outputs, kind.facts().sigmas[0]);
    let options = SearchOptions::default();
    let diagnosed = diagnose(&plant, prepared(&plant, run), None, &options).unwrap();
    let answer = &diagnosed.answer;
    let effects = plant.description().effects.iter();
    let of_time: Vec<&str> = effects
        .filter(|own| own.kind.is_of_time())
        .map(|own| &*own.id)
        .collect();
    let mut named = answer.findings.iter().map(|one| &*one.effect);
    assert!(named.all(|name| !of_time.contains(&name)), "{answer:?}");
    // They are told as noise that the plant does not declare, or as what is left.
    let is_told = !answer.undeclared_noise.is_empty() || answer.is_unexplained();
    assert!(is_told, "{answer:?}");
    // Where the noise takes them up at once, left-out parts have nothing to refuse.
    let path = answer.path.iter().filter(|step| step.refused.is_some());
    let refused = path.filter_map(|step| step.effect.as_ref());
    let mut all = refused.chain(&answer.only_in_white_noise);
    assert!(all.any(|id| of_time.contains(&id.as_str())), "{answer:?}");
    let words = gyrocal_words::plant::all(answer).join(" ");
    let is_told = words.contains("Not named: ") || words.contains("In white noise alone ");
    assert!(is_told, "{words}");
}

#[test]
fn an_effect_beside_such_changes_stands_in_left_out_parts() {
    let kind = Kind::Duffing;
    let plant = loaded(kind);
    let mut setting = Setting::random(kind, FIRST_SEED + 1, ROWS);
    setting.hidden = ("v_rate.x^3", 0.02);
    // Its root mean square in the readings is twelve standard deviations of their noise, that of the offsets two.
    let mut run = simulate(&with_strength(&setting, 300.0), None);
    add_offsets(&mut run.outputs, 0.25 * kind.facts().sigmas[0]);
    let later = Setting {
        seed: setting.seed + 1,
        ..with_strength(&setting, 300.0)
    };
    let later = record(&plant, &later);
    let options = SearchOptions::default();
    let diagnosed = diagnose(&plant, prepared(&plant, run), Some(later), &options).unwrap();
    let answer = &diagnosed.answer;
    let mut found = answer.findings.iter();
    assert!(
        found.any(|one| one.set().any(|id| id == setting.hidden.0)),
        "{:?}",
        gyrocal_words::plant::all(answer)
    );
    let errors: Vec<[f64; 2]> = answer
        .path
        .iter()
        .filter(|step| step.refused.is_none())
        .map(|step| {
            [
                step.outputs[0].left_out.unwrap(),
                step.outputs[0].later.unwrap(),
            ]
        })
        .collect();
    // Each effect that stands lowers the error of left-out parts; the first, which is there, that of a later record.
    assert!(
        errors.windows(2).all(|pair| pair[1][0] < 0.98 * pair[0][0]),
        "{errors:?}"
    );
    assert!(errors[1][1] < 0.5 * errors[0][1], "{errors:?}");
    let steps = answer.path.iter().filter(|step| step.refused.is_none());
    assert_eq!(steps.count(), answer.findings.len() + 1);
}
