//! Cramér-Rao bound of the coefficients.

use gyrocal::trajectory::orientation;
use gyrocal::{Anchored, Surveyed};
use nalgebra::{Cholesky, DMatrix};

use crate::attitude::attitude_hypotheses;
use crate::check::check_lengths;
use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::layout::Layout;
use crate::options::Options;
use crate::problem::Problem;
use crate::run::Run;
use crate::settings::filter_settings;
use crate::single_run::run_problem;

/// Cramér-Rao bound of the nine coefficients: the least covariance of any estimator, for noise and
/// prior as the bench declares them. Returned in the order of [`gyrocal::Drift`], in the units of
/// the coefficients.
///
/// The bound is the inverse of the information of the record, linearised about the true trajectory
/// and the true coefficients, plus that of the prior (Van Trees, *Detection, Estimation, and
/// Modulation Theory* I, 1968, section 2.4); the attitudes at all rows are eliminated. Latitude,
/// Earth rate and gravity are unknowns with the sigmas that the bench declares, and known without
/// a sigma.
///
/// `platform_c_enu` is the true attitude at each row, platform components from East, North, Up
/// components; `drift` are the true coefficients in the order of the result. Of the samples only
/// missing values matter.
///
/// # Errors
/// [`CalibrationError::UnequalLengths`] of the record; [`CalibrationError::NotLevelled`] if the
/// bench gives no attitude and the record neither; [`CalibrationError::Pass`] if there is not one
/// attitude for each row, or the record cannot be passed over;
/// [`CalibrationError::NotPositiveDefinite`] if the information has no inverse.
pub fn cramer_rao_bound(
    run: &Run<'_>,
    platform_c_enu: &[[[f64; 3]; 3]],
    drift: &[f64; PARAMETERS],
) -> Result<[[f64; PARAMETERS]; PARAMETERS], CalibrationError> {
    check_lengths(run.record)?;
    let layout = Layout::new(&[run.bench]);
    // The integration rule has no influence: the bound is linearised about the truth.
    let options = Options::default();
    let settings = filter_settings(run.bench, options.discretisation);
    // All hypotheses have the same covariance: it does not depend on azimuth.
    let prior = attitude_hypotheses(run.record, run.bench)?
        .first()
        .map(|hypothesis| hypothesis.prior)
        .ok_or(CalibrationError::NotLevelled)?;
    let points = platform_c_enu.iter().map(orientation).collect();
    let mut values = vec![0.0; layout.unknowns.len()];
    values[..PARAMETERS].copy_from_slice(drift);
    let parameter_unknowns = layout.parameter_unknowns(0);
    let problem = Problem {
        model: &Anchored(Surveyed),
        integration: options.discretisation.integration,
        longest_step_s: options.discretisation.longest_step_s,
        runs: vec![run_problem(
            run,
            run.record.len(),
            &settings,
            &prior,
            points,
            parameter_unknowns.clone(),
        )],
        unknowns: layout.unknowns,
        values,
    };
    let reduced = problem
        .with_run(0, &problem.parameters(0), |pass| pass.reduce(|_| ()))
        .map_err(|source| CalibrationError::pass(0, source))?;
    // Columns are the parameters of the model; in a single run each of them is one unknown.
    let sigma: Vec<f64> = parameter_unknowns
        .iter()
        .map(|unknowns| unknowns.iter().map(|i| problem.unknowns[*i].sigma).sum())
        .collect();
    let unknown: Vec<usize> = (0..parameter_unknowns.len())
        .filter(|i| sigma[*i] > 0.0)
        .collect();
    let information = DMatrix::from_fn(unknown.len(), unknown.len(), |i, j| {
        let (a, b) = (unknown[i], unknown[j]);
        let own = if i == j { sigma[a].powi(-2) } else { 0.0 };
        reduced.gram[(a + 1, b + 1)] + own
    });
    let covariance = Cholesky::new(information)
        .ok_or(CalibrationError::NotPositiveDefinite)?
        .inverse();
    // The coefficients come first, and each of them has a prior.
    Ok(core::array::from_fn(|i| {
        // Rounding of the inverse differs on the two sides of its diagonal.
        core::array::from_fn(|j| covariance[(i.max(j), i.min(j))])
    }))
}
