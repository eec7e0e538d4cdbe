//! None of these: effects that the catalogue does not hold, beside effects that it does, and the
//! probability that the diagnosis gives to none of its effects.

use gyrocal_diagnosis::Diagnosis;
use gyrocal_evaluation::{EvaluationError, Statistic, UnlistedRecord, diagnosed, inject_any};
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::mean;
use gyrocal_truth::faults::UnlistedKind;
use gyrocal_truth::{Scenario, simulate};
use serde::{Deserialize, Serialize};

use super::drawn::{self, noisy};
use super::judged;
use crate::harness::{Context, DIAGNOSIS, Error, Figure, Population, Row, Sources, of};

/// What can move the records.
const SOURCES: Sources = of(DIAGNOSIS, &[file!(), drawn::FILE, judged::FILE]);

/// Bins of equal count of the probability.
const BINS: usize = 5;

/// Largest ratio of strengths that count as equal.
const EQUAL: f64 = 1.25;

/// Purpose of the stream of draws.
const EFFECTS: u64 = 45;

/// Strengths given the nominal model, in standard deviations.
const STRENGTHS: [f64; 2] = [8.0, 200.0];

/// Least strength beside the best model of the catalogue.
const BESIDE: f64 = 8.0;

/// What is hidden in a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Of {
    /// Kinds outside of the catalogue that served to choose constants, and others.
    Developed,
    Unseen,
    /// An effect of the catalogue.
    Listed,
}

/// Result for one record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Outside {
    of: Of,
    /// Strength of the effect given the nominal model, and beside what is named; the latter is that
    /// of the former of an effect of the catalogue.
    strength: f64,
    beside: f64,
    /// Probability that none of the catalogue is the cause, as the diagnosis states it: that of its
    /// likeliest name. One that is unexplained without a name states it with certainty; one that is called
    /// clean, or of which the search was cut, not at all.
    none: Option<f64>,
    /// Whether one effect is named without alternatives.
    is_single: bool,
    is_clean: bool,
}

impl Outside {
    /// Whether one effect is named without alternatives, and nothing says that none of these is likelier.
    fn is_named_alone(&self) -> bool {
        self.is_single && self.none.is_none_or(|none| none < 0.5)
    }

    fn is_outside(&self) -> bool {
        self.of != Of::Listed && self.beside >= BESIDE
    }
}

pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let population = Population::new("outside", [760_000, 4000, 8], SOURCES, record);
    let mut rows = rows_of(Of::Developed, "used in development");
    rows.extend(rows_of(Of::Unseen, "not used"));
    let name = "effects of the catalogue: none of these above a half";
    let denied =
        |one: &Outside| (one.of == Of::Listed).then(|| one.none.is_some_and(|none| none > 0.5));
    let reason = "one in twenty may be told to look elsewhere in vain";
    rows.push(Row::share(name, denied).at_most(0.05, reason));
    let name = "the same, of which there is a record of the catalogue that is as strong";
    let pairs = |all: &[Outside]| of_equal_strength(all).len().to_string();
    rows.push(Row::words(name, pairs));
    let name = "stated probability of none of these, of the share that is so, in five bins of records of equal strength";
    rows.push(Row::words(name, calibration));
    for bin in 0..BINS {
        let name = format!("the same, probability less share: bin {}", bin + 1);
        let excess = move |all: &[Outside]| {
            let bins = bins(all);
            let of_bin = bins.get(bin).map_or(&[][..], Vec::as_slice);
            Statistic::Mean(of_bin.iter().map(|[none, so]| none - so).collect())
        };
        let reason =
            "a twentieth of what is stated; the standard error of 140 records is 0.04 at one half";
        rows.push(Row::new(name, excess).between([-0.05, 0.05], reason));
    }
    context.measure(&population, &rows)
}

/// Rows of effects outside of the catalogue.
fn rows_of(kinds: Of, which: &str) -> Vec<Row<'static, Outside>> {
    let share = |name: [&str; 2], least: f64, is: fn(&Outside) -> bool| {
        Row::share(name.join(which), move |one: &Outside| {
            (one.of == kinds && one.beside >= least).then(|| is(one))
        })
    };
    let strong = ", 8 σ beside what is named: named alone, none of these below a half";
    let all = ", 8 to 200 σ of which the names may leave less";
    let clean = ", 8 σ beside what is named: called clean";
    let cut = ", 8 σ beside: searches cut, which state no probability";
    let same = "the same, kinds ";
    vec![
        share(
            ["outside of the catalogue, kinds ", strong],
            BESIDE,
            Outside::is_named_alone,
        )
        .at_most(0.1, "a wrong name without a warning is the worst answer"),
        share([same, all], 0.0, Outside::is_named_alone),
        share([same, clean], BESIDE, |one| one.is_clean),
        share([same, cut], BESIDE, |one| {
            one.none.is_none() && !one.is_clean
        }),
    ]
}

