//! How a sample is taken: whether it surprises, and in how many parts.

use gyrocal_estimation::Innovation;
use gyrocal_estimation::form::Form;

use super::ControllerFilter;
use crate::controller_error::ControllerError;
use crate::saved::{SavedForm, SavedNumber};

/// Most that the variance of the attitude may grow between the start and the first sample, rad²: 3.5°, an
/// hour and a half of drift that is known to 1 deg/h, 1 deg/h/g and 1 deg/h/g². Up to there a first update in
/// parts leaves the errors that their sigmas say (`tests/surprises.rs`); after two hours they were one and a half
/// times as large, after four six times.
const LARGEST_GROWTH: f64 = 3.73e-3;

/// NIS that a sound sample exceeds once in a hundred: chi-square with three degrees of freedom.
const USUAL_NIS: f64 = 11.345;

impl<T: SavedNumber, F: Form<T> + SavedForm> ControllerFilter<T, F> {
    /// Takes a sample at the time the filter is at, whatever its NIS: after [`ControllerError::Diverged`],
    /// with the sample that it answered. All sigmas are widened in the same proportion, fourfold in variance
    /// at a time, until the NIS of the sample is one that a sound sample exceeds once in a hundred. Where the platform is known to have been turned, but its gyros are as before,
    /// [`Self::start`] with the coefficients found so far loses less.
    ///
    /// # Errors
    /// As [`Self::update`], but no surprise; [`ControllerError::GapAtStart`], and nothing has changed.
    pub fn reopen(
        &mut self,
        specific_force_g: &[T; 3],
    ) -> Result<Innovation<T, 3>, ControllerError> {
        self.check_sample(specific_force_g)?;
        let doublings = self.doublings()?;
        // Sixty fourfold variances lead from any sensible sigma to more than a turn.
        for _ in 0..60 {
            if self.probe(specific_force_g)?.nis <= T::from_f64(USUAL_NIS) {
                break;
            }
            let result = self.filter.kernel_mut().widen(T::from_f64(4.0));
            self.stopped_by(result)?;
        }
        self.surprises.end();
        self.correct_in_parts(specific_force_g, doublings)
    }

    /// Number of samples since the start that were not taken because of their NIS.
    #[must_use]
    pub fn surprising_samples(&self) -> u32 {
        self.surprises.count
    }

    #[inline(never)]
    pub(super) fn take(
        &mut self,
        interval_s: T,
        specific_force_g: &[T; 3],
    ) -> Result<Innovation<T, 3>, ControllerError> {
        if self.at_start.is_none() {
            let largest_nis = self.limits.largest_nis;
            let innovation = self.correct(specific_force_g, T::ZERO, largest_nis)?;
            if innovation.nis <= largest_nis {
                self.surprises.end();
                return Ok(innovation);
            }
        }
        match self.surprise(interval_s, specific_force_g)? {
            Some(_) => Err(self.surprised()),
            None => {
                let doublings = self.doublings()?;
                self.correct_in_parts(specific_force_g, doublings)
            }
        }
    }

    /// One function for all calls, so that a firmware holds the update once; see
    /// [`PlatformFilter::update_at_origin`].
    #[inline(never)]
    fn correct(
        &mut self,
        specific_force_g: &[T; 3],
        noise: T,
        largest_nis: T,
    ) -> Result<Innovation<T, 3>, ControllerError> {
        let result = self
            .filter
            .update_at_origin(specific_force_g, noise, largest_nis);
        self.stopped_by(result)
    }

    /// The innovation of a sample, where the noise is enlarged by what a linear output leaves out.
    #[cold]
    fn probe(&mut self, specific_force_g: &[T; 3]) -> Result<Innovation<T, 3>, ControllerError> {
        let curved = self.filter.curved_g2();
        self.correct(specific_force_g, curved, T::from_f64(-1.0))
    }

    /// Takes a sample in parts where one linear output does not serve. The first part has the noise of the
    /// sample doubled so many times, and each of the others as much information as those before it together,
    /// linear where they have led to. For a linear output all of them together are one update. The
    /// innovation is that of the last.
    ///
    /// Progressive or recursive updates: R. Zanetti, *Recursive update filtering for nonlinear estimation*,
    /// IEEE Transactions on Automatic Control 57(6), 2012.
    #[cold]
    #[inline(never)]
    fn correct_in_parts(
        &mut self,
        specific_force_g: &[T; 3],
        doublings: u32,
    ) -> Result<Innovation<T, 3>, ControllerError> {
        let (own, any) = (self.filter.noise_g2(), T::from_f64(f64::INFINITY));
        let mut noise = own;
        for _ in 0..doublings {
            noise = noise + noise;
        }
        // 2^-n twice, then 2^-(n - 1) to 1/2: the sum is one.
        for part in 0..doublings {
            self.correct(specific_force_g, noise - own, any)?;
            if part > 0 {
                noise = noise * T::from_f64(0.5);
            }
        }
        self.correct(specific_force_g, noise - own, any)
    }

    /// Doublings of the noise of a sample, none but for the first one since the start, before which the
    /// prior may have been coasted.
    fn doublings(&mut self) -> Result<u32, ControllerError> {
        let Some(at_start) = self.at_start else {
            return Ok(0);
        };
        let grown = self.filter.attitude_variance() - at_start;
        if grown > T::from_f64(LARGEST_GROWTH) {
            return Err(ControllerError::GapAtStart);
        }
        self.at_start = None;
        Ok(self.filter.doublings(grown))
    }

    /// The innovation of a sample that is too surprising also where the noise is enlarged by what a linear
    /// output leaves out; it is counted.
    #[cold]
    #[inline(never)]
    pub(crate) fn surprise(
        &mut self,
        interval_s: T,
        specific_force_g: &[T; 3],
    ) -> Result<Option<Innovation<T, 3>>, ControllerError> {
        let innovation = self.probe(specific_force_g)?;
        if innovation.nis <= self.limits.largest_nis {
            self.surprises.end();
            return Ok(None);
        }
        self.surprises.add(interval_s);
        Ok(Some(innovation))
    }

    /// The answer to a sample that was too surprising.
    #[cold]
    pub(crate) fn surprised(&self) -> ControllerError {
        match self.surprises.have_diverged() {
            true => ControllerError::Diverged,
            false => ControllerError::SampleSurprising,
        }
    }

    /// As [`Self::take`], clipped; for the watch. The innovation, and whether it was taken.
    #[cfg(feature = "watch")]
    #[inline]
    pub(crate) fn take_clipped(
        &mut self,
        interval_s: T,
        specific_force_g: &[T; 3],
        clip: T,
    ) -> Result<(Innovation<T, 3>, bool), ControllerError> {
        let mut largest_nis = self.limits.largest_nis;
        loop {
            if self.at_start.is_none() {
                let filter = &mut self.filter;
                let result = filter.update_clipped(specific_force_g, clip, largest_nis);
                let innovation = self.stopped_by(result)?;
                if innovation.nis <= largest_nis {
                    self.surprises.end();
                    return Ok((innovation, true));
                }
            }
            if let Some(innovation) = self.surprise(interval_s, specific_force_g)? {
                return Ok((innovation, false));
            }
            let doublings = self.doublings()?;
            if doublings > 0 {
                let innovation = self.correct_in_parts(specific_force_g, doublings)?;
                return Ok((innovation, true));
            }
            largest_nis = T::from_f64(f64::INFINITY);
        }
    }
}
