//! Planned runs, made: predicted against actual sigmas and confidence sets.

use gyrocal_calibration::{NoiseModel, Options, calibrate_runs};
use gyrocal_design::{NamedCause, PlanOptions, Proposal, compare, plan};
use gyrocal_evaluation::{Statistic, diagnosed, inject_any, run_of};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{InitialAttitude, Population as Platforms, Scenario, Simulation, simulate};
use serde::{Deserialize, Serialize};

use super::continued;
use crate::harness::{Context, DIAGNOSIS, Error, Figure, Population, Row, of};

/// Seed of the platforms and their records.
const PLATFORMS: u64 = 78;

/// Strength of an injected effect at which confidence sets are large.
const STRENGTH: f64 = 6.0;

/// Duration of the short next run, as a fraction of the record: it distinguishes some of the
/// alternatives.
const SHORT: f64 = 1.0 / 12.0;

/// Ratios that are within 20 %, and why.
const WITHIN: [f64; 2] = [0.8, 1.2];
const WITHIN_REASON: &str = "a plan is chosen by differences that are larger";

/// Sizes of one confidence set: of the record, and predicted and actual after a next run.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Sets {
    /// Size of the set of the record; `None` without a set of two or more.
    now: Option<f64>,
    /// After a short run and one as long as the record: predicted, found.
    after: [[f64; 2]; 2],
}

/// All figures of the part.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let extreme = |which: &str, from: f64, of: fn(f64, f64) -> f64| {
        let name = format!("planned run: {which} of the nine sigmas over the predicted, any run");
        let value = move |all: &[Vec<f64>]| {
            let extreme = all.iter().flatten().copied().fold(from, of);
            Statistic::Value(extreme, all.len() as u64)
        };
        Row::new(name, value).between(WITHIN, WITHIN_REASON)
    };
    let ratios = [
        extreme("least", f64::INFINITY, f64::min),
        extreme("largest", 0.0, f64::max),
    ];
    let name = "planned run: mean size of named sets of two or more before it";
    let mut sizes = vec![Row::mean(name, |of: &Sets| of.now)];
    let lengths = ["a twelfth of the record", "as long as the record"];
    for (which, length) in lengths.into_iter().enumerate() {
        let name = format!("planned run {length}: mean size of the set");
        let after = move |of: &Sets| of.now.map(|_| of.after[which]);
        let ratio = Row::ratio(format!("{name} over the predicted"), move |of| {
            let [predicted, found] = after(of)?;
            Some([found, predicted])
        });
        sizes.push(ratio.between(WITHIN, WITHIN_REASON));
        sizes.push(Row::mean(name, move |of| Some(after(of)?[1])));
    }
    let sources = of(DIAGNOSIS, &[file!()]);
    let sigmas = Population::new("planned sigmas", [600_000, 200, 3], sources, sigmas);
    let sets = Population::new("planned sets", [610_000, 300, 6], sources, sets);
    let mut figures = context.measure(&sigmas, &ratios)?;
    figures.extend(context.measure(&sets, &sizes)?);
    Ok(figures)
}

/// Two days at any latitude and attitude; of every other record the turn-ons differ.
fn scenario(seed: u64) -> Scenario {
    let mut scenario = Scenario {
        duration_s: 2.0 * 86_400.0,
        ..Platforms::new(PLATFORMS).scenario(seed)
    };
    scenario.prior.turn_on_sigma_deg_per_h = [0.01 * (seed % 2) as f64; 3];
    scenario
}

/// The next run as planned, with the injected effect as it continues.
fn made(scenario: &Scenario, planned: &Proposal) -> Result<Simulation, Error> {
    Ok(simulate(&Scenario {
        seed: scenario.seed ^ 0x5ec0_4d00,
        initial: InitialAttitude::AnglesDeg(planned.angles_deg.unwrap_or_default()),
        duration_s: planned.duration_s,
        hidden: continued(scenario, scenario.duration_s)?,
        ..scenario.clone()
    })?)
}

/// The nine sigmas of a joint calibration with the planned run over the predicted ones.
fn sigmas(seed: u64) -> Result<Vec<f64>, Error> {
    let scenario = scenario(seed);
    let first = simulate(&scenario)?;
    let (noise, options) = (NoiseModel::default(), Options::default());
    let fitted = NamedCause::fitted(&[], &run_of(&first), &noise, &options)?;
    let planned = plan(&fitted, &run_of(&first), &[], &PlanOptions::default())?;
    let best = planned.proposals.first().ok_or("no proposal")?;
    let second = made(&scenario, best)?;
    let joint = calibrate_runs(&[run_of(&first), run_of(&second)], &options, |_| ())?;
    let both = best.outlook.coefficients.iter().zip(joint.coefficients());
    let ratios = both.map(|(predicted, found)| found.sigma / predicted.sigma);
    Ok(ratios.collect())
}

fn sets(seed: u64) -> Result<Sets, Error> {
    let (scenario, _) = inject_any(scenario(seed), STRENGTH, &mut Draw::new(seed, 0))?;
    let first = simulate(&scenario)?;
    let found = diagnosed(&first)?;
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
        let planned = plan(fitted, &run_of(&first), &named, &options)?;
        let now = planned.now.sets.first().map(|set| set.mean_size);
        sets.now = now.filter(|size| *size > 1.0);
        let best = planned.proposals.first().ok_or("no proposal")?;
        let predicted = best.outlook.sets.first().ok_or("no set")?.mean_size;
        let (second, calibration) = (made(&scenario, best)?, Options::default());
        let runs = [run_of(&first), run_of(&second)];
        let compared = compare(fitted, &runs[0], &runs[1], None, &named, &calibration)?;
        let left = compared.sets.first().ok_or("no set")?;
        let left = left.iter().filter(|member| member.stays).count();
        *after = [predicted, left as f64];
    }
    Ok(sets)
}
