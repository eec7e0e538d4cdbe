//! The catalogue's law, in the axes of the platform or in those of instruments fixed to a body.

use gyrocal::generated::catalogue::{CatalogueInputs, conditions_index};
use gyrocal::generated::strapdown_catalogue::StrapdownCatalogueInputs;
use gyrocal::scalar::{Model, NamedInputs, RatesJacobian};
use gyrocal::{Anchored, Catalogue, Regressors, StrapdownCatalogue};

use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::gyro_axes::GyroAxes;
use crate::run::{Conditions, Run};

/// The platform with every effect of the catalogue. Parameters and shapes of both are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Law {
    /// Gyros and accelerometers lie along the axes of the platform that they hold.
    Platform,
    /// They are fixed to a body, and the platform is computed from their outputs.
    Strapdown,
}

/// Inputs of [`Law`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct LawInputs {
    pub(crate) catalogue: CatalogueInputs<f64>,
    /// Platform components from components along the axes of the instruments, by rows.
    pub(crate) platform_c_gyros: [f64; 9],
}

impl Law {
    /// The law of a record with these axes of the instruments.
    pub(crate) fn of(run: &Run<'_>, axes: Option<&GyroAxes>) -> Result<Self, CalibrationError> {
        let Some(axes) = axes else {
            return Ok(Self::Platform);
        };
        let (rows, attitudes) = (run.record.len(), axes.len());
        if rows != attitudes {
            return Err(CalibrationError::GyroAxes { rows, attitudes });
        }
        Ok(Self::Strapdown)
    }

    /// The model, with the chart moved along.
    pub(crate) fn anchored(self) -> &'static Anchored<Self> {
        match self {
            Self::Platform => &Anchored(Self::Platform),
            Self::Strapdown => &Anchored(Self::Strapdown),
        }
    }

    /// Coefficients that a fit starts from, where a filter of the platform has estimated these.
    pub(crate) fn starts_from(self, filtered: &[f64; PARAMETERS]) -> [f64; PARAMETERS] {
        match self {
            Self::Platform => *filtered,
            // They are those of other axes.
            Self::Strapdown => [0.0; PARAMETERS],
        }
    }
}

impl LawInputs {
    fn strapdown(&self) -> StrapdownCatalogueInputs<f64> {
        let CatalogueInputs {
            omega_0,
            f_0,
            east_0,
            field_0,
            conditions,
            shapes,
        } = self.catalogue;
        StrapdownCatalogueInputs {
            omega_0,
            f_0,
            east_0,
            field_0,
            platform_c_gyros: self.platform_c_gyros,
            conditions,
            shapes,
        }
    }
}

impl NamedInputs<f64> for LawInputs {
    #[inline(always)]
    fn filled(value: f64) -> Self {
        Self {
            catalogue: CatalogueInputs::filled(value),
            platform_c_gyros: [value; 9],
        }
    }

    #[inline(always)]
    fn group_mut(&mut self, name: &str) -> Option<&mut [f64]> {
        match name {
            "platform_c_gyros" => Some(&mut self.platform_c_gyros),
            _ => self.catalogue.group_mut(name),
        }
    }
}

impl Conditions for LawInputs {
    fn set_conditions(&mut self, time_s: f64, interval_s: f64, regressors: &Regressors<f64>) {
        let conditions = &mut self.catalogue.conditions;
        conditions[conditions_index::TIME_S] = time_s;
        conditions[conditions_index::INTERVAL_S] = interval_s;
        conditions[conditions_index::TEMPERATURE_K] = regressors.temperature_k;
        conditions[conditions_index::TEMPERATURE_RATE_K_PER_H] =
            regressors.temperature_rate_k_per_h;
        conditions[conditions_index::TEMPERATURE_HYSTERESIS_K] =
            regressors.temperature_hysteresis_k;
    }

    fn set_gyro_axes(&mut self, platform_c_gyros: &[f64; 9]) {
        self.platform_c_gyros = *platform_c_gyros;
    }
}

impl Model<f64, 3, 3> for Law {
    type Inputs = LawInputs;

    #[inline(always)]
    fn parameters(&self) -> usize {
        Catalogue::PARAMETERS
    }

    #[inline(always)]
    fn output_parameters(&self) -> usize {
        Model::<f64, 3, 3>::output_parameters(&Catalogue)
    }

    #[inline(always)]
    fn noise_parameters(&self) -> Option<[usize; 3]> {
        Model::<f64, 3, 3>::noise_parameters(&Catalogue)
    }

    #[inline]
    fn rates(&self, moving: &[f64; 3], parameters: &[f64], inputs: &LawInputs) -> [f64; 3] {
        match self {
            Self::Platform => Catalogue.rates(moving, parameters, &inputs.catalogue),
            Self::Strapdown => StrapdownCatalogue.rates(moving, parameters, &inputs.strapdown()),
        }
    }

    #[inline]
    fn rates_jacobian(
        &self,
        moving: &[f64; 3],
        parameters: &[f64],
        inputs: &LawInputs,
        jacobian: &mut RatesJacobian<'_, f64, 3>,
    ) -> [f64; 3] {
        match self {
            Self::Platform => {
                Catalogue.rates_jacobian(moving, parameters, &inputs.catalogue, jacobian)
            }
            Self::Strapdown => {
                StrapdownCatalogue.rates_jacobian(moving, parameters, &inputs.strapdown(), jacobian)
            }
        }
    }

    #[inline]
    fn rates_jacobian_at_origin(
        &self,
        parameters: &[f64],
        inputs: &LawInputs,
        jacobian: &mut RatesJacobian<'_, f64, 3>,
    ) -> [f64; 3] {
        match self {
            Self::Platform => {
                Catalogue.rates_jacobian_at_origin(parameters, &inputs.catalogue, jacobian)
            }
            Self::Strapdown => StrapdownCatalogue.rates_jacobian_at_origin(
                parameters,
                &inputs.strapdown(),
                jacobian,
            ),
        }
    }

    #[inline]
    fn output(&self, moving: &[f64; 3], parameters: &[f64], inputs: &LawInputs) -> [f64; 3] {
        match self {
            Self::Platform => Catalogue.output(moving, parameters, &inputs.catalogue),
            Self::Strapdown => StrapdownCatalogue.output(moving, parameters, &inputs.strapdown()),
        }
    }

    #[inline]
    fn output_jacobian(
        &self,
        moving: &[f64; 3],
        parameters: &[f64],
        inputs: &LawInputs,
        d_moving: &mut [[f64; 3]; 3],
        d_parameters: &mut [f64],
    ) -> [f64; 3] {
        match self {
            Self::Platform => Catalogue.output_jacobian(
                moving,
                parameters,
                &inputs.catalogue,
                d_moving,
                d_parameters,
            ),
            Self::Strapdown => StrapdownCatalogue.output_jacobian(
                moving,
                parameters,
                &inputs.strapdown(),
                d_moving,
                d_parameters,
            ),
        }
    }

    #[inline]
    fn output_jacobian_at_origin(
        &self,
        parameters: &[f64],
        inputs: &LawInputs,
        d_moving: &mut [[f64; 3]; 3],
        d_parameters: &mut [f64],
    ) -> [f64; 3] {
        match self {
            Self::Platform => Catalogue.output_jacobian_at_origin(
                parameters,
                &inputs.catalogue,
                d_moving,
                d_parameters,
            ),
            Self::Strapdown => StrapdownCatalogue.output_jacobian_at_origin(
                parameters,
                &inputs.strapdown(),
                d_moving,
                d_parameters,
            ),
        }
    }
}
