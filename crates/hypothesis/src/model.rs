//! A fitted model, as far as score tests need it.

use gyrocal_scalar::effect::Role;
use nalgebra::{DMatrix, DVector};

use crate::plant::Plant;
use crate::rate_noise::{RateNoise, RateNoiseFit};
use crate::rows::Covariate;
use gyrocal_inference::{Column, ExtraColumns, Singular, Stopped};

/// Value of an onset or a time constant that nothing sets.
const UNSET_SHAPE: f64 = 1.0;

/// The part of a model beyond its nominal parameters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelExtension {
    /// Indices of parameters that are estimated beside the nominal ones, each with its standard
    /// deviation before the record; infinite without a prior.
    pub parameters: Vec<(usize, f64)>,
    /// Onsets and time constants, in the order of the plant's; what is missing is one.
    pub shapes: Vec<f64>,
    /// Further columns that are estimated.
    pub columns: ExtraColumns,
}

impl ModelExtension {
    /// An onset or a time constant.
    #[must_use]
    pub fn shape(&self, index: usize) -> f64 {
        self.shapes.get(index).copied().unwrap_or(UNSET_SHAPE)
    }

    /// Sets an onset or a time constant.
    pub fn set_shape(&mut self, index: usize, value: f64) {
        if self.shapes.len() <= index {
            self.shapes.resize(index + 1, UNSET_SHAPE);
        }
        self.shapes[index] = value;
    }

    /// All shapes of a plant.
    #[must_use]
    pub fn all_shapes(&self, plant: &Plant) -> Vec<f64> {
        (0..plant.shapes.len())
            .map(|index| self.shape(index))
            .collect()
    }

    /// Sets the shape of a parameter of an effect, if the model has it.
    pub fn set_role(&mut self, role: Role, value: f64) {
        if let Some(index) = role.shape_index() {
            self.set_shape(index, value);
        }
    }
}

/// Score and information of a sudden change of the moving states in one step, the unknowns of the
/// fit free.
#[derive(Clone, Debug, PartialEq)]
pub struct StateJump {
    /// Score of the change of each state.
    pub score: DVector<f64>,
    /// Information on it.
    pub information: DMatrix<f64>,
    /// Score of a change of each output of the row that ends the step; zero where it is missing.
    pub outputs: DVector<f64>,
}

/// A model at its best fit to a record.
///
/// Gram matrices are those of whitened innovations and their derivatives, the moving states at all
/// rows eliminated: column 0 is the innovations.
pub trait FittedModel: Clone {
    /// Reason why a fit or a pass fails.
    type Error: From<Singular> + From<Stopped>;

    /// The plant.
    fn plant(&self) -> &'static Plant;

    /// The part beyond the nominal parameters.
    fn extension(&self) -> &ModelExtension;

    /// Covariates at each row, along the fitted trajectory.
    fn covariates(&self) -> Vec<Covariate>;

    /// Estimates: nominal parameters, parameters of the extension, its further columns.
    fn values(&self) -> &[f64];

    /// Covariance of their errors.
    fn covariance(&self) -> &DMatrix<f64>;

    /// Degrees of freedom of the variance of each estimate, in the order of [`Self::values`]: the noise
    /// that it rests on was estimated from the record. Infinite where the noise is known or known well; an
    /// estimate beyond the end of the list counts as such, and so do all of a model that does not tell them.
    ///
    /// # Errors
    /// Those of a pass over the record.
    fn degrees_of_freedom(&self) -> Result<Vec<f64>, Self::Error> {
        Ok(Vec::new())
    }

    /// Standard deviations before the record, in the order of [`Self::values`].
    fn prior_sigma(&self) -> Vec<f64>;

    /// Minimum of the cost: minus twice the log-likelihood but for a constant.
    fn cost(&self) -> f64;

    /// Fits another extension, starting from this fit.
    ///
    /// # Errors
    /// Those of the fit.
    fn refitted(&self, extension: &ModelExtension) -> Result<Self, Self::Error>;

    /// Noise that the fit believes the rates to have.
    fn rate_noise(&self) -> RateNoise;

    /// Noise of the rates at the largest restricted likelihood, linearised about this fit, with random
    /// walks of the rates `walking`; `absent` are places among [`Self::values`] of what the model shall
    /// not have.
    ///
    /// # Errors
    /// Those of a pass over the record.
    fn fit_rate_noise(
        &self,
        walking: &[usize],
        absent: &[usize],
    ) -> Result<RateNoiseFit, Self::Error>;

    /// Noise of the rates at the largest likelihood of which all unknowns of the fit are integrated out, effects
    /// too. Each unknown that is not takes a degree of freedom off the noise, of some twenty. Models with other
    /// effects cannot be compared by that likelihood: it serves intervals. `None` of a model that does not
    /// estimate its noise so.
    ///
    /// # Errors
    /// Those of a pass over the record.
    fn restricted_noise(&self) -> Result<Option<RateNoise>, Self::Error> {
        Ok(None)
    }

    /// 95 % interval of each random walk of the rates that the fit has, by its profile likelihood.
    ///
    /// # Errors
    /// Those of a pass over the record.
    fn walk_intervals(&self) -> Result<Vec<Option<[f64; 2]>>, Self::Error>;

    /// Fits the same extension with other noise of the rates.
    ///
    /// # Errors
    /// Those of the fit.
    fn with_rate_noise(&self, noise: &RateNoise) -> Result<Self, Self::Error>;

    /// Gram matrix with all parameters of the plant as columns, then the extension's further
    /// columns, then `further`.
    ///
    /// # Errors
    /// Those of a pass over the record.
    fn signatures_gram(&self, further: &[Column]) -> Result<DMatrix<f64>, Self::Error>;

    /// Gram matrix with the values of the fit as columns, in the order of [`Self::values`], then
    /// `further`.
    ///
    /// # Errors
    /// Those of a pass over the record.
    fn conditional_gram(&self, further: &[Column]) -> Result<DMatrix<f64>, Self::Error>;

    /// Whether nominal parameters move so far to take an effect up that rivals are compared by fits and not
    /// by scores about one fit.
    fn sets_need_fits(&self) -> bool {
        false
    }

    /// How many times larger than of white noise differences of twice the log-likelihood vary, since what is left is
    /// correlated from row to row; one where it is as the fit believes it to be. Sets are as much wider.
    ///
    /// # Errors
    /// Those of a pass over the record.
    fn inflation(&self) -> Result<f64, Self::Error> {
        Ok(1.0)
    }

    /// Work of all passes that were made so far, in a unit that grows with rows and columns; zero of a
    /// model that does not count it, whose searches have no budget.
    fn work(&self) -> u64 {
        0
    }

    /// Sudden changes of the moving states in each step, by the row that ends it; `None` for the
    /// first row.
    ///
    /// # Errors
    /// Those of a pass over the record.
    fn state_jumps(&self) -> Result<Vec<Option<StateJump>>, Self::Error>;
}
