//! The joint Gaussian of all outputs of a record if parameters are known: noise of every part and
//! first point as independent normals, put through the model by differences.

use gyrocal_scalar::Model;
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};

use crate::chain::{Chain, DENSITY, PRIOR, PRIOR_COVARIANCE, PRIOR_POINT, VARIANCE};
use crate::common::Pendulum;

pub(crate) struct Density<'a> {
    pub(crate) chain: &'a Chain,
}

impl Density<'_> {
    /// Of the first point, and one for each part's torque.
    fn unknowns(&self) -> usize {
        let rows = self.chain.times_s.len();
        2 + (0..rows - 1)
            .map(|row| self.chain.parts(row).0)
            .sum::<usize>()
    }

    fn points(&self, unknowns: &DVector<f64>) -> Vec<[f64; 2]> {
        let root = Matrix2::from(PRIOR_COVARIANCE).cholesky().unwrap().l();
        let offset = root * Vector2::new(unknowns[0], unknowns[1]);
        let mut moving = [PRIOR_POINT[0] + offset[0], PRIOR_POINT[1] + offset[1]];
        let mut points = vec![moving];
        let mut next = 2;
        for row in 0..self.chain.times_s.len() - 1 {
            let (parts, part_s) = self.chain.parts(row);
            let sigma = (DENSITY / part_s).sqrt();
            let torques: Vec<f64> = (next..next + parts).map(|i| sigma * unknowns[i]).collect();
            next += parts;
            moving = self.chain.over(row, moving, &PRIOR, &torques);
            points.push(moving);
        }
        points
    }

    /// Predicted minus measured outputs over their sigmas.
    fn outputs(&self, unknowns: &DVector<f64>) -> DVector<f64> {
        let points = self.points(unknowns);
        let present = self.chain.present();
        DVector::from_iterator(
            present.len(),
            present.iter().map(|(row, output)| {
                let predicted: [f64; 2] = Pendulum.output(&points[*row], &PRIOR, &());
                (predicted[*output] - self.chain.measured[*row][*output]) / VARIANCE[*output].sqrt()
            }),
        )
    }

    fn outputs_jacobian(&self, unknowns: &DVector<f64>) -> DMatrix<f64> {
        let columns: Vec<DVector<f64>> = (0..unknowns.len())
            .map(|column| {
                let at = |steps: f64| {
                    let mut moved = unknowns.clone();
                    moved[column] += steps * STEP;
                    self.outputs(&moved)
                };
                ((at(1.0) - at(-1.0)) * 8.0 - (at(2.0) - at(-2.0))) / (12.0 * STEP)
            })
            .collect();
        DMatrix::from_columns(&columns)
    }

    /// Residuals and covariance of all outputs if parameters have their prior means.
    pub(crate) fn outputs_given_parameters(&self) -> (DVector<f64>, DMatrix<f64>) {
        let unknowns = DVector::zeros(self.unknowns());
        let scale = self.scale();
        let residuals = scale.component_mul(&self.outputs(&unknowns));
        let [first, second, noise] = self.parts_of_the_covariance();
        (residuals, first + second + noise)
    }

    /// Derivatives of that covariance with respect to the logarithms of the variances: of the two
    /// outputs, and of the torque.
    pub(crate) fn shares_of_the_noise(&self) -> [DMatrix<f64>; 3] {
        let [_, second, noise] = self.parts_of_the_covariance();
        let of = |wanted: usize| {
            let present = self.chain.present();
            let diagonal = present.iter().map(|(_, output)| {
                if *output == wanted {
                    VARIANCE[wanted]
                } else {
                    0.0
                }
            });
            DMatrix::from_diagonal(&DVector::from_iterator(present.len(), diagonal))
        };
        assert_eq!(second, of(0) + of(1));
        [of(0), of(1), noise]
    }

    /// Of the first point, of the outputs' own noise, and of the torque.
    fn parts_of_the_covariance(&self) -> [DMatrix<f64>; 3] {
        let unknowns = DVector::zeros(self.unknowns());
        let scale = DMatrix::from_diagonal(&self.scale());
        let jacobian = &scale * self.outputs_jacobian(&unknowns);
        let square = |from: usize, count: usize| {
            let columns = jacobian.columns(from, count);
            columns * columns.transpose()
        };
        let variances = self.chain.present();
        let variances = variances.iter().map(|(_, output)| VARIANCE[*output]);
        [
            square(0, 2),
            DMatrix::from_diagonal(&DVector::from_iterator(scale.nrows(), variances)),
            square(2, unknowns.len() - 2),
        ]
    }

    /// Sigmas of the outputs, with the sign that makes residuals measured minus predicted.
    fn scale(&self) -> DVector<f64> {
        let present = self.chain.present();
        let sigmas = present.iter().map(|(_, output)| -VARIANCE[*output].sqrt());
        DVector::from_iterator(present.len(), sigmas)
    }
}

/// Of unknowns in units of their sigmas; the rule is exact to the fourth power.
const STEP: f64 = 0.02;
