//! The page of a fit of a plant, and that of several beside each other.

use gyrocal_answer::{ComparedFit, OutputFit, PlantComparison, PlantFit};
use gyrocal_document::{Item, Part, Section, Table};
use gyrocal_record::Manifest;
use gyrocal_statistics::format;
use gyrocal_words::counted;
use gyrocal_words::plant::{comparison_screen, direction, fit_screen, simulation_error};

use super::{over_time, rms, tables};
use crate::diagnosis::section;
use crate::origin::{file_name, origin};

/// The page of a fit.
#[must_use]
pub fn of_fit(fit: &PlantFit, manifest: &Manifest) -> Part {
    let sections = vec![estimates(fit), noise(fit), simulations(fit)];
    Part {
        name: file_name(manifest, 0, "record"),
        size: size(fit),
        first: fit_screen(fit),
        sections,
        origin: origin(manifest),
    }
}

fn size(fit: &PlantFit) -> String {
    let duration_s = format::short(fit.record.duration_s, 4);
    format!("{} over {duration_s} s", counted(fit.record.rows, "row"))
}

fn estimates(fit: &PlantFit) -> Section {
    let rows = fit.correlations.iter().map(|one| {
        let [first, second] = one.of.clone();
        [first, second, format!("{:.3}", one.coefficient)]
    });
    let heads = "of | and | > correlation";
    let mut items = vec![
        Item::Estimates(tables::estimates("", &fit.coefficients)),
        Table::of("The largest correlations of estimates", heads, rows).into(),
    ];
    items.extend(fit.undetermined.iter().map(direction).map(Item::text));
    let lead = "Estimates with their standard deviations.";
    section("parameters", "Parameters", lead, items)
}

fn noise(fit: &PlantFit) -> Section {
    let table = over_time::tests("", &fit.noise, &fit.remainder);
    let lead = "One-step innovations of a right model are white (Ljung-Box).";
    section("noise", "Noise", lead, vec![table.into()])
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
    let rows = fit.outputs.iter().map(|one| row("the record", one));
    let rows = rows.chain(later.map(|one| row("later record", one)));
    let heads = "of | output | > open loop | > one step ahead | > left-out parts";
    let over = format::short(fit.horizon_s, 4);
    let free = match fit.first_rows {
        0 => String::new(),
        rows => format!(
            " The first {} of a record do not count.",
            counted(rows, "row")
        ),
    };
    let lead =
        format!("Root mean square errors and fit percentages; in open loop over {over} s.{free}");
    let table = Table::of("", heads, rows);
    section("simulations", "Simulations", &lead, vec![table.into()])
}

/// The page of fits of several plants to one record.
#[must_use]
pub fn of_comparison(compared: &PlantComparison, manifest: &Manifest) -> Part {
    let mut first = comparison_screen(compared);
    let models = compared.models.iter();
    first.table = Some(table(models.clone()));
    let sections = models.flat_map(|one| {
        let title = |section: Section| Section {
            title: format!("{}: {}", one.name, section.title.to_lowercase()),
            ..section
        };
        [estimates(&one.fit), noise(&one.fit), simulations(&one.fit)].map(title)
    });
    Part {
        name: file_name(manifest, compared.models.len(), "record"),
        size: compared
            .models
            .first()
            .map_or_else(String::new, |one| size(&one.fit)),
        sections: sections.collect(),
        first,
        origin: origin(manifest),
    }
}

/// A row for each output; criteria stand in the first of a plant.
fn table<'a>(models: impl Iterator<Item = &'a ComparedFit> + Clone) -> Table {
    let has_later = models.clone().any(|one| one.fit.later.is_some());
    let rows = models.flat_map(|one| {
        let fit = &one.fit;
        fit.outputs.iter().enumerate().map(move |(index, output)| {
            let of = |text: String| if index == 0 { text } else { String::new() };
            let later = fit
                .later
                .as_ref()
                .map(|later| later.outputs[index].open_loop.rms);
            let held_out = later.unwrap_or(output.left_out_rms);
            [
                of(one.name.clone()),
                output.output.clone(),
                rms(output.open_loop.rms, &output.unit),
                rms(held_out, &output.unit),
                of(fit.unknowns.to_string()),
                of(format!("{:.1}", fit.log_likelihood)),
                of(format!("{:.1}", fit.aic)),
                of(format!("{:.1}", fit.bic)),
            ]
        })
    });
    let held_out = if has_later { "later" } else { "left out" };
    let heads = format!(
        "model | output | > open loop | > {held_out} | > unknowns | > nats | > AIC | > BIC"
    );
    Table::of("", &heads, rows)
}
