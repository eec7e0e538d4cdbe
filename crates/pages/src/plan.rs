//! The page of a planned next run.

use gyrocal_design::{AttitudeOf, PlanResult, Proposal, prose, tables};
use gyrocal_document::{Bar, BarGroup, Bars, Item, Part, Tint};
use gyrocal_words::{hours, size};

use crate::origin::{part, record_name};
use crate::words::section;

/// The page of a plan.
#[must_use]
pub fn of_plan(plan: &PlanResult) -> Part {
    let lead = "Runs, standard deviations and what is told apart: of the record so far, and of record and next run \
                together.";
    let items = tables(plan).into_iter().map(Item::from).collect();
    let mut sections = vec![section("sigmas", "What the run gives", lead, items)];
    if !plan.proposals.is_empty() {
        let lead = "The best attitudes of each duration, against continuing in the present one.";
        let items = vec![Item::Bars(proposals(plan))];
        sections.push(section("proposals", "Proposals", lead, items));
    }
    let lead = "What is known, the recommended run, and what it is expected to tell.";
    let items = prose(plan).into_iter().map(Item::Words).collect();
    sections.push(section("words", "In words", lead, items));
    let (manifest, first) = (&plan.manifest, gyrocal_design::first_screen(plan));
    let name = record_name(manifest, plan.records.len());
    let size = size(plan.record.rows, plan.record.duration_s);
    part(manifest, name, size, first, sections)
}

fn attitude(plan: &PlanResult, proposal: &Proposal) -> String {
    let Some([x, y, z]) = proposal.angles_deg else {
        return "continue in the present attitude".to_owned();
    };
    let body = match plan.attitude_of {
        AttitudeOf::Unit => "unit",
        _ => "platform",
    };
    format!("{body} angles {x:.0}°, {y:.0}°, {z:.0}°").replace('-', "−")
}

/// Ratio of the sigmas of each proposal.
fn proposals(plan: &PlanResult) -> Bars {
    let bar = |proposal: &Proposal, tint: Tint| Bar {
        label: format!(
            "{}, {}",
            attitude(plan, proposal),
            hours(proposal.duration_s)
        ),
        value: 100.0 * proposal.outlook.sigma_ratio,
        tint,
        note: match proposal.outlook.sets.len() {
            0 => String::new(),
            _ => format!("{:.2} names left beyond one", proposal.outlook.surplus()),
        },
    };
    let going_on = plan.going_on.iter().map(|run| bar(run, Tint::Other));
    let best = plan.proposals.iter().map(|run| bar(run, Tint::Extended));
    Bars::new(
        "Sigmas after record and run over those of the record so far",
        "geometric mean over the nine coefficients, %",
        vec![
            BarGroup::new("Proposals, the best first for each duration", best),
            BarGroup::new("Continuing in the present attitude", going_on),
        ],
    )
}
