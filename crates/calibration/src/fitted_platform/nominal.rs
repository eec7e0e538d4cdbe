//! The nominal model fitted to a record.

use std::borrow::Cow;

use gyrocal::{Chart, FilterSettings};
use gyrocal_hypothesis::ExtraColumns;
use gyrocal_inference::stop;

use super::{FittedPlatform, NoiseModel, Parts, of_site, walks};
use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::gyro_axes::GyroAxes;
use crate::initial_guess::{Guessed, InitialGuess, best_fit, initial_guess};
use crate::law::{Law, LawInputs};
use crate::options::Options;
use crate::problem::{Problem, RunProblem, Unknown};
use crate::run::{Run, WeightedRows};
use crate::settings::filter_settings;
use crate::solve::MAX_PASSES;
use crate::start::Start;

impl<'a> FittedPlatform<'a> {
    /// Fits the nominal model; what the bench declares uncertain of its site is in the extension.
    ///
    /// # Errors
    /// As [`crate::calibrate`].
    pub fn nominal(
        run: &Run<'a>,
        options: &Options,
        noise: &NoiseModel,
    ) -> Result<Self, CalibrationError> {
        Self::nominal_of_unit(run, None, options, noise)
    }

    /// The same of a strapdown unit, if the axes of its instruments at each row are given: the law holds in
    /// these axes, and coefficients and effects are errors of the instruments' outputs.
    ///
    /// # Errors
    /// As [`Self::nominal`], and [`CalibrationError::GyroAxes`] if there is not one attitude for each row.
    pub fn nominal_of_unit(
        run: &Run<'a>,
        axes: Option<&GyroAxes>,
        options: &Options,
        noise: &NoiseModel,
    ) -> Result<Self, CalibrationError> {
        stop::finished(best_fit(
            |start| guess(run, options, noise, start),
            |guess| Self::nominal_from(run, axes, options, noise, guess),
            |fit| (fit.solution.cost, fit.solution.values),
        ))
    }

    /// The same from the usual start only, however poor the fit: quicker where the record fits no model.
    ///
    /// # Errors
    /// As [`Self::nominal`].
    pub fn nominal_once(
        run: &Run<'a>,
        options: &Options,
        noise: &NoiseModel,
    ) -> Result<Self, CalibrationError> {
        let from = |start| {
            let guessed = guess(run, options, noise, start)?;
            Self::nominal_from(run, None, options, noise, guessed.guess)
        };
        stop::finished(from(Start::FILTERED).or_else(|_| from(Start::CAREFUL)))
    }

    fn nominal_from(
        run: &Run<'a>,
        axes: Option<&GyroAxes>,
        options: &Options,
        noise: &NoiseModel,
        beginning: InitialGuess,
    ) -> Result<Self, CalibrationError> {
        let law = Law::of(run, axes)?;
        let settings = filter_settings(run.bench, options.moving_chart());
        let extension = of_site(run.bench);
        let mut values = law.starts_from(&beginning.start.drift).to_vec();
        values.resize(PARAMETERS + extension.parameters.len(), 0.0);
        let accel_noise_g = noise
            .accel_ratio
            .map(|ratio| ratio * settings.accel_noise_g);
        let mut rows = WeightedRows::new(run.record, run.record.len(), accel_noise_g);
        rows.weights.clone_from(&noise.weights);
        rows.gyro_axes = axes.cloned().map(Cow::Owned);
        let mut chart: Chart<f64, LawInputs> = Chart::for_model(settings.site);
        if let Some(field_gauss) = run.bench.magnetic_field_gauss {
            chart.set_field_gauss(field_gauss);
        }
        let density = settings.drift_noise_density();
        let leg = RunProblem {
            rows,
            chart,
            noise_density: noise.gyro_ratio.map(|ratio| ratio * ratio * density),
            prior: beginning.prior.orientation,
            prior_covariance: beginning.prior.covariance,
            points: match axes {
                Some(axes) => axes.trajectory(run.record, &beginning.prior.orientation),
                None => beginning.start.points,
            },
            parameter_unknowns: Vec::new(),
            further: ExtraColumns::default(),
            amplitudes: Vec::new(),
            walks: walks(&noise.gyro_walk_deg_per_h_per_sqrt_h),
            walk_changes: Vec::new(),
        };
        let problem = Problem {
            model: law.anchored(),
            integration: options.discretisation.integration,
            longest_step_s: options.discretisation.longest_step_s,
            unknowns: settings
                .drift_sigma
                .to_array()
                .into_iter()
                .chain(extension.parameters.iter().map(|(_, sigma)| *sigma))
                .map(Unknown::estimated)
                .collect(),
            runs: vec![leg],
            values,
        };
        let noise = noise.clone();
        let several = None;
        let parts = Parts {
            noise,
            several,
            most_passes: MAX_PASSES,
        };
        Self::solved(problem, extension, parts)
    }
}

/// What a fit of one record starts from.
fn guess(
    run: &Run<'_>,
    options: &Options,
    noise: &NoiseModel,
    start: Start,
) -> Result<Guessed<InitialGuess>, CalibrationError> {
    let settings = filter_settings(run.bench, options.moving_chart());
    // Noise that is believed to be far larger than declared is that of the first guess as well.
    let largest_ratio = noise.accel_ratio.into_iter().fold(1.0, f64::max);
    let guessing = FilterSettings {
        accel_noise_g: largest_ratio * settings.accel_noise_g,
        ..settings
    };
    let guess = initial_guess(run, &guessing, options, start)?;
    Ok(Guessed {
        is_careful: guess.start.by_windows,
        guess,
    })
}
