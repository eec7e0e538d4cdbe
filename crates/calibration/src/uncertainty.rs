//! Covariance of the estimates, with the uncertainty of considered parameters: equation (7) of the
//! [crate documentation](crate).
//!
//! A considered parameter keeps its value; its uncertainty enters the covariance of the others
//! through their sensitivity to it (Schmidt; Bierman, *Factorization Methods*, 1977, ch. VIII).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::problem::Unknown;
use crate::solve::Solution;

/// A considered unknown.
#[derive(Clone)]
pub(crate) struct Considered {
    /// Its index.
    pub(crate) unknown: usize,
    /// Derivatives of the estimates with respect to its assumed value.
    pub(crate) sensitivity: DVector<f64>,
    /// Its standard deviation if it were estimated from the records without a prior; infinite if it
    /// is unobservable.
    pub(crate) from_records_sigma: f64,
}

/// Covariances of the joint solution.
#[derive(Clone)]
pub(crate) struct Uncertainty {
    /// Indices of the unknowns that are estimated, in the order of the matrices.
    pub(crate) estimated: Vec<usize>,
    /// Covariance if the considered unknowns were known.
    pub(crate) conditional: DMatrix<f64>,
    /// Covariance that includes the uncertainty of the considered unknowns.
    pub(crate) total: DMatrix<f64>,
    /// The considered unknowns.
    pub(crate) considered: Vec<Considered>,
    cholesky: Cholesky<f64, Dyn>,
}

impl Uncertainty {
    /// `None` if information plus prior is not positive definite.
    pub(crate) fn new(unknowns: &[Unknown], solution: &Solution) -> Option<Self> {
        let (considered, estimated): (Vec<usize>, Vec<usize>) =
            (0..unknowns.len()).partition(|index| unknowns[*index].considered);
        let count = estimated.len();
        let mut information = DMatrix::from_fn(count, count, |i, j| {
            solution.information[(estimated[i], estimated[j])]
        });
        for (i, index) in estimated.iter().enumerate() {
            information[(i, i)] += unknowns[*index].sigma.powi(-2);
        }
        let cholesky = Cholesky::new(information)?;
        // Rounding of the inverse differs on the two sides of its diagonal.
        let mut conditional = cholesky.inverse();
        conditional.fill_upper_triangle_with_lower_triangle();
        let mut total = conditional.clone();
        let considered = considered
            .into_iter()
            .map(|unknown| {
                let own = solution.information[(unknown, unknown)];
                let cross =
                    DVector::from_fn(count, |i, _| solution.information[(estimated[i], unknown)]);
                let sensitivity = -cholesky.solve(&cross);
                let information = own + cross.dot(&sensitivity);
                // Of an unobservable quantity only the rounding error of this difference is left.
                let floor = own * f64::EPSILON * count as f64 * 100.0;
                let sigma = unknowns[unknown].sigma;
                total += sigma * sigma * &sensitivity * sensitivity.transpose();
                Considered {
                    unknown,
                    from_records_sigma: if information > floor {
                        information.powf(-0.5)
                    } else {
                        f64::INFINITY
                    },
                    sensitivity,
                }
            })
            .collect();
        total.fill_upper_triangle_with_lower_triangle();
        Some(Self {
            estimated,
            conditional,
            total,
            considered,
            cholesky,
        })
    }

    /// ln det of the conditional covariance.
    pub(crate) fn log_determinant(&self) -> f64 {
        -2.0 * self
            .cholesky
            .l()
            .diagonal()
            .iter()
            .map(|x| x.ln())
            .sum::<f64>()
    }
}
