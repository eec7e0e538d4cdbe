//! Restricted likelihood of the gyros' noise: white noise and random walks.

mod likelihood;

use gyrocal_hypothesis::{RateNoise, RateNoiseFit};
use gyrocal_inference::{Maximum, Walk};
use likelihood::Likelihood;
use nalgebra::{Cholesky, DVector};

use super::{AXES, FittedPlatform, walks};
use crate::error::CalibrationError;
use crate::platform::PLATFORM;

/// Standard deviation of the logarithm of a gyro's white noise over the declared one before the
/// record: bench files are off by factors of two, seldom of four.
pub const GYRO_NOISE_PRIOR_SIGMA: f64 = 0.7;

/// Density of a walk that counts as none, over that of the white noise over the square of the
/// record's duration.
const NO_WALK: f64 = 1e-6;

/// Fewest degrees of freedom that are told. Below, the first order fails: with a normal logarithm of the
/// variance, of standard deviation 1.3, the largest of a walk that is named, the 97.5 % point is 3.1
/// sigmas, that of three degrees, where the first order has one degree and 12.7 sigmas.
const FEWEST_DEGREES: f64 = 3.0;

/// Gain of the log-likelihood that a step expects below which it is not made where effects are integrated out: a
/// logarithm is then good to two hundredths of its standard deviation, a tenth of what that corrects.
const RESTRICTED_GAIN: f64 = 2e-4;

