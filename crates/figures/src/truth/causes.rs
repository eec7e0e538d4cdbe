//! One cause of the catalogue in noise that is misdeclared in half of the records: detection, sets,
//! intervals, and the coefficients with the cause in the model.

use gyrocal::Effect;
use gyrocal::effect::EffectKind;
use gyrocal_calibration::{FittedPlatform, Options, PLATFORM, rows};
use gyrocal_diagnosis::Diagnosis;
use gyrocal_diagnosis::error_budget::CONFIDENCE_SET_COVERAGE;
use gyrocal_diagnosis::set_coverage::SET_COVERAGE;
use gyrocal_evaluation::{
    InjectedEffect, diagnosed, effect_of, inject_one_of, run_of, same_or_equivalent, set_holds,
    sets_without_walks, testable_effects,
};
use gyrocal_hypothesis::{FittedModel, HypothesisSet, ModelExtension};
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::{NORMAL_97_5, median};
use gyrocal_truth::{Simulation, simulate};
use serde::{Deserialize, Serialize};

use super::drawn::{self, noisy};
use super::judged::{self, Stated, coefficient_rows, coefficients, may_walk};
use crate::harness::{Context, DIAGNOSIS, Error, Figure, Population, Row, Sources, of};

use Causes::{All, Of, Slow};
use EffectKind::{Exponential, InitialState, Periodic, Ramp, Regressor, StateJump, Step};

/// What can move the records.
const SOURCES: Sources = of(DIAGNOSIS, &[file!(), drawn::FILE, judged::FILE]);

/// Purpose of the stream of draws.
const CAUSES: u64 = 47;

/// Reason of the coverage of sets.
const SETS: &str = "the sets are of 95 %";

/// A population.
struct Cell {
    causes: &'static str,
    of: Causes,
    strength: f64,
    /// First seed, and number of records: of the full and of the small version.
    seeds: [u64; 3],
}

/// The causes of which one is hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Causes {
    /// All of the catalogue.
    All,
    /// Those that change slowly in time.
    Slow,
    /// Those of a kind, of which there are few among all.
    Of(EffectKind),
}

const CELLS: [Cell; 12] = [
    cell("", All, 8.0, [801_000, 1000, 4]),
    cell("", All, 12.0, [811_000, 600, 0]),
    cell("slow causes, ", Slow, 5.0, [821_000, 300, 0]),
    cell("slow causes, ", Slow, 6.0, [831_000, 300, 0]),
    of_kind("warm-ups, ", Exponential, 8.0, 841_000),
    of_kind("warm-ups, ", Exponential, 12.0, 851_000),
    of_kind("steps, ", Step, 8.0, 861_000),
    of_kind("ramps, ", Ramp, 8.0, 862_000),
    of_kind("periodic causes, ", Periodic, 8.0, 863_000),
    of_kind("causes of a logged quantity, ", Regressor, 8.0, 864_000),
    of_kind("jumps of the attitude, ", StateJump, 8.0, 865_000),
    of_kind("wrong first attitudes, ", InitialState, 8.0, 866_000),
];

const fn cell(causes: &'static str, of: Causes, strength: f64, seeds: [u64; 3]) -> Cell {
    Cell {
        causes,
        of,
        strength,
        seeds,
    }
}

const fn of_kind(causes: &'static str, kind: EffectKind, strength: f64, first: u64) -> Cell {
    cell(causes, Of(kind), strength, [first, 300, 0])
}

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

impl Caused {
    fn is_of(&self, kind: EffectKind) -> bool {
        effect_of(&self.effect).is_some_and(|effect| effect.kind == kind)
    }

    /// Of effects that a random walk stands for least, whether the set is without one.
    fn quick_alone(&self) -> Option<bool> {
        // Constants of a gyro that the search tests are the terms of specific force.
        let of_gyro = effect_of(&self.effect).is_some_and(|effect| effect.rate().is_some());
        let is_quick = self.is_of(Periodic) || (self.is_of(EffectKind::Constant) && of_gyro);
        is_quick.then_some(self.alone)
    }
}

pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for cell in &CELLS {
        let name = cell.named("records");
        let job = |seed| record(cell, seed);
        let population = Population::new(name, cell.seeds, SOURCES, job);
        figures.extend(context.measure(&population, &cell.rows())?);
    }
    Ok(figures)
}

