//! Planned runs, made: predicted against actual sigmas and confidence sets.

use gyrocal::effect::EffectKind;
use gyrocal_calibration::{NoiseModel, Options, Run, calibrate_runs};
use gyrocal_design::{NamedCause, PlanOptions, Proposal, compare, plan};
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_evaluation::{constant_of_channel, effect_of, inject_any};
use gyrocal_statistics::Judgement;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Hidden, InitialAttitude, Population, Scenario, Simulation, simulate};
use serde::{Deserialize, Serialize};

use super::Error;
use crate::figure::Figure;
use crate::resumable;

/// Seed of the population of records.
const POPULATION: u64 = 78;

/// Seeds of records for the sigmas, and of records with an injected effect of the given strength, at
/// which confidence sets are large.
const SIGMA_SEEDS: [u64; 2] = [600_000, 200];
const SET_SEEDS: [u64; 2] = [610_000, 300];
const STRENGTH: f64 = 6.0;

/// Numbers of records in the small version.
const SMALL: [u64; 2] = [3, 6];

/// Duration of the short next run, as a fraction of the record: it distinguishes some of the
/// alternatives.
const SHORT: f64 = 1.0 / 12.0;

/// Ratios that are within 20 %.
const WITHIN: [f64; 2] = [0.8, 1.2];

/// Result of a planned run that was made.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Sigmas {
    /// Least and largest of the nine ratios of the sigma of a joint calibration to the predicted one.
    ratios: [f64; 2],
}

/// Sizes of one confidence set: of the record, and predicted and actual after a next run.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Sets {
    /// Size of the set of the record; `None` without a set of two or more.
    now: Option<f64>,
    /// After a short run and one as long as the record: predicted, found.
    after: [[f64; 2]; 2],
}

/// All figures of planning.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let runs = if small {
        SMALL
    } else {
        [SIGMA_SEEDS[1], SET_SEEDS[1]]
    };
    let seeds = SIGMA_SEEDS[0]..SIGMA_SEEDS[0] + runs[0];
    let outcome =
        resumable::campaign("naming", "plan-sigmas", seeds.clone(), small)?.run(sigmas, |_| ())?;
    let ratios: Vec<[f64; 2]> = outcome.successes().map(|(_, case)| case.ratios).collect();
    let least = ratios.iter().map(|r| r[0]).fold(f64::INFINITY, f64::min);
    let most = ratios.iter().map(|r| r[1]).fold(0.0, f64::max);
    let mut figures = Vec::new();
    for (name, extreme) in [("least", least), ("largest", most)] {
        figures.push(
            Figure::within(
                &format!("planned run: {name} of the nine sigmas over the predicted, any run"),
                WITHIN,
                extreme,
            )
            .over(ratios.len(), format!("{seeds:?}")),
        );
    }
    let failed = outcome.failures().count();
    let seeds = SET_SEEDS[0]..SET_SEEDS[0] + runs[1];
    let outcome =
        resumable::campaign("naming", "plan-sets", seeds.clone(), small)?.run(sets, |_| ())?;
    let cases: Vec<&Sets> = outcome
        .successes()
        .map(|(_, case)| case)
        .filter(|case| case.now.is_some())
        .collect();
    let mean = |of: &dyn Fn(&Sets) -> f64| {
        let values: Vec<f64> = cases.iter().map(|case| of(case)).collect();
        gyrocal_statistics::mean(&values)
    };
    figures.push(Figure::note(
        "planned run: mean size of named sets of two or more before it",
        format!("{:.2}", mean(&|case| case.now.unwrap_or(0.0))),
    ));
    for (index, length) in ["a twelfth of the record", "as long as the record"]
        .into_iter()
        .enumerate()
    {
        let [predicted, found] = [0, 1].map(|which| mean(&|case| case.after[index][which]));
        let name = format!("planned run {length}: mean size of the set over the predicted");
        let mut figure = Figure::within(&name, WITHIN, found / predicted)
            .over(cases.len(), format!("{seeds:?}"));
        if small {
            let missed = |case: &Sets| case.after[index][1] - case.after[index][0];
            let square = mean(&|case| (missed(case) - (found - predicted)).powi(2));
            let error = (square / cases.len() as f64).sqrt();
            // Two-sided 90 % for met and 99.9 % for missed.
            let off = (found - predicted).abs() - 0.2 * predicted;
            figure = figure.judged(Judgement::of(off + 1.645 * error <= 0.0, off > 3.3 * error));
        }
        figures.push(figure);
        figures.push(Figure::note(
            &format!("planned run {length}: mean size of the set"),
            format!("{found:.2}, predicted {predicted:.2}"),
        ));
    }
    let failed = failed + outcome.failures().count();
    if failed > 0 {
        figures.push(Figure::note(
            "planned run: records that could not be planned for",
            failed.to_string(),
        ));
    }
    Ok(figures)
}

