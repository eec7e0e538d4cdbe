//! A diagnosis held against the right answer.

use gyrocal::effect::{EffectKind, Enters};
use gyrocal_diagnosis::result::Finding;
use gyrocal_diagnosis::{DiagnosisError, DiagnosisResult};
use gyrocal_plant::PlantError;
use gyrocal_plant::answer::Diagnosis as PlantDiagnosis;
use gyrocal_record::AXES;
use serde::{Deserialize, Serialize};

use super::FieldOutcome;
use super::right::{Right, SEVERAL, Silent, UNLISTED};
use crate::catalogue::{effect_family, effect_of, same_or_equivalent};

/// How an answer compares with the right one. The cases exclude each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Judgement {
    /// All that must be told is told, and nothing else.
    Right,
    /// Part of it is told, or another name with it, or nothing but that something is unexplained.
    NotSettled,
    /// What must be told is not, or a name of noise or of the set-up is false.
    Wrong,
    /// A physical cause is named that the record does not have, and nothing of what it has.
    PhysicalAlone,
}

/// What was told, in short.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Answer {
    /// The right thing, as an error of the set-up of this kind.
    SetUp(String),
    /// The right thing, as the name of this finding.
    Named(String),
    /// The right thing, in the confidence set of this finding.
    InSet(String),
    /// Nothing.
    Silent,
    /// A physical cause that the record does not have.
    Physical {
        /// The effect.
        effect: String,
        /// Its p-value.
        p_value: f64,
    },
    /// Other names.
    Other(Vec<String>),
    /// No diagnosis, with its error.
    Error(String),
}

/// What a diagnosis told.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Told {
    names: Vec<Name>,
    error: Option<String>,
}

/// One name, with the other members of its set.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Name {
    pub(super) id: String,
    pub(super) set: Vec<String>,
    /// `None` of what is no finding.
    pub(super) p_value: Option<f64>,
    /// Whether it is a cause within the instrument, and neither noise nor an error of the set-up.
    pub(super) is_physical: bool,
}

impl Told {
    pub(super) fn of(found: Result<&DiagnosisResult, &DiagnosisError>) -> Self {
        match found {
            Ok(result) => Self::of_result(result),
            Err(DiagnosisError::Setup { result }) => Self::of_result(result),
            Err(DiagnosisError::OfRecord { source, .. }) => Self::of(Err(source)),
            Err(DiagnosisError::SeveralPlatforms { .. }) => Self::set_up(SEVERAL),
            Err(error) => Self {
                error: Some(error.to_string()),
                ..Self::default()
            },
        }
    }

    /// Names without an error.
    pub(super) fn named(names: Vec<Name>) -> Self {
        Self { names, error: None }
    }

    /// An error of the set-up and nothing else.
    pub(super) fn set_up(kind: &str) -> Self {
        Self::named(vec![Name::plain(kind)])
    }

    fn of_result(result: &DiagnosisResult) -> Self {
        let problems = result
            .setup
            .iter()
            .map(|problem| Name::plain(&problem.kind));
        let names = problems
            .chain(result.findings.iter().map(Name::of))
            .collect();
        let stated = result.causes().filter_map(|cause| cause.none_of_these);
        Self::with_unlisted(names, result.is_unexplained(), stated)
    }

    /// As `RecordScore::tells_of_another`.
    fn with_unlisted(
        mut names: Vec<Name>,
        is_unexplained: bool,
        stated: impl Iterator<Item = f64>,
    ) -> Self {
        if is_unexplained || stated.reduce(f64::min).is_some_and(|none| none > 0.5) {
            names.push(Name::plain(UNLISTED));
        }
        Self::named(names)
    }

    pub(super) fn of_plant(found: Result<&PlantDiagnosis, &PlantError>) -> Self {
        match found {
            Ok(found) => {
                let named = found.findings.iter().map(|one| {
                    let rivals = one.rivals.iter().map(|(id, _)| id);
                    Name {
                        id: one.effect.clone(),
                        set: rivals.chain(&one.equivalents).cloned().collect(),
                        p_value: Some(one.p_value),
                        is_physical: true,
                    }
                });
                let stated = found.findings.iter().filter_map(|one| one.none_of_these);
                Self::with_unlisted(named.collect(), !found.unexplained.is_empty(), stated)
            }
            Err(error) => Self {
                error: Some(error.to_string()),
                ..Self::default()
            },
        }
    }
}

impl Name {
    pub(super) fn plain(id: &str) -> Self {
        Self {
            id: id.to_owned(),
            set: Vec::new(),
            p_value: None,
            is_physical: false,
        }
    }

    fn is_set_up(&self) -> bool {
        self.p_value.is_none() && self.id != UNLISTED
    }

