//! How the records of a fit to a strapdown unit begin.

use super::FittedPlatform;
use crate::unit_start::UnitStart;

impl FittedPlatform<'_> {
    /// How a record of a strapdown unit begins, as its bench declares it; `None` of a stabilised platform, and
    /// where there is no such record.
    #[must_use]
    pub fn unit_start(&self, record: usize) -> Option<UnitStart> {
        let run = self.problem.runs.get(record)?;
        let axes = run.rows.gyro_axes.as_ref()?;
        Some(UnitStart::new(
            axes.first()?,
            &run.prior,
            &run.prior_covariance,
        ))
    }
}
