//! Information of a day of each effect of the default list, and sizes of knocks: medians over the
//! population that constants are tuned on.

use gyrocal_watch_trials::{Injected, Trial, delays, knocks};

/// Seed of the population for tuning; figures are reported on others.
const TUNED_ON: u64 = 20_261_121;

fn main() {
    let trials = [
        ("step", Injected::Step(0), "gyro_x.step"),
        ("ramp", Injected::Ramp(1), "gyro_y.ramp"),
        ("cross", Injected::Cross(0, 1), "gyro_x.g_y"),
        ("own", Injected::Cross(0, 0), "gyro_x.g_x"),
        ("bias", Injected::Bias(2), "accel_z.bias"),
    ];
    for (name, effect, id) in trials {
        let trial = Trial {
            effect,
            id,
            sigmas_a_day: 4.0,
        };
        let mut all: Vec<f64> = (0..24)
            .filter_map(|number| delays(TUNED_ON, number, &[trial], 1, 1, 1e-5).ok())
            .filter_map(|runs| Some(runs.first()?.first()?.information_of_a_day))
            .collect();
        all.sort_by(f64::total_cmp);
        println!(
            "{name}: {:e} {:e} {:e}",
            all[3],
            all[all.len() / 2],
            all[20]
        );
    }
    let mut sizes: Vec<f64> = (0..12)
        .filter_map(|number| knocks(TUNED_ON, number, 10.0, 1).ok())
        .map(|runs| runs[0].size)
        .collect();
    sizes.sort_by(f64::total_cmp);
    println!("knock of 10: {:e}", sizes[6]);
}
