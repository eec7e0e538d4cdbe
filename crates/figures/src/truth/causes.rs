//! One cause of the catalogue in noise that is misdeclared in half of the records: detection, sets,
//! intervals, and the coefficients with the cause in the model.

use gyrocal::effect::EffectKind;
use gyrocal::{EFFECTS, Effect};
use gyrocal_calibration::{FittedPlatform, NoiseModel, Options, Run, rows};
use gyrocal_diagnosis::result::Finding;
use gyrocal_diagnosis::{DiagnoseOptions, Diagnosis, diagnose, selection};
use gyrocal_evaluation::{
    EvaluationError, InjectedEffect, draw_shape, inject_into, same_or_equivalent, scenario,
    testable_effects,
};
use gyrocal_hypothesis::{FittedModel, HypothesisSet, ModelExtension, SearchOptions, search};
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::{Judgement, NORMAL_97_5, Proportion};
use gyrocal_truth::{Hidden, Scenario, Simulation, simulate};
use serde::{Deserialize, Serialize};

use super::Extent;
use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;

/// Purposes of the streams of draws.
const CAUSES: u64 = 47;
const LEVELS: u64 = 48;

/// Ratio of the true standard deviation to the declared one, in half of the records.
const MISDECLARED: [f64; 2] = [0.5, 2.0];

/// Most draws of an effect that the record shows.
const DRAWS: usize = 100;

/// Fewer records than these are judged by an interval.
const FEW: usize = 100;

/// Number of drift coefficients.
const COEFFICIENTS: usize = 9;

/// A population.
struct Cell {
    name: &'static str,
    strength: f64,
    /// Only causes that change slowly in time.
    slow: bool,
    /// Whether detection and sets are figures of it.
    tells_sets: bool,
    /// Least share of sets without a noise process: with diurnal and g terms, with warm-ups.
    least_alone: [f64; 2],
    first_seed: u64,
    records: u64,
    small: u64,
}

const CELLS: [Cell; 4] = [
    Cell {
        name: "d = 8",
        strength: 8.0,
        slow: false,
        tells_sets: true,
        least_alone: [0.85, 0.55],
        first_seed: 800_000,
        records: 1000,
        small: 4,
    },
    Cell {
        name: "d = 12",
        strength: 12.0,
        slow: false,
        tells_sets: false,
        least_alone: [0.97, 0.88],
        first_seed: 810_000,
        records: 600,
        small: 0,
    },
    Cell {
        name: "slow causes, d = 5",
        strength: 5.0,
        slow: true,
        tells_sets: false,
        least_alone: [0.0, 0.0],
        first_seed: 820_000,
        records: 300,
        small: 0,
    },
    Cell {
        name: "slow causes, d = 6",
        strength: 6.0,
        slow: true,
        tells_sets: false,
        least_alone: [0.0, 0.0],
        first_seed: 830_000,
        records: 300,
        small: 0,
    },
];

/// Result for one record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Caused {
    effect: String,
    detected: bool,
    /// Whether the set of a finding holds the cause; and no noise process.
    in_set: bool,
    alone: bool,
    set_size: Option<usize>,
    spurious: bool,
    /// The same of a search that knows that no rate walks.
    oracle_in_set: bool,
    oracle_set_size: Option<usize>,
    /// Whether the intervals of the coefficients hold the true ones: over the set, and of the first
    /// member.
    over_set: Vec<bool>,
    first: Vec<bool>,
    /// Width of the intervals over those of the true model.
    widths: Vec<f64>,
}

pub(super) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let small = extent.small;
    let mut figures = Vec::new();
    for cell in CELLS.iter().filter(|cell| cell.small > 0 || !small) {
        let count = extent.records(cell.records, cell.small);
        let seeds = cell.first_seed..cell.first_seed + count;
        let campaign = resumable::campaign("truth", cell.name, seeds.clone(), small)?;
        let outcome = campaign.run(|seed| record(cell, seed), |_| ())?;
        let records: Vec<Caused> = outcome.successes().map(|(_, one)| one.clone()).collect();
        figures.extend(cell_figures(&Told {
            cell,
            records: &records,
            small,
            seeds: &format!("{seeds:?}"),
        }));
    }
    Ok(figures)
}

