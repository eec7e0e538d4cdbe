//! Initial guess of the Gauss-Newton iteration for one run.

use gyrocal::FilterSettings;

use crate::attitude::{AttitudePrior, attitude_hypotheses};
use crate::azimuth::search_azimuth;
use crate::error::CalibrationError;
use crate::gross_errors::gross_errors;
use crate::initial_trajectory::InitialTrajectory;
use crate::options::Options;
use crate::result::AzimuthSearch;
use crate::run::Run;
use crate::single_run::initial_trajectory;

/// Initial trajectory of a run, the attitude prior that belongs to it, and how its azimuth was
/// found.
pub(crate) struct InitialGuess {
    pub(crate) prior: AttitudePrior,
    pub(crate) start: InitialTrajectory,
    pub(crate) azimuth: Option<AzimuthSearch>,
    /// Rows that were left out: see [`gross_errors`].
    pub(crate) gross_errors: Vec<usize>,
}

/// Initial guess of a run without its gross errors; `careful` goes by growing windows even if
/// the filter does not diverge.
pub(crate) fn initial_guess(
    run: &Run<'_>,
    settings: &FilterSettings<f64>,
    options: &Options,
    careful: bool,
) -> Result<InitialGuess, CalibrationError> {
    let gross_errors = gross_errors(run.record, settings.accel_noise_g);
    if gross_errors.is_empty() {
        return guess_from_all_rows(run, settings, options, careful);
    }
    let values = gross_errors
        .iter()
        .flat_map(|row| [0, 1, 2].map(|axis| [*row, axis]));
    let run = Run {
        record: &run.record.without(values),
        bench: run.bench,
    };
    Ok(InitialGuess {
        gross_errors,
        ..guess_from_all_rows(&run, settings, options, careful)?
    })
}

fn guess_from_all_rows(
    run: &Run<'_>,
    settings: &FilterSettings<f64>,
    options: &Options,
    careful: bool,
) -> Result<InitialGuess, CalibrationError> {
    let hypotheses = attitude_hypotheses(run.record, run.bench)?;
    let (chosen, azimuth) = if let [declared] = hypotheses.as_slice() {
        (*declared, None)
    } else {
        let (chosen, search) = search_azimuth(run, settings, &hypotheses, options)?;
        (chosen, Some(search))
    };
    Ok(InitialGuess {
        prior: chosen.prior,
        start: initial_trajectory(run, settings, &chosen, options, careful)?,
        azimuth,
        gross_errors: Vec::new(),
    })
}
