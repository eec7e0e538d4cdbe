//! The search for causes: forward, with a full fit after each that is found.

use gyrocal::generated::catalogue::{EFFECTS, PARAMETERS};
use gyrocal_calibration::{CalibrationError, Column, Extended, Extension};
use gyrocal_record::{Bench, Record};

use super::bank::{Bank, Joint};
use super::family::{Candidate, Family, Plan, Unavailable, axis_of, extend, jump, parameter};
use super::knock::{self, Knock};
use super::line::{self, DriftLine};
use super::null::Null;
use super::walk::Walk;

/// How causes are looked for.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchOptions {
    /// Probability that a record of the nominal model shows anything.
    pub false_alarm_probability: f64,
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
            coverage: 0.95,
            also: Vec::new(),
            seed: 0,
        }
    }
}

/// More causes than this in one record mean that the catalogue does not hold the one there is.
const MOST_EFFECTS: usize = 6;

/// Rivals within this difference of penalised statistics belong to the named set: twice a
/// log-likelihood ratio. Over simulated records with causes five standard deviations large the
/// true one was within 2.8 of the first in 95 %, and within 3.4 in 97 %; `cargo figures naming`
/// measures the coverage.
pub(crate) const SET_CONSTANT: f64 = 3.5;

/// A richer effect than one that it contains must be better by the 5 % point of chi-square with
/// one degree of freedom.
pub(crate) const RICHER: f64 = 3.84;

/// Onsets and time constants are refined on so many points between the neighbours of the best.
const REFINED: usize = 9;

/// One parameter of a cause.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundParameter {
    /// Its name: `size`, `onset_s`, `sine`, ….
    pub name: &'static str,
    /// The estimate.
    pub estimate: f64,
    /// Its standard deviation; `None` for onsets and time constants, which were searched.
    pub sigma: Option<f64>,
    /// Unit of both.
    pub unit: &'static str,
}

/// An effect that explains nearly as much.
#[derive(Clone, Debug, PartialEq)]
pub struct Rival {
    /// Its public id.
    pub effect: &'static str,
    /// How much less likely it makes the record, after the families' searching is allowed for.
    pub log_likelihood_deficit: f64,
}

/// A cause that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The effect that is named.
    pub effect: &'static str,
    /// Its parameters.
    pub parameters: Vec<FoundParameter>,
    /// Its statistic as a number of standard deviations.
    pub z: f64,
    /// Probability that the largest statistic of the whole search is as large by chance.
    pub p_value: f64,
    /// The rest of the named set, nearest first.
    pub rivals: Vec<Rival>,
    /// Effects that no record can tell from it, with the sizes that they would need.
    pub equivalents: Vec<(&'static str, Vec<FoundParameter>)>,
}

/// One family in the first search.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranked {
    /// Public id of the effect.
    pub effect: &'static str,
    /// Its largest statistic less what searching alone reaches.
    pub statistic: f64,
}

/// What a search found.
pub struct Searched<'a> {
    /// The model with all that was found, at its best fit.
    pub fitted: Extended<'a>,
    /// The causes, strongest first.
    pub findings: Vec<Finding>,
    /// Lines in the drift that no effect of the catalogue explains; they are in the model.
    pub lines: Vec<DriftLine>,
    /// All families in the first search, largest first.
    pub ranking: Vec<Ranked>,
    /// What their largest statistic must exceed.
    pub threshold: f64,
    /// What could not be looked for.
    pub unavailable: Vec<Unavailable>,
}

