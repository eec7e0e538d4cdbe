//! Makers of records with effects: of the catalogue, and drifts that it does not hold.

use core::f64::consts::TAU;
use std::sync::Arc;

use gyrocal_record::AXES;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::faults::{Series, UnlistedEffect};
use gyrocal_truth::{Hidden, Moment, Scenario, Temperature, simulate};

use super::records::{EDITS, Result, axis_of, between, clean, of};
use crate::catalogue::effect_of;
use crate::injection::{first_of, inject_into, nominal_fit};
use crate::out_of_catalogue::{MAX_DRAWS, UnlistedRecord};

/// Purpose of the random stream of a turn.
const TURNS: u64 = 34;

/// Largest cosine of the angle between the signatures of effects of one record.
const LARGEST_COSINE: f64 = 0.95;

/// Effects of one axis, by their ids with `i` for it and `ij` for a pair with it, and their shapes.
type Effects = Vec<(&'static str, Option<f64>)>;

/// A record with `further` effects and those that are drawn, each of these of the same strength beside the
/// others; `back`: the second is the first, negated.
fn with_effects(
    seed: u64,
    mut scenario: Scenario,
    strengths: [f64; 2],
    (back, further): (bool, &[Hidden]),
    draw: impl Fn(&mut Draw) -> Effects,
) -> Result {
    let clean = simulate(&scenario)?;
    let fitted = nominal_fit(&clean)?;
    let random = &mut Draw::new(seed, EDITS);
    let (axis, mut injected) = first_of(MAX_DRAWS, strengths[1], |_| {
        let axis = axis_of(random);
        let own = format!("_{}.", AXES[axis]);
        let pair = ["_xy.", "_yz.", "_xz."][axis];
        let strength = random.log_uniform(strengths);
        let effects = draw(random).into_iter().filter_map(|(id, shape)| {
            let id = id.replace("_i.", &own).replace("_ij.", pair);
            Some((effect_of(&id)?, shape))
        });
        let effects: Vec<_> = effects.collect();
        let injected = inject_into(&clean, &fitted, &effects, strength, LARGEST_COSINE, random)?;
        Ok(injected.map(|injected| (axis, injected)))
    })?;
    if let ([first, second], true) = (&mut injected[..], back) {
        second.sizes = first.sizes.iter().map(|size| -size).collect();
    }
    scenario.hidden = further.to_vec();
    for one in &injected {
        scenario.hidden.push(one.to_hidden()?);
    }
    Ok(of(simulate(&scenario)?, Some(axis)))
}

/// Steps of 18 to 60 sigma; `after` are ranges of the share of the record between each and the one before.
pub(super) fn steps(seed: u64, after: &[[f64; 2]], back: bool) -> Result {
    let scenario = clean(seed, 0);
    let duration_s = scenario.duration_s;
    with_effects(seed, scenario, [18.0, 60.0], (back, &[]), |random| {
        let mut share = 0.0;
        let step = |range: &[f64; 2]| {
            share += between(random, *range);
            ("gyro_i.step", Some(share * duration_s))
        };
        after.iter().map(step).collect()
    })
}

pub(super) fn step_in_gap(seed: u64) -> Result {
    let mut scenario = clean(seed, 0);
    let middle_s = 0.5 * scenario.duration_s;
    scenario.gaps_s = vec![[middle_s - 14_400.0, middle_s + 14_400.0]];
    with_effects(seed, scenario, [12.0, 40.0], (false, &[]), |random| {
        let onset_s = middle_s + between(random, [-10_000.0, 10_000.0]);
        vec![("gyro_i.step", Some(onset_s))]
    })
}

pub(super) fn slow_warm_up(seed: u64) -> Result {
    let scenario = clean(seed, 0);
    let duration_h = scenario.duration_s / 3600.0;
    with_effects(seed, scenario, [14.0, 43.0], (false, &[]), |random| {
        let time_constant_h = duration_h * random.log_uniform([0.35, 1.5]);
        vec![("gyro_i.warmup", Some(time_constant_h))]
    })
}

pub(super) fn accelerometer(seed: u64) -> Result {
    const IDS: [&str; 3] = ["accel_i.scale", "accel_i.bias", "accel_ij.nonorthogonality"];
    with_effects(seed, clean(seed, 0), [16.0, 16.0], (false, &[]), |_| {
        IDS.map(|id| (id, None)).to_vec()
    })
}

/// A turn of the platform in the third quarter of the record, and a ramp of a strength beside, which is far weaker in
/// what precedes.
pub(super) fn knock(seed: u64, angles_deg: [f64; 2], ramp: Option<f64>) -> Result {
    let scenario = clean(seed, 0);
    let random = &mut Draw::new(seed, TURNS);
    let axis: [f64; 3] = core::array::from_fn(|_| random.normal());
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let angle_deg = between(random, angles_deg);
    let [x, y, z] = axis.map(|x| angle_deg * x / length);
    let onset_s = between(random, [0.5, 0.75]) * scenario.duration_s;
    let turn = [("x_deg", x), ("y_deg", y), ("z_deg", z)];
    let parameters = [&turn[..], &[("onset_s", onset_s)]].concat();
    let knock = Hidden::new("platform.knock", &parameters)?;
    let (strengths, ramp) = (
        [ramp.unwrap_or(1.0); 2],
        ramp.map(|_| ("gyro_i.ramp", None)),
    );
    let draw = |_: &mut Draw| ramp.into_iter().collect();
    with_effects(seed, scenario, strengths, (false, &[knock]), draw)
}

/// A record with a drift of one gyro that the catalogue does not hold, of a strength.
fn with_drift<F: Fn(&Moment) -> f64 + Send + Sync + 'static>(
    seed: u64,
    scenario: &Scenario,
    strength: f64,
    unit: impl Fn(&mut Draw) -> F,
) -> Result {
    let random = &mut Draw::new(seed, EDITS);
    first_of(MAX_DRAWS, strength, |_| {
        let axis = axis_of(random);
        let effect = UnlistedEffect::of("drift", true, axis, Arc::new(unit(random)));
        let record = UnlistedRecord::scaled(scenario, effect, strength)?;
        Ok(record.map(|record| of(record.with, Some(axis))))
    })
}

