//! None of these: effects that the catalogue does not hold, beside effects that it does, and the
//! probability that the diagnosis gives to none of its effects.

use gyrocal_diagnosis::{DiagnoseOptions, Diagnosis, diagnose};
use gyrocal_evaluation::{EvaluationError, UnlistedKind, UnlistedRecord, inject_any, scenario};
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::{Judgement, Proportion};
use gyrocal_truth::{Hidden, Scenario, simulate};
use serde::{Deserialize, Serialize};

use super::Extent;
use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;

/// First seeds: kinds that served to choose constants, others, effects of the catalogue.
const FIRST_SEEDS: [u64; 3] = [760_000, 770_000, 780_000];

/// Records of each kind outside of the catalogue, of which there are two; there are as many of the catalogue
/// as of both. The same in the small version.
const RECORDS: u64 = 1000;
const SMALL: u64 = 2;
const OF_CATALOGUE: usize = 2;

/// Names of the cells of results.
const CELLS: [&str; 3] = ["outside-developed", "outside-unseen", "outside-listed"];

/// Largest share of records with such an effect that are named alone, none of these being less likely
/// than not.
const MISNAMED: f64 = 0.10;

/// Largest share of records with an effect of the catalogue of which none of these is said.
const DENIED: f64 = 0.05;

/// Bins of equal count of the probability, and the largest difference of its mean in a bin from the
/// share of records to which none of the catalogue applies.
const BINS: usize = 5;
const CALIBRATED: f64 = 0.05;

/// Largest ratio of strengths that count as equal.
const EQUAL: f64 = 1.25;

/// Purposes of the streams of draws.
const EFFECTS: u64 = 45;
const LEVELS: u64 = 46;

/// Strengths given the nominal model, in standard deviations.
const STRENGTHS: [f64; 2] = [8.0, 200.0];

/// Least strength beside the best model of the catalogue.
const BESIDE: f64 = 8.0;

/// Ratio of the true standard deviation to the declared one, in half of the records.
const MISDECLARED: [f64; 2] = [0.5, 2.0];

/// A cause that the diagnosis names.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Named {
    effect: String,
    z: f64,
    alternatives: Vec<String>,
    none: Option<f64>,
}

/// Result for one record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Outside {
    /// The effect, its strength given the nominal model, and beside what is named; the latter is that
    /// of the former of an effect of the catalogue.
    effect: String,
    strength: f64,
    beside: f64,
    named: Vec<Named>,
    unexplained: bool,
}

impl Outside {
    /// Probability that none of the catalogue is the cause, as the diagnosis states it: that of its
    /// likeliest name. One that is unexplained without a name states it with certainty; one that is called
    /// clean, or of which the search was cut, not at all.
    fn none(&self) -> Option<f64> {
        if self.named.is_empty() {
            return self.unexplained.then_some(1.0);
        }
        let all = self.named.iter().filter_map(|named| named.none);
        all.reduce(f64::min)
    }

    /// Whether one effect is named without alternatives, and nothing says that none of these is likelier.
    fn is_named_alone(&self) -> bool {
        matches!(self.named.as_slice(), [only] if only.alternatives.is_empty())
            && self.none().is_none_or(|none| none < 0.5)
    }
}