fn run(simulation: &Simulation) -> Run<'_> {
    Run {
        record: &simulation.record,
        bench: &simulation.bench,
    }
}

/// Two days at any latitude and attitude; of every other record the turn-ons differ.
fn scenario(seed: u64) -> Scenario {
    let mut scenario = Scenario {
        duration_s: 2.0 * 86_400.0,
        ..Population::new(POPULATION).scenario(seed)
    };
    scenario.prior.turn_on_sigma_deg_per_h = [0.01 * (seed % 2) as f64; 3];
    scenario
}

/// The next run as planned, with the injected effect as it continues.
fn made(scenario: &Scenario, planned: &Proposal) -> Result<Simulation, Error> {
    let mut next = Scenario {
        seed: scenario.seed ^ 0x5ec0_4d00,
        initial: InitialAttitude::AnglesDeg(planned.angles_deg.unwrap_or_default()),
        duration_s: planned.duration_s,
        hidden: Vec::new(),
        ..scenario.clone()
    };
    let days = scenario.duration_s / 86_400.0;
    for hidden in &scenario.hidden {
        let size = hidden
            .parameters()
            .first()
            .map_or(0.0, |(_, size, _)| *size);
        let effect = effect_of(hidden.id()).ok_or("an effect that the catalogue lacks")?;
        let grown = match effect.kind {
            EffectKind::InitialState | EffectKind::StateJump => continue,
            EffectKind::Step => size,
            EffectKind::Ramp => size * days,
            _ => 0.0,
        };
        if effect.kind != EffectKind::Step {
            next.hidden.push(hidden.clone());
        }
        if grown != 0.0 {
            let constant = constant_of_channel(effect).ok_or("a change of no channel")?;
            let bias = Hidden::new(constant, &[("size", grown)])?;
            next.hidden.push(bias);
        }
    }
    Ok(simulate(&next)?)
}

fn sigmas(seed: u64) -> Result<Sigmas, Error> {
    let scenario = scenario(seed);
    let first = simulate(&scenario)?;
    let noise = NoiseModel::default();
    let fitted = NamedCause::fitted(&[], &run(&first), &noise, &Options::default())?;
    let planned = plan(&fitted, &run(&first), &[], &PlanOptions::default())?;
    let best = planned.proposals.first().ok_or("no proposal")?;
    let second = made(&scenario, best)?;
    let joint = calibrate_runs(&[run(&first), run(&second)], &Options::default(), |_| ())?;
    let predicted = best.outlook.coefficients.iter();
    let ratios: Vec<f64> = predicted
        .zip(joint.coefficients())
        .map(|(predicted, found)| found.sigma / predicted.sigma)
        .collect();
    Ok(Sigmas {
        ratios: [
            ratios.iter().copied().fold(f64::INFINITY, f64::min),
            ratios.iter().copied().fold(0.0, f64::max),
        ],
    })
}

fn sets(seed: u64) -> Result<Sets, Error> {
    let (scenario, _) = inject_any(scenario(seed), STRENGTH, &mut Draw::new(seed, 0))?;
    let first = simulate(&scenario)?;
    let found = diagnose(&first.record, &first.bench, &DiagnoseOptions::default())?;
    let named = NamedCause::all(&found.result);
    let fitted = found.extended.as_ref().unwrap_or(&found.nominal);
    let mut sets = Sets {
        now: None,
        after: [[0.0; 2]; 2],
    };
    if !named.iter().any(|named| !named.rivals.is_empty()) {
        return Ok(sets);
    }
    for (after, share) in sets.after.iter_mut().zip([SHORT, 1.0]) {
        let options = PlanOptions {
            durations_s: vec![share * scenario.duration_s],
            ..PlanOptions::default()
        };
        let planned = plan(fitted, &run(&first), &named, &options)?;
        let of_first = |sizes: Vec<f64>| sizes.first().copied();
        let now = planned.now.sets.iter().map(|set| set.mean_size);
        sets.now = of_first(now.collect()).filter(|size| *size > 1.0);
        let best = planned.proposals.first().ok_or("no proposal")?;
        let predicted = best.outlook.sets.iter().map(|set| set.mean_size);
        let second = made(&scenario, best)?;
        let compared = compare(
            fitted,
            &run(&first),
            &run(&second),
            None,
            &named,
            &Options::default(),
        )?;
        let left = compared.sets.iter().map(|set| {
            let stay = set.iter().filter(|member| member.stays);
            stay.count() as f64
        });
        let predicted = of_first(predicted.collect()).ok_or("no set")?;
        *after = [predicted, of_first(left.collect()).ok_or("no set")?];
    }
    Ok(sets)
}
