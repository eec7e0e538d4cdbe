//! The JSON result.

use std::path::Path;

use gyrocal::generated::MODEL_HASH;
use gyrocal_diagnosis::plan::{Aim, Forecast, Outlook, Proposal, SetForecast};
use gyrocal_record::{
    GoalReport, OutlookReport, PlanAim, PlanReport, ProposalReport, SCHEMA_VERSION,
    SetMemberReport, SetReport, SigmaReport,
};

use super::Found;
use crate::Failure;
use crate::outputs::manifest;

pub(super) fn report(
    found: &Found<'_>,
    seed: u64,
    inputs: &[&Path],
) -> Result<PlanReport, Failure> {
    let planned = &found.planned;
    Ok(PlanReport {
        schema_version: SCHEMA_VERSION,
        manifest: manifest(MODEL_HASH, seed, inputs)?,
        aim: match planned.aim {
            Aim::Set => PlanAim::Set,
            _ => PlanAim::Sigmas,
        },
        now: outlook(&planned.now),
        going_on: planned.going_on.iter().map(proposal).collect(),
        proposals: planned.proposals.iter().map(proposal).collect(),
        goal: planned.reached.as_ref().map(|reached| GoalReport {
            wish: found.wish.clone().unwrap_or_default(),
            already: reached.already,
            run: reached.run.as_ref().map(proposal),
            longest_s: reached.longest_s,
        }),
        inseparable: planned
            .inseparable
            .iter()
            .map(|class| class.iter().map(|id| (*id).to_owned()).collect())
            .collect(),
    })
}

fn proposal(proposal: &Proposal) -> ProposalReport {
    ProposalReport {
        initial_angles_deg: proposal.angles_deg,
        duration_s: proposal.duration_s,
        outlook: outlook(&proposal.outlook),
    }
}

fn outlook(outlook: &Outlook) -> OutlookReport {
    OutlookReport {
        sigma_ratio: outlook.sigma_ratio,
        coefficients: outlook.coefficients.iter().map(sigma).collect(),
        sizes: outlook.sizes.iter().map(sigma).collect(),
        sets: outlook.sets.iter().map(set).collect(),
    }
}

fn sigma(forecast: &Forecast) -> SigmaReport {
    SigmaReport {
        name: forecast.name.clone(),
        sigma: forecast.sigma,
        unit: forecast.unit.to_owned(),
    }
}

fn set(set: &SetForecast) -> SetReport {
    SetReport {
        effect: set.effect.to_owned(),
        mean_size: set.mean_size,
        one_left: set.one_left,
        members: set
            .members
            .iter()
            .map(|member| SetMemberReport {
                effect: member.effect.to_owned(),
                equivalents: member
                    .equivalents
                    .iter()
                    .map(|id| (*id).to_owned())
                    .collect(),
                told_apart: member.told_apart,
            })
            .collect(),
    }
}
