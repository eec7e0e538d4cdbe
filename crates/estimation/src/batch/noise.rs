//! Likelihood of the noise: its gradient and information, carried along with the filter.

use alloc::vec;
use alloc::vec::Vec;

use super::linearisation::Whitened;
use super::pass::Taken;
use super::step::{Step, add, map_columns, sandwich};

/// Gradient and information of the log-likelihood with respect to the natural logarithms of the
/// noise variances: those of the outputs, then those of the noise inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseScore {
    /// The log-likelihood.
    pub log_likelihood: f64,
    /// Its gradient.
    pub gradient: Vec<f64>,
    /// Expected information, by rows.
    pub information: Vec<f64>,
}

/// Derivatives of mean and covariance of a filter with respect to logarithms of variances
/// (Gupta, Mehra, IEEE Trans. Automatic Control 19(6), 1974).
pub(crate) struct NoiseFilter<const M: usize> {
    outputs: usize,
    mean: Vec<[f64; M]>,
    covariance: Vec<[[f64; M]; M]>,
    d_innovation: Vec<f64>,
    d_variance: Vec<f64>,
    pub(crate) score: NoiseScore,
}

impl<const M: usize> NoiseFilter<M> {
    pub(crate) fn new(outputs: usize) -> Self {
        let count = outputs + M;
        Self {
            outputs,
            mean: vec![[0.0; M]; count],
            covariance: vec![[[0.0; M]; M]; count],
            d_innovation: vec![0.0; count],
            d_variance: vec![0.0; count],
            score: NoiseScore {
                log_likelihood: 0.0,
                gradient: vec![0.0; count],
                information: vec![0.0; count * count],
            },
        }
    }

    pub(crate) fn predict(&mut self, step: &Step<M>) {
        for (k, (mean, covariance)) in self.mean.iter_mut().zip(&mut self.covariance).enumerate() {
            map_columns(&step.moving, mean, 1);
            *covariance = sandwich(&step.moving, covariance);
            if let Some(input) = k.checked_sub(self.outputs) {
                add(covariance, &step.shares[input]);
            }
        }
    }

    /// Takes an output after the filter has.
    pub(crate) fn take(&mut self, whitened: &Whitened<'_>, taken: &Taken<M>) {
        let h = &taken.jacobian;
        let total = whitened.deviation * whitened.deviation;
        let innovation = whitened.columns[0] * whitened.deviation;
        let mut gain = [0.0; M];
        for i in 0..M {
            for j in 0..M {
                gain[i] += taken.covariance[i][j] * h[j] / total;
            }
        }
        self.score.log_likelihood -=
            0.5 * (whitened.columns[0].powi(2) + ln(total * core::f64::consts::TAU));
        let count = self.mean.len();
        for k in 0..count {
            let (mean, covariance) = (&mut self.mean[k], &mut self.covariance[k]);
            let mut cross = [0.0; M];
            let mut d_innovation = 0.0;
            let mut d_total = if k == whitened.output {
                taken.variance
            } else {
                0.0
            };
            for i in 0..M {
                for j in 0..M {
                    cross[i] += covariance[i][j] * h[j];
                }
                d_innovation -= h[i] * mean[i];
            }
            for i in 0..M {
                d_total += h[i] * cross[i];
            }
            let mut d_gain = [0.0; M];
            for i in 0..M {
                d_gain[i] = (cross[i] - gain[i] * d_total) / total;
                mean[i] += d_gain[i] * innovation + gain[i] * d_innovation;
            }
            for i in 0..M {
                for j in 0..M {
                    covariance[i][j] -= d_gain[i] * total * gain[j]
                        + gain[i] * d_total * gain[j]
                        + gain[i] * total * d_gain[j];
                }
            }
            self.d_innovation[k] = d_innovation;
            self.d_variance[k] = d_total / total;
            self.score.gradient[k] +=
                0.5 * (innovation * innovation / total - 1.0) * self.d_variance[k]
                    - innovation * d_innovation / total;
        }
        for k in 0..count {
            for l in 0..=k {
                let information = 0.5 * self.d_variance[k] * self.d_variance[l]
                    + self.d_innovation[k] * self.d_innovation[l] / total;
                self.score.information[k * count + l] += information;
                if l < k {
                    self.score.information[l * count + k] += information;
                }
            }
        }
    }
}

fn ln(value: f64) -> f64 {
    gyrocal_scalar::Scalar::ln(value)
}
