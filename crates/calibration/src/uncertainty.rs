//! Covariance of what is estimated, with the uncertainty of what is only considered.
//!
//! A considered parameter keeps its value; its uncertainty enters the covariance of the others
//! through their sensitivity to it (Schmidt; Bierman, *Factorization Methods*, 1977, ch. VIII).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::problem::Unknown;
use crate::solve::Solution;

/// Covariances of the joint solution.
#[derive(Clone)]
pub(crate) struct Uncertainty {
    /// Indices of the unknowns that are estimated, in the order of the matrices.
    pub(crate) estimated: Vec<usize>,
    /// Covariance if everything considered were known.
    pub(crate) conditional: DMatrix<f64>,
    /// Covariance with what is considered.
    pub(crate) total: DMatrix<f64>,
    /// Derivatives of the estimates with respect to each considered unknown, by its index.
    pub(crate) sensitivities: Vec<(usize, DVector<f64>)>,
    /// What the records alone say of each considered unknown: its standard deviation if it were
    /// estimated with no prior of its own.
    pub(crate) from_records: Vec<(usize, f64)>,
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
        let mut sensitivities = Vec::with_capacity(considered.len());
        let mut from_records = Vec::with_capacity(considered.len());
        for index in considered {
            let cross = DVector::from_fn(count, |i, _| solution.information[(estimated[i], index)]);
            // A unit more of it than assumed is taken for this much of the others, and an
            // assumed value that is off by a unit shifts the estimates by as much.
            let taken = -cholesky.solve(&cross);
            let left = solution.information[(index, index)] + cross.dot(&taken);
            // What is left cancels to rounding where the record says nothing.
            let floor = solution.information[(index, index)] * f64::EPSILON * count as f64 * 100.0;
            from_records.push((
                index,
                if left > floor {
                    left.powf(-0.5)
                } else {
                    f64::INFINITY
                },
            ));
            let sigma = unknowns[index].sigma;
            total += sigma * sigma * &taken * taken.transpose();
            sensitivities.push((index, taken));
        }
        total.fill_upper_triangle_with_lower_triangle();
        Some(Self {
            estimated,
            conditional,
            total,
            sensitivities,
            from_records,
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