/// The records of a cell, to be told as figures.
struct Told<'r> {
    cell: &'r Cell,
    records: &'r [Caused],
    small: bool,
    seeds: &'r str,
}

impl Told<'_> {
    fn share(&self, what: &str, least: f64, of: impl Iterator<Item = bool>) -> Figure {
        let all: Vec<bool> = of.collect();
        let count = all.len();
        let share = Proportion::of(all);
        let name = format!("{}: {what}", self.cell.name);
        let mut figure = Figure::within(&name, [least, 1.0], share.share()).of_share(share);
        if self.small || count < FEW {
            figure = figure.judged(share.at_least(least));
        }
        figure.over(count, self.seeds)
    }

    fn ratio(&self, what: &str, bounds: [f64; 2], measured: f64) -> Figure {
        let name = format!("{}: {what}", self.cell.name);
        let mut figure = Figure::within(&name, bounds, measured);
        if self.small {
            figure = figure.judged(Judgement::TooFew);
        }
        figure.over(self.records.len(), self.seeds)
    }

    fn note(&self, what: &str, of: impl Iterator<Item = bool>) -> Figure {
        let name = format!("{}: {what}", self.cell.name);
        let measured = format!("{:.3}", Proportion::of(of).share());
        Figure::note(&name, measured).over(self.records.len(), self.seeds)
    }

    /// Power for slow causes.
    fn power(&self) -> Figure {
        let of = |held: fn(&Caused) -> bool| Proportion::of(self.records.iter().map(held)).share();
        let power = of(|one| one.in_set) / of(|one| one.oracle_in_set).max(f64::MIN_POSITIVE);
        let what = "power over that of a search that knows that no rate walks";
        Figure {
            target: ">= 0.95".to_owned(),
            ..self.ratio(what, [0.95, f64::INFINITY], power)
        }
    }

    /// Detection and sets.
    fn naming(&self) -> Vec<Figure> {
        let all = || self.records.iter();
        let sizes = all().filter_map(|one| Some([one.set_size?, one.oracle_set_size?]));
        let [own, oracle] = sizes.fold([0.0, 0.0], |[own, oracle], [one, other]| {
            [own + one as f64, oracle + other as f64]
        });
        let what = "mean set size over that of a search that knows that no rate walks";
        vec![
            self.share("detected", 0.98, all().map(|one| one.detected)),
            self.share("a set holds the cause", 0.95, all().map(|one| one.in_set)),
            self.ratio(what, [0.0, 1.1], own / oracle.max(1.0)),
            self.note("spurious second cause", all().map(|one| one.spurious)),
        ]
    }

    /// Sets without a noise process.
    fn alone(&self) -> [Figure; 2] {
        let kind = |one: &Caused| effect(&one.effect).map(|effect| effect.kind);
        let is_quick = |one: &&Caused| {
            kind(one) == Some(EffectKind::Periodic)
                || (kind(one) == Some(EffectKind::Constant) && one.effect.contains(".g_"))
        };
        let is_warm_up = |one: &&Caused| kind(one) == Some(EffectKind::Exponential);
        let [quick, warm_up] = self.cell.least_alone;
        let of_quick = self.records.iter().filter(is_quick).map(|one| one.alone);
        let of_warm_ups = self.records.iter().filter(is_warm_up).map(|one| one.alone);
        [
            self.share(
                "no noise process in the set, diurnal and g terms",
                quick,
                of_quick,
            ),
            self.share(
                "no noise process in the set, warm-ups",
                warm_up,
                of_warm_ups,
            ),
        ]
    }

    /// Intervals of the coefficients.
    fn coefficients(&self) -> [Figure; 3] {
        let all = || self.records.iter();
        let covered = all().flat_map(|one| one.over_set.iter().copied());
        let first = all().flat_map(|one| one.first.iter().copied());
        let mut widths: Vec<f64> = all().flat_map(|one| one.widths.clone()).collect();
        widths.sort_by(f64::total_cmp);
        let median = widths.get(widths.len() / 2).copied().unwrap_or(f64::NAN);
        let what = "coefficients in the 95 % intervals over the sets, whatever was named";
        [
            self.share(what, 0.93, covered),
            self.note("in those of the first member", first),
            self.ratio(
                "median width of these over the true model's",
                [0.0, 1.3],
                median,
            ),
        ]
    }
}

