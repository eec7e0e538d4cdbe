//! The drift coefficients, over the members of the confidence sets.
//!
//! An estimate after a choice among models is a mixture: each member of a set has the weight of its
//! penalised likelihood (Buckland, Burnham, Augustin, Biometrics 53, 603, 1997). Within a member errors have
//! Student's distribution, since the noise of the gyros was estimated from the same record.

use gyrocal::generated::platform::DRIFT;
use gyrocal_calibration::FittedPlatform;
use gyrocal_hypothesis::{Finding, NominalEstimate};
use gyrocal_statistics::{normal_probability, student_probability};

use crate::validation::CrossValidated;
use gyrocal_answer::{CoefficientEstimate, CoefficientInterval, Coefficients, SetMember};

/// Probability on each side of a 95 % interval.
const TAIL: f64 = 0.025;

/// Halvings of the interval that a quantile is searched in: to 1e-12 of it.
const HALVINGS: usize = 40;

/// Deviates beyond every component between which a quantile is searched.
const FARTHEST: f64 = 8.0;

/// Most models that the members of several sets make up; beyond, each set is replaced by itself.
const MOST_MODELS: usize = 500;

/// One model of the mixture.
#[derive(Clone)]
struct Model {
    effects: Vec<String>,
    weight: f64,
    values: Vec<f64>,
    covariance: Vec<Vec<f64>>,
}

/// Estimates of the nominal and of the extended model, and their mixture over the sets of the accepted
/// findings.
pub(super) fn coefficients(
    nominal: &FittedPlatform<'_>,
    findings: &[Finding],
    validated: &CrossValidated<'_>,
) -> Coefficients {
    let count = DRIFT.len();
    let extended = validated.extended.as_ref();
    let fit = extended.unwrap_or(nominal);
    let row = |i: usize| (0..count).map(|j| fit.covariance()[(i, j)]).collect();
    let covariance: Vec<Vec<f64>> = (0..count).map(row).collect();
    let decided = findings.iter().zip(&validated.decisions);
    let accepted: Vec<&Finding> = decided
        .filter(|(_, decision)| decision.accepted)
        .map(|(finding, _)| finding)
        .collect();
    let base = Model {
        effects: accepted.iter().map(|f| f.effect.to_owned()).collect(),
        weight: 1.0,
        values: fit.values()[..count].to_vec(),
        covariance: covariance.clone(),
    };
    let models = extended.map(|_| models(base, &accepted));
    // Where no pass succeeds, nothing is known of the noise: the normal distribution.
    let degrees = fit.degrees_of_freedom();
    let degrees = degrees.unwrap_or_else(|_| vec![f64::INFINITY; count]);
    let of = |values: &[f64], covariance: &[Vec<f64>]| -> Vec<CoefficientEstimate> {
        let all = DRIFT.iter().enumerate();
        all.map(|(index, element)| CoefficientEstimate {
            name: element.id.to_owned(),
            estimate: values[index],
            sigma: covariance[index][index].sqrt(),
            unit: element.unit.to_owned(),
        })
        .collect()
    };
    Coefficients {
        declared: Vec::new(),
        nominal: DRIFT
            .iter()
            .enumerate()
            .map(|(index, element)| CoefficientEstimate {
                name: element.id.to_owned(),
                estimate: nominal.values()[index],
                sigma: nominal.covariance()[(index, index)].sqrt(),
                unit: element.unit.to_owned(),
            })
            .collect(),
        extended: extended.map(|fit| of(&fit.values()[..count], &covariance)),
        over_set: models.as_ref().map(|models| {
            let all = DRIFT.iter().enumerate();
            all.map(|(index, element)| CoefficientInterval {
                name: element.id.to_owned(),
                ..mixture(models, index, degrees[index], element.unit)
            })
            .collect()
        }),
        members: models
            .filter(|models| models.len() > 1)
            .unwrap_or_default()
            .into_iter()
            .map(|model| SetMember {
                coefficients: of(&model.values, &model.covariance),
                effects: model.effects,
                weight: model.weight,
                covariance: model.covariance,
            })
            .collect(),
        covariance,
    }
}

/// All models that the sets make up, the likeliest first, with weights that add up to one.
fn models(base: Model, findings: &[&Finding]) -> Vec<Model> {
    let (joint, own): (Vec<Member<'_>>, Vec<Member<'_>>) =
        members(findings).into_iter().partition(Member::is_joint);
    let of_place = |place: usize| own.iter().filter(move |member| member.places == [place]);
    let product = (0..findings.len())
        .map(|place| of_place(place).count() + 1)
        .try_fold(1usize, usize::checked_mul);
    let is_whole = product.is_some_and(|count| count <= MOST_MODELS);
    let mut models = vec![base.clone()];
    for place in 0..findings.len() {
        let from = models[..if is_whole { models.len() } else { 1 }].to_vec();
        for other in of_place(place) {
            models.extend(from.iter().map(|model| replaced(model, &base, other)));
        }
    }
    models.extend(joint.iter().map(|other| replaced(&base, &base, other)));
    let total: f64 = models.iter().map(|model| model.weight).sum();
    for model in &mut models {
        model.weight /= total;
    }
    models.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    models
}

