//! The search for causes: forward, with a full fit after each that is found.

use gyrocal_calibration::{CalibrationError, Extended, Extension};
use gyrocal_record::{Bench, Record};

use super::family::{Family, Plan, Unavailable, equivalent_to, extend};
use super::finding::{Accepted, Finding, Stage, tell};
use super::knock;
use super::null::{Normals, Null};
use super::refine::refined;
use super::score::{Best, RICHER, Ranked, Scores};
use super::unnamed::{self, Unnamed};

/// How causes are looked for.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchOptions {
    /// Probability that a record of the nominal model shows anything.
    pub false_alarm_probability: f64,
    /// Probability that such a record shows anything that has no name.
    pub unnamed_probability: f64,
    /// Probability that the named set holds the cause.
    pub coverage: f64,
    /// Effects beside those of the default search.
    pub also: Vec<String>,
    /// Seed of the draws that thresholds come from.
    pub seed: u64,
}

impl Default for SearchOptions {
    fn default() -> Self {
        Self {
            false_alarm_probability: 0.01,
            unnamed_probability: 0.001,
            coverage: 0.95,
            also: Vec::new(),
            seed: 0,
        }
    }
}

/// More causes than this in one record mean that the catalogue does not hold the one there is.
const MOST_EFFECTS: usize = 6;

/// What a search found.
pub struct Searched<'a> {
    /// The model with all that was found, at its best fit.
    pub fitted: Extended<'a>,
    /// The causes, strongest first.
    pub findings: Vec<Finding>,
    /// What no effect of the catalogue explains; it is in the model.
    pub unnamed: Vec<Unnamed>,
    /// All families in the first search, largest first.
    pub ranking: Vec<Ranked>,
    /// What their largest statistic must exceed.
    pub threshold: f64,
    /// What could not be looked for.
    pub unavailable: Vec<Unavailable>,
    base: Extension,
    plan: Plan,
    accepted: Vec<Accepted>,
}

impl Searched<'_> {
    /// The extension with what has no name and some of the findings: those that are `kept`.
    pub(crate) fn extension_with(&self, record: &Record, kept: &[bool]) -> Extension {
        let accepted = self.accepted.iter().zip(kept);
        let accepted: Vec<Accepted> = accepted
            .filter(|(_, kept)| **kept)
            .map(|(accepted, _)| accepted.clone())
            .collect();
        extension(&self.base, &self.plan, record, &accepted, &self.unnamed)
    }
}

/// When a random walk may be named: it goes where several other causes lead, too.
enum Walks<'a> {
    /// Not before those were looked for.
    Wait,
    /// They are being looked for.
    Left(Box<Walking<'a>>),
    /// Now.
    Take,
}

/// Where a search stood when a random walk would have been named.
struct Walking<'a> {
    /// What the walk explains, as it compares with other causes.
    score: f64,
    threshold: f64,
    stage: Stage<'a>,
    accepted: Vec<Accepted>,
    unnamed: Vec<Unnamed>,
}

impl Walking<'_> {
    /// What was found instead explains: twice the logarithm of the likelihood, less what searching
    /// reaches and, for each cause but the first, what one must reach. `None` if there are not
    /// several, as one alone has been compared with the walk before, or not without what has no
    /// name.
    fn instead(
        &self,
        stage: &Stage<'_>,
        accepted: &[Accepted],
        unnamed: &[Unnamed],
    ) -> Option<f64> {
        let found = &accepted[self.accepted.len()..];
        if found.len() < 2 || unnamed.len() > self.unnamed.len() {
            return None;
        }
        let penalties: f64 = found.iter().map(|accepted| accepted.penalty).sum();
        let more = (found.len() - 1) as f64 * self.threshold;
        Some(self.stage.fitted.cost() - stage.fitted.cost() - penalties - more)
    }
}