fn cell_figures(told: &Told<'_>) -> Vec<Figure> {
    if told.cell.slow {
        return vec![told.power()];
    }
    let mut figures = Vec::new();
    if told.cell.tells_sets {
        figures.extend(told.naming());
    }
    figures.extend(told.alone());
    figures.extend(told.coefficients());
    figures
}

fn effect(id: &str) -> Option<&'static Effect> {
    EFFECTS.iter().find(|effect| effect.id == id)
}

fn is_slow(effect: &Effect) -> bool {
    effect.rate().is_some()
        && matches!(
            effect.kind,
            EffectKind::Ramp | EffectKind::Step | EffectKind::Exponential | EffectKind::Periodic
        )
}

/// Scenario without a cause, and its true noise.
fn plain(seed: u64) -> Result<(Scenario, NoiseModel), EvaluationError> {
    let mut random = Draw::new(seed, LEVELS);
    let mut plain = Scenario {
        interval_s: 60.0,
        ..scenario(seed)
    };
    let mut noise = NoiseModel::default();
    if random.uniform() < 0.5 {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            noise.gyro_ratio[axis] = random.log_uniform(MISDECLARED);
            noise.accel_ratio[axis] = random.log_uniform(MISDECLARED);
            for (id, ratio) in [
                (format!("gyro_{name}.noise"), noise.gyro_ratio[axis]),
                (format!("accel_{name}.noise"), noise.accel_ratio[axis]),
            ] {
                plain.hidden.push(Hidden::new(&id, &[("ratio", ratio)])?);
            }
        }
    }
    Ok((plain, noise))
}

/// A cause of the strength of the cell in the noise as it is.
fn draw(
    cell: &Cell,
    seed: u64,
    plain: &Scenario,
    noise: &NoiseModel,
) -> Result<InjectedEffect, EvaluationError> {
    let mut random = Draw::new(seed, CAUSES);
    let effects: Vec<_> = testable_effects(plain)
        .into_iter()
        .filter(|effect| !cell.slow || is_slow(effect))
        .collect();
    let clean = simulate(plain)?;
    let run = Run {
        record: &clean.record,
        bench: &clean.bench,
    };
    let fitted = FittedPlatform::nominal(&run, &Options::default(), noise)?;
    for _ in 0..DRAWS {
        let effect = *random.one_of(&effects);
        let with_shape = [(effect, draw_shape(effect, plain, &mut random))];
        let injected = inject_into(
            &clean,
            &fitted,
            &with_shape,
            cell.strength,
            1.0,
            &mut random,
        )?;
        if let Some(only) = injected.and_then(|injected| injected.into_iter().next()) {
            return Ok(only);
        }
    }
    Err(EvaluationError::NotInjectable {
        tried: DRAWS,
        strength: cell.strength,
    })
}

fn record(cell: &Cell, seed: u64) -> Result<Caused, EvaluationError> {
    let (plain, noise) = plain(seed)?;
    let injected = draw(cell, seed, &plain, &noise)?;
    let mut hidden = plain.hidden.clone();
    hidden.push(injected.to_hidden()?);
    let simulation = simulate(&Scenario { hidden, ..plain })?;
    let (data, bench) = (&simulation.record, &simulation.bench);
    let found = diagnose(data, bench, &DiagnoseOptions::default())?;
    let id = injected.effect.id;
    let sets: Vec<(bool, usize)> = found
        .result
        .causes()
        .map(|finding| (holds(finding, id), 1 + finding.alternatives.len()))
        .collect();
    let in_set = sets.iter().any(|(holds, _)| *holds);
    let alone = found
        .result
        .causes()
        .any(|finding| holds(finding, id) && !has_noise(finding));
    let [over_set, first, widths] = coefficients(&found, &simulation, &injected)?;
    let oracle = oracle(&found, &simulation, id)?;
    Ok(Caused {
        effect: id.to_owned(),
        detected: !sets.is_empty(),
        in_set,
        alone,
        set_size: sets.first().map(|(_, size)| *size),
        spurious: sets.len() > 1,
        oracle_in_set: oracle.0,
        oracle_set_size: oracle.1,
        over_set: over_set.iter().map(|held| *held > 0.5).collect(),
        first: first.iter().map(|held| *held > 0.5).collect(),
        widths,
    })
}