type Rows = Vec<Row<'static, Caused>>;

impl Cell {
    /// Name of a row.
    fn named(&self, what: &str) -> String {
        format!("{}d = {}: {what}", self.causes, self.strength)
    }

    fn share(&self, what: &str, of: fn(&Caused) -> bool) -> Row<'static, Caused> {
        Row::share(self.named(what), move |one| Some(of(one)))
    }

    /// Coverage of the set of causes of a kind, where something was found.
    fn coverage(&self, what: &str, kind: EffectKind) -> Row<'static, Caused> {
        Row::share(self.named(what), move |one: &Caused| {
            (one.detected && one.is_of(kind)).then_some(one.in_set)
        })
    }

    fn rows(&self) -> Rows {
        match self.of {
            Slow => self.power(),
            Of(kind) => {
                let coverage = self.coverage("coverage of the set", kind);
                let mut rows = vec![coverage.at_least(CONFIDENCE_SET_COVERAGE, SETS)];
                rows.extend((kind == Exponential).then(|| self.warm_ups()));
                rows
            }
            All => {
                // Coverages are stated of causes of this strength.
                let is_stated = self.strength == 8.0;
                let mut rows = if is_stated { self.naming() } else { Vec::new() };
                rows.extend(self.beside_noise());
                rows
            }
        }
    }

    /// Power for slow causes: that a set holds the cause.
    fn power(&self) -> Rows {
        let over = self.named("power over that of a search that knows that no rate walks");
        let both = |one: &Caused| Some([one.in_set, one.oracle_in_set].map(f64::from));
        vec![
            Row::ratio(over, both)
                .at_least(0.95, "unknown noise hides one cause of twenty at most"),
            self.share("a set holds the cause", |one| one.in_set),
            self.share("the same of that search", |one| one.oracle_in_set),
        ]
    }

    /// Detection and sets.
    fn naming(&self) -> Rows {
        let over = self.named("mean set size over that of a search that knows that no rate walks");
        let sizes = |one: &Caused| Some([one.set_size? as f64, one.oracle_set_size? as f64]);
        let kinds = SET_COVERAGE.iter().map(|(kind, _)| *kind);
        let of_kind = |kind| self.coverage(&format!("coverage of the set, kind {kind:?}"), kind);
        let mut rows = vec![
            self.share("detected", |one| one.detected)
                .at_least(0.98, "the threshold is three standard deviations lower"),
            self.share("a set holds the cause", |one| one.in_set)
                .at_least(CONFIDENCE_SET_COVERAGE, SETS),
            Row::ratio(over, sizes).at_most(1.1, "unknown noise adds one name to ten at most"),
            self.share("spurious second cause", |one| one.spurious),
        ];
        rows.extend(kinds.map(of_kind));
        rows
    }

    /// Sets without a noise process, and intervals of the coefficients.
    fn beside_noise(&self) -> Rows {
        let least = if self.strength < 10.0 { 0.85 } else { 0.97 };
        let quick = self.named("no noise process in the set, diurnal and g terms");
        let reason = "no walk follows a day or the attitude for long";
        let covered =
            self.named("coefficients in the 95 % intervals over the sets, whatever was named");
        let first = self.named("in those of the first member");
        let widths = self.named("median width of these over the true model's");
        let width = |one: &Caused| (!one.widths.is_empty()).then(|| median(&one.widths));
        let quick = Row::share(quick, Caused::quick_alone).at_least(least, reason);
        let mut rows = vec![quick, self.warm_ups()];
        rows.extend(coefficient_rows(&covered, |one: &Caused| &one.over_set));
        rows.push(Row::each(first, |one: &Caused| one.first.clone()));
        let reason = "what names and noise that are not known may cost";
        rows.push(Row::median(widths, width).at_most(1.3, reason));
        rows
    }

    /// Sets of warm-ups without a noise process.
    fn warm_ups(&self) -> Row<'static, Caused> {
        let least = if self.strength < 10.0 { 0.55 } else { 0.88 };
        let name = self.named("no noise process in the set, warm-ups");
        let alone = |one: &Caused| one.is_of(Exponential).then_some(one.alone);
        let reason = "a walk may stand for a slow curve; the stronger it is, the less";
        Row::share(name, alone).at_least(least, reason)
    }
}

