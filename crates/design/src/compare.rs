//! Two records together: what is left of the sets that the first one had.

use gyrocal_calibration::{CalibrationError, FittedPlatform, GyroAxes, NoiseModel, Options, Run};
use gyrocal_hypothesis::stop;

use crate::candidates::{candidates, times};
use crate::error::DesignError;
use crate::joint_unknowns::{ConfidenceSet, JointUnknowns};
use crate::named_cause::{NamedCause, fitted_alone, without_compared_walks};
use crate::past::Past;
use crate::result::Forecast;
use crate::run_information::RunInformation;
use crate::set_comparison::{Comparison, deficits, stays};
use crate::sigma::sigmas;

/// Confidence sets and coefficients from two records together.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// Standard deviations of the nine coefficients, with what was named in the model.
    pub coefficients: Vec<Forecast>,
    /// The members of each named set, the one that was named in the first record first.
    pub sets: Vec<Vec<ComparedMember>>,
}

/// A member of a named set, judged by both records.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedMember {
    /// Its id.
    pub effect: &'static str,
    /// Log-likelihood of the effect named by both records less its own, penalties subtracted.
    pub log_likelihood_deficit: f64,
    /// Whether it is in the set that is left.
    pub stays: bool,
    /// Estimate and standard deviation of each size, in the units of the model; none of a random
    /// walk.
    pub sizes: Vec<[f64; 2]>,
}

/// Compares the members of the sets of a record on that record and another one. `fitted` is the
/// fit to the first with what was named; its noise holds for both. A random walk that is named without rivals is
/// noise and has no set. Of a strapdown unit `axes` are those of the instruments at each row of the other
/// record.
///
/// # Errors
/// [`DesignError`].
pub fn compare(
    fitted: &FittedPlatform<'_>,
    first: &Run<'_>,
    second: &Run<'_>,
    axes: Option<&GyroAxes>,
    named: &[NamedCause],
    options: &Options,
) -> Result<Compared, DesignError> {
    let fitted = without_compared_walks(fitted, named)?;
    let past = Past::new(&fitted, first);
    let sets = candidates(&fitted, &past, named)?;
    let times = times(&past, second.record.duration_s());
    let unknowns = JointUnknowns::new(&fitted, first, &sets, &times);
    // Values that the first record's noise has no trust in are no rows of the second.
    let noise = NoiseModel {
        weights: None,
        ..fitted.noise_model().clone()
    };
    let other = fitted_alone(named, second, axes, &noise, options)?;
    let mut information = unknowns.of_first(&RunInformation::of_record(
        &fitted,
        first.record,
        &unknowns.first,
    )?);
    let next = unknowns.of_next(&RunInformation::of_record(
        &other,
        second.record,
        &unknowns.next,
    )?);
    information.information += next.information;
    information.score += next.score;
    let (coefficients, _) =
        sigmas(&unknowns, &information.information).ok_or(CalibrationError::NotPositiveDefinite)?;
    let judged = unknowns
        .cases
        .iter()
        .map(|case| judged(case, &unknowns, &information));
    stop::check()?;
    Ok(Compared {
        coefficients,
        sets: judged
            .collect::<Option<_>>()
            .ok_or(CalibrationError::NotPositiveDefinite)?,
    })
}

fn judged(
    case: &ConfidenceSet,
    unknowns: &JointUnknowns,
    information: &RunInformation,
) -> Option<Vec<ComparedMember>> {
    let comparison = Comparison::new(case, &unknowns.list, &information.information)?;
    let projected = &comparison.projection * &information.score;
    let statistics = comparison.statistics(projected.as_slice());
    let (_, deficits) = deficits(&case.members, &statistics)?;
    Some(
        case.members
            .iter()
            .zip(deficits)
            .enumerate()
            .map(|(index, (member, deficit))| ComparedMember {
                effect: member.candidate.row.id,
                log_likelihood_deficit: deficit,
                stays: stays(deficit),
                sizes: comparison.estimates(index, projected.as_slice()),
            })
            .collect(),
    )
}