/// Looks for causes in a record, from the nominal model at its best fit.
///
/// # Errors
/// As [`Extended::refitted`].
pub fn search<'a>(
    nominal: Extended<'a>,
    record: &Record,
    bench: &Bench,
    options: &SearchOptions,
) -> Result<Searched<'a>, CalibrationError> {
    let also: Vec<&str> = options.also.iter().map(String::as_str).collect();
    let plan = Plan::new(record, bench, &also);
    let base = nominal.extension().clone();
    let mut normals = Normals::new(options.seed);
    let mut stage = Stage::new(nominal, &plan, record, &[])?;
    let mut accepted: Vec<Accepted> = Vec::new();
    let mut inseparable: Vec<usize> = Vec::new();
    let mut unnamed: Vec<Unnamed> = Vec::new();
    let mut seeking = true;
    let mut first: Option<(Vec<Ranked>, f64)> = None;
    let mut walks = Walks::Wait;
    loop {
        let Stage { fitted, bank, .. } = &stage;
        let taken: Vec<usize> = accepted
            .iter()
            .map(|accepted| accepted.family)
            .chain(inseparable.iter().copied())
            .collect();
        let families: Vec<Family> = plan
            .families
            .iter()
            .enumerate()
            .map(|(index, family)| {
                let taken = taken.contains(&index) || equivalent_to(&plan, index, &taken);
                family.unless(taken || family.walk.is_some() && matches!(walks, Walks::Left(_)))
            })
            .collect();
        let null = Null::draw(bank, &families, &mut normals);
        let jumps = fitted.jumps()?;
        let scores = Scores::of(bank, &families, &null, knock::best(&jumps, record));
        let threshold = null.threshold(options.false_alarm_probability);
        first.get_or_insert_with(|| (scores.ranking(&families), threshold));
        let best = scores
            .named(&families)
            .filter(|_| scores.largest() > threshold && accepted.len() < MOST_EFFECTS);
        // What the catalogue has no name for goes into the model without one: if nothing else is
        // there, or if it explains so much more that a name would be a false one. A random walk
        // would swallow any curve.
        let stands = |other: &Unnamed| {
            let explains_more = |best: Best| {
                // Several causes together look like a line of the day.
                !other.is_of_the_day(record)
                    && other.equivalent() > scores.penalised(best.family) + RICHER
            };
            other.ln_probability < options.unnamed_probability.ln()
                && best.is_none_or(explains_more)
        };
        // Of what bends or switches with a force, a polynomial or one knock takes up most.
        let curves = !accepted.is_empty()
            || best.is_none_or(|best| {
                let family = &families[best.family];
                family.walk.is_some() || family.knock
            });
        if seeking
            && unnamed.len() < MOST_EFFECTS
            && let Some(other) = unnamed::strongest(fitted, record, &jumps, curves, stands)?
        {
            unnamed.push(other);
            match fitted
                .refitted(&extension(&base, &plan, record, &accepted, &unnamed))
                .and_then(|fitted| Stage::new(fitted, &plan, record, &accepted))
            {
                Ok(next) => {
                    stage = next;
                    continue;
                }
                // What cannot be fitted beside the others is left to the tests of what remains.
                Err(_) => {
                    unnamed.pop();
                    seeking = false;
                }
            }
        }
        match (best, walks) {
            (Some(best), Walks::Wait) if families[best.family].walk.is_some() => {
                walks = Walks::Left(Box::new(Walking {
                    score: scores.penalised(best.family) - RICHER,
                    threshold,
                    stage: stage.clone(),
                    accepted: accepted.clone(),
                    unnamed: unnamed.clone(),
                }));
                continue;
            }
            (None, Walks::Left(walking)) => {
                let instead = walking.instead(&stage, &accepted, &unnamed);
                if instead.is_none_or(|instead| instead < walking.score) {
                    (stage, accepted) = (walking.stage, walking.accepted);
                    unnamed = walking.unnamed;
                }
                walks = Walks::Take;
                continue;
            }
            (_, as_before) => walks = as_before,
        }
        let Some(best) = best else {
            break;
        };
        let shape = refined(fitted, record, &plan, &best)?;
        accepted.push(Accepted {
            family: best.family,
            shape,
            p_value: null.probability(scores.largest()),
            searched: best.searched,
            penalty: best.searched + null.penalties[best.family],
        });
        match fitted
            .refitted(&extension(&base, &plan, record, &accepted, &unnamed))
            .and_then(|fitted| Stage::new(fitted, &plan, record, &accepted))
        {
            Ok(next) => stage = next,
            // What cannot be fitted beside the others cannot be told from them.
            Err(_) => {
                accepted.pop();
                inseparable.push(best.family);
            }
        }
    }
    let (ranking, threshold) = first.unwrap_or_default();
    // What was found first may be explained by what was found later, or may have another name
    // beside it.
    let mut exchanges = 0;
    let findings = loop {
        let mut findings = Vec::with_capacity(accepted.len());
        let mut weakest: Option<(usize, f64)> = None;
        let mut better: Option<(usize, Best, f64)> = None;
        for index in 0..accepted.len() {
            let told = tell(&stage, &plan, record, &accepted, index, &mut normals)?;
            findings.push(told.finding);
            if weakest.is_none_or(|(_, least)| told.tested < least) {
                weakest = Some((index, told.tested));
            }
            if let Some((other, advantage)) = told.better
                && better.is_none_or(|(.., most)| advantage > most)
            {
                better = Some((index, other, advantage));
            }
        }
        if let Some((index, other, _)) = better
            && accepted.len() > 1
            && exchanges < MOST_EFFECTS
        {
            exchanges += 1;
            let mut others = accepted.clone();
            let own = others.remove(index);
            let without = extension(&base, &plan, record, &others, &unnamed);
            let exchanged = stage.fitted.refitted(&without).and_then(|fitted| {
                let mut exchanged = accepted.clone();
                exchanged[index] = Accepted {
                    family: other.family,
                    shape: refined(&fitted, record, &plan, &other)?,
                    searched: other.searched,
                    ..own
                };
                let with = extension(&base, &plan, record, &exchanged, &unnamed);
                let stage = Stage::new(fitted.refitted(&with)?, &plan, record, &exchanged)?;
                Ok((stage, exchanged))
            });
            if let Ok(exchanged) = exchanged {
                (stage, accepted) = exchanged;
                continue;
            }
        }
        match weakest {
            Some((index, strength))
                if strength <= threshold && accepted.len() + unnamed.len() > 1 =>
            {
                accepted.remove(index);
                let fewer = extension(&base, &plan, record, &accepted, &unnamed);
                stage = Stage::new(stage.fitted.refitted(&fewer)?, &plan, record, &accepted)?;
            }
            _ => break findings,
        }
    };
    Ok(Searched {
        fitted: stage.fitted,
        findings,
        unnamed,
        ranking,
        threshold,
        unavailable: plan.unavailable.clone(),
        base,
        plan,
        accepted,
    })
}

/// The model that all accepted effects make up.
fn extension(
    base: &Extension,
    plan: &Plan,
    record: &Record,
    accepted: &[Accepted],
    unnamed: &[Unnamed],
) -> Extension {
    let mut extension = base.clone();
    for found in unnamed {
        let columns = found.columns.iter().cloned();
        extension.further.extend(columns, f64::INFINITY);
    }
    for accepted in accepted {
        extend(
            plan,
            record,
            &mut extension,
            accepted.family,
            accepted.shape,
        );
    }
    extension
}