/// An effect in the model.
#[derive(Clone, Debug)]
struct Accepted {
    family: usize,
    shape: Option<f64>,
    p_value: f64,
    /// What its statistic loses for having been looked for in every step.
    searched: f64,
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
    let mut fitted = nominal;
    let mut accepted: Vec<Accepted> = Vec::new();
    let mut inseparable: Vec<usize> = Vec::new();
    let mut lines: Vec<DriftLine> = Vec::new();
    let mut first: Option<(Vec<Ranked>, f64)> = None;
    loop {
        let bank = Bank::new(&fitted, &plan.further, &[])?;
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
                family.unless(taken.contains(&index) || equivalent_to(&plan, index, &taken))
            })
            .collect();
        let null = Null::draw(&bank, &families, options.seed);
        let scores = Scores::of(&bank, &families, &null, knock::best(&fitted, record)?);
        let threshold = null.threshold(options.false_alarm_probability);
        first.get_or_insert_with(|| (scores.ranking(&families), threshold));
        let Some(best) = scores.named(&families) else {
            break;
        };
        let statistic = scores.penalised(best.family);
        if statistic <= threshold || accepted.len() == MOST_EFFECTS {
            break;
        }
        // A random walk swallows a line, which has no name in the catalogue: it goes into the
        // model without one.
        if plan.families[best.family].walk.is_some()
            && let Some(gyro) = axis_of(plan.families[best.family].id())
            && lines.len() < MOST_EFFECTS
            && let Some(line) = line::strongest(&fitted, record, gyro)?
            && line.statistic - line.searched > best.statistic
        {
            lines.push(line);
            fitted = fitted.refitted(&extension(&base, &plan, record, &accepted, &lines))?;
            continue;
        }
        let shape = refined(&fitted, record, &plan, &best)?;
        accepted.push(Accepted {
            family: best.family,
            shape,
            p_value: null.probability(statistic),
            searched: best.searched,
        });
        let refitted = fitted
            .refitted(&extension(&base, &plan, record, &accepted, &lines))
            .and_then(|refitted| Bank::new(&refitted, &[], &[]).map(|_| refitted));
        match refitted {
            Ok(refitted) => fitted = refitted,
            // What cannot be fitted beside the others cannot be told from them.
            Err(_) => {
                accepted.pop();
                inseparable.push(best.family);
            }
        }
    }
    let (ranking, threshold) = first.unwrap_or_default();
    // What was found first may be explained by what was found later.
    let findings = loop {
        let mut findings = Vec::with_capacity(accepted.len());
        let mut weakest: Option<(usize, f64)> = None;
        for index in 0..accepted.len() {
            let (found, strength) = finding(&fitted, &plan, record, &accepted, index, options)?;
            findings.push(found);
            if weakest.is_none_or(|(_, least)| strength < least) {
                weakest = Some((index, strength));
            }
        }
        match weakest {
            Some((index, strength)) if strength <= threshold && accepted.len() > 1 => {
                accepted.remove(index);
                fitted = fitted.refitted(&extension(&base, &plan, record, &accepted, &lines))?;
            }
            _ => break findings,
        }
    };
    Ok(Searched {
        fitted,
        findings,
        lines,
        ranking,
        threshold,
        unavailable: plan.unavailable,
    })
}

