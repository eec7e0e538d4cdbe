//! One cause of the catalogue in noise that is misdeclared in half of the records: detection, sets,
//! intervals, and the coefficients with the cause in the model.

mod record;

use gyrocal::effect::EffectKind;
use gyrocal::{EFFECTS, Effect};
use gyrocal_diagnosis::error_budget::CONFIDENCE_SET_COVERAGE;
use gyrocal_statistics::{Judgement, Proportion};
use record::{Caused, record};
pub(super) use record::{covered, holds, plain};

use super::Extent;
use super::coverage::of_coefficients;
use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;

/// Fewer records than these are judged by an interval.
const FEW: usize = 100;

/// A population.
struct Cell {
    name: &'static str,
    strength: f64,
    /// The causes of which one is hidden.
    of: Causes,
    /// Whether detection and sets are figures of it.
    tells_sets: bool,
    /// Least share of sets without a noise process: with diurnal and g terms, with warm-ups.
    least_alone: [f64; 2],
    first_seed: u64,
    records: u64,
    small: u64,
}

/// Causes of a population.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Causes {
    /// All of the catalogue.
    All,
    /// Those that change slowly in time.
    Slow,
    /// Those of a kind, of which there are few among all.
    Of(EffectKind),
}

const CELLS: [Cell; 4] = [
    Cell {
        name: "d = 8",
        strength: 8.0,
        of: Causes::All,
        tells_sets: true,
        least_alone: [0.85, 0.55],
        first_seed: 801_000,
        records: 1000,
        small: 4,
    },
    Cell {
        name: "d = 12",
        strength: 12.0,
        of: Causes::All,
        least_alone: [0.97, 0.88],
        first_seed: 811_000,
        records: 600,
        ..FURTHER
    },
    Cell {
        name: "slow causes, d = 5",
        strength: 5.0,
        of: Causes::Slow,
        first_seed: 821_000,
        ..FURTHER
    },
    Cell {
        name: "slow causes, d = 6",
        strength: 6.0,
        of: Causes::Slow,
        first_seed: 831_000,
        ..FURTHER
    },
];

/// A further population, of the full version only.
const FURTHER: Cell = Cell {
    name: "",
    strength: 8.0,
    of: Causes::All,
    tells_sets: false,
    least_alone: [0.0, 0.0],
    first_seed: 0,
    records: 300,
    small: 0,
};

/// Populations of one kind of causes, of which the coverage of sets is measured.
const KINDS: [Cell; 8] = [
    Cell {
        name: "warm-ups, d = 8",
        of: Causes::Of(EffectKind::Exponential),
        least_alone: [0.0, 0.55],
        first_seed: 841_000,
        ..FURTHER
    },
    Cell {
        name: "warm-ups, d = 12",
        strength: 12.0,
        of: Causes::Of(EffectKind::Exponential),
        least_alone: [0.0, 0.88],
        first_seed: 851_000,
        ..FURTHER
    },
    Cell {
        name: "steps, d = 8",
        of: Causes::Of(EffectKind::Step),
        first_seed: 861_000,
        ..FURTHER
    },
    Cell {
        name: "ramps, d = 8",
        of: Causes::Of(EffectKind::Ramp),
        first_seed: 862_000,
        ..FURTHER
    },
    Cell {
        name: "periodic causes, d = 8",
        of: Causes::Of(EffectKind::Periodic),
        first_seed: 863_000,
        ..FURTHER
    },
    Cell {
        name: "causes of a logged quantity, d = 8",
        of: Causes::Of(EffectKind::Regressor),
        first_seed: 864_000,
        ..FURTHER
    },
    Cell {
        name: "jumps of the attitude, d = 8",
        of: Causes::Of(EffectKind::StateJump),
        first_seed: 865_000,
        ..FURTHER
    },
    Cell {
        name: "wrong first attitudes, d = 8",
        of: Causes::Of(EffectKind::InitialState),
        first_seed: 866_000,
        ..FURTHER
    },
];

