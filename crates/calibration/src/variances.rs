//! Variances of the coefficients by the quantities that they come from.
//!
//! Linearised about the solution, the errors of the estimates are sums of independent parts: of the noise
//! of the sensors, of the distance of each true unknown from the mean of its prior, of the error of each
//! declared attitude, and of the error of each considered quantity. With equations (4) and (7) of the
//! [crate documentation](crate), P = (A + W)⁻¹, and A_x the cross information of the first attitude:
//!
//! ```text
//! P = P A P + P W P,      P A P = noise + (P A_x) P₀ (P A_x)ᵀ                        (8)
//! ```
//!
//! Each part is a sensitivity times the standard uncertainty of its quantity, squared, as the GUM asks.

use gyrocal::Chart;
use gyrocal::estimation::Manifold;
use gyrocal::generated::platform::DRIFT;
use gyrocal::trajectory::Orientation;
use gyrocal_hypothesis::Column;
use nalgebra::{Cholesky, DMatrix, DVector, Matrix3, RowVector3};

use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::layout::SiteQuantity;
use crate::problem::Problem;
use crate::run::Conditions;
use crate::solve::Solution;
use crate::uncertainty::{Considered, Uncertainty};

/// Source of uncertainty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum UncertaintySource {
    /// Noise of accelerometers and gyros.
    Noise,
    /// The declared attitude at the first row, of all records.
    Attitude,
    /// Prior of a coefficient, by its index: distance of the true one from its mean, which is zero.
    Prior(usize),
    /// Scatter of the constant drift of a gyro over turn-ons, by its axis.
    TurnOn(usize),
    /// Sizes of the effects in the model, before the record.
    Effects,
    /// A quantity of the site.
    Site(SiteQuantity),
    /// Choice of the model: scatter of the estimates over the models that the record leaves open.
    Model,
    /// Innovations larger than the declared noise makes them.
    Remainder,
}

impl UncertaintySource {
    /// The source in words; one name for all priors of coefficients, and for all gyros.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Noise => "noise of the sensors",
            Self::Attitude => "attitude at the first row",
            Self::Prior(_) => "prior of the coefficients",
            Self::TurnOn(_) => "scatter over turn-ons",
            Self::Effects => "prior of the effects",
            Self::Site(SiteQuantity::Gravity) => "gravity",
            Self::Site(SiteQuantity::Latitude) => "latitude",
            Self::Site(SiteQuantity::EarthRate) => "Earth rate",
            Self::Model => "choice of the model",
            Self::Remainder => "unexplained remainder",
        }
    }

    /// Whether it was evaluated by statistics of the record (type A of the GUM); else by declared values
    /// and judgement (type B).
    #[must_use]
    pub fn is_type_a(self) -> bool {
        self == Self::Noise
    }

    /// Distribution that the quantity counts as having.
    #[must_use]
    pub fn distribution(self) -> &'static str {
        match self {
            Self::Model => "discrete",
            _ => "normal",
        }
    }

    /// Unit of the quantity; `coefficient` is that of the coefficient, for sources that are known by
    /// their contribution to it only.
    #[must_use]
    pub fn unit(self, coefficient: &'static str) -> &'static str {
        match self {
            Self::Noise | Self::Model | Self::Remainder => coefficient,
            Self::Attitude | Self::Site(SiteQuantity::Latitude) => "deg",
            Self::Prior(index) => DRIFT.get(index).map_or(coefficient, |element| element.unit),
            Self::TurnOn(_) => "deg/h",
            Self::Effects => "prior sigma",
            Self::Site(_) => "relative",
        }
    }
}

/// A quantity that the estimates depend on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InputQuantity {
    pub(crate) source: UncertaintySource,
    /// Its standard uncertainty, in its unit.
    pub(crate) standard: f64,
    /// Derivative of each coefficient by it; of several quantities of one source, the root of the sum of
    /// squares.
    pub(crate) sensitivity: [f64; PARAMETERS],
}

/// Parts of the variances of the coefficients.
#[derive(Clone, Debug)]
pub(crate) struct Variances {
    /// By the noise of the sensors.
    pub(crate) noise: [f64; PARAMETERS],
    /// By other quantities.
    pub(crate) inputs: Vec<InputQuantity>,
    /// What the sum of squared innovations would lose if the considered quantities were estimated within
    /// their declared uncertainties: their errors make innovations larger, and are in the budget already.
    pub(crate) squares_by_considered: f64,
}

impl Variances {
    /// Adds a quantity; those of one source become one.
    fn add(&mut self, new: InputQuantity) {
        let mut inputs = self.inputs.iter_mut();
        let Some(same) = inputs.find(|one| one.source == new.source) else {
            self.inputs.push(new);
            return;
        };
        let standard = same.standard.max(new.standard);
        for (sum, own) in same.sensitivity.iter_mut().zip(new.sensitivity) {
            let together = (*sum * same.standard).hypot(own * new.standard);
            *sum = if standard > 0.0 {
                together / standard
            } else {
                sum.hypot(own)
            };
        }
        same.standard = standard;
    }
}

