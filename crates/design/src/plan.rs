//! The next run.

use gyrocal_calibration::{CalibrationError, FittedPlatform, Run};
use gyrocal_diagnosis::manifest;
use gyrocal_hypothesis::stop;

use crate::error::DesignError;
use crate::named_cause::{NamedCause, without_compared_walks};
use crate::options::PlanOptions;
use crate::past::Past;
use crate::planner::{FINE, Planner};
use crate::result::{AttitudeOf, PlanResult, Proposal, Reached, SCHEMA_VERSION};
use crate::shortest_run::reach;

/// Longest run, s: a year.
const MOST_S: f64 = 366.0 * 86_400.0;

/// Searches for the next run with the smallest expected confidence sets or standard deviations, given
/// a fit with the causes that were named in its record, whose noise the run has too.
///
/// Of a fit to several records `run` has the record of [`gyrocal_calibration::joined_record`] and the bench
/// of the last: the next run is one more record of the platform, with a clock and a turn-on of its own.
///
/// Of a fit to a strapdown unit the next run is a log of the unit at rest in another attitude, from which a
/// platform is computed as from the logs before.
///
/// A random walk that is named without rivals is noise of all runs and has no set.
///
/// # Errors
/// [`DesignError`].
pub fn plan(
    fitted: &FittedPlatform<'_>,
    run: &Run<'_>,
    named: &[NamedCause],
    options: &PlanOptions,
) -> Result<PlanResult, DesignError> {
    stop::finished(planned(fitted, run, named, options))
}

fn planned(
    fitted: &FittedPlatform<'_>,
    run: &Run<'_>,
    named: &[NamedCause],
    options: &PlanOptions,
) -> Result<PlanResult, DesignError> {
    options.goal.check()?;
    let fitted = without_compared_walks(fitted, named)?;
    let past = Past::new(&fitted, run);
    let planner = Planner::new(&fitted, &past, named, options)?;
    let own = [past.last().record.duration_s()];
    let durations_s = if options.durations_s.is_empty() {
        &own[..]
    } else {
        &options.durations_s
    };
    let least_s = planner.least_s();
    for found_s in durations_s {
        if !(least_s..=MOST_S).contains(found_s) {
            return Err(DesignError::Duration {
                found_s: *found_s,
                least_s,
                most_s: MOST_S,
            });
        }
    }
    let mut now = None;
    let (mut going_on, mut proposals) = (Vec::new(), Vec::new());
    for duration_s in durations_s {
        let (present, longer) = planner.with(*duration_s, FINE, |evaluator| {
            Ok((evaluator.present(), evaluator.continued()?))
        })?;
        now = now.or(present);
        going_on.extend(longer.map(|outlook| Proposal {
            angles_deg: None,
            duration_s: *duration_s,
            outlook,
        }));
        proposals.extend(planner.search(*duration_s)?);
    }
    let now = now.ok_or(CalibrationError::NotPositiveDefinite)?;
    let reached = match proposals.first().and_then(|best| best.angles_deg) {
        Some(_) if !options.goal.is_empty() && options.goal.is_met(&now) => Some(Reached {
            wish: options.goal.in_words().unwrap_or_default(),
            already: true,
            run: None,
            longest_s: 0.0,
        }),
        Some(angles_deg) if !options.goal.is_empty() => Some(reach(&planner, angles_deg)?),
        _ => None,
    };
    Ok(PlanResult {
        schema_version: SCHEMA_VERSION,
        manifest: manifest(options.seed),
        record: past.summary(),
        records: past.summaries(),
        setup: Vec::new(),
        attitude_of: match fitted.is_strapdown() {
            true => AttitudeOf::Unit,
            false => AttitudeOf::Platform,
        },
        aim: planner.aim,
        now,
        going_on,
        proposals,
        goal: reached,
        inseparable: planner.inseparable(),
    })
}