    fn of(finding: &Finding) -> Self {
        let alternatives = finding.alternatives.iter().map(|other| &other.effect);
        let equivalents = finding.equivalents.iter().map(|other| &other.effect);
        Self {
            id: finding.effect.clone(),
            set: alternatives.chain(equivalents).cloned().collect(),
            p_value: Some(finding.p_value),
            is_physical: is_physical(&finding.effect),
        }
    }
}

pub(super) fn is_physical(id: &str) -> bool {
    effect_of(id).is_some_and(|effect| {
        let is_set_up = matches!(
            effect.enters,
            Enters::Inputs(_) | Enters::Time | Enters::Filter
        );
        !effect.is_noise() && effect.kind != EffectKind::InitialState && !is_set_up
    })
}

/// Whether an id is of a list of names; `i` of a family is `axis`, if that is given, but of noise any.
fn is_of(id: &str, names: &[&str], axis: Option<usize>) -> bool {
    let is_noise = effect_of(id).is_some_and(|effect| matches!(effect.kind, EffectKind::Noise(_)));
    names.iter().any(|name| match axis {
        Some(axis) if name.contains("_i.") && !is_noise => {
            same_or_equivalent(id, &name.replace("_i.", &format!("_{}.", AXES[axis])))
        }
        _ => same_or_equivalent(id, name) || effect_family(id) == *name,
    })
}

/// Judges what was told of a record whose deviation is on `axis`; `faint` if it shows less than it must.
pub(super) fn judge(right: &Right, axis: Option<usize>, faint: bool, told: &Told) -> FieldOutcome {
    let names = &told.names;
    let by_name = |at: usize, list: &[&str]| is_of(&names[at].id, list, axis);
    let by_set = |at: usize, list: &[&str]| names[at].set.iter().any(|id| is_of(id, list, axis));
    let mut free: Vec<usize> = (0..names.len()).collect();
    // Each is told by a finding of its own: by its name, or else by its set.
    let mut tellers: Vec<Option<usize>> = vec![None; right.each.len()];
    for named in [true, false] {
        for (teller, list) in tellers.iter_mut().zip(right.each) {
            let tells = |at: &usize| {
                if named {
                    by_name(*at, list)
                } else {
                    by_set(*at, list)
                }
            };
            let place = free.iter().position(tells);
            *teller = teller.or_else(|| place.map(|place| free.remove(place)));
        }
    }
    let pairs = || tellers.iter().zip(right.each);
    let mut is_whole = !right.each.is_empty() && tellers.iter().all(Option::is_some);
    let mut is_named = pairs().all(|(at, list)| at.is_some_and(|at| by_name(at, list)));
    let mut teller = tellers.iter().flatten().next().copied();
    if let Some(place) = free.iter().position(|at| by_name(*at, right.whole)) {
        teller = Some(free.remove(place));
        (is_whole, is_named) = (true, true);
    }
    free.retain(|at| !by_name(*at, right.beside));
    let beside: Vec<String> = free.iter().map(|at| names[*at].id.clone()).collect();
    let is_near = free.iter().any(|at| by_name(*at, right.near));
    let physical = free
        .iter()
        .map(|at| &names[*at])
        .find(|name| name.is_physical && !is_of(&name.id, right.near, axis));
    let may_be_silent = match right.silent {
        Silent::Never => false,
        Silent::Faint => faint,
        Silent::Always => true,
    };
    let only_unlisted = !free.is_empty() && free.iter().all(|at| names[*at].id == UNLISTED);
    let judgement = match (teller, physical, &told.error) {
        (_, _, Some(_)) if may_be_silent => Judgement::Wrong,
        (_, _, Some(_)) => Judgement::NotSettled,
        (Some(_), ..) if is_whole && free.is_empty() && (is_named || right.in_set) => {
            Judgement::Right
        }
        (Some(_), Some(_), _) if !is_whole => Judgement::Wrong,
        (Some(_), ..) => Judgement::NotSettled,
        (None, Some(_), _) => Judgement::PhysicalAlone,
        (None, None, _) if free.is_empty() && may_be_silent => Judgement::Right,
        (None, None, _) if is_near || only_unlisted => Judgement::NotSettled,
        (None, None, _) => Judgement::Wrong,
    };
    let id = |at: usize| names[at].id.clone();
    let answer = match (teller, physical, &told.error) {
        (_, _, Some(error)) => Answer::Error(error.clone()),
        (Some(at), ..) if names[at].is_set_up() => Answer::SetUp(id(at)),
        (Some(at), ..) if is_named => Answer::Named(id(at)),
        (Some(at), ..) => Answer::InSet(id(at)),
        (None, Some(name), _) => Answer::Physical {
            effect: name.id.clone(),
            p_value: name.p_value.unwrap_or(1.0),
        },
        (None, None, _) if names.is_empty() => Answer::Silent,
        (None, None, _) => Answer::Other(names.iter().map(|name| name.id.clone()).collect()),
    };
    FieldOutcome {
        judgement,
        answer,
        beside,
        strength: None,
    }
}
