//! The innovations of a filter over a record.

use crate::error::DiagnosisError;

/// One-step innovations, one row for each row of the record they come from.
///
/// If the model and the declared noise are right, the components of [`normalised`] are
/// independent in time and across axes, with mean zero and variance one.
///
/// [`normalised`]: Self::normalised
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Innovations {
    /// Time of each row.
    pub time_s: Vec<f64>,
    /// Measured minus predicted specific force \[g\]; `NaN` where a component is missing.
    pub residual_g: Vec<[f64; 3]>,
    /// L⁻¹ times the residual, with L Lᵀ its predicted covariance; `NaN` where missing.
    pub normalised: Vec<[f64; 3]>,
    /// Inverse of the predicted covariance times the residual \[1/g\]; zero where missing.
    pub weighted_per_g: Vec<[f64; 3]>,
    /// Specific force in platform axes as the filter knew it at the row \[g\], never `NaN`.
    pub specific_force_g: Vec<[f64; 3]>,
}

impl Innovations {
    /// Appends a row. Missing components of the residual are `NaN`; rows and columns of the
    /// covariance that belong to them are not looked at.
    ///
    /// # Errors
    ///
    /// [`DiagnosisError::NotPositiveDefinite`] for a covariance that is none.
    pub fn push(
        &mut self,
        time_s: f64,
        residual_g: [f64; 3],
        covariance_g2: &[[f64; 3]; 3],
        specific_force_g: [f64; 3],
    ) -> Result<(), DiagnosisError> {
        let [normalised, weighted_per_g] =
            whiten(&residual_g, covariance_g2).ok_or(DiagnosisError::NotPositiveDefinite {
                row: self.time_s.len() + 1,
            })?;
        self.time_s.push(time_s);
        self.residual_g.push(residual_g);
        self.normalised.push(normalised);
        self.weighted_per_g.push(weighted_per_g);
        self.specific_force_g.push(specific_force_g);
        Ok(())
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Whether there are no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// Checks that the series have one row for each of `rows`.
    ///
    /// # Errors
    ///
    /// [`DiagnosisError::UnequalLengths`].
    pub fn check(&self, rows: usize) -> Result<(), DiagnosisError> {
        let lengths = [
            ("innovation times", self.time_s.len()),
            ("residuals", self.residual_g.len()),
            ("normalised innovations", self.normalised.len()),
            ("weighted innovations", self.weighted_per_g.len()),
            ("specific force", self.specific_force_g.len()),
        ];
        match lengths.into_iter().find(|(_, found)| *found != rows) {
            None => Ok(()),
            Some((what, found)) => Err(DiagnosisError::UnequalLengths {
                what,
                found,
                expected: rows,
            }),
        }
    }
}

/// L⁻¹ r and (L Lᵀ)⁻¹ r over the components that are there.
fn whiten(residual: &[f64; 3], covariance: &[[f64; 3]; 3]) -> Option<[[f64; 3]; 2]> {
    let there = residual.map(|component| !component.is_nan());
    let mut lower = [[0.0; 3]; 3];
    let mut white = [0.0; 3];
    for i in (0..3).filter(|i| there[*i]) {
        let mut own = residual[i];
        for j in (0..i).filter(|j| there[*j]) {
            let shared: f64 = (0..j).map(|l| lower[i][l] * lower[j][l]).sum();
            lower[i][j] = (covariance[i][j] - shared) / lower[j][j];
            own -= lower[i][j] * white[j];
        }
        let variance = covariance[i][i] - (0..i).map(|j| lower[i][j] * lower[i][j]).sum::<f64>();
        if !(variance > 0.0 && variance.is_finite()) {
            return None;
        }
        lower[i][i] = variance.sqrt();
        white[i] = own / lower[i][i];
    }
    let mut weighted = [0.0; 3];
    for i in (0..3).rev().filter(|i| there[*i]) {
        let later: f64 = (i + 1..3).map(|j| lower[j][i] * weighted[j]).sum();
        weighted[i] = (white[i] - later) / lower[i][i];
    }
    let normalised = core::array::from_fn(|i| if there[i] { white[i] } else { f64::NAN });
    Some([normalised, weighted])
}

#[cfg(test)]
mod tests {
    use super::*;

    const COVARIANCE: [[f64; 3]; 3] = [[4.0, 1.0, -0.5], [1.0, 3.0, 0.7], [-0.5, 0.7, 2.0]];

    #[test]
    fn weighted_times_covariance_is_the_residual() {
        for missing in [None, Some(0), Some(1), Some(2)] {
            let mut residual = [0.3, -1.2, 2.5];
            if let Some(axis) = missing {
                residual[axis] = f64::NAN;
            }
            let [white, weighted] = whiten(&residual, &COVARIANCE).unwrap_or([[0.0; 3]; 2]);
            let mut nis = 0.0;
            for i in (0..3).filter(|i| Some(*i) != missing) {
                let back: f64 = (0..3).map(|j| COVARIANCE[i][j] * weighted[j]).sum();
                // Numbers of order one: a few roundings.
                assert!((back - residual[i]).abs() < 1e-14, "{back} {}", residual[i]);
                nis += residual[i] * weighted[i];
            }
            let sum: f64 = white.iter().filter(|w| !w.is_nan()).map(|w| w * w).sum();
            assert!((nis - sum).abs() < 1e-13, "{nis} {sum}");
            assert_eq!(
                white.iter().filter(|w| w.is_nan()).count(),
                usize::from(missing.is_some())
            );
        }
    }

    #[test]
    fn a_matrix_that_is_no_covariance_is_an_error() {
        let mut innovations = Innovations::default();
        let mut covariance = COVARIANCE;
        covariance[1][1] = 0.1;
        let error = innovations.push(0.0, [0.0; 3], &covariance, [0.0, 0.0, 1.0]);
        assert!(matches!(
            error,
            Err(DiagnosisError::NotPositiveDefinite { row: 1 })
        ));
        assert!(innovations.is_empty());
    }
}
