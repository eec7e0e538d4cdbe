//! Effects of a model file, and findings that it cannot have.

use gyrocal::effect::{Enters, Role};
use gyrocal::generated::catalogue::{PARAMETERS, SHAPES};
use gyrocal::{EFFECTS, Effect};
use gyrocal_answer::{AlternativeKind, Answer, Finding, Verdict};
use gyrocal_record::{
    Gyros, KnownEffect, ModelFile, ParameterEstimate, Standing, any_of, nearest_names,
};
use miette::{Report, miette};

/// A model file, with the findings left out and the exact equivalents.
#[derive(Debug)]
pub(super) struct Extension {
    pub(super) model: ModelFile,
    /// Findings left out, each with the reason as a clause.
    pub(super) left_out: Vec<(String, String)>,
    /// Effects of the model with their exact equivalents.
    pub(super) equivalents: Vec<(String, Vec<String>)>,
}

/// Effects that a model file may name.
pub(crate) fn known() -> Vec<KnownEffect<'static>> {
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

/// The diagnosis with members of its confidence sets in the place of the effects that it names.
pub(super) fn with_members(
    mut diagnosis: Answer,
    members: &[String],
    name: &str,
) -> Result<Answer, Report> {
    for member in members {
        let others = |finding: &Finding| -> Vec<String> {
            let all = finding.alternatives.iter();
            let all = all.filter(|one| one.kind != AlternativeKind::NotSearched);
            all.map(|one| one.effect.clone()).collect()
        };
        let mut findings = diagnosis.findings.iter();
        let Some(place) = findings.position(|finding| others(finding).contains(member)) else {
            let all: Vec<String> = diagnosis.findings.iter().flat_map(others).collect();
            let known: Vec<&str> = all.iter().map(String::as_str).collect();
            let expected = if known.is_empty() {
                "no set has another member than the effect that is named".to_owned()
            } else {
                format!("expected {}", any_of(&known))
            };
            return Err(miette!(
                help = "--effects takes any effect of the catalogue",
                "{name}: found no alternative `{member}` in a confidence set, {expected}"
            ));
        };
        let finding = &mut diagnosis.findings[place];
        let mut others = core::mem::take(&mut finding.alternatives).into_iter();
        let own = others.find(|one| one.effect == *member);
        finding.parameters = own.map_or_else(Vec::new, |one| one.parameters);
        finding.effect.clone_from(member);
        finding.accepted = Some(true);
    }
    Ok(diagnosis)
}

/// The model of what a diagnosis found.
pub(super) fn of_diagnosis(diagnosis: &Answer, name: &str) -> Result<Extension, Report> {
    let gyros = match diagnosis.is_strapdown() {
        true => Gyros::Strapdown,
        false => Gyros::Platform,
    };
    let mut extension = Extension {
        model: ModelFile {
            gyros,
            ..ModelFile::default()
        },
        left_out: Vec::new(),
        equivalents: Vec::new(),
    };
    for finding in &diagnosis.findings {
        let row = row(&finding.effect).map_err(|report| report.wrap_err(name.to_owned()))?;
        if let Some(objection) = known_effect(row).objection() {
            let left_out = (finding.effect.clone(), objection.to_owned());
            extension.left_out.push(left_out);
            continue;
        }
        if finding.accepted == Some(false) {
            let why = "has no predictive gain: it is not in the extended model of the diagnosis; \
                       --effects includes it anyway";
            extension
                .left_out
                .push((finding.effect.clone(), why.to_owned()));
            continue;
        }
        let model = &mut extension.model;
        if model.effects.contains(&finding.effect) {
            let again = "was found more than once, and a model has it once";
            extension
                .left_out
                .push((finding.effect.clone(), again.to_owned()));
            continue;
        }
        model.effects.push(finding.effect.clone());
        for found in &finding.parameters {
            let mut own = row.parameters.iter();
            let own = own.find(|parameter| parameter.name == found.name);
            match (own.map(|parameter| parameter.role), found.sigma) {
                (Some(Role::Parameter(at)), Some(sigma)) => {
                    model.estimates.push(ParameterEstimate {
                        parameter: PARAMETERS[at].id.to_owned(),
                        value: found.estimate,
                        sigma,
                    });
                }
                (Some(Role::Onset(Some(at)) | Role::TimeConstant(at)), _) => {
                    let id = SHAPES[at].id;
                    model.shapes.push((id.to_owned(), found.estimate));
                }
                // Without a sigma it is not an initial value of a filter.
                (Some(_), _) => {}
                (None, _) => {
                    return Err(miette!(
                        help = "write the diagnosis again with this version of the program",
                        "{name}: found the parameter `{}` of `{}`, expected {}",
                        found.name,
                        finding.effect,
                        row.parameters
                            .iter()
                            .map(|own| own.name)
                            .collect::<Vec<_>>()
                            .join(", ")
                    ));
                }
            }
        }
        let others: Vec<String> = finding.equivalents().map(str::to_owned).collect();
        if !others.is_empty() {
            extension.equivalents.push((finding.effect.clone(), others));
        }
    }
    if extension.model.effects.is_empty() {
        return Err(nothing(diagnosis, &extension, name));
    }
    Ok(extension)
}