fn holds(finding: &Finding, id: &str) -> bool {
    let mut others = finding.alternatives.iter();
    same_or_equivalent(&finding.effect, id)
        || others.any(|other| same_or_equivalent(&other.effect, id))
}

/// Whether a noise process is in a set.
fn has_noise(finding: &Finding) -> bool {
    let all = finding
        .alternatives
        .iter()
        .map(|other| other.effect.as_str());
    let is_walk = |id: &str| effect(id).is_some_and(|one| one.kind == EffectKind::RandomWalk);
    all.chain([finding.effect.as_str()]).any(is_walk)
}

/// The same search without random walks: whether a set holds the cause, and the size of the first.
fn oracle(
    found: &Diagnosis<'_>,
    simulation: &Simulation,
    id: &str,
) -> Result<(bool, Option<usize>), EvaluationError> {
    let options = SearchOptions {
        false_alarm_probability: found.result.false_alarm_shares.search,
        ..SearchOptions::default()
    };
    let (record, bench) = (&simulation.record, &simulation.bench);
    let mut selection = selection(record, bench, &[]);
    selection
        .effects
        .retain(|effect| effect.kind != EffectKind::RandomWalk);
    let run = Run { record, bench };
    let mut noise = found.noise_model.clone();
    noise.gyro_walk_deg_per_h_per_sqrt_h = [0.0; 3];
    let nominal = FittedPlatform::nominal(&run, &Options::default(), &noise)?;
    let rows = rows(record, nominal.covariates());
    let searched = search(nominal, rows, &selection, &options)?;
    let mut findings = searched.findings.iter();
    let in_set = findings.any(|finding| {
        let mut others = finding.alternatives.iter();
        same_or_equivalent(finding.effect, id)
            || others.any(|other| same_or_equivalent(other.effect, id))
    });
    let first = searched.findings.first();
    Ok((in_set, first.map(|finding| 1 + finding.alternatives.len())))
}

/// Whether the intervals over the set hold the true coefficients, whether those of the first member do,
/// and the widths of the former over those of the true model.
fn coefficients(
    found: &Diagnosis<'_>,
    simulation: &Simulation,
    injected: &InjectedEffect,
) -> Result<[Vec<f64>; 3], EvaluationError> {
    let Some(stated) = &found.result.coefficients else {
        return Ok(Default::default());
    };
    let run = Run {
        record: &simulation.record,
        bench: &simulation.bench,
    };
    let mut noise = found.noise_model.clone();
    noise.gyro_walk_deg_per_h_per_sqrt_h = [0.0; 3];
    let nominal = FittedPlatform::nominal(&run, &Options::default(), &noise)?;
    let plant = &gyrocal_calibration::PLATFORM;
    let rows = rows(run.record, nominal.covariates());
    let set = HypothesisSet::new(plant, &rows, &[injected.effect]);
    let mut extension = ModelExtension::default();
    set.add_to_model(plant, &rows, &mut extension, 0, injected.shape);
    let true_model = nominal.refitted(&extension)?;
    let truth = simulation.truth.coefficients;
    let truth: Vec<f64> = (0..3)
        .flat_map(|gyro| {
            [
                truth.bias_deg_per_h[gyro],
                truth.g_deg_per_h_per_g[gyro],
                truth.gg_deg_per_h_per_g2[gyro],
            ]
        })
        .collect();
    let mut answers: [Vec<f64>; 3] = Default::default();
    for (index, value) in truth.iter().enumerate().take(COEFFICIENTS) {
        let best = stated.extended.as_ref().unwrap_or(&stated.nominal);
        let own = NORMAL_97_5 * best[index].sigma;
        let first = [best[index].estimate - own, best[index].estimate + own];
        let interval = stated
            .over_set
            .as_ref()
            .map_or(first, |all| all[index].interval);
        let held =
            |interval: [f64; 2]| f64::from(u8::from((interval[0]..=interval[1]).contains(value)));
        answers[0].push(held(interval));
        answers[1].push(held(first));
        let sigma = true_model.covariance()[(index, index)].sqrt();
        answers[2].push((interval[1] - interval[0]) / (2.0 * NORMAL_97_5 * sigma));
    }
    Ok(answers)
}