impl FittedPlatform<'_> {
    /// Number of parameters of the extension that have a prior: what the bench declares uncertain.
    fn nuisances(&self) -> usize {
        let parameters = self.extension.parameters.iter();
        parameters.filter(|(_, sigma)| sigma.is_finite()).count()
    }

    /// The noise that the fit believes the gyros to have.
    #[must_use]
    pub fn rate_noise(&self) -> RateNoise {
        RateNoise {
            white: self.noise.gyro_ratio.to_vec(),
            walk: self.noise.gyro_walk_deg_per_h_per_sqrt_h.to_vec(),
        }
    }

    /// The noise of the gyros at the largest restricted likelihood, linearised about this fit, with
    /// random walks of the gyros `walking`; `absent` are places among [`Self::values`] of what the
    /// model shall not have.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`] and [`CalibrationError::NotPositiveDefinite`].
    pub fn fit_rate_noise(
        &self,
        walking: &[usize],
        absent: &[usize],
    ) -> Result<RateNoiseFit, CalibrationError> {
        self.fit_rate_noise_with(walking, absent, &[], self.points().len())
    }

    /// The same with the noise of this fit's walks, and the white noise of some gyros `held` at the
    /// declared one.
    ///
    /// # Errors
    /// As [`Self::fit_rate_noise`].
    pub fn fit_rate_noise_held(&self, held: &[usize]) -> Result<RateNoiseFit, CalibrationError> {
        let rows = self.points().len();
        self.fit_rate_noise_with(&self.rate_noise().walking(), &[], held, rows)
    }

    /// The noise of the gyros that walk in this fit, and the white noise of all, from the first `rows`
    /// rows alone.
    ///
    /// # Errors
    /// As [`Self::fit_rate_noise`].
    pub fn fit_rate_noise_to_first(&self, rows: usize) -> Result<RateNoiseFit, CalibrationError> {
        self.fit_rate_noise_with(&self.rate_noise().walking(), &[], &[], rows)
    }

    /// The noise of this fit with the effects of its extension integrated out as its coefficients are: each
    /// unknown of an effect takes a degree of freedom off the noise that hides it, of some twenty. Models with
    /// other effects are compared without, as their flat priors have no common unit.
    ///
    /// # Errors
    /// As [`Self::fit_rate_noise`].
    pub fn restricted_noise(&self) -> Result<RateNoise, CalibrationError> {
        let (mut likelihood, _) = self.likelihood(&self.rate_noise().walking(), &[], &[]);
        likelihood.integrates_effects = true;
        let (logarithms, at) = likelihood.maximise_to(RESTRICTED_GAIN)?;
        Ok(likelihood.result(&logarithms, &at)?.noise)
    }

    fn fit_rate_noise_with(
        &self,
        walking: &[usize],
        absent: &[usize],
        held: &[usize],
        rows: usize,
    ) -> Result<RateNoiseFit, CalibrationError> {
        let (mut likelihood, unit) = self.likelihood(walking, absent, held);
        likelihood.rows = rows;
        likelihood.start(unit)?;
        let (logarithms, at) = likelihood.maximise()?;
        likelihood.result(&logarithms, &at)
    }

    /// 95 % interval of each walk of this fit by its profile likelihood: the other noise moves with it
    /// as at the maximum. The lower end is zero where the likelihood stays high; `None` of a gyro
    /// without a walk, and where there is no upper end.
    ///
    /// # Errors
    /// As [`Self::fit_rate_noise`].
    pub fn walk_intervals(&self) -> Result<Vec<Option<[f64; 2]>>, CalibrationError> {
        let walking = self.rate_noise().walking();
        let mut intervals = vec![None; AXES];
        if walking.is_empty() {
            return Ok(intervals);
        }
        let (likelihood, _) = self.likelihood(&walking, &[], &[]);
        let (logarithms, at) = likelihood.maximise()?;
        let fit = likelihood.result(&logarithms, &at)?;
        let covariance = Cholesky::new(at.information.clone())
            .ok_or(CalibrationError::NotPositiveDefinite)?
            .inverse();
        let maximum = Maximum {
            logarithms: &logarithms,
            covariance: &covariance,
            value: at.value,
        };
        for (index, rate) in walking.into_iter().enumerate() {
            let own = AXES + index;
            let size =
                |logarithm: f64| fit.noise.walk[rate] * (0.5 * (logarithm - logarithms[own])).exp();
            let [low, high] = maximum.interval(own, &mut |moved| likelihood.value(moved).ok());
            intervals[rate] = high.map(|high| [low.map_or(0.0, size), size(high)]);
        }
        Ok(intervals)
    }

    /// Degrees of freedom of the variance of each estimate: the noise of the gyros that it rests on was
    /// estimated from the record (Satterthwaite, Biometrics Bulletin 2, 110, 1946). An error over its
    /// sigma has nearly Student's distribution with as many. Three at least. The information on that noise is
    /// what it would be with the unknowns of the fit known: degrees are rather too many.
    ///
    /// # Errors
    /// As [`Self::fit_rate_noise`].
    pub fn degrees_of_freedom(&self) -> Result<Vec<f64>, CalibrationError> {
        let (likelihood, _) = self.likelihood(&self.rate_noise().walking(), &[], &[]);
        let (information, derivatives) = likelihood.at_fit()?;
        let of_noise = Cholesky::new(information).ok_or(CalibrationError::NotPositiveDefinite)?;
        let covariance = self.covariance();
        let shared = self.shared;
        let changes: Vec<_> = derivatives
            .iter()
            .map(|derivative| covariance * derivative * covariance)
            .collect();
        let degrees = |place: usize| {
            let change = DVector::from_iterator(
                changes.len(),
                changes.iter().map(|change| change[(place, place)]),
            );
            let of_variance = of_noise.solve(&change).dot(&change);
            let degrees = 2.0 * covariance[(place, place)].powi(2) / of_variance;
            degrees.max(FEWEST_DEGREES)
        };
        Ok((0..shared).map(degrees).collect())
    }

    /// The likelihood of the noise about this fit, and the density of a walk that does over the record
    /// as much as the declared white noise.
    fn likelihood<'p>(
        &'p self,
        walking: &[usize],
        absent: &'p [usize],
        held: &'p [usize],
    ) -> (Likelihood<'p, 'p>, f64) {
        let leg = &self.problem.runs[0];
        let runs = self.problem.runs.iter();
        let duration_s = runs.map(|run| run.rows.duration_s()).fold(0.0, f64::max);
        let unit = leg.noise_density.iter().sum::<f64>() / AXES as f64 / (duration_s * duration_s);
        let mut walks = Vec::new();
        let mut free = Vec::new();
        for (rate, channel) in PLATFORM.rates.iter().enumerate() {
            let before = leg
                .walks
                .iter()
                .find(|one| one.parameter == channel.constant);
            let wanted = walking.contains(&rate);
            if wanted {
                free.push(walks.len());
            }
            if wanted || before.is_some() {
                let density = before
                    .filter(|_| wanted)
                    .map_or(NO_WALK * unit, |one| one.density);
                walks.push(Walk {
                    parameter: channel.constant,
                    density,
                });
            }
        }
        let likelihood = Likelihood {
            fitted: self,
            walks,
            free,
            absent,
            held,
            rows: self.points().len(),
            integrates_effects: false,
        };
        (likelihood, unit)
    }

    /// The same extension fitted with other noise of the gyros.
    ///
    /// # Errors
    /// As [`Self::refitted`].
    pub fn with_rate_noise(&self, noise: &RateNoise) -> Result<Self, CalibrationError> {
        let mut model = self.noise.clone();
        for axis in 0..AXES {
            model.gyro_ratio[axis] = noise.white[axis];
            model.gyro_walk_deg_per_h_per_sqrt_h[axis] = noise.walk[axis];
        }
        let change: [f64; AXES] = core::array::from_fn(|axis| {
            (model.gyro_ratio[axis] / self.noise.gyro_ratio[axis]).powi(2)
        });
        let sizes = model.gyro_walk_deg_per_h_per_sqrt_h;
        self.refitted_with(
            &self.extension,
            |leg| {
                for (density, change) in leg.noise_density.iter_mut().zip(change) {
                    *density *= change;
                }
                leg.set_walks(walks(&sizes));
            },
            model,
        )
    }
}
