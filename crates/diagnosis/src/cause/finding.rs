//! What is said of a cause that was found.

use gyrocal::effect::Enters;
use gyrocal::generated::catalogue::{EFFECTS, PARAMETERS};
use gyrocal_calibration::{CalibrationError, Column, Extended};
use gyrocal_record::Record;

use super::bank::{Bank, Joint, Products};
use super::family::{Candidate, Family, Plan, equivalent_to, jump, with_shape};
use super::null::{Normals, Null};
use super::score::{Best, RICHER, Scores};

/// Rivals within this difference of penalised statistics belong to the named set: twice a
/// log-likelihood ratio. Over simulated records with causes five standard deviations large the
/// true one was within 2.8 of the first in 95 %, and within 3.4 in 97 %; `cargo figures naming`
/// measures the coverage.
pub(crate) const SET_CONSTANT: f64 = 3.5;

/// One parameter of a cause.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundParameter {
    /// Its name: `size`, `onset_s`, `sine`, ….
    pub name: &'static str,
    /// The estimate.
    pub estimate: f64,
    /// Its standard deviation: of a size with the onset or time constant unknown, of these to
    /// first order. `None` where a walk or a knock has none.
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

/// An effect in the model.
#[derive(Clone, Debug)]
pub(super) struct Accepted {
    pub(super) family: usize,
    pub(super) shape: Option<f64>,
    pub(super) p_value: f64,
    /// What its statistic loses for having been looked for in every step.
    pub(super) searched: f64,
    /// The same with what searching over onsets or time constants reaches.
    pub(super) penalty: f64,
}

/// A model with accepted effects at its best fit, and what its signatures say.
#[derive(Clone)]
pub(super) struct Stage<'a> {
    pub(super) fitted: Extended<'a>,
    /// With all that is in the model projected out.
    pub(super) bank: Bank,
    products: Products,
    /// Of each accepted effect.
    own: Vec<Own>,
}

/// Where an effect of the model is.
#[derive(Clone)]
struct Own {
    /// Its values among those of the fit.
    places: Vec<usize>,
    /// Columns of a turn in the step of a knock.
    turn: Option<[usize; 3]>,
    /// Columns of size and onset or time constant.
    shaped: Option<[usize; 2]>,
}

impl<'a> Stage<'a> {
    /// Of a model that was fitted with `accepted`.
    pub(super) fn new(
        fitted: Extended<'a>,
        plan: &Plan,
        record: &Record,
        accepted: &[Accepted],
    ) -> Result<Self, CalibrationError> {
        let mut further = plan.further.clone();
        let own = accepted
            .iter()
            .map(|accepted| {
                let family = &plan.families[accepted.family];
                let places = places(&fitted, plan, family);
                let mut own = Own {
                    places,
                    turn: None,
                    shaped: None,
                };
                let first = PARAMETERS.len() + further.len();
                if let (true, Some(onset_s)) = (family.knock, accepted.shape) {
                    further.extend(jump(record, onset_s));
                    own.turn = Some([first, first + 1, first + 2]);
                }
                if let ([place], Some(shape)) = (own.places.as_slice(), accepted.shape) {
                    let size = fitted.values()[*place];
                    if let Some(columns) = with_shape(record, family.effect, shape, size) {
                        further.extend(columns);
                        own.shaped = Some([first, first + 1]);
                    }
                }
                own
            })
            .collect();
        let products = Products::new(&fitted, &further)?;
        Ok(Self {
            bank: products.bank(&[])?,
            fitted,
            products,
            own,
        })
    }
}

/// What is to be said of one accepted effect, the others being in the model.
pub(super) struct Told {
    pub(super) finding: Finding,
    /// Its statistic as the test takes it.
    pub(super) tested: f64,
    /// An effect that would be named in its place, and by how much it is better.
    pub(super) better: Option<(Best, f64)>,
}

/// Tells of one accepted effect, the others being in the model.
pub(super) fn tell(
    stage: &Stage<'_>,
    plan: &Plan,
    record: &Record,
    accepted: &[Accepted],
    index: usize,
    normals: &mut Normals,
) -> Result<Told, CalibrationError> {
    let fitted = &stage.fitted;
    let own = &accepted[index];
    let family = &plan.families[own.family];
    let Own {
        places,
        turn,
        shaped,
    } = &stage.own[index];
    let bank = stage.products.bank(places)?;
    // How uncertain the size is with the onset or time constant.
    let shaped = shaped.and_then(|columns| bank.joint(&columns));
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
    if let Some(turn) = turn {
        families[own.family].candidates = vec![Candidate {
            columns: turn.to_vec(),
            shape: None,
        }];
    }
    let null = Null::draw(&bank, &families, normals);
    let scores = Scores::of(&bank, &families, &null, None);
    // What searching in every step reaches is in the place of what three directions do.
    let (best, tested) = if family.knock {
        let statistic = scores.best[own.family].map_or(0.0, |best| best.statistic);
        (statistic - own.searched, statistic - own.searched)
    } else {
        (scores.penalised(own.family), scores.tested(own.family))
    };
    // One that explains more since others are in the model.
    let better = (0..families.len())
        .filter(|other| *other != own.family)
        .map(|other| (other, scores.penalised(other) - best))
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .filter(|(_, advantage)| *advantage > RICHER)
        .and_then(|(other, advantage)| Some((scores.best[other]?, advantage)));
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
            let row = EFFECTS.iter().find(|effect| effect.id == *id)?;
            let columns: Vec<usize> = row.model_parameters().collect();
            let joint = bank.joint(&columns)?;
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
            _ => estimates(fitted, family, places, own.shape, shaped.as_ref()),
        },
        z: statistic.max(0.0).sqrt(),
        p_value: own.p_value,
        rivals,
        equivalents,
    };
    Ok(Told {
        finding,
        tested,
        better,
    })
}

fn from_joint(effect: &'static gyrocal::Effect, joint: &Joint) -> Vec<FoundParameter> {
    (0..joint.estimate.len())
        .map(|i| FoundParameter {
            name: effect.parameters[i].name,
            estimate: joint.estimate[i],
            sigma: Some(joint.covariance[(i, i)].sqrt()),
            unit: effect.parameters[i].unit,
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
    if matches!(family.effect.enters, Enters::States(_)) {
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
    let states: Vec<usize> = family.effect.model_parameters().collect();
    extension
        .parameters
        .iter()
        .enumerate()
        // What the bench declares uncertain has a sigma and is no cause.
        .filter(|(_, (parameter, sigma))| states.contains(parameter) && sigma.is_infinite())
        .map(|(index, _)| first + index)
        .collect()
}

fn estimates(
    fitted: &Extended<'_>,
    family: &Family,
    places: &[usize],
    shape: Option<f64>,
    shaped: Option<&Joint>,
) -> Vec<FoundParameter> {
    let effect = family.effect;
    let with_shape = |index: usize| shaped.map(|joint| joint.covariance[(index, index)].sqrt());
    effect
        .parameters
        .iter()
        .enumerate()
        .map(|(index, parameter)| {
            let (estimate, sigma) = match places.get(index) {
                Some(place) => (
                    fitted.values()[*place] / parameter.scale,
                    with_shape(index).or_else(|| {
                        Some(fitted.covariance()[(*place, *place)].sqrt() / parameter.scale)
                    }),
                ),
                None => (shape.unwrap_or(f64::NAN), with_shape(index)),
            };
            FoundParameter {
                name: parameter.name,
                estimate,
                sigma,
                unit: parameter.unit,
            }
        })
        .collect()
}
