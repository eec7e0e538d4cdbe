//! A diagnosis held against the right answer.

use gyrocal::effect::EffectKind;
use gyrocal_answer::{Answer, Finding, Subject};
use gyrocal_diagnosis::DiagnosisError;
use gyrocal_plant::PlantError;
use gyrocal_record::AXES;
use serde::{Deserialize, Serialize};

use super::right::{Names, Right, SEVERAL, Silent, UNLISTED};
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

/// What a diagnosis told.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Told {
    names: Vec<Name>,
    error: Option<String>,
    /// All of it; `None` if the diagnosis failed.
    pub(super) answer: Option<Answer>,
}

/// One name, with the other members of its set.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Name {
    pub(super) id: String,
    pub(super) set: Vec<String>,
    /// Whether it is a cause within the instrument, and neither noise nor an error of the set-up.
    pub(super) is_physical: bool,
}

impl Told {
    pub(super) fn of(found: Result<Answer, DiagnosisError>) -> Self {
        match found {
            Ok(result) => Self::of_result(result),
            Err(DiagnosisError::Setup { result }) => Self::of_result(*result),
            Err(DiagnosisError::OfRecord { source, .. }) => Self::of(Err(*source)),
            Err(DiagnosisError::SeveralPlatforms { .. }) => Self::set_up(SEVERAL),
            Err(error) => Self::failed(&error),
        }
    }

    pub(super) fn of_plant(found: Result<Answer, PlantError>) -> Self {
        match found {
            Ok(answer) => Self::of_result(answer),
            Err(error) => Self::failed(&error),
        }
    }

    fn failed(error: &dyn core::error::Error) -> Self {
        Self {
            error: Some(error.to_string()),
            ..Self::default()
        }
    }

    /// Names without an error.
    pub(super) fn named(names: Vec<Name>) -> Self {
        Self {
            names,
            ..Self::default()
        }
    }

    /// An error of the set-up and nothing else.
    pub(super) fn set_up(kind: &str) -> Self {
        Self::named(vec![Name::plain(kind)])
    }

    fn of_result(result: Answer) -> Self {
        let problems = result.setup.iter();
        let problems = problems.map(|problem| Name::plain(&problem.kind));
        let is_plant = matches!(result.subject, Subject::Plant(_));
        let findings = result.findings.iter();
        let names = problems.chain(findings.map(|finding| Name::of(finding, is_plant)));
        let stated = result.causes().filter_map(|cause| cause.none_of_these);
        let told = Self::with_unlisted(names.collect(), result.is_unexplained(), stated);
        Self {
            answer: Some(result),
            ..told
        }
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

    /// The names, or the error.
    pub(super) fn words(&self) -> Vec<String> {
        let names = self.names.iter().map(|name| name.id.clone());
        names.chain(self.error.clone()).collect()
    }
}

impl Name {
    pub(super) fn plain(id: &str) -> Self {
        Self {
            id: id.to_owned(),
            set: Vec::new(),
            is_physical: false,
        }
    }

    fn of(finding: &Finding, is_plant: bool) -> Self {
        let set = finding.set().chain(finding.equivalents());
        Self {
            id: finding.effect.clone(),
            set: set.map(str::to_owned).collect(),
            is_physical: is_plant || is_physical(&finding.effect),
        }
    }
}

pub(super) fn is_physical(id: &str) -> bool {
    effect_of(id).is_some_and(|effect| !effect.is_noise() && !effect.is_of_set_up())
}

/// Whether an id is of a list of names; `i` of a family is `axis`, if that is given, but of noise any.
fn is_of(id: &str, names: &[String], axis: Option<usize>) -> bool {
    let is_noise = effect_of(id).is_some_and(|effect| matches!(effect.kind, EffectKind::Noise(_)));
    names.iter().any(|name| match axis {
        Some(axis) if name.contains("_i.") && !is_noise => {
            same_or_equivalent(id, &name.replace("_i.", &format!("_{}.", AXES[axis])))
        }
        _ => same_or_equivalent(id, name) || effect_family(id) == name,
    })
}

/// Judges what was told of a record whose deviation is on `axis`; `faint` if it shows less than it must.
pub(super) fn judge(right: &Right, axis: Option<usize>, faint: bool, told: &Told) -> Judgement {
    let may_be_silent = match right.silent {
        Silent::Never => false,
        Silent::Faint => faint,
        Silent::Always => true,
    };
    if told.error.is_some() {
        return match may_be_silent {
            true => Judgement::Wrong,
            false => Judgement::NotSettled,
        };
    }
    let by_name = |name: &Name, list: &[String]| is_of(&name.id, list, axis);
    let by_set = |name: &Name, list: &[String]| name.set.iter().any(|id| is_of(id, list, axis));
    let mut free: Vec<&Name> = told.names.iter().collect();
    let mut takes = |list: &[String], tells: &dyn Fn(&Name, &[String]) -> bool| {
        let place = free.iter().position(|name| tells(name, list));
        place.map(|place| free.remove(place)).is_some()
    };
    // Each is told by a finding of its own: by its name, or else by its set.
    let mut left: Vec<&Names> = right.each.iter().collect();
    left.retain(|list| !takes(list, &by_name));
    let is_named = left.is_empty();
    left.retain(|list| !takes(list, &by_set));
    let at_once = takes(&right.whole, &by_name);
    let is_told = at_once || left.len() < right.each.len();
    let is_whole = at_once || (left.is_empty() && is_told);
    let is_named = at_once || is_named || right.in_set;
    free.retain(|name| !by_name(name, &right.beside));
    let is_false = |name: &&Name| name.is_physical && !by_name(name, &right.near);
    let is_physical = free.iter().any(is_false);
    let is_near = free.iter().any(|name| by_name(name, &right.near));
    let only_unlisted = !free.is_empty() && free.iter().all(|name| name.id == UNLISTED);
    match (is_told, is_physical) {
        (true, _) if is_whole && is_named && free.is_empty() => Judgement::Right,
        (true, true) if !is_whole => Judgement::Wrong,
        (true, _) => Judgement::NotSettled,
        (false, true) => Judgement::PhysicalAlone,
        (false, false) if free.is_empty() && may_be_silent => Judgement::Right,
        (false, false) if is_near || only_unlisted => Judgement::NotSettled,
        (false, false) => Judgement::Wrong,
    }
}