pub(crate) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let small = extent.small;
    let count = extent.records(RECORDS, SMALL);
    let cell = |place: usize| -> Result<Vec<Outside>, Error> {
        let times = if place == OF_CATALOGUE && !small {
            2
        } else {
            1
        };
        let seeds = FIRST_SEEDS[place]..FIRST_SEEDS[place] + times * count;
        let campaign = resumable::campaign("truth", CELLS[place], seeds, small)?;
        let outcome = campaign.run(|seed| record(place, seed), |_| ())?;
        let found = outcome.successes().filter_map(|(_, found)| found.clone());
        Ok(found.collect())
    };
    let unlisted = [cell(0)?, cell(1)?];
    let listed = cell(OF_CATALOGUE)?;
    let mut figures = Vec::new();
    for (records, which) in unlisted.iter().zip(["used in development", "not used"]) {
        let strong: Vec<&Outside> = records.iter().filter(|one| one.beside >= BESIDE).collect();
        let misnamed = strong.iter().map(|one| one.is_named_alone()).collect();
        let name = format!(
            "outside of the catalogue, kinds {which}, 8 σ beside what is named: named alone, none of \
             these below a half"
        );
        figures.push(share(&name, MISNAMED, misnamed, small));
        let alone = records.iter().map(Outside::is_named_alone);
        let name = format!("the same, kinds {which}, 8 to 200 σ of which the names may leave less");
        let measured = format!("{:.3}", Proportion::of(alone).share());
        figures.push(Figure::note(&name, measured).over(records.len(), ""));
        let is_clean = |one: &Outside| one.named.is_empty() && !one.unexplained;
        let name = format!("the same, kinds {which}, 8 σ beside what is named: called clean");
        let missed = Proportion::of(strong.iter().map(|one| is_clean(one)));
        figures.push(Figure::note_share(&name, missed, ""));
        let name = format!(
            "the same, kinds {which}, 8 σ beside: searches cut, which state no probability"
        );
        let is_silent = |one: &Outside| one.none().is_none() && !is_clean(one);
        let silent = Proportion::of(strong.iter().map(|one| is_silent(one)));
        figures.push(Figure::note_share(&name, silent, ""));
    }
    let denied = listed.iter();
    let denied = denied.map(|one| one.none().is_some_and(|none| none > 0.5));
    let denied = denied.collect();
    let name = "effects of the catalogue: none of these above a half";
    figures.push(share(name, DENIED, denied, small));
    let strong = unlisted.iter().flatten().filter(|one| one.beside >= BESIDE);
    let stated = |one: &Outside| Some((one.strength, one.none()?));
    let pairs = of_equal_strength(
        strong.filter_map(stated).collect(),
        listed.iter().filter_map(stated).collect(),
    );
    let name = "the same, of which there is a record of the catalogue that is as strong";
    figures.push(Figure::note(name, pairs.len().to_string()).over(pairs.len(), ""));
    let both = pairs
        .iter()
        .flat_map(|[outside, of_catalogue]| [(*outside, true), (*of_catalogue, false)]);
    figures.push(calibration(&mut both.collect::<Vec<_>>(), small));
    Ok(figures)
}

/// Pairs of what is stated of a record outside of the catalogue and of one of it: of the one whose strength given
/// the nominal model is the nearest, within a quarter, none of them twice, the strongest first, which few match.
/// Prior odds are one to one so.
fn of_equal_strength(
    mut outside: Vec<(f64, f64)>,
    mut catalogue: Vec<(f64, f64)>,
) -> Vec<[f64; 2]> {
    outside.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut pairs = Vec::new();
    for (strength, none) in outside {
        let off = |of: &(f64, f64)| (of.0 / strength).ln().abs();
        let nearest = (0..catalogue.len())
            .filter(|one| off(&catalogue[*one]) < EQUAL.ln())
            .min_by(|a, b| off(&catalogue[*a]).total_cmp(&off(&catalogue[*b])));
        if let Some(nearest) = nearest {
            pairs.push([none, catalogue.swap_remove(nearest).1]);
        }
    }
    pairs
}

fn share(name: &str, limit: f64, all: Vec<bool>, small: bool) -> Figure {
    let records = all.len();
    let share = Proportion::of(all);
    let mut figure = Figure::within(name, [0.0, limit], share.share()).of_share(share);
    if small {
        figure = figure.judged(share.at_most(limit));
    }
    figure.over(records, "")
}

/// Stated probabilities against what is true, in bins of equal count.
fn calibration(stated: &mut [(f64, bool)], small: bool) -> Figure {
    stated.sort_by(|a, b| a.0.total_cmp(&b.0));
    let size = stated.len().div_ceil(BINS).max(1);
    let bins: Vec<[f64; 2]> = stated
        .chunks(size)
        .map(|bin| {
            let count = bin.len() as f64;
            let mean = bin.iter().map(|one| one.0).sum::<f64>() / count;
            [mean, bin.iter().filter(|one| one.1).count() as f64 / count]
        })
        .collect();
    let worst = bins.iter().map(|[mean, share]| (mean - share).abs());
    let worst = worst.fold(0.0, f64::max);
    let shown: Vec<String> = bins
        .iter()
        .map(|[mean, share]| format!("{mean:.2} of {share:.2}"))
        .collect();
    let name = "stated probability of none of these, of the share that is so, in five bins of records of equal strength";
    let mut figure = Figure::within(name, [0.0, CALIBRATED], worst);
    figure.measured = shown.join(", ");
    if small {
        figure = figure.judged(Judgement::TooFew);
    }
    figure.over(stated.len(), "")
}

