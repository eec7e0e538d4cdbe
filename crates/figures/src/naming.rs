//! Causes hidden in simulated records: what is detected, what is named, and what clean records
//! show.

pub(crate) mod hidden;

use gyrocal_campaign::statistics::Proportion;
use gyrocal_campaign::{Campaign, Fingerprint, Outcome};

use crate::figure::Figure;
use hidden::{Case, clean, hidden};

/// Why a figure could not be measured.
type Error = Box<dyn std::error::Error + Send + Sync>;

/// Seeds of clean records, and of records with a cause of each strength.
const CLEAN_SEEDS: [u64; 2] = [100_000, 2_000];
const HIDDEN_SEEDS: [(f64, u64, [f64; 2]); 4] = [
    (5.0, 200_000, [0.86, 0.0]),
    (6.0, 300_000, [0.97, 0.0]),
    (8.0, 400_000, [0.995, 0.91]),
    (12.0, 500_000, [0.995, 0.97]),
];

/// Records of each strength; in the small version, which runs everywhere, fewer.
const HIDDEN_RUNS: u64 = 1_000;
const SMALL_RUNS: u64 = 24;

/// All figures of the topic.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let [first, runs] = CLEAN_SEEDS;
    let runs = if small { 2 * SMALL_RUNS } else { runs };
    let seeds = first..first + runs;
    let outcome = campaign("clean", seeds.clone(), small).run(clean, |_| ())?;
    let alarms = Proportion::of(outcome.successes().map(|(_, alarm)| *alarm));
    let mut figures = Vec::new();
    // A small population cannot show 2 %: it fails if it shows that the rate is above it.
    figures.push(
        if small {
            Figure::truth(
                "false alarms not shown to exceed 2 % (nominal 1 %)",
                alarms.lower_bound(0.999) <= 0.02,
            )
        } else {
            Figure::within(
                "false alarms on clean records, one-sided 95 % upper bound",
                [f64::NEG_INFINITY, 0.02],
                alarms.upper_bound(0.95),
            )
        }
        .over(alarms.trials as usize, format!("{seeds:?}")),
    );
    figures.push(Figure::note(
        "false alarms on clean records",
        format!("{} of {}", alarms.hits, alarms.trials),
    ));
    for (strength, first, targets) in HIDDEN_SEEDS {
        let runs = if small { SMALL_RUNS } else { HIDDEN_RUNS };
        let seeds = first..first + runs;
        let outcome = campaign(&format!("hidden-{strength}"), seeds.clone(), small)
            .run(|seed| hidden(seed, strength), |_| ())?;
        figures.extend(of_strength(
            strength,
            targets,
            &outcome,
            small,
            &format!("{seeds:?}"),
        ));
    }
    Ok(figures)
}

fn campaign(name: &str, seeds: core::ops::Range<u64>, small: bool) -> Campaign {
    let fingerprint = Fingerprint::new("naming").with("cell", name);
    let campaign = Campaign::new(seeds, fingerprint);
    if small {
        campaign
    } else {
        campaign.results(format!("target/naming-{name}.jsonl"))
    }
}

/// Figures of one strength. A small population holds a target if it does not show that the rate
/// is below it.
fn of_strength(
    strength: f64,
    [detected_at_least, first_at_least]: [f64; 2],
    outcome: &Outcome<Case>,
    small: bool,
    seeds: &str,
) -> Vec<Figure> {
    let cases: Vec<&Case> = outcome.successes().map(|(_, case)| case).collect();
    let share = |of: &dyn Fn(&Case) -> Option<bool>| {
        Proportion::of(cases.iter().filter_map(|case| of(case)))
    };
    let figure = |name: &str, least: f64, found: Proportion| {
        let name = format!("d = {strength}: {name}");
        let mut figure = Figure::within(&name, [least, f64::INFINITY], found.share())
            .over(found.trials as usize, seeds.to_owned());
        if small {
            figure.holds = Some(found.upper_bound(0.999) >= least);
        }
        figure
    };
    let detected = |case: &Case| case.detected;
    let mut figures = vec![
        figure(
            "detected",
            detected_at_least,
            share(&|case| Some(case.detected)),
        ),
        figure(
            "the named set holds the truth",
            0.95,
            share(&|case| detected(case).then_some(case.in_set)),
        ),
        figure(
            "95 % interval of the size holds it, given the right name",
            0.93,
            share(&|case| case.covered),
        ),
    ];
    if first_at_least > 0.0 {
        figures.push(figure(
            "the class named first is right",
            first_at_least,
            share(&|case| detected(case).then_some(case.first)),
        ));
    }
    let sizes: Vec<f64> = cases
        .iter()
        .filter(|case| case.detected)
        .map(|case| case.set_size as f64)
        .collect();
    figures.push(Figure::note(
        &format!("d = {strength}: mean size of the named set"),
        format!("{:.2}", gyrocal_campaign::statistics::mean(&sizes)),
    ));
    let failed = outcome.failures().count();
    if failed > 0 {
        figures.push(Figure::note(
            &format!("d = {strength}: records that could not be diagnosed"),
            failed.to_string(),
        ));
    }
    figures
}
