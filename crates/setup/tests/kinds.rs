//! Every breakage is told, by a finding of its kind and nothing beside.

use gyrocal_setup::check_setup;
use gyrocal_testkit::broken_setups::BREAKAGES;

/// First of the fresh seeds; each breakage has its own.
const FIRST_SEED: u64 = 2_100_000;

#[test]
fn gross_errors_are_told() {
    let runs: u64 = std::env::var("RUNS").ok().and_then(|n| n.parse().ok()).unwrap_or(20);
    let (mut right, mut all) = (0, 0);
    for (index, breakage) in BREAKAGES.iter().enumerate() {
        let mut hits = 0;
        for run in 0..runs {
            let seed = FIRST_SEED + 1000 * index as u64 + run;
            let broken = breakage.record(seed);
            let check = check_setup(&broken.record, &broken.bench);
            let ok = check.findings.len() == 1 && check.findings.iter().all(|f| breakage.kinds.iter().any(|k| f.kind.as_str() == *k || f.equivalent_kinds.iter().any(|e| e.as_str() == *k)));
            hits += u64::from(ok);
            if !ok {
                println!("{seed} {} lat {:.1} {:?}", breakage.name, broken.bench.latitude_deg, check.findings.iter().map(|f| (f.kind.as_str(), &f.description, &f.evidence)).collect::<Vec<_>>());
            }
        }
        println!("{:40} {hits}/{runs}", breakage.name);
        right += hits; all += runs;
    }
    println!("{right} of {all}");
}