fn record(place: usize, seed: u64) -> Result<Option<Outside>, EvaluationError> {
    let half = UnlistedKind::OF_FORCE.len() / 2;
    match place {
        2 => listed(seed).map(Some),
        _ => unlisted(
            UnlistedKind::OF_FORCE[place * half + seed as usize % half],
            seed,
        ),
    }
}

fn misdeclared(seed: u64) -> Result<Scenario, EvaluationError> {
    let mut random = Draw::new(seed, LEVELS);
    let mut plain = Scenario {
        interval_s: 120.0,
        ..scenario(seed)
    };
    if random.uniform() < 0.5 {
        for instrument in [
            "gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z",
        ] {
            let ratio = random.log_uniform(MISDECLARED);
            let id = format!("{instrument}.noise");
            plain.hidden.push(Hidden::new(&id, &[("ratio", ratio)])?);
        }
    }
    Ok(plain)
}

/// A record with an effect of a kind that the catalogue does not hold; `None` of a record that cannot show
/// it.
fn unlisted(kind: UnlistedKind, seed: u64) -> Result<Option<Outside>, EvaluationError> {
    let mut random = Draw::new(seed, EFFECTS);
    let strength = random.log_uniform(STRENGTHS);
    let scenario = misdeclared(seed)?;
    let Some(record) = UnlistedRecord::draw(&scenario, kind, strength, &mut random)? else {
        return Ok(None);
    };
    let (data, bench) = (&record.with.record, &record.with.bench);
    let found = diagnose(data, bench, &DiagnoseOptions::default())?;
    let id = record.effect.id.clone();
    let beside = record.strength_beside(&found);
    Ok(beside.map(|beside| outside(id, [strength, beside], &found)))
}

/// A record with an effect of the catalogue.
fn listed(seed: u64) -> Result<Outside, EvaluationError> {
    let mut random = Draw::new(seed, EFFECTS);
    let strength = random.log_uniform(STRENGTHS);
    let plain = misdeclared(seed)?;
    let noise = plain.hidden.clone();
    let (mut scenario, injected) = inject_any(plain, strength, &mut random)?;
    scenario.hidden.extend(noise);
    let simulation = simulate(&scenario)?;
    let found = diagnose(
        &simulation.record,
        &simulation.bench,
        &DiagnoseOptions::default(),
    )?;
    let id = injected.effect.id.to_owned();
    Ok(outside(id, [strength, strength], &found))
}

fn outside(effect: String, [strength, beside]: [f64; 2], found: &Diagnosis<'_>) -> Outside {
    let named = found.result.causes().map(|cause| Named {
        effect: cause.effect.clone(),
        z: cause.z,
        alternatives: cause
            .alternatives
            .iter()
            .map(|other| other.effect.clone())
            .collect(),
        none: cause.none_of_these,
    });
    Outside {
        effect,
        strength,
        beside,
        named: named.collect(),
        unexplained: found.result.is_unexplained(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_of_the_catalogue_are_as_strong_and_taken_once() {
        let catalogue = vec![(8.0, 0.1), (9.0, 0.2), (20.0, 0.3), (200.0, 0.4)];
        let outside = vec![(8.1, 0.8), (19.0, 0.6), (21.0, 0.7)];
        // 21 takes the one of 20, and for 19 none is left.
        assert_eq!(
            of_equal_strength(outside, catalogue),
            [[0.7, 0.3], [0.8, 0.1]]
        );
    }

    #[test]
    fn a_record_that_is_called_clean_states_nothing() {
        let mut record = Outside {
            effect: String::new(),
            strength: 9.0,
            beside: 9.0,
            named: Vec::new(),
            unexplained: false,
        };
        assert_eq!(record.none(), None);
        record.unexplained = true;
        assert_eq!(record.none(), Some(1.0));
    }
}
