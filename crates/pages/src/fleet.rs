//! The page of a fleet.

use gyrocal_document::{Bar, BarGroup, Bars, Item, Part, Table, Tint};
use gyrocal_fleet::{FleetResult, prose};
use gyrocal_statistics::format;
use gyrocal_words::counted;

use crate::origin::part;
use crate::words::section;

/// Units of a coefficient that are shown as bars.
const SHOWN: usize = 40;

/// The page of what a fleet shows.
#[must_use]
pub fn of_fleet(fleet: &FleetResult) -> Part {
    let lead = "Mean and spread of the units, with 95 % intervals. The spread is without the errors of the estimates.";
    let items = vec![Item::from(prose::coefficients(fleet))];
    let title = "Coefficients over the units";
    let mut sections = vec![section("coefficients", title, lead, items)];
    if !fleet.recurring.is_empty() {
        let lead = "Too weak for one record, and in more units than chance puts them.";
        let items = vec![Item::Bars(evidence(fleet)), Item::from(units(fleet))];
        sections.push(section("recurring", "Causes that recur", lead, items));
    }
    let levels = fleet.coefficients.iter().map(|one| {
        let mut bars: Vec<Bar> = one
            .levels
            .iter()
            .map(|level| Bar {
                label: level.unit.clone(),
                value: level.estimate.abs(),
                tint: match one.outliers.iter().any(|other| other.unit == level.unit) {
                    true => Tint::Extended,
                    false => Tint::Nominal,
                },
                note: format::with_sigma(level.estimate, level.sigma),
            })
            .collect();
        bars.sort_by(|a, b| b.value.total_cmp(&a.value));
        let more = bars.len().saturating_sub(SHOWN);
        bars.truncate(SHOWN);
        let quantity = format!("size of the coefficient, {}", one.unit);
        let heading = "Units, the largest first; outside of the others in the second colour";
        let more = (more > 0).then(|| counted(more, "unit"));
        Item::Bars(Bars {
            omitted: more.map_or_else(String::new, |units| {
                format!("{units} with smaller coefficients are not shown.")
            }),
            ..Bars::new(&one.name, &quantity, vec![BarGroup::new(heading, bars)])
        })
    });
    let lead = "Each coefficient of each unit, mean over its records.";
    sections.push(section("units", "Units", lead, levels.collect()));
    let lead = "All that the fleet shows.";
    let items = prose::all(fleet).into_iter().map(Item::Words).collect();
    sections.push(section("words", "In words", lead, items));
    let units = counted(fleet.units, "unit");
    let size = format!("{units}, {}", counted(fleet.records, "record"));
    let (name, first) = ("fleet".to_owned(), prose::first_screen(fleet));
    part(&fleet.manifest, name, size, first, sections)
}

fn evidence(fleet: &FleetResult) -> Bars {
    let bars = fleet.recurring.iter().map(|cause| Bar {
        label: cause.effect.clone(),
        value: cause.ln_evidence,
        tint: Tint::Extended,
        note: format::p_value(cause.p_value),
    });
    let quantity = "logarithm of the e-value, nats";
    Bars::new("Evidence", quantity, vec![BarGroup::new("Effects", bars)])
}

/// Units that are likely to have a recurring cause.
fn units(fleet: &FleetResult) -> Table {
    let rows = fleet.recurring.iter().flat_map(|cause| {
        cause.units.iter().map(|one| {
            let probability = format!("{:.2}", one.probability);
            [cause.effect.clone(), one.unit.clone(), probability]
        })
    });
    let title = "Units that are more likely than not to have it";
    Table::of(title, "effect | unit | > probability", rows)
}
