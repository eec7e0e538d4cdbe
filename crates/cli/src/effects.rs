//! `gyrocal effects`: the catalogue of effects, from the generated table.

use std::fmt::Write as _;

use clap::Args;
use comfy_table::Cell;
use gyrocal::effect::{Continuation, EffectKind, Enters, Experiment, Need, NoiseProperty};
use gyrocal::{EFFECTS, Effect};
use gyrocal_diagnosis::prose::{Screen, Standing};
use gyrocal_record::{any_of, nearest_names, printable_line};
use gyrocal_statistics::format;
use miette::miette;

use crate::Failure;
use crate::answer::Answer;
use crate::tables::{right, table};

/// List the effects that a diagnosis knows, or explain one.
///
/// Without an id, all effects are listed by the part of the model that they enter; --verbose adds a table with
/// names and units.
#[derive(Debug, Args)]
pub(crate) struct EffectsArguments {
    /// Id of an effect, such as gyro_y.g_z, or of a family, such as gyro_i.warmup.
    #[arg(value_name = "ID")]
    id: Option<String>,
}

/// Runs the command.
pub(crate) fn run(arguments: &EffectsArguments) -> Result<Answer, Failure> {
    let Some(id) = &arguments.id else {
        return Ok(Answer::of(overview(), listed(EFFECTS.iter())));
    };
    if let Some(effect) = EFFECTS.iter().find(|effect| effect.id == id) {
        return Ok(Answer::of(explained(effect), String::new()));
    }
    let family: Vec<&Effect> = EFFECTS
        .iter()
        .filter(|effect| effect.family == id)
        .collect();
    if let Some(first) = family.first() {
        let mut screen = explained(first);
        let ids: Vec<&str> = family.iter().map(|effect| effect.id).collect();
        screen.facts.insert(
            0,
            gyrocal_diagnosis::prose::Fact {
                label: "family".to_owned(),
                words: format!("{}: {}; below: {}", first.family, ids.join(", "), first.id),
            },
        );
        return Ok(Answer::of(screen, listed(family.into_iter())));
    }
    let mut known: Vec<&str> = EFFECTS.iter().map(|effect| effect.id).collect();
    known.extend(EFFECTS.iter().map(|effect| effect.family));
    known.sort_unstable();
    known.dedup();
    let near = any_of(&nearest_names(id, &known, 3));
    Err(Failure::Work(miette!(
        help = format!("the nearest are {near}; `gyrocal effects` lists all"),
        "found `{}`, expected the id of an effect",
        printable_line(id)
    )))
}

/// All families by the part of the model that they enter.
fn overview() -> Screen {
    let mut parts: Vec<(&str, Vec<&str>)> = Vec::new();
    for effect in &EFFECTS {
        let part = match effect.enters {
            Enters::Rates(_) => "gyros",
            Enters::Outputs(_) => "outputs",
            Enters::States(_) => "attitude",
            Enters::Inputs(_) => "inputs",
            Enters::Time => "time",
            Enters::Filter => "filter",
        };
        match parts.iter_mut().find(|(known, _)| *known == part) {
            Some((_, families)) if families.contains(&effect.family) => {}
            Some((_, families)) => families.push(effect.family),
            None => parts.push((part, vec![effect.family])),
        }
    }
    let tested = EFFECTS
        .iter()
        .filter(|effect| effect.default_search)
        .count();
    let mut screen = Screen::new(
        Standing::Neutral,
        "EFFECTS",
        format!(
            "{} of the catalogue, {tested} of them tested without being asked for",
            EFFECTS.len()
        ),
    );
    for (part, families) in &parts {
        screen.fact(part, families.join(", "));
    }
    screen.fact(
        "axes",
        "i, j, k stand for x, y, z: gyro_i.g_j is gyro_y.g_z, …",
    );
    screen.then("gyrocal effects gyro_y.g_z", "explains one");
    screen
}

/// A table of effects with name and unit.
fn listed(effects: impl Iterator<Item = &'static Effect>) -> String {
    let mut table = table(["id", "typical size", "tested", "meaning"]);
    for effect in effects {
        table.add_row([
            Cell::new(effect.id),
            right(typical(effect)),
            Cell::new(tested(effect)),
            Cell::new(effect.name),
        ]);
    }
    format!("{}\n", table.trim_fmt())
}

fn typical(effect: &Effect) -> String {
    let unit = effect.parameters.first().map_or("", |first| first.unit);
    match unit {
        "" => String::new(),
        "1" => format::short(effect.typical_size, 3),
        unit => format!("{} {unit}", format::short(effect.typical_size, 3)),
    }
}

fn tested(effect: &Effect) -> &'static str {
    if effect.is_nominal {
        "a coefficient"
    } else if effect.default_search {
        "yes"
    } else {
        "on request"
    }
}

/// All that the catalogue says of an effect.
fn explained(effect: &Effect) -> Screen {
    let mut screen = Screen::new(Standing::Neutral, effect.id, effect.name);
    screen.fact("course in time", course(effect.kind));
    screen.fact("term", spaced(effect.formula));
    let parameters = effect.parameters.iter();
    let parameters: Vec<String> = parameters
        .map(|parameter| format!("{} [{}]", parameter.name, parameter.unit))
        .collect();
    screen.fact("parameters", parameters.join(", "));
    screen.fact("typical size", typical(effect));
    screen.fact("tested", standing(effect));
    let needs: Vec<String> = effect.needs.iter().map(need).collect();
    screen.fact("needs", needs.join(", "));
    if !effect.equivalents.is_empty() {
        screen.fact("same as", effect.equivalents.join(", "));
        screen.fact("because", effect.equivalence.reason);
        screen.fact("would tell them", effect.equivalence.experiment);
    }
    screen.fact("looks like", effect.near_twins.join(", "));
    let experiments = effect.separated_by.iter().map(experiment);
    screen.fact("told apart by", experiments.collect::<Vec<_>>().join("; "));
    screen.fact("in a later record", later(effect.continuation));
    screen.fact("source", effect.reference);
    if effect.has_term() && !effect.is_nominal {
        screen.then(
            format!(
                "gyrocal extend --effects {} --out extended.model.toml",
                effect.id
            ),
            "a filter with it",
        );
    }
    screen
}

/// A formula with blanks, at which a line may break.
fn spaced(formula: &str) -> String {
    let spaced = formula.replace('*', " * ").replace('/', " / ");
    spaced.replace(',', ", ").replace(",  ", ", ")
}

fn standing(effect: &Effect) -> String {
    let mut text = String::new();
    let _ = match tested(effect) {
        "yes" => write!(text, "by every diagnosis"),
        "on request" if effect.has_signature() => {
            write!(text, "by `gyrocal diagnose --effects {}`", effect.id)
        }
        "on request" => write!(text, "by the noise audit or --filter of a diagnosis"),
        other => write!(
            text,
            "no: it is {other} of the nominal model, estimated by calibrate"
        ),
    };
    text
}

fn course(kind: EffectKind) -> &'static str {
    match kind {
        EffectKind::Constant => "constant",
        EffectKind::Step => "zero before an onset, constant after it",
        EffectKind::FromOnset => "zero before an onset, any function of time after it",
        EffectKind::Exponential => "decays with a time constant from the start of the record",
        EffectKind::Ramp => "proportional to time",
        EffectKind::Periodic => "periodic",
        EffectKind::Regressor => "proportional to a logged quantity",
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