impl<D, I> Problem<'_, D, I>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    /// Parts (8) of the variances at the solution; `source_of` is the source that the prior of an unknown
    /// belongs to.
    pub(crate) fn variances(
        &self,
        solution: &Solution,
        uncertainty: &Uncertainty,
        source_of: impl Fn(usize) -> UncertaintySource,
    ) -> Result<Variances, CalibrationError> {
        // The coefficients are the first unknowns, and estimated.
        let covariance = &uncertainty.conditional;
        let mut parts = Variances {
            noise: core::array::from_fn(|i| covariance[(i, i)]),
            inputs: Vec::new(),
            squares_by_considered: self.squares_by_considered(solution, uncertainty)?,
        };
        for run in 0..self.runs.len() {
            let sensitivity = covariance * self.attitude_cross(run, uncertainty)?;
            let of_prior = Matrix3::from(self.runs[run].prior_covariance);
            let standard_rad = (of_prior.trace() / 3.0).sqrt();
            let variance: [f64; PARAMETERS] = core::array::from_fn(|i| {
                let row = RowVector3::from_fn(|_, axis| sensitivity[(i, axis)]);
                (row * of_prior * row.transpose())[0].max(0.0)
            });
            let standard = standard_rad.to_degrees();
            parts.add(InputQuantity {
                source: UncertaintySource::Attitude,
                standard,
                sensitivity: variance.map(|one| match standard > 0.0 {
                    true => one.sqrt() / standard,
                    false => 0.0,
                }),
            });
            for (noise, own) in parts.noise.iter_mut().zip(variance) {
                *noise -= own;
            }
        }
        for (place, unknown) in uncertainty.estimated.iter().enumerate() {
            let sigma = self.unknowns[*unknown].sigma;
            if !sigma.is_finite() {
                continue;
            }
            let source = source_of(*unknown);
            // Effects differ in their units.
            let (standard, scale) = match source {
                UncertaintySource::Effects => (1.0, sigma),
                _ => (sigma, sigma * sigma),
            };
            let sensitivity = core::array::from_fn(|i| covariance[(i, place)] / scale);
            parts.add(InputQuantity {
                source,
                standard,
                sensitivity,
            });
            for (noise, own) in parts.noise.iter_mut().zip(sensitivity) {
                *noise -= (own * standard).powi(2);
            }
        }
        for considered in &uncertainty.considered {
            parts.add(InputQuantity {
                source: source_of(considered.unknown),
                standard: self.unknowns[considered.unknown].sigma,
                // By the true value, not by the assumed one.
                sensitivity: core::array::from_fn(|i| -considered.sensitivity[i]),
            });
        }
        // Of a coefficient that the record says nothing of, rounding errors are left.
        parts.noise = parts.noise.map(|noise| noise.max(0.0));
        Ok(parts)
    }

    /// gᵀ (A_cc + W_c − A_cp P A_pc)⁻¹ g, with the gradient g by the considered quantities c at the best
    /// estimates p, and the weights W_c of their declared uncertainties.
    fn squares_by_considered(
        &self,
        solution: &Solution,
        uncertainty: &Uncertainty,
    ) -> Result<f64, CalibrationError> {
        let declared: Vec<&Considered> = uncertainty
            .considered
            .iter()
            .filter(|one| self.unknowns[one.unknown].sigma > 0.0)
            .collect();
        let count = declared.len();
        if count == 0 {
            return Ok(0.0);
        }
        let all = &solution.information;
        let information = DMatrix::from_fn(count, count, |i, j| {
            let (own, other) = (declared[i].unknown, declared[j].unknown);
            let estimated = uncertainty.estimated.iter().enumerate();
            // The sensitivity is -P A_pc.
            let through: f64 = estimated
                .map(|(place, unknown)| all[(own, *unknown)] * declared[j].sensitivity[place])
                .sum();
            let weight = match i == j {
                true => self.unknowns[own].sigma.powi(-2),
                false => 0.0,
            };
            all[(own, other)] + through + weight
        });
        let gradient = DVector::from_fn(count, |i, _| solution.gradient[declared[i].unknown]);
        // Rounding differs on the two sides of the diagonal; the factorisation reads one.
        let cholesky = Cholesky::new(information).ok_or(CalibrationError::NotPositiveDefinite)?;
        Ok(cholesky.solve(&gradient).dot(&gradient))
    }

    /// Cross information A_x of the estimated unknowns with the attitude at the first row of a run.
    fn attitude_cross(
        &self,
        run: usize,
        uncertainty: &Uncertainty,
    ) -> Result<DMatrix<f64>, CalibrationError> {
        let columns = self.runs[run].column_unknowns();
        let mut further = self.runs[run].further.clone();
        let turns = (0..3).map(|state| Column::InitialState { row: 0, state });
        further.extend(turns, f64::INFINITY);
        let parameters = self.parameters(run);
        let reduced = self
            .with_active(run, &parameters, &self.active(run), &further, |pass| {
                pass.reduce(|_| ())
            })
            .map_err(|error| CalibrationError::pass(run, error))?;
        let mut cross = DMatrix::zeros(uncertainty.estimated.len(), 3);
        for (place, unknown) in uncertainty.estimated.iter().enumerate() {
            for (column, unknowns) in columns.iter().enumerate() {
                if unknowns.contains(unknown) {
                    for axis in 0..3 {
                        // Column 0 is the residual.
                        cross[(place, axis)] +=
                            reduced.gram[(1 + column, 1 + columns.len() + axis)];
                    }
                }
            }
        }
        Ok(cross)
    }
}