/// The model that all accepted effects make up.
fn extension(
    base: &Extension,
    plan: &Plan,
    record: &Record,
    accepted: &[Accepted],
    lines: &[DriftLine],
) -> Extension {
    let mut extension = base.clone();
    for found in lines {
        let columns = line::courses(record, found.gyro, found.period_h);
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

/// Whether a family cannot be told from one that is in the model.
fn equivalent_to(plan: &Plan, family: usize, taken: &[usize]) -> bool {
    let id = plan.families[family].effect.id;
    taken
        .iter()
        .any(|other| plan.families[*other].effect.equivalents.contains(&id))
}

/// The best candidate of a family.
#[derive(Clone, Copy, Debug)]
struct Best {
    family: usize,
    candidate: usize,
    statistic: f64,
    /// Variance of the increments of a random walk; onset of a knock, s.
    shape: f64,
    /// What a knock's statistic loses for having been looked for in every step.
    searched: f64,
}

/// The best candidate of every family, and what searching alone reaches.
struct Scores<'a> {
    best: Vec<Option<Best>>,
    penalties: &'a [f64],
}

impl<'a> Scores<'a> {
    fn of(bank: &Bank, families: &[Family], null: &'a Null, knock: Option<Knock>) -> Self {
        let best = families
            .iter()
            .enumerate()
            .map(|(family, content)| {
                if content.knock && content.candidates.is_empty() {
                    return knock.map(|knock| Best {
                        family,
                        candidate: 0,
                        statistic: knock.equivalent,
                        shape: knock.onset_s,
                        searched: knock.statistic - knock.equivalent,
                    });
                }
                if let Some(steps) = &content.walk {
                    let (information, score) = bank.part(steps);
                    let (statistic, variance) = Walk::new(information).best(&score);
                    return Some(Best {
                        family,
                        candidate: 0,
                        statistic,
                        shape: variance,
                        searched: 0.0,
                    });
                }
                content
                    .candidates
                    .iter()
                    .enumerate()
                    .filter_map(|(candidate, columns)| {
                        bank.joint(&columns.columns).map(|joint| Best {
                            family,
                            candidate,
                            statistic: joint.statistic,
                            shape: 0.0,
                            searched: 0.0,
                        })
                    })
                    .max_by(|a, b| a.statistic.total_cmp(&b.statistic))
            })
            .collect();
        Self {
            best,
            penalties: &null.penalties,
        }
    }

    fn penalised(&self, family: usize) -> f64 {
        self.best[family].map_or(f64::NEG_INFINITY, |best| {
            best.statistic - self.penalties[family]
        })
    }

    /// The penalised statistic, a random walk behind what follows a law.
    fn preferred(&self, families: &[Family], family: usize) -> f64 {
        let walk = families[family].walk.is_some();
        self.penalised(family) - if walk { RICHER } else { 0.0 }
    }

    /// The family to be named: the best, or a simpler one that it contains if it is not
    /// significantly better than that; of equivalents the first.
    fn named(&self, families: &[Family]) -> Option<Best> {
        let best = (0..families.len())
            .filter(|family| self.best[*family].is_some())
            .max_by(|a, b| {
                self.preferred(families, *a)
                    .total_cmp(&self.preferred(families, *b))
            })?;
        // Of equivalents the first in the table, which the families follow.
        let equivalents = families[best].effect.equivalents;
        let best = (0..best)
            .find(|other| {
                self.best[*other].is_some() && equivalents.contains(&families[*other].id())
            })
            .unwrap_or(best);
        let gyro = families[best].id().split('.').next().unwrap_or("");
        if families[best].id().ends_with(".warmup") {
            let simpler = [
                format!("{gyro}.ramp"),
                "platform.initial_attitude".to_owned(),
            ];
            let found = families
                .iter()
                .position(|family| simpler.iter().any(|id| id == family.id()));
            let richer = self.best[best].map_or(0.0, |best| best.statistic);
            if let Some(simple) = found
                && let Some(simple) = self.best[simple]
                && richer - simple.statistic < RICHER
            {
                return Some(simple);
            }
        }
        self.best[best]
    }

    fn ranking(&self, families: &[Family]) -> Vec<Ranked> {
        let mut ranking: Vec<Ranked> = families
            .iter()
            .enumerate()
            .filter(|(index, _)| self.best[*index].is_some())
            .map(|(index, family)| Ranked {
                effect: family.id(),
                statistic: self.penalised(index),
            })
            .collect();
        ranking.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
        ranking
    }
}

/// The onset or time constant of the best candidate, on a finer grid between its neighbours.
fn refined(
    fitted: &Extended<'_>,
    record: &Record,
    plan: &Plan,
    best: &Best,
) -> Result<Option<f64>, CalibrationError> {
    let family = &plan.families[best.family];
    if family.walk.is_some() || family.knock {
        return Ok(Some(best.shape));
    }
    let candidates = &plan.families[best.family].candidates;
    let candidate = &candidates[best.candidate];
    let Some(shape) = candidate.shape else {
        return Ok(None);
    };
    let neighbour = |offset: isize| {
        best.candidate
            .checked_add_signed(offset)
            .and_then(|index| candidates.get(index))
            .and_then(|candidate| candidate.shape)
            .unwrap_or(shape)
    };
    let (low, high) = (neighbour(-1), neighbour(1));
    let first_s = record.time_s.first().copied().unwrap_or(0.0);
    let Some(column) = candidate.columns.first() else {
        return Ok(Some(shape));
    };
    let around = &plan.further[column - PARAMETERS.len()];
    let mut shapes = Vec::with_capacity(REFINED);
    let mut columns = Vec::with_capacity(REFINED);
    for index in 0..REFINED {
        let share = index as f64 / (REFINED - 1) as f64;
        match around {
            Column::Onset { parameter, .. } => {
                let time_s = low + share * (high - low);
                let row = record.time_s.partition_point(|t| t - first_s < time_s);
                shapes.push(record.time_s[row.min(record.len() - 1)] - first_s);
                columns.push(Column::Onset {
                    parameter: *parameter,
                    row,
                });
            }
            Column::Course { parameter, .. } => {
                let time_constant_h = low * (high / low).powf(share);
                shapes.push(time_constant_h);
                columns.push(super::family::warm_up(record, *parameter, time_constant_h));
            }
            _ => return Ok(Some(shape)),
        }
    }
    let bank = Bank::new(fitted, &columns, &[])?;
    let finest = (0..columns.len())
        .filter_map(|index| {
            let joint = bank.joint(&[PARAMETERS.len() + index])?;
            Some((shapes[index], joint.statistic))
        })
        .max_by(|a, b| a.1.total_cmp(&b.1));
    Ok(Some(finest.map_or(shape, |(shape, _)| shape)))
}

/// What is to be said of one accepted effect, the others being in the model, and its statistic
/// less what searching reaches.
fn finding(
    fitted: &Extended<'_>,
    plan: &Plan,
    record: &Record,
    accepted: &[Accepted],
    index: usize,
    options: &SearchOptions,
) -> Result<(Finding, f64), CalibrationError> {
    let own = &accepted[index];
    let family = &plan.families[own.family];
    let places = places(fitted, plan, family);
    let mut further = plan.further.clone();
    if let (true, Some(onset_s)) = (family.knock, own.shape) {
        further.extend(jump(record, onset_s));
    }
    let bank = Bank::new(fitted, &further, &places)?;
    let others: Vec<usize> = accepted
        .iter()
        .enumerate()
        .filter(|(other, _)| *other != index)
        .map(|(_, accepted)| accepted.family)
        .collect();
    let mut families: Vec<Family> = plan
        .families
        .iter()
        .enumerate()
        .map(|(family, content)| {
            content.unless(others.contains(&family) || equivalent_to(plan, family, &others))
        })
        .collect();
    if family.knock {
        let first = PARAMETERS.len() + plan.further.len();
        families[own.family].candidates = vec![Candidate {
            columns: (first..first + 3).collect(),
            shape: None,
        }];
    }
    let null = Null::draw(&bank, &families, options.seed);
    let scores = Scores::of(&bank, &families, &null, None);
    let best = scores.penalised(own.family) - own.searched;
    let mut rivals: Vec<Rival> = (0..families.len())
        .filter(|other| {
            *other != own.family
                && scores.best[*other].is_some()
                && !family.effect.equivalents.contains(&families[*other].id())
        })
        .map(|other| Rival {
            effect: families[other].id(),
            log_likelihood_deficit: 0.5 * (best - scores.penalised(other)),
        })
        .filter(|rival| rival.log_likelihood_deficit < 0.5 * SET_CONSTANT)
        .collect();
    rivals.sort_by(|a, b| {
        a.log_likelihood_deficit
            .total_cmp(&b.log_likelihood_deficit)
    });
    let equivalents = family
        .effect
        .equivalents
        .iter()
        .filter_map(|id| {
            let columns: Option<Vec<usize>> = EFFECTS
                .iter()
                .find(|effect| effect.id == *id)?
                .states
                .iter()
                .map(|id| parameter(id))
                .collect();
            let row = EFFECTS.iter().find(|effect| effect.id == *id)?;
            let joint = bank.joint(&columns?)?;
            Some((row.id, from_joint(row, &joint)))
        })
        .collect();
    let statistic = scores.best[own.family].map_or(0.0, |best| best.statistic);
    let finding = Finding {
        effect: family.id(),
        parameters: match (&family.walk, own.shape) {
            (Some(_), Some(variance)) => vec![FoundParameter {
                name: "size",
                estimate: (variance / plan.onset_interval_h(record)).sqrt(),
                sigma: None,
                unit: "deg/h/sqrt(h)",
            }],
            _ => estimates(fitted, family, &places, own.shape),
        },
        z: statistic.max(0.0).sqrt(),
        p_value: own.p_value,
        rivals,
        equivalents,
    };
    Ok((finding, best))
}

fn from_joint(effect: &'static gyrocal::EffectRow, joint: &Joint) -> Vec<FoundParameter> {
    (0..joint.estimate.len())
        .map(|i| FoundParameter {
            name: effect.parameters[i],
            estimate: joint.estimate[i],
            sigma: Some(joint.covariance[(i, i)].sqrt()),
            unit: effect.units[i],
        })
        .collect()
}

/// Where an effect's values are among those of the fit.
fn places(fitted: &Extended<'_>, plan: &Plan, family: &Family) -> Vec<usize> {
    let extension = fitted.extension();
    let first = crate::COEFFICIENTS;
    if let Some(steps) = &family.walk {
        let base = first + extension.parameters.len();
        let own: Vec<&Column> = steps
            .iter()
            .map(|column| &plan.further[column - PARAMETERS.len()])
            .collect();
        let columns = extension.further.columns().iter().enumerate();
        return columns
            .filter(|(_, column)| own.contains(column))
            .map(|(index, _)| base + index)
            .collect();
    }
    if family.effect.kind == "state" {
        let base = first + extension.parameters.len();
        return extension
            .further
            .columns()
            .iter()
            .enumerate()
            .filter(|(_, column)| match column {
                Column::Start { .. } => !family.knock,
                Column::Jump { .. } => family.knock,
                _ => false,
            })
            .map(|(index, _)| base + index)
            .collect();
    }
    let states: Vec<Option<usize>> = family
        .effect
        .states
        .iter()
        .map(|id| parameter(id))
        .collect();
    extension
        .parameters
        .iter()
        .enumerate()
        // What the bench declares uncertain has a sigma and is no cause.
        .filter(|(_, (parameter, sigma))| states.contains(&Some(*parameter)) && sigma.is_infinite())
        .map(|(index, _)| first + index)
        .collect()
}

fn estimates(
    fitted: &Extended<'_>,
    family: &Family,
    places: &[usize],
    shape: Option<f64>,
) -> Vec<FoundParameter> {
    let effect = family.effect;
    // Attitudes are estimated in radians.
    let to_unit = |unit: &str| {
        if unit == "deg" && effect.kind == "state" {
            180.0 / core::f64::consts::PI
        } else {
            1.0
        }
    };
    effect
        .parameters
        .iter()
        .zip(effect.units)
        .enumerate()
        .map(|(index, (name, unit))| match places.get(index) {
            Some(place) => FoundParameter {
                name,
                estimate: fitted.values()[*place] * to_unit(unit),
                sigma: Some(fitted.covariance()[(*place, *place)].sqrt() * to_unit(unit)),
                unit,
            },
            None => FoundParameter {
                name,
                estimate: shape.unwrap_or(f64::NAN),
                sigma: None,
                unit,
            },
        })
        .collect()
}