/// A drift that is there for some times of one to three hours; 20 sigma, several 30.
pub(super) fn pulses(seed: u64, count: usize) -> Result {
    let scenario = clean(seed, 0);
    let strength = if count == 1 { 20.0 } else { 30.0 };
    with_drift(seed, &scenario, strength, |random| {
        let window = |_| {
            let from_s = between(random, [0.1, 0.9]) * scenario.duration_s;
            from_s..from_s + 3600.0 * between(random, [1.0, 3.0])
        };
        let windows: Vec<_> = (0..count).map(window).collect();
        move |moment: &Moment| f64::from(windows.iter().any(|one| one.contains(&moment.time_s)))
    })
}

/// Waves of the day, its half and its third with amplitudes as 20, 14 and 12, of 27 sigma together.
pub(super) fn harmonics(seed: u64) -> Result {
    with_drift(seed, &clean(seed, 0), 27.0, |random| {
        let phases: [f64; 3] = core::array::from_fn(|_| TAU * random.uniform());
        move |moment: &Moment| {
            let day = TAU * moment.time_s / 86_400.0;
            let wave = |size: f64, order: usize| {
                size * libm::sin((order + 1) as f64 * day + phases[order])
            };
            wave(1.0, 0) + wave(0.7, 1) + wave(0.6, 2)
        }
    })
}

pub(super) fn lagging_temperature(seed: u64) -> Result {
    const LAG_S: f64 = 3.0 * 3600.0;
    let mut scenario = clean(seed, 0);
    scenario.temperature = Some(Temperature::default());
    let logged = simulate(&scenario)?.record.temperature_c;
    let logged = logged.unwrap_or_default();
    let share = 1.0 - libm::exp(-scenario.interval_s / LAG_S);
    let mut behind = logged.first().copied().unwrap_or(0.0);
    let follow = |value: &f64| {
        behind += share * (value - behind);
        behind - Temperature::default().mean_c
    };
    let values: Vec<f64> = logged.iter().map(follow).collect();
    with_drift(seed, &scenario, 20.0, |_| {
        let (interval_s, values) = (scenario.interval_s, values.clone());
        let series = Series { interval_s, values };
        move |moment: &Moment| series.at(moment.time_s)
    })
}