pub(crate) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let small = extent.small;
    let mut figures = Vec::new();
    let cells = CELLS.iter().chain(&KINDS);
    for cell in cells.filter(|cell| cell.small > 0 || !small) {
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

    /// Power for slow causes: that a set holds the cause.
    fn power(&self) -> Vec<Figure> {
        let of = |held: fn(&Caused) -> bool| Proportion::of(self.records.iter().map(held));
        let [own, oracle] = [of(|one| one.in_set), of(|one| one.oracle_in_set)];
        let power = own.share() / oracle.share().max(f64::MIN_POSITIVE);
        let what = "power over that of a search that knows that no rate walks";
        let over = Figure {
            target: ">= 0.95".to_owned(),
            ..self.ratio(what, [0.95, f64::INFINITY], power)
        };
        let note = |what: &str, share| {
            Figure::note_share(&format!("{}: {what}", self.cell.name), share, self.seeds)
        };
        vec![
            over,
            note("a set holds the cause", own),
            note("the same of that search", oracle),
        ]
    }

    /// Detection and sets.
    fn naming(&self) -> Vec<Figure> {
        let all = || self.records.iter();
        let sizes = all().filter_map(|one| Some([one.set_size?, one.oracle_set_size?]));
        let [own, oracle] = sizes.fold([0.0, 0.0], |[own, oracle], [one, other]| {
            [own + one as f64, oracle + other as f64]
        });
        let what = "mean set size over that of a search that knows that no rate walks";
        let mut figures = vec![
            self.share("detected", 0.98, all().map(|one| one.detected)),
            self.share("a set holds the cause", 0.95, all().map(|one| one.in_set)),
            self.ratio(what, [0.0, 1.1], own / oracle.max(1.0)),
            self.note("spurious second cause", all().map(|one| one.spurious)),
        ];
        figures.extend(self.coverage_by_kind());
        figures
    }

    /// Coverage of the set, of the records in which something was found, by kind of the cause.
    fn coverage_by_kind(&self) -> Vec<Figure> {
        let mut kinds: Vec<(EffectKind, Vec<bool>)> = Vec::new();
        for one in self.records.iter().filter(|one| one.detected) {
            let Some(effect) = effect(&one.effect) else {
                continue;
            };
            match kinds.iter_mut().find(|(kind, _)| *kind == effect.kind) {
                Some((_, held)) => held.push(one.in_set),
                None => kinds.push((effect.kind, vec![one.in_set])),
            }
        }
        let row = |(kind, held): &(EffectKind, Vec<bool>)| {
            let name = format!("{}: coverage of the set, kind {kind:?}", self.cell.name);
            let share = Proportion::of(held.iter().copied());
            Figure::note(&name, format!("{:.3}", share.share())).over(held.len(), self.seeds)
        };
        kinds.iter().map(row).collect()
    }

    /// Sets without a noise process, of effects that a random walk stands for least.
    fn alone(&self) -> [Figure; 2] {
        // Constants of a gyro that the search tests are the terms of specific force.
        let of_gyro = |one: &Caused| effect(&one.effect).is_some_and(|one| one.rate().is_some());
        let is_quick = |one: &&Caused| {
            kind(one) == Some(EffectKind::Periodic)
                || (kind(one) == Some(EffectKind::Constant) && of_gyro(one))
        };
        let of_quick = self.records.iter().filter(is_quick).map(|one| one.alone);
        let what = "no noise process in the set, diurnal and g terms";
        let quick = self.share(what, self.cell.least_alone[0], of_quick);
        [quick, self.alone_of_warm_ups()]
    }

    /// The same of warm-ups.
    fn alone_of_warm_ups(&self) -> Figure {
        let is_warm_up = |one: &&Caused| kind(one) == Some(EffectKind::Exponential);
        let of_warm_ups = self.records.iter().filter(is_warm_up).map(|one| one.alone);
        let what = "no noise process in the set, warm-ups";
        self.share(what, self.cell.least_alone[1], of_warm_ups)
    }

    /// Sets of one kind of causes: their coverage where something was found, and warm-ups without a noise process.
    fn of_kind(&self, kind: EffectKind) -> Vec<Figure> {
        let found = self.records.iter().filter(|one| one.detected);
        let name = format!("{}: coverage of the set", self.cell.name);
        let covered = Proportion::of(found.map(|one| one.in_set));
        let mut figures = vec![Figure {
            target: format!("{CONFIDENCE_SET_COVERAGE} not excluded"),
            // Of eight kinds none is to fail by chance.
            holds: Some(covered.at_least(CONFIDENCE_SET_COVERAGE) != Judgement::Missed),
            ..Figure::note_share(&name, covered, self.seeds)
        }];
        if kind == EffectKind::Exponential {
            figures.push(self.alone_of_warm_ups());
        }
        figures
    }

    /// Intervals of the coefficients.
    fn coefficients(&self) -> Vec<Figure> {
        let all = || self.records.iter();
        let covered: Vec<&[bool]> = all().map(|one| one.over_set.as_slice()).collect();
        let first = all().flat_map(|one| one.first.iter().copied());
        let mut widths: Vec<f64> = all().flat_map(|one| one.widths.clone()).collect();
        widths.sort_by(f64::total_cmp);
        let median = widths.get(widths.len() / 2).copied().unwrap_or(f64::NAN);
        let name = format!(
            "{}: coefficients in the 95 % intervals over the sets, whatever was named",
            self.cell.name
        );
        let mut figures = of_coefficients(&name, &covered, self.seeds, self.small);
        figures.extend([
            self.note("in those of the first member", first),
            self.ratio(
                "median width of these over the true model's",
                [0.0, 1.3],
                median,
            ),
        ]);
        figures
    }
}

