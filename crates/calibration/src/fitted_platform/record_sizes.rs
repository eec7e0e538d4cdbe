//! Sizes of an effect in each of several records, about a fit in which all records share them.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::FittedPlatform;
use crate::error::CalibrationError;

/// Information of a size of which the coefficients leave less than this share cannot be seen.
const VISIBLE: f64 = 1e-9;

/// Estimates of some values of a fit, in each record by itself.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordSizes {
    /// The records that tell of them.
    pub records: Vec<usize>,
    /// Estimates, all of a record together.
    pub estimates: DVector<f64>,
    /// Covariance of their errors.
    pub covariance: DMatrix<f64>,
}

impl FittedPlatform<'_> {
    /// Estimates of the values at `places` (counted like [`Self::values`]) if each record has its own and all
    /// other values are shared, linearised about this fit.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`], and [`CalibrationError::NotPositiveDefinite`] if no two of the records tell
    /// of them.
    pub fn sizes_by_record(&self, places: &[usize]) -> Result<RecordSizes, CalibrationError> {
        let grams: Vec<DMatrix<f64>> = (0..self.records())
            .map(|run| Ok(self.conditional_in(run, &[])?.gram))
            .collect::<Result<_, CalibrationError>>()?;
        let shared: Vec<usize> = (0..self.shared)
            .filter(|place| !places.contains(place))
            .collect();
        let all = |gram: &DMatrix<f64>, place: usize| gram[(place + 1, place + 1)];
        let largest = |place: &usize| {
            let own = grams.iter().map(|gram| all(gram, *place));
            own.fold(0.0, f64::max)
        };
        let records: Vec<usize> = (0..grams.len())
            .filter(|run| {
                let seen = |place: &usize| all(&grams[*run], *place) > VISIBLE * largest(place);
                places.iter().all(seen)
            })
            .collect();
        let (first, each) = (shared.len(), places.len());
        let count = first + each * records.len();
        let mut information = DMatrix::<f64>::zeros(count, count);
        let mut gradient = DVector::<f64>::zeros(count);
        for (i, place) in shared.iter().enumerate() {
            let unknown = &self.problem.unknowns[*place];
            let weight = unknown.sigma.powi(-2);
            information[(i, i)] += weight;
            gradient[i] += weight * (unknown.prior - self.problem.values[*place]);
        }
        for (run, gram) in grams.iter().enumerate() {
            let slot = records.iter().position(|record| *record == run);
            // Places of the record's columns among the unknowns.
            let own = slot.into_iter().flat_map(|slot| {
                let at = first + each * slot;
                places
                    .iter()
                    .enumerate()
                    .map(move |(i, place)| (at + i, *place))
            });
            let columns: Vec<(usize, usize)> =
                shared.iter().copied().enumerate().chain(own).collect();
            for (i, place) in &columns {
                gradient[*i] -= gram[(0, place + 1)];
                for (j, other) in &columns {
                    information[(*i, *j)] += gram[(place + 1, other + 1)];
                }
            }
        }
        let cholesky = Cholesky::new(information).ok_or(CalibrationError::NotPositiveDefinite)?;
        let change = cholesky.solve(&gradient);
        let inverse = cholesky.inverse();
        let own = each * records.len();
        Ok(RecordSizes {
            estimates: DVector::from_fn(own, |i, _| {
                self.problem.values[places[i % each]] + change[first + i]
            }),
            covariance: inverse.view((first, first), (own, own)).into_owned(),
            records,
        })
    }
}
