//! The page of a fit of a plant, and that of several beside each other.

use gyrocal_answer::{OutputFit, PlantComparison, PlantFit};
use gyrocal_document::{Item, Part, Section, Table};
use gyrocal_record::Manifest;
use gyrocal_statistics::format;
use gyrocal_words::plant::{comparison_screen, direction, fit_screen, simulation_error};

use super::{over_time, rms, tables};
use crate::origin::{file_name, part};
use crate::words::section;

/// The page of a fit.
#[must_use]
pub fn of_fit(fit: &PlantFit, manifest: &Manifest) -> Part {
    let (name, sections) = (file_name(manifest, 0, "record"), of_model(fit).into());
    part(manifest, name, String::new(), fit_screen(fit), sections)
}

/// The page of fits of several plants to one record.
#[must_use]
pub fn of_comparison(compared: &PlantComparison, manifest: &Manifest) -> Part {
    let mut first = comparison_screen(compared);
    first.table = Some(table(compared));
    let sections = compared.models.iter().flat_map(|one| {
        of_model(&one.fit).map(|section| Section {
            title: format!("{}, {}", section.title, one.name),
            ..section
        })
    });
    let (name, sections) = (file_name(manifest, 0, "record"), sections.collect());
    part(manifest, name, String::new(), first, sections)
}

fn of_model(fit: &PlantFit) -> [Section; 2] {
    [estimates(fit), simulations(fit)]
}

fn estimates(fit: &PlantFit) -> Section {
    let rows = fit.correlations.iter().map(|one| {
        let [first, second] = one.of.clone();
        [first, second, format!("{:.3}", one.coefficient)]
    });
    let correlations = Table::of("Largest correlations", "of | and | > correlation", rows);
    let mut items = vec![
        Item::Estimates(tables::estimates("", &fit.coefficients)),
        correlations.into(),
        over_time::tests("Noise (Ljung-Box)", &fit.noise, &fit.remainder).into(),
    ];
    items.extend(fit.undetermined.iter().map(direction).map(Item::text));
    let lead = "Estimates with their standard deviations.";
    section("parameters", "Parameters", lead, items)
}

fn simulations(fit: &PlantFit) -> Section {
    let row = |of: &str, one: &OutputFit| {
        let left_out = one.left_out_rms;
        [
            of.to_owned(),
            one.output.clone(),
            simulation_error(&one.open_loop, &one.unit),
            simulation_error(&one.one_step, &one.unit),
            left_out.map_or_else(String::new, |_| rms(left_out, &one.unit)),
        ]
    };
    let later = fit.later.iter().flat_map(|later| &later.outputs);
    let rows = fit.outputs.iter().map(|one| row("record", one));
    let rows = rows.chain(later.map(|one| row("later record", one)));
    let heads = "of | output | > open loop | > one step ahead | > left-out parts";
    let (over, free) = (format::short(fit.horizon_s, 4), fit.first_rows);
    let lead =
        format!("In open loop over {over} s. The first {free} rows of a record do not count.");
    let items = vec![Table::of("", heads, rows).into()];
    section("simulations", "Simulations", &lead, items)
}

/// A row for each output of each plant.
fn table(compared: &PlantComparison) -> Table {
    let mut held_out = "left out";
    let mut rows = Vec::new();
    for one in &compared.models {
        let fit = &one.fit;
        for (index, output) in fit.outputs.iter().enumerate() {
            let left_out = output.left_out_rms;
            let mut error = left_out.map_or_else(String::new, |_| rms(left_out, &output.unit));
            if let Some(later) = &fit.later {
                error = rms(later.outputs[index].open_loop.rms, &output.unit);
                held_out = "later";
            }
            let [nats, aic, bic] =
                [fit.log_likelihood, fit.aic, fit.bic].map(|one| format!("{one:.1}"));
            let (name, unknowns) = (one.name.clone(), fit.unknowns.to_string());
            let open_loop = rms(output.open_loop.rms, &output.unit);
            let output = output.output.clone();
            rows.push([name, output, open_loop, error, unknowns, nats, aic, bic]);
        }
    }
    let heads = "model | output | > open loop | > HELD | > unknowns | > nats | > AIC | > BIC";
    Table::of("", &heads.replace("HELD", held_out), rows)
}
