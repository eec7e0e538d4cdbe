//! The filter, each call once: library and program share its code, as a firmware would.

use gyrocal::{
    ControllerError, ControllerFilter, FilterSettings, InitialAttitude, Innovation, Limits,
};

use crate::record::Number;

/// The filter that is tested.
#[derive(Clone, Debug)]
pub struct Filter(ControllerFilter<Number>);

impl Filter {
    /// Bytes of a saved state.
    pub const SAVED_BYTES: usize = ControllerFilter::<Number>::SAVED_BYTES;

    /// As [`ControllerFilter::unset`].
    #[must_use]
    pub const fn unset() -> Self {
        Self(ControllerFilter::unset())
    }

    /// As [`ControllerFilter::start`], with the default limits.
    ///
    /// # Errors
    /// The same.
    #[inline(never)]
    pub fn start(
        &mut self,
        settings: &FilterSettings<Number>,
        attitude: &InitialAttitude<Number>,
    ) -> Result<(), ControllerError> {
        self.0.start(settings, attitude, Limits::default())
    }

    /// As [`ControllerFilter::update`].
    ///
    /// # Errors
    /// The same.
    #[inline(never)]
    pub fn update(
        &mut self,
        sample: &[Number; 3],
    ) -> Result<Innovation<Number, 3>, ControllerError> {
        self.0.update(sample)
    }

    /// As [`ControllerFilter::step`].
    ///
    /// # Errors
    /// The same.
    #[inline(never)]
    pub fn step(
        &mut self,
        interval_s: Number,
        sample: &[Number; 3],
    ) -> Result<Innovation<Number, 3>, ControllerError> {
        self.0.step(interval_s, sample)
    }

    /// As [`ControllerFilter::coast`].
    ///
    /// # Errors
    /// The same.
    #[inline(never)]
    pub fn coast(&mut self, interval_s: Number) -> Result<(), ControllerError> {
        self.0.coast(interval_s)
    }

    /// As [`ControllerFilter::save`].
    ///
    /// # Errors
    /// The same.
    #[inline(never)]
    pub fn save(&self, place: &mut [u8; Self::SAVED_BYTES]) -> Result<(), ControllerError> {
        self.0.save(place)
    }

    /// As [`ControllerFilter::restore`].
    ///
    /// # Errors
    /// The same.
    #[inline(never)]
    pub fn restore(&mut self, saved: &[u8]) -> Result<(), ControllerError> {
        self.0.restore(saved)
    }

    /// Coefficients, then their sigmas.
    #[inline(never)]
    #[must_use]
    pub fn estimates(&self) -> [[Number; 9]; 2] {
        let filter = self.0.filter();
        [filter.drift().to_array(), filter.drift_sigma().to_array()]
    }

    /// The numbers that the next steps depend on.
    #[inline(never)]
    pub fn numbers(&self, put: &mut dyn FnMut(Number)) {
        self.0.filter().kernel().save(|number| put_one(put, number));
    }

    /// True between a start and a failure.
    #[must_use]
    pub fn is_running(&self) -> bool {
        self.0.is_running()
    }
}

/// Out of line: the calls are many.
#[inline(never)]
fn put_one(put: &mut dyn FnMut(Number), number: Number) {
    put(number);
}