/// A member of one set, or of several that it stands for together.
struct Member<'f> {
    /// Findings that it replaces.
    places: Vec<usize>,
    effects: Vec<&'static str>,
    /// Its weight over that of the named effects.
    weight: f64,
    nominal: &'f NominalEstimate,
}

impl Member<'_> {
    /// Whether it is one model for several findings or of several effects, as random walks are.
    fn is_joint(&self) -> bool {
        self.places.len() > 1 || self.effects.len() > 1
    }
}

/// The members of all sets; those with one fit are one.
fn members<'f>(findings: &[&'f Finding]) -> Vec<Member<'f>> {
    let mut members: Vec<Member<'f>> = Vec::new();
    for (place, finding) in findings.iter().enumerate() {
        // No record prefers an exact equivalent to the effect that is named.
        let equivalents = finding.exact_equivalents.iter();
        let equivalents = equivalents.map(|other| (other.effect, 0.0, &other.nominal));
        let alternatives = finding.alternatives.iter();
        let alternatives =
            alternatives.map(|other| (other.effect, other.log_likelihood_deficit, &other.nominal));
        for (effect, deficit, nominal) in equivalents.chain(alternatives) {
            let Some(nominal) = nominal else {
                continue;
            };
            if let Some(same) = members.iter_mut().find(|one| one.nominal == nominal) {
                if !same.effects.contains(&effect) {
                    same.effects.push(effect);
                }
                if !same.places.contains(&place) {
                    same.places.push(place);
                }
                continue;
            }
            members.push(Member {
                places: vec![place],
                effects: vec![effect],
                weight: (-deficit).exp(),
                nominal,
            });
        }
    }
    members
}

/// A model with a member in the place of a named effect: changes of estimates and of covariances add up.
fn replaced(model: &Model, base: &Model, member: &Member<'_>) -> Model {
    let mut replaced = model.clone();
    for place in &member.places {
        replaced.effects[*place] = member.effects.join(" + ");
    }
    if member.places.len() > 1 {
        replaced.effects.dedup();
    }
    replaced.weight *= member.weight;
    for (i, value) in replaced.values.iter_mut().enumerate() {
        *value += member.nominal.values[i] - base.values[i];
        for (j, element) in replaced.covariance[i].iter_mut().enumerate() {
            *element += member.nominal.covariance[(i, j)] - base.covariance[i][j];
        }
        // Of several replacements each may take from a variance.
        let least = f64::min(base.covariance[i][i], member.nominal.covariance[(i, i)]);
        replaced.covariance[i][i] = replaced.covariance[i][i].max(least);
    }
    replaced
}

/// Mean, standard deviation and 95 % interval of one coefficient.
fn mixture(models: &[Model], index: usize, degrees: f64, unit: &str) -> CoefficientInterval {
    let component = |model: &Model| {
        let sigma = model.covariance[index][index].sqrt();
        (model.weight, model.values[index], sigma)
    };
    let all: Vec<(f64, f64, f64)> = models.iter().map(component).collect();
    let mean: f64 = all.iter().map(|(weight, value, _)| weight * value).sum();
    let variance: f64 = all
        .iter()
        .map(|(weight, value, sigma)| weight * (sigma * sigma + (value - mean).powi(2)))
        .sum();
    CoefficientInterval {
        name: String::new(),
        estimate: mean,
        sigma: variance.sqrt(),
        interval: [TAIL, 1.0 - TAIL].map(|tail| quantile(&all, degrees, tail)),
        degrees_of_freedom: Some(degrees).filter(|degrees| degrees.is_finite()),
        unit: unit.to_owned(),
    }
}

/// Quantile of a mixture of Student's distributions, by bisection.
fn quantile(components: &[(f64, f64, f64)], degrees: f64, probability: f64) -> f64 {
    let ends = |side: f64| {
        components
            .iter()
            .map(move |(_, mean, sigma)| mean + side * FARTHEST * sigma)
    };
    let mut low = ends(-1.0).fold(f64::INFINITY, f64::min);
    let mut high = ends(1.0).fold(f64::NEG_INFINITY, f64::max);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let below: f64 = components
            .iter()
            .map(|(weight, mean, sigma)| {
                let deviate = (middle - mean) / sigma;
                let below = student_probability(deviate, degrees);
                weight * below.unwrap_or_else(|| normal_probability(deviate))
            })
            .sum();
        if below < probability {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::quantile as student;

    fn quantile(components: &[(f64, f64, f64)], probability: f64) -> f64 {
        student(components, f64::INFINITY, probability)
    }

    #[test]
    fn quantiles_of_a_mixture() {
        // One component: the normal distribution.
        assert!((quantile(&[(1.0, 3.0, 2.0)], 0.975) - (3.0 + 2.0 * 1.959_964)).abs() < 1e-5);
        // Ten degrees of freedom: 2.228 from tables.
        assert!((student(&[(1.0, 3.0, 2.0)], 10.0, 0.975) - (3.0 + 2.0 * 2.228_139)).abs() < 1e-5);
        // Two that are far apart with equal weight: the 5 % point of the upper one from above.
        let two = [(0.5, 0.0, 1.0), (0.5, 100.0, 1.0)];
        assert!((quantile(&two, 0.975) - (100.0 + 1.644_854)).abs() < 1e-5);
        assert!((quantile(&two, 0.025) + 1.644_854).abs() < 1e-5);
    }
}
