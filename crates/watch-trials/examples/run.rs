//! Prints numbers of trials.
use gyrocal_watch_trials::*;
use rayon::prelude::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let n: u64 = a[2].parse().unwrap();
    let lanes: usize = a[3].parse().unwrap();
    let seed = 20_261_131;
    match a[1].as_str() {
        "sound" => {
            let walk: f64 = a[4].parse().unwrap();
            let mut noises = vec![(Noise::Declared, walk)];
            if walk == 1e-5 {
                noises.extend([
                    (Noise::Larger(1.1), walk),
                    (Noise::Correlated(0.1), walk),
                    (Noise::Student4, walk),
                    (Noise::Declared, 2e-5),
                    (Noise::Declared, 1e-4),
                ]);
            }
            let all: Vec<Vec<Sound>> = (0..n)
                .into_par_iter()
                .map(|i| sound(seed, i, 1.0, walk, &noises, lanes).unwrap())
                .collect();
            for (k, noise) in noises.iter().enumerate() {
                let alarms: usize = all.iter().map(|s| s[k].alarms).sum();
                let platforms: usize = all.iter().map(|s| s[k].platforms).sum();
                let mut days: Vec<f64> = all.iter().flat_map(|s| s[k].days.clone()).collect();
                days.sort_by(f64::total_cmp);
                println!(
                    "declared {walk} {noise:?}: {alarms} of {platforms}, jumps {}; {:?}",
                    all.iter().map(|s| s[k].by_jumps).sum::<usize>(),
                    &days[..days.len().min(12)]
                );
            }
        }
        "delay" => {
            let all: Vec<(Vec<Trial>, Vec<Vec<Delay>>)> = (0..n)
                .into_par_iter()
                .map(|i| {
                    let g = (i % 3) as usize;
                    let o = (g + 1) % 3;
                    let l = ["x", "y", "z"];
                    let id = |s: String| -> &'static str { Box::leak(s.into_boxed_str()) };
                    let mut t = vec![];
                    for z in [2.0, 4.0, 8.0] {
                        t.push(Trial {
                            effect: Injected::Step(g),
                            id: id(format!("gyro_{}.step", l[g])),
                            sigmas_a_day: z,
                        });
                        t.push(Trial {
                            effect: Injected::Ramp(g),
                            id: id(format!("gyro_{}.ramp", l[g])),
                            sigmas_a_day: z,
                        });
                        t.push(Trial {
                            effect: Injected::Cross(g, o),
                            id: id(format!("gyro_{}.g_{}", l[g], l[o])),
                            sigmas_a_day: z,
                        });
                        t.push(Trial {
                            effect: Injected::Bias(g),
                            id: id(format!("accel_{}.bias", l[g])),
                            sigmas_a_day: z,
                        });
                    }
                    let d = delays(seed + 1, i, &t, lanes, 30, a[4].parse().unwrap()).unwrap();
                    (t, d)
                })
                .collect();
            for k in 0..12 {
                let t = all[0].0[k];
                let runs: Vec<&Delay> = all.iter().flat_map(|(_, d)| &d[k]).collect();
                let med = |f: &dyn Fn(&Delay) -> Option<f64>| {
                    let mut v: Vec<f64> = runs.iter().map(|d| f(d).unwrap_or(99.0)).collect();
                    v.sort_by(f64::total_cmp);
                    v[v.len() / 2]
                };
                let (a, b) = (med(&|d| d.days), med(&|d| d.alone_days));
                let al: Vec<&&Delay> = runs
                    .iter()
                    .filter(|d| d.days.is_some_and(|x| x > 0.0))
                    .collect();
                println!(
                    "{:?} z{}: {a:.2} alone {b:.2} ratio {:.2}; held {:.3} set {:.2} first {:.2} found {}/{} early {}",
                    t.effect,
                    t.sigmas_a_day,
                    a / b,
                    al.iter().filter(|d| d.held).count() as f64 / al.len() as f64,
                    al.iter().map(|d| d.set as f64).sum::<f64>() / al.len() as f64,
                    al.iter().filter(|d| d.first).count() as f64 / al.len() as f64,
                    al.len(),
                    runs.len(),
                    runs.iter()
                        .filter(|d| d.days.is_some_and(|x| x <= 0.0))
                        .count()
                );
            }
        }
        _ => {
            for z in [8.0, 10.0, 12.0] {
                let all: Vec<Knocked> = (0..n)
                    .into_par_iter()
                    .flat_map(|i| knocks(seed + 2, i, z, lanes).unwrap())
                    .collect();
                let mut steps: Vec<usize> = all.iter().filter_map(|k| k.steps).collect();
                steps.sort();
                println!(
                    "knock {z}: found {} of {}, median {:?}, within 15: {}, 96: {}, axis {}",
                    steps.len(),
                    all.len(),
                    steps.get(all.len() / 2),
                    steps.iter().filter(|s| **s <= 15).count(),
                    steps.iter().filter(|s| **s <= 96).count(),
                    all.iter().filter(|k| k.axis).count()
                );
            }
        }
    }
}
