//! Entries of the catalogue in words.

use gyrocal::effect::{Continuation, EffectKind, Experiment, Need, NoiseProperty};
use gyrocal::{EFFECTS, Effect};
use gyrocal_statistics::format;

use gyrocal_answer::Answer;
use gyrocal_document::{Screen, Standing};

use crate::files::joined;
use crate::format::behind;

/// All that the catalogue says of an effect.
#[must_use]
pub fn explained(effect: &Effect) -> Screen {
    let mut screen = Screen::new(Standing::Neutral, effect.id, effect.name);
    screen.fact("course in time", course(effect.kind));
    screen.fact("term", spaced(effect.formula));
    let parameters = effect.parameters.iter();
    let parameters = parameters.map(|one| format!("{} [{}]", one.name, one.unit));
    screen.fact("parameters", joined(parameters, ", "));
    screen.fact("typical size", typical_size(effect));
    screen.fact("tested", standing(effect));
    screen.fact("needs", joined(effect.needs.iter().map(need), ", "));
    if !effect.equivalents.is_empty() {
        screen.fact("same as", effect.equivalents.join(", "));
        screen.fact("because", effect.equivalence.reason);
        screen.fact("would tell them", effect.equivalence.experiment);
    }
    screen.fact("looks like", effect.near_twins.join(", "));
    let experiments = effect.separated_by.iter().map(experiment);
    screen.fact("told apart by", joined(experiments, "; "));
    screen.fact("in a later record", later(effect.continuation));
    screen.fact("source", effect.reference);
    if effect.has_term() && !effect.is_nominal {
        let id = effect.id;
        let command = format!("gyrocal extend --effects {id} --out extended.model.toml");
        screen.then(command, "a filter with it");
    }
    screen
}

/// Its typical size with unit; empty for an effect without a size.
#[must_use]
pub fn typical_size(effect: &Effect) -> String {
    let unit = effect.parameters.first().map_or("", |first| first.unit);
    match unit {
        "" => String::new(),
        unit => format::short(effect.typical_size, 3) + &behind(unit),
    }
}

/// Whether a diagnosis tests it, in a word or two.
#[must_use]
pub fn tested(effect: &Effect) -> &'static str {
    if effect.is_nominal {
        "a coefficient"
    } else if effect.default_search {
        "yes"
    } else {
        "on request"
    }
}

/// Whether an id is that of correlated noise: its slow part looks like noise of the gyros.
#[must_use]
pub fn is_correlation(id: &str) -> bool {
    kind(id) == Some(EffectKind::Noise(NoiseProperty::Correlation))
}

/// Whether a random walk is among the causes: a simulation without measurements cannot follow it.
pub(super) fn has_random_walk(result: &Answer) -> bool {
    let mut causes = result.causes();
    causes.any(|cause| kind(&cause.effect) == Some(EffectKind::RandomWalk))
}

fn kind(id: &str) -> Option<EffectKind> {
    let row = EFFECTS.iter().find(|row| row.id == id);
    row.map(|row| row.kind)
}

/// A formula with blanks, at which a line may break.
fn spaced(formula: &str) -> String {
    let spaced = formula.replace('*', " * ").replace('/', " / ");
    spaced.replace(',', ", ").replace(",  ", ", ")
}

fn standing(effect: &Effect) -> String {
    if effect.is_nominal {
        "no: it is a coefficient of the nominal model, estimated by calibrate".to_owned()
    } else if effect.default_search {
        "by every diagnosis".to_owned()
    } else if effect.has_signature() {
        format!("by `gyrocal diagnose --effects {}`", effect.id)
    } else {
        "by the noise audit or --filter of a diagnosis".to_owned()
    }
}

fn course(kind: EffectKind) -> &'static str {
    match kind {
        EffectKind::Constant => "constant",
        EffectKind::Step => "zero before an onset, constant after it",
        EffectKind::FromOnset => "zero before an onset, any function of time after it",
        EffectKind::Exponential => "decays with a time constant from the start of the record",
        EffectKind::Ramp => "proportional to time",
        EffectKind::Periodic => "periodic",
        EffectKind::Regressor => "a function of a logged quantity",
        EffectKind::RandomWalk => "random walk: the integral of white noise",
        EffectKind::StateJump => "sudden change of the attitude at an onset",
        EffectKind::InitialState => "wrong attitude at the first row",
        EffectKind::Noise(NoiseProperty::Level) => "noise other than declared",
        EffectKind::Noise(NoiseProperty::Outliers) => "isolated values far outside the noise",
        EffectKind::Noise(NoiseProperty::Quantisation) => "steps of the least significant bit",
        EffectKind::Noise(NoiseProperty::Correlation) => "noise correlated from row to row",
        EffectKind::Integration => "error of the integration rule of a filter",
    }
}

fn need(need: &Need) -> String {
    match need {
        Need::Column(name) => format!("the column `{name}` of the record"),
        Need::Key(key) => format!("`{key}` in the bench file"),
    }
}

fn later(continuation: Continuation) -> &'static str {
    match continuation {
        Continuation::BeginsAnew => "begins anew",
        Continuation::GoesOn => "goes on",
        Continuation::Stays => "stays as at the end of the record",
        Continuation::ThisRecord => "none: it belongs to its record",
    }
}

fn experiment(experiment: &Experiment) -> String {
    match experiment {
        Experiment::OtherInitialState => "a run from another initial attitude".to_owned(),
        Experiment::OtherStart => {
            "a run from another initial attitude or at another time of day".to_owned()
        }
        Experiment::MeasureInitialState => {
            "an independent measurement of the initial attitude".to_owned()
        }
        Experiment::ControlRegressor(name) => format!("a run with {name} held or stepped"),
        Experiment::ChangeInput(what) => format!("a run with {what}"),
        Experiment::MeasureInput(what) => (*what).to_owned(),
        Experiment::StartLate => "a run that starts long after switching on".to_owned(),
    }
}
