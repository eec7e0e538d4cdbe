//! The model file of what a diagnosis found, or of listed effects.

use gyrocal::effect::{Enters, Role};
use gyrocal::generated::catalogue::{PARAMETERS, SHAPES};
use gyrocal::{EFFECTS, Effect};
use gyrocal_answer::{Alternative, AlternativeKind, Answer, Finding, Parameter, Verdict};
use gyrocal_record::{
    Gyros, KnownEffect, LeftOut, ModelFile, ParameterEstimate, Standing, any_of, nearest_names,
};

/// A model file, with the findings left out and the exact equivalents.
#[derive(Debug, Default)]
pub struct ModelExtension {
    /// The model of an extended filter.
    pub model: ModelFile,
    /// Findings that it cannot have, each with the reason as a clause.
    pub left_out: Vec<LeftOut>,
    /// Its effects with their exact equivalents.
    pub equivalents: Vec<(String, Vec<String>)>,
}

/// No model file can be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExtensionError {
    /// No effect of the catalogue has this id.
    #[error("found `{id}`, expected the id of an effect")]
    UnknownEffect {
        /// What was given.
        id: String,
    },
    /// An effect is listed that no model file can have.
    #[error("`{id}` {objection}")]
    NoTerm {
        /// The effect.
        id: String,
        /// Why not, as a clause.
        objection: &'static str,
    },
    /// An effect is listed twice.
    #[error("found `{id}` twice, expected each effect once")]
    Twice {
        /// The effect.
        id: String,
    },
    /// Two of the listed effects are exact equivalents.
    #[error("`{id}` and `{other}` are exact equivalents, which no record distinguishes")]
    Equivalent {
        /// The second of them.
        id: String,
        /// The first.
        other: String,
    },
    /// A member of the confidence sets is asked for that none has.
    #[error("found no alternative `{member}` in a confidence set, {}", expected(.known))]
    NoMember {
        /// What was asked for.
        member: String,
        /// The members that the sets have.
        known: Vec<String>,
    },
    /// A finding has a parameter that its effect does not have.
    #[error("found the parameter `{found}` of `{effect}`, expected {expected}")]
    UnknownParameter {
        /// The parameter.
        found: String,
        /// The effect.
        effect: String,
        /// Those of the effect.
        expected: String,
    },
    /// The diagnosis has no finding.
    #[error(
        "found the verdict `{verdict}` and no finding, expected an effect of the extended model"
    )]
    NoFinding {
        /// Its verdict, as in the JSON.
        verdict: &'static str,
        /// What to do.
        advice: &'static str,
    },
    /// All findings are left out.
    #[error(
        "found no finding that is a term of the model, expected an effect of the extended model"
    )]
    AllLeftOut {
        /// Each with its reason.
        left_out: Vec<LeftOut>,
    },
}

impl ExtensionError {
    /// What to do, where the error does not say it.
    #[must_use]
    pub fn advice(&self) -> Option<String> {
        Some(match self {
            Self::UnknownEffect { id } => {
                let terms = EFFECTS.iter();
                let terms = terms.filter(|row| row.has_term() && !row.is_nominal);
                let terms: Vec<&str> = terms.map(|row| row.id).collect();
                format!("the nearest are {}", any_of(&nearest_names(id, &terms, 3)))
            }
            Self::NoTerm { .. } | Self::Twice { .. } => return None,
            Self::Equivalent { .. } => "keep one of them".to_owned(),
            Self::NoMember { .. } => "--effects takes any effect of the catalogue".to_owned(),
            Self::UnknownParameter { .. } => {
                "write the diagnosis again with this version of the program".to_owned()
            }
            Self::NoFinding { advice, .. } => (*advice).to_owned(),
            Self::AllLeftOut { left_out } => {
                let reasons = left_out.iter();
                let reasons = reasons.map(|one| format!("`{}` {}", one.effect, one.why));
                reasons.collect::<Vec<_>>().join("\n")
            }
        })
    }
}

fn expected(known: &[String]) -> String {
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    if known.is_empty() {
        "no set has another member than the effect that is named".to_owned()
    } else {
        format!("expected {}", any_of(&known))
    }
}

/// Effects that a model file may name.
#[must_use]
pub fn known_effects() -> Vec<KnownEffect<'static>> {
    EFFECTS.iter().map(known_effect).collect()
}

