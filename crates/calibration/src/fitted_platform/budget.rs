//! Uncertainty budget of a fit with effects.

use gyrocal::generated::catalogue;
use gyrocal::generated::platform::DRIFT;

use super::FittedPlatform;
use crate::budget::{Estimate, UncertaintyBudget};
use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::fit::FitStatistics;
use crate::layout::SiteQuantity;
use crate::variances::UncertaintySource;

impl FittedPlatform<'_> {
    /// The uncertainty of each coefficient by its sources, with the effects and the noise of this fit. The
    /// noise has the degrees of freedom of its estimate.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`], and as [`Self::fit_rate_noise`].
    pub fn uncertainty_budget(&self) -> Result<UncertaintyBudget, CalibrationError> {
        let (unknowns, solution) = (&self.problem.unknowns, &self.solution);
        let source = |unknown| self.source_of(unknown);
        let variances = self
            .problem
            .variances(solution, &self.uncertainty, source)?;
        let degrees = self.degrees_of_freedom()?;
        let fit = FitStatistics::of_batch(solution, unknowns, &self.uncertainty);
        let estimates = core::array::from_fn(|index| Estimate {
            id: DRIFT[index].id,
            unit: DRIFT[index].unit,
            meaning: DRIFT[index].doc,
            value: self.problem.values[index],
            noise_degrees: degrees[index],
        });
        Ok(UncertaintyBudget::new(
            estimates,
            &variances,
            &fit,
            self.records(),
        ))
    }

    /// Source of the prior of an unknown.
    fn source_of(&self, unknown: usize) -> UncertaintySource {
        if unknown < PARAMETERS {
            return UncertaintySource::Prior(unknown);
        }
        if let Some(several) = &self.several
            && unknown >= self.shared
        {
            return UncertaintySource::TurnOn((unknown - self.shared) % several.offsets.len());
        }
        let parameter = self.extension.parameters.get(unknown - PARAMETERS);
        let element = parameter.and_then(|(place, _)| catalogue::PARAMETERS.get(*place));
        let mut quantities = SiteQuantity::ALL.into_iter();
        let quantity = quantities.find(|one| element.is_some_and(|element| element.id == one.id()));
        quantity.map_or(UncertaintySource::Effects, UncertaintySource::Site)
    }
}