fn cell_figures(told: &Told<'_>) -> Vec<Figure> {
    match told.cell.of {
        Causes::Slow => return told.power(),
        Causes::Of(kind) => return told.of_kind(kind),
        Causes::All => {}
    }
    let mut figures = Vec::new();
    if told.cell.tells_sets {
        figures.extend(told.naming());
    }
    figures.extend(told.alone());
    figures.extend(told.coefficients());
    figures
}

fn kind(one: &Caused) -> Option<EffectKind> {
    effect(&one.effect).map(|effect| effect.kind)
}

fn effect(id: &str) -> Option<&'static Effect> {
    EFFECTS.iter().find(|effect| effect.id == id)
}

#[cfg(test)]
mod tests {
    use gyrocal_diagnosis::set_coverage::SET_COVERAGE;

    use super::*;
    use crate::harness::pages;

    /// The row of the page with the coverage of a kind.
    fn row_of(kind: EffectKind) -> String {
        let own = |cell: &&Cell| cell.of == Causes::Of(kind) && cell.name.ends_with("d = 8");
        match KINDS.iter().find(own) {
            Some(cell) => format!("{}: coverage of the set", cell.name),
            None => format!("d = 8: coverage of the set, kind {kind:?}"),
        }
    }

    #[test]
    fn stated_coverages_are_those_of_the_page() {
        let page = std::fs::read_to_string(pages::path("diagnosis")).unwrap();
        for (kind, stated) in SET_COVERAGE {
            let start = format!("| {} ", row_of(kind));
            let row = page.lines().find(|line| line.starts_with(&start));
            let measured = row.and_then(|row| row.split('|').nth(3)?.split_whitespace().next());
            let measured: f64 = measured.expect(&start).parse().unwrap();
            // Rounded down, and never all of them; three decimals have no exact binary form.
            let rounded = ((100.0 * measured + 1e-9).floor() / 100.0).min(0.99);
            assert!(
                (rounded - stated).abs() < 1e-9,
                "{start}: {measured}, stated {stated}"
            );
        }
    }
}