/// Pairs of what is stated of a record outside of the catalogue and of one of it: of the one whose strength given
/// the nominal model is the nearest, within a quarter, none of them twice, the strongest first, which few match.
/// Prior odds are one to one so.
fn of_equal_strength(all: &[Outside]) -> Vec<[f64; 2]> {
    let stated = |is_meant: fn(&Outside) -> bool| {
        let meant = all.iter().filter(move |one| is_meant(one));
        let stated = meant.filter_map(|one| Some((one.strength, one.none?)));
        stated.collect::<Vec<(f64, f64)>>()
    };
    let mut outside = stated(Outside::is_outside);
    let mut catalogue = stated(|one| one.of == Of::Listed);
    outside.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut pairs = Vec::new();
    for (strength, none) in outside {
        let off = |of: &usize| (catalogue[*of].0 / strength).ln().abs();
        let near = (0..catalogue.len()).filter(|one| off(one) < EQUAL.ln());
        if let Some(nearest) = near.min_by(|a, b| off(a).total_cmp(&off(b))) {
            pairs.push([none, catalogue.swap_remove(nearest).1]);
        }
    }
    pairs
}

/// Stated probabilities of these pairs in bins of equal count, each with 1 where it is so and 0 where not.
fn bins(all: &[Outside]) -> Vec<Vec<[f64; 2]>> {
    let pairs = of_equal_strength(all).into_iter();
    let both = pairs.flat_map(|[outside, listed]| [[outside, 1.0], [listed, 0.0]]);
    let mut stated: Vec<[f64; 2]> = both.collect();
    stated.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let size = stated.len().div_ceil(BINS).max(1);
    stated.chunks(size).map(<[_]>::to_vec).collect()
}

/// Mean probability and share of each bin, in words.
fn calibration(all: &[Outside]) -> String {
    let words = |bin: &Vec<[f64; 2]>| {
        let [stated, so] = [0, 1].map(|which| mean(bin.iter().map(|one| one[which])));
        format!("{stated:.2} of {so:.2}")
    };
    bins(all).iter().map(words).collect::<Vec<_>>().join(", ")
}

/// Half of the records have an effect of the catalogue, a quarter each one of the kinds that served to choose
/// constants and of the others: all in turn, and the next where a record cannot show one.
fn record(seed: u64) -> Result<Outside, Error> {
    let mut random = Draw::new(seed, EFFECTS);
    let strength = random.log_uniform(STRENGTHS);
    let scenario = Scenario {
        interval_s: 120.0,
        ..noisy(seed)?.0
    };
    let (developed, unseen) = UnlistedKind::OF_FORCE.split_at(5);
    let (of, kinds) = match seed % 4 {
        0 => (Of::Developed, developed),
        1 => (Of::Unseen, unseen),
        _ => {
            let (scenario, _) = inject_any(scenario, strength, &mut random)?;
            let simulation = simulate(&scenario)?;
            let found = diagnosed(&simulation)?;
            return Ok(outside(Of::Listed, [strength; 2], &found));
        }
    };
    let in_turn = kinds.iter().cycle().skip((seed / 4) as usize % 5);
    for kind in in_turn.take(5) {
        if let Some(record) = UnlistedRecord::draw(&scenario, *kind, strength, &mut random)? {
            let found = diagnosed(&record.with)?;
            if let Some(beside) = record.strength_beside(&found) {
                return Ok(outside(of, [strength, beside], &found));
            }
        }
    }
    Err(EvaluationError::NotInjectable { tried: 5, strength }.into())
}

fn outside(of: Of, [strength, beside]: [f64; 2], found: &Diagnosis<'_>) -> Outside {
    let causes: Vec<_> = found.result.causes().collect();
    let unexplained = found.result.is_unexplained();
    let stated = causes.iter().filter_map(|cause| cause.none_of_these);
    Outside {
        of,
        strength,
        beside,
        none: match causes.is_empty() {
            true => unexplained.then_some(1.0),
            false => stated.reduce(f64::min),
        },
        is_single: matches!(causes.as_slice(), [only] if only.alternatives.is_empty()),
        is_clean: causes.is_empty() && !unexplained,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_of_the_catalogue_are_as_strong_and_taken_once() {
        let of = |of: Of, (strength, none): (f64, f64)| Outside {
            of,
            strength,
            beside: strength,
            none: Some(none),
            is_single: false,
            is_clean: false,
        };
        let catalogue = [(8.0, 0.1), (9.0, 0.2), (20.0, 0.3), (200.0, 0.4)];
        let outside = [(8.1, 0.8), (19.0, 0.6), (21.0, 0.7)];
        let listed = catalogue.map(|one| of(Of::Listed, one));
        let mut all = outside.map(|one| of(Of::Unseen, one)).to_vec();
        all.extend(listed);
        // 21 takes the one of 20, and for 19 none is left.
        assert_eq!(of_equal_strength(&all), [[0.7, 0.3], [0.8, 0.1]]);
        let bins = "0.10 of 0.00, 0.30 of 0.00, 0.70 of 1.00, 0.80 of 1.00";
        assert_eq!(calibration(&all), bins);
    }
}
