//! Records of real plants, and the page about them: what is named, and the error on a later record.

use std::path::Path;

use gyrocal_answer::Answer;
use gyrocal_plant::{ColumnMap, LoadedPlant, SearchOptions, diagnose};
use gyrocal_words::plant::{verdict, why};

use crate::any_plant::{derived, holds};
use crate::harness::{Context, Error, Figure};
use crate::page;
use crate::values::{Values, table};

/// A plant with two records of it.
struct Measured {
    folder: &'static str,
    name: &'static str,
    /// What sets must hold; the sentences of the page beside its tables are about these.
    held: &'static [&'static str],
    /// Error of the later record that is asked for, in the unit of its output.
    least: f64,
}

const ALL: [Measured; 2] = [
    Measured {
        folder: "quarter_drone",
        name: "beam with a propeller",
        held: &["v_rate.u|u|", "v_rate.sign(v)"],
        least: 0.05,
    },
    Measured {
        folder: "buck_converter",
        name: "DC-DC converter",
        held: &["v_rate.v u", "v_rate.v |x|"],
        least: 0.17,
    },
];

/// Template of docs/real-plants.md.
pub(crate) const TEMPLATE: &str = include_str!("real_plants/page.md");

/// All figures of the part. The last compares the page with the measurement; with leave to write it is renewed
/// instead.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut values = Values::default();
    let mut figures = Vec::new();
    for measured in &ALL {
        figures.extend(of_plant(measured, &mut values)?);
    }
    let topic = "plants --part real";
    let same = page::filled("real-plants.md", TEMPLATE, &values, topic, context.write)?;
    let name = "docs/real-plants.md is what is measured";
    figures.push(Figure::truth(name, same));
    Ok(figures)
}

fn of_plant(measured: &Measured, values: &mut Values) -> Result<Vec<Figure>, Error> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/measured");
    let file = |name: &str| data.join(measured.folder).join(name);
    let plant = derived(&file("plant.py"))?;
    let columns = ColumnMap::read(&file("columns.toml"))?;
    let record = |name: &str| columns.record(plant.description(), &file(name));
    let [first, later] = [record("record.csv")?, record("later.csv")?];
    let options = SearchOptions::default();
    let answer = diagnose(&plant, first, Some(later), &options)?.answer;
    let (name, folder) = (measured.name, measured.folder);
    values.put(format!("{folder}_said"), format!("> {}", verdict(&answer)));
    values.put(format!("{folder}_path"), path_table(&answer));
    values.put(format!("{folder}_sets"), sets(&answer));
    let named: Vec<&str> = answer.findings.iter().map(|one| &*one.effect).collect();
    let is_held = |id: &&str| answer.findings.iter().any(|one| holds(one, id));
    let of_time = named.iter().filter(|id| is_of_time(&plant, id)).count();
    let (nominal, extended, unit) = later_errors(&answer);
    let row = |what: &str| format!("{name}: {what}");
    let [before, after] = [nominal, extended].map(|error| format!("{error:.4} {unit}"));
    let (least, is_small) = (
        format!("<= {} {unit}", measured.least),
        extended <= measured.least,
    );
    let better = row("later record simulated better with what was found");
    let of_nominal = row("error on the later record, nominal model");
    let of_extended = row("error on the later record, with what was found");
    let (asked, all) = (
        format!("sets hold {}", measured.held.join(", ")),
        named.join(", "),
    );
    let are_held = measured.held.iter().all(is_held);
    Ok(vec![
        Figure::told(&row("named"), &asked, all, are_held),
        Figure::at_most(&row("functions of time named"), 0.0, of_time as f64, ""),
        Figure::truth(&better, extended < nominal),
        Figure::note(&of_nominal, before),
        Figure::told(&of_extended, &least, after, is_small),
    ])
}

/// What is named, each with what the record does not tell from it, the likeliest first.
fn sets(answer: &Answer) -> String {
    let code = |id: &str| format!("`{}`", id.replace('|', "\\|"));
    let rows = answer.findings.iter().map(|one| {
        let others: Vec<String> = one.set().skip(1).map(code).collect();
        vec![code(&one.effect), others.join(", ")]
    });
    table(&["named", "not told from it by the record"], rows)
}

/// The way of the search, outputs one after the other.
fn path_table(answer: &Answer) -> String {
    let error = |error: Option<f64>, unit: &str| {
        error.map_or_else(|| "∞".to_owned(), |error| format!("{error:.3} {unit}"))
    };
    let rows = answer.path.iter().flat_map(|step| {
        let model = step.effect.as_ref();
        let model = model.map_or_else(|| "nominal model".to_owned(), |id| format!("+ {id}"));
        let model = model.replace('|', "\\|");
        let stands = step.refused.map_or("stands", why);
        step.outputs.iter().map(move |one| {
            vec![
                model.clone(),
                error(one.left_out, &one.unit),
                error(one.later, &one.unit),
                stands.to_owned(),
            ]
        })
    });
    table(&["model", "left-out parts", "later record", ""], rows)
}

fn is_of_time(plant: &LoadedPlant, id: &str) -> bool {
    let mut own = plant.description().effects.iter();
    own.any(|own| own.id == id && own.kind.is_of_time())
}

/// Errors of the first output on the later record, and its unit; infinite where a simulation leaves the numbers.
fn later_errors(answer: &Answer) -> (f64, f64, &str) {
    let gain = answer.gain.as_ref();
    let later = gain.and_then(|gain| gain.validation.as_ref());
    let error = later.and_then(|later| later.open_loop.first());
    let of = |error: Option<f64>| error.unwrap_or(f64::INFINITY);
    error.map_or((f64::INFINITY, f64::INFINITY, ""), |error| {
        (of(error.nominal), of(error.extended), &*error.unit)
    })
}