/// The model of a list of effects.
pub(super) fn of_list(ids: &[String], gyros: Gyros) -> Result<Extension, Report> {
    let mut model = ModelFile {
        gyros,
        ..ModelFile::default()
    };
    let mut equivalents = Vec::new();
    for id in ids {
        let row = row(id)?;
        if let Some(objection) = known_effect(row).objection() {
            return Err(miette!("--effects: `{id}` {objection}"));
        }
        if model.effects.contains(id) {
            return Err(miette!(
                "--effects: found `{id}` twice, expected each effect once"
            ));
        }
        let same = |other: &&String| row.equivalents.contains(&other.as_str());
        if let Some(other) = model.effects.iter().find(same) {
            return Err(miette!(
                help = "keep one of them",
                "--effects: `{id}` and `{other}` are exact equivalents, which no record distinguishes"
            ));
        }
        if !row.equivalents.is_empty() {
            let others = row.equivalents.iter().map(|&other| other.to_owned());
            equivalents.push((id.clone(), others.collect()));
        }
        model.effects.push(id.clone());
    }
    Ok(Extension {
        model,
        left_out: Vec::new(),
        equivalents,
    })
}

fn nothing(diagnosis: &Answer, extension: &Extension, name: &str) -> Report {
    if extension.left_out.is_empty() {
        let (verdict, help) = match diagnosis.verdict {
            Verdict::NotSettled => (
                "not-settled",
                "the search ended before it named anything: mend the largest fault, and record again",
            ),
            Verdict::Unexplained => (
                "unexplained",
                "add the missing effect to the catalogue first: docs/adding-a-term.md",
            ),
            _ => (
                "clean",
                "the nominal model fits the record and needs no extension",
            ),
        };
        return miette!(
            help = help,
            "{name}: found the verdict `{verdict}` and no finding, expected an effect of the \
             extended model"
        );
    }
    let reasons = extension.left_out.iter();
    let reasons: Vec<String> = reasons.map(|(id, why)| format!("`{id}` {why}")).collect();
    miette!(
        help = reasons.join("\n"),
        "{name}: found no finding that is a term of the model, expected an effect of the extended \
         model"
    )
}

fn row(id: &str) -> Result<&'static Effect, Report> {
    EFFECTS.iter().find(|row| row.id == id).ok_or_else(|| {
        let terms = EFFECTS
            .iter()
            .filter(|row| row.has_term() && !row.is_nominal);
        let terms: Vec<&str> = terms.map(|row| row.id).collect();
        let near = any_of(&nearest_names(id, &terms, 3));
        miette!(
            help = format!("the nearest are {near}"),
            "found `{id}`, expected the id of an effect"
        )
    })
}
