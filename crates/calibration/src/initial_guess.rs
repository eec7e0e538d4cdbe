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
use crate::start::Start;

/// Initial trajectory of a run, the attitude prior that belongs to it, and how its azimuth was
/// found.
pub(crate) struct InitialGuess {
    pub(crate) prior: AttitudePrior,
    pub(crate) start: InitialTrajectory,
    pub(crate) azimuth: Option<AzimuthSearch>,
    /// Rows that were left out: see [`gross_errors`].
    pub(crate) gross_errors: Vec<usize>,
}

/// Mean of the squared normalised innovations from which on a fit is poor: an effect of a thousand
/// standard deviations in a record of a day stays below it, and a minimum far from the right one lies
/// above it.
const POOR_FIT: f64 = 1000.0;

/// The same of a fit in stages, which is the only one: of warm-ups of some deg/h the right minimum lies at two
/// thousand, a wrong one above a million.
const POOR_STAGED: f64 = 1e4;

/// What a fit starts from.
pub(crate) struct Guessed<G> {
    pub(crate) guess: G,
    /// Whether all its trajectories were made by growing windows, asked for or not.
    pub(crate) is_careful: bool,
}

/// The fit from the usual start; where it is poor or fails, the best from all starts; where all fail, a good
/// one in stages. `quality` gives the cost of a fit and its number of values.
pub(crate) fn best_fit<G, T, E>(
    mut guess: impl FnMut(Start) -> Result<Guessed<G>, E>,
    mut fit: impl FnMut(G) -> Result<T, E>,
    quality: impl Fn(&T) -> (f64, usize),
) -> Result<T, E> {
    // Starts that were made by windows without being asked to: the careful ones would be the same.
    let mut careful = Vec::new();
    let mut fit_from = |start: Start, careful: &mut Vec<Start>| {
        let guessed = guess(start)?;
        if guessed.is_careful {
            careful.push(start.carefully());
        }
        fit(guessed.guess)
    };
    let first = fit_from(Start::FILTERED, &mut careful);
    let is_below = |most: f64, fit: &T| {
        let (cost, values) = quality(fit);
        cost < most * values as f64
    };
    let is_good = |fit: &T| is_below(POOR_FIT, fit);
    if first.as_ref().is_ok_and(is_good) {
        return first;
    }
    let failed = first.is_err();
    let mut best = first;
    for start in Start::OTHERS {
        if careful.contains(&start) {
            continue;
        }
        let Ok(other) = fit_from(start, &mut careful) else {
            continue;
        };
        // A fit that succeeds after a failure is taken as before, unless it is poor.
        let good = failed && is_good(&other);
        let is_better = match &best {
            Ok(best) => quality(&other).0 < quality(best).0,
            Err(_) => true,
        };
        if is_better {
            best = Ok(other);
        }
        if good {
            break;
        }
    }
    if best.is_err()
        && let Ok(staged) = fit_from(Start::STAGED, &mut careful)
        && is_below(POOR_STAGED, &staged)
    {
        best = Ok(staged);
    }
    best
}

/// Initial guess of a run without its gross errors.
pub(crate) fn initial_guess(
    run: &Run<'_>,
    settings: &FilterSettings<f64>,
    options: &Options,
    start: Start,
) -> Result<InitialGuess, CalibrationError> {
    let settings = &start.settings(settings);
    let gross_errors = gross_errors(run.record, settings.accel_noise_g);
    if gross_errors.is_empty() {
        return guess_from_all_rows(run, settings, options, start);
    }
    let values = gross_errors
        .iter()
        .flat_map(|row| (0..3).map(|axis| [*row, axis]));
    let run = Run {
        record: &run.record.without(values),
        bench: run.bench,
    };
    Ok(InitialGuess {
        gross_errors,
        ..guess_from_all_rows(&run, settings, options, start)?
    })
}

fn guess_from_all_rows(
    run: &Run<'_>,
    settings: &FilterSettings<f64>,
    options: &Options,
    start: Start,
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
        start: initial_trajectory(run, settings, &chosen, options, start)?,
        azimuth,
        gross_errors: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use core::convert::Infallible;

    use super::{Guessed, Start, best_fit};

    /// The starts that are fitted from where each fit is poor.
    fn fitted_from(diverges: impl Fn(Start) -> bool) -> Vec<[bool; 2]> {
        let mut fitted = Vec::new();
        let guess = |start: Start| {
            Ok::<_, Infallible>(Guessed {
                guess: [start.careful, start.loose],
                is_careful: start.careful || diverges(start),
            })
        };
        let poor = |from: [bool; 2]| {
            fitted.push(from);
            Ok(())
        };
        let found = best_fit(guess, poor, |()| (f64::INFINITY, 1));
        assert!(found.is_ok());
        fitted
    }

    #[test]
    fn a_start_by_windows_is_fitted_from_once() {
        let [usual, careful, loose, both] =
            [[false, false], [true, false], [false, true], [true, true]];
        assert_eq!(fitted_from(|_| false), [usual, careful, loose, both]);
        assert_eq!(fitted_from(|start| !start.loose), [usual, loose, both]);
        assert_eq!(fitted_from(|_| true), [usual, loose]);
    }

    #[test]
    fn stages_are_the_last_start_and_their_fit_must_not_be_poor() {
        // All fits fail but that in stages, which has this cost a value.
        let from_stages = |cost: f64| {
            let mut starts = Vec::new();
            let guess = |start: Start| {
                starts.push(start);
                Ok(Guessed {
                    guess: start.staged,
                    is_careful: start.careful,
                })
            };
            let fit = |staged: bool| if staged { Ok(cost) } else { Err("no descent") };
            let found = best_fit(guess, fit, |cost| (*cost, 1));
            assert_eq!(starts.last(), Some(&Start::STAGED));
            assert_eq!(starts.iter().filter(|start| start.staged).count(), 1);
            found
        };
        assert_eq!(from_stages(2000.0), Ok(2000.0));
        assert_eq!(from_stages(4.8e6), Err("no descent"));
    }
}