fn is_slow(effect: &Effect) -> bool {
    effect.rate().is_some() && matches!(effect.kind, Ramp | Step | Exponential | Periodic)
}

/// Simulates and diagnoses the record of a seed.
fn record(cell: &Cell, seed: u64) -> Result<Caused, Error> {
    let (mut scenario, noise) = noisy(seed)?;
    // Without a log there is no such cause.
    if cell.of == Of(Regressor) {
        scenario.temperature.get_or_insert_default();
    }
    let mut effects = testable_effects(&scenario);
    effects.retain(|effect| match cell.of {
        All => true,
        Slow => is_slow(effect),
        Of(kind) => effect.kind == kind,
    });
    let mut random = Draw::new(seed, CAUSES);
    let (scenario, cause) = inject_one_of(&effects, scenario, &noise, cell.strength, &mut random)?;
    let simulation = simulate(&scenario)?;
    let found = diagnosed(&simulation)?;
    let id = cause.effect.id;
    let causes: Vec<_> = found.result.causes().collect();
    let mut holding = causes.iter().filter(|finding| set_holds(finding, id));
    let oracle = sets_without_walks(&found, &simulation)?;
    let holds_it = |set: &Vec<&str>| set.iter().any(|effect| same_or_equivalent(effect, id));
    let stated = coefficients(&found.result, &simulation);
    let sigmas = true_sigmas(&found, &simulation, &cause)?;
    let of_true = |(one, sigma): (&Stated, f64)| one.width / (2.0 * NORMAL_97_5 * sigma);
    Ok(Caused {
        effect: id.to_owned(),
        detected: !causes.is_empty(),
        in_set: holding.clone().next().is_some(),
        alone: holding.any(|finding| !may_walk(finding, None)),
        set_size: causes.first().map(|first| 1 + first.alternatives.len()),
        spurious: causes.len() > 1,
        oracle_in_set: oracle.iter().any(holds_it),
        oracle_set_size: oracle.first().map(Vec::len),
        over_set: stated.iter().map(|one| one.covered).collect(),
        first: stated.iter().map(|one| one.first).collect(),
        widths: stated.iter().zip(sigmas).map(of_true).collect(),
    })
}

/// Standard deviations of the coefficients by a model with the cause.
fn true_sigmas(
    found: &Diagnosis<'_>,
    simulation: &Simulation,
    cause: &InjectedEffect,
) -> Result<Vec<f64>, Error> {
    let run = run_of(simulation);
    let mut noise = found.noise_model.clone();
    noise.gyro_walk_deg_per_h_per_sqrt_h = [0.0; 3];
    let nominal = FittedPlatform::nominal(&run, &Options::default(), &noise)?;
    let rows = rows(run.record, nominal.covariates());
    let set = HypothesisSet::new(&PLATFORM, &rows, &[cause.effect]);
    let mut extension = ModelExtension::default();
    set.add_to_model(&PLATFORM, &rows, &mut extension, 0, cause.shape);
    let variances = nominal.refitted(&extension)?.covariance().diagonal();
    Ok(variances.iter().map(|variance| variance.sqrt()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::harness::pages;

    #[test]
    fn stated_coverages_are_those_of_the_page() {
        let page = std::fs::read_to_string(pages::path("diagnosis")).unwrap();
        for (kind, stated) in SET_COVERAGE {
            let own = |cell: &&Cell| cell.of == Of(kind) && cell.strength == 8.0;
            let of_all = || CELLS[0].named(&format!("coverage of the set, kind {kind:?}"));
            let own = CELLS.iter().find(own);
            let row = own.map_or_else(of_all, |cell| cell.named("coverage of the set"));
            let start = format!("| {row} ");
            let row = page.lines().find(|line| line.starts_with(&start));
            let measured = row.and_then(|row| row.split('|').nth(3)?.split_whitespace().next());
            let measured: f64 = measured.expect(&start).parse().unwrap();
            // Rounded down, and never all of them; three decimals have no exact binary form.
            let rounded = ((100.0 * measured + 1e-9).floor() / 100.0).min(0.99);
            let off = (rounded - stated).abs();
            assert!(off < 1e-9, "{start}: {measured}, stated {stated}");
        }
    }
}