fn known_effect(row: &'static Effect) -> KnownEffect<'static> {
    let shape = row.shape().and_then(|shape| shape.role.shape_index());
    KnownEffect {
        id: row.id,
        standing: if row.is_nominal {
            Standing::Nominal
        } else if row.has_term() {
            Standing::Term
        } else if row.is_noise() {
            Standing::Noise
        } else if matches!(row.enters, Enters::States(_)) {
            Standing::State
        } else {
            Standing::Filter
        },
        states: row.model_parameters().map(|at| PARAMETERS[at].id).collect(),
        shapes: shape.into_iter().map(|at| SHAPES[at].id).collect(),
    }
}

/// The answer with members of its confidence sets in the place of the effects that it names.
///
/// # Errors
/// [`ExtensionError::NoMember`].
pub fn with_members(mut answer: Answer, members: &[String]) -> Result<Answer, ExtensionError> {
    for member in members {
        let mut findings = answer.findings.iter();
        let Some(place) = findings.position(|own| in_set(own).any(|one| one.effect == *member))
        else {
            let all = answer.findings.iter().flat_map(in_set);
            return Err(ExtensionError::NoMember {
                member: member.clone(),
                known: all.map(|one| one.effect.clone()).collect(),
            });
        };
        let finding = &mut answer.findings[place];
        let mut others = core::mem::take(&mut finding.alternatives).into_iter();
        let own = others.find(|one| one.effect == *member);
        finding.parameters = own.map_or_else(Vec::new, |one| one.parameters);
        finding.effect.clone_from(member);
        finding.accepted = Some(true);
    }
    Ok(answer)
}

/// The alternatives of a finding that were searched for.
fn in_set(finding: &Finding) -> impl Iterator<Item = &Alternative> {
    let all = finding.alternatives.iter();
    all.filter(|one| one.kind != AlternativeKind::NotSearched)
}

/// The model of what a diagnosis found.
///
/// # Errors
/// An answer of another version, or without a finding that is a term of the model.
pub fn extension_of(answer: &Answer) -> Result<ModelExtension, ExtensionError> {
    let mut extension = ModelExtension::default();
    if answer.is_strapdown() {
        extension.model.gyros = Gyros::Strapdown;
    }
    for finding in &answer.findings {
        let row = row(&finding.effect)?;
        let model = &mut extension.model;
        let why = if let Some(objection) = known_effect(row).objection() {
            objection
        } else if finding.accepted == Some(false) {
            "has no predictive gain: it is not in the extended model of the diagnosis; --effects includes \
             it anyway"
        } else if model.effects.contains(&finding.effect) {
            "was found more than once, and a model has it once"
        } else {
            model.effects.push(finding.effect.clone());
            for found in &finding.parameters {
                add_parameter(model, row, found)?;
            }
            let others: Vec<String> = finding.equivalents().map(str::to_owned).collect();
            if !others.is_empty() {
                extension.equivalents.push((finding.effect.clone(), others));
            }
            continue;
        };
        extension.left_out.push(LeftOut {
            effect: finding.effect.clone(),
            why: why.to_owned(),
        });
    }
    if extension.model.effects.is_empty() {
        return Err(nothing(answer, extension.left_out));
    }
    Ok(extension)
}

/// Adds the estimate of a parameter as its initial value, or that of a shape as built in.
fn add_parameter(
    model: &mut ModelFile,
    row: &'static Effect,
    found: &Parameter,
) -> Result<(), ExtensionError> {
    let mut own = row.parameters.iter();
    let own = own.find(|parameter| parameter.name == found.name);
    match (own.map(|parameter| parameter.role), found.sigma) {
        (Some(Role::Parameter(at)), Some(sigma)) => model.estimates.push(ParameterEstimate {
            parameter: PARAMETERS[at].id.to_owned(),
            value: found.estimate,
            sigma,
        }),
        (Some(Role::Onset(Some(at)) | Role::TimeConstant(at)), _) => {
            let id = SHAPES[at].id;
            model.shapes.push((id.to_owned(), found.estimate));
        }
        // Without a sigma it is not an initial value of a filter.
        (Some(_), _) => {}
        (None, _) => {
            let expected: Vec<&str> = row.parameters.iter().map(|own| own.name).collect();
            return Err(ExtensionError::UnknownParameter {
                found: found.name.clone(),
                effect: row.id.to_owned(),
                expected: expected.join(", "),
            });
        }
    }
    Ok(())
}

/// The model of a list of effects.
///
/// # Errors
/// An effect that is unknown, listed twice or beside an exact equivalent, or that no model file can have.
pub fn extension_by(ids: &[String], gyros: Gyros) -> Result<ModelExtension, ExtensionError> {
    let mut extension = ModelExtension::default();
    extension.model.gyros = gyros;
    for id in ids {
        let row = row(id)?;
        let effects = &mut extension.model.effects;
        if let Some(objection) = known_effect(row).objection() {
            let id = id.clone();
            return Err(ExtensionError::NoTerm { id, objection });
        }
        if effects.contains(id) {
            return Err(ExtensionError::Twice { id: id.clone() });
        }
        let same = |other: &&String| row.equivalents.contains(&other.as_str());
        if let Some(other) = effects.iter().find(same) {
            return Err(ExtensionError::Equivalent {
                id: id.clone(),
                other: other.clone(),
            });
        }
        effects.push(id.clone());
        if !row.equivalents.is_empty() {
            let others = row.equivalents.iter().map(|&other| other.to_owned());
            extension.equivalents.push((id.clone(), others.collect()));
        }
    }
    Ok(extension)
}

fn nothing(answer: &Answer, left_out: Vec<LeftOut>) -> ExtensionError {
    if !left_out.is_empty() {
        return ExtensionError::AllLeftOut { left_out };
    }
    let verdict = answer.verdict;
    ExtensionError::NoFinding {
        verdict: verdict.name(),
        advice: match verdict {
            Verdict::NotSettled => {
                "the search ended before it named anything: mend the largest fault, and record again"
            }
            Verdict::Unexplained => {
                "add the missing effect to the catalogue first: docs/adding-a-term.md"
            }
            Verdict::Setup => "mend the set-up, and diagnose the record again",
            _ => "the nominal model fits the record and needs no extension",
        },
    }
}

fn row(id: &str) -> Result<&'static Effect, ExtensionError> {
    let unknown = || ExtensionError::UnknownEffect { id: id.to_owned() };
    EFFECTS.iter().find(|row| row.id == id).ok_or_else(unknown)
}
