//! `gyrocal effects`: the catalogue of effects, from the generated table.

use clap::Args;
use gyrocal::effect::Enters;
use gyrocal::{EFFECTS, Effect};
use gyrocal_document::{Screen, Standing, Table};
use gyrocal_record::{any_of, nearest_names, printable_line};
use gyrocal_words::{explained, joined, tested, typical_size};
use miette::miette;

use crate::Failure;
use crate::layout::drawn;
use crate::reply::Reply;

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
pub(crate) fn run(arguments: &EffectsArguments) -> Result<Reply, Failure> {
    let Some(id) = &arguments.id else {
        return Ok(Reply::of(overview(), listed(EFFECTS.iter())));
    };
    if let Some(effect) = EFFECTS.iter().find(|effect| effect.id == id) {
        return Ok(Reply::of(explained(effect), String::new()));
    }
    let family = EFFECTS.iter().filter(|effect| effect.family == id);
    let family: Vec<&Effect> = family.collect();
    if let Some(first) = family.first() {
        let mut screen = explained(first);
        let ids = joined(family.iter().map(|effect| effect.id), ", ");
        let words = format!("{}: {ids}; below: {}", first.family, first.id);
        screen.fact("family", words);
        screen.facts.rotate_right(1);
        return Ok(Reply::of(screen, listed(family.into_iter())));
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
    let tested = EFFECTS.iter().filter(|effect| effect.default_search);
    let (all, tested) = (EFFECTS.len(), tested.count());
    let what = format!("{all} of the catalogue, {tested} of them tested without being asked for");
    let mut screen = Screen::new(Standing::Neutral, "EFFECTS", what);
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
    let rows = effects.map(|effect| {
        let [id, tested, name] = [effect.id, tested(effect), effect.name].map(str::to_owned);
        [id, typical_size(effect), tested, name]
    });
    let heads = "id | > typical size | tested | meaning";
    format!("{}\n", drawn(&Table::of("", heads, rows)))
}
