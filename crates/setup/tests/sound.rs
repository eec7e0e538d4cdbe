//! Sound records of all sorts do not set the check off.

use gyrocal_setup::check_setup;
use gyrocal_statistics::deviates::Draw;
use gyrocal_testkit::broken_setups::{large_effects, varied_record, varied_scenario};

const FIRST_SEED: u64 = 2_000_000;

#[test]
fn sound_records_are_left_alone() {
    let runs: u64 = std::env::var("RUNS").ok().and_then(|n| n.parse().ok()).unwrap_or(20);
    let mut alarms = 0;
    for seed in FIRST_SEED..FIRST_SEED + runs {
        let mut scenario = varied_scenario(seed);
        let e = if seed % 2 == 1 { large_effects(&scenario, &mut Draw::new(seed, 4)) } else { vec![] };
        scenario.hidden.extend(e);
        let s = varied_record(seed, &scenario);
        let check = check_setup(&s.record, &s.bench);
        if !check.findings.is_empty() {
            alarms += 1;
            println!("{seed} lat {:.1} dt {} days {:.2} prior {:.2} noise {:.1e} hidden {:?} {:?}", scenario.latitude_deg, scenario.interval_s, scenario.duration_s/86400., scenario.prior.g_sigma_deg_per_h_per_g[0], s.bench.accel_noise_g, scenario.hidden.iter().map(|h| (h.id().to_owned(), h.parameters())).collect::<Vec<_>>(), check.findings.iter().map(|f| (f.kind.as_str(), &f.description, &f.evidence)).collect::<Vec<_>>());
        }
    }
    println!("alarms {alarms} of {runs}");
}
