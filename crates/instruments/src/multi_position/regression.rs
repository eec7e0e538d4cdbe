//! Rates of one gyro and terms of the drift law, weighted by the standard errors of the stops.

use nalgebra::{DMatrix, DVector};

use super::positions::Positions;
use super::terms::{Term, response};

/// Rates and terms of one gyro at some stops, over the standard errors of the rates.
pub(crate) struct WeightedStops {
    pub(crate) gyro: usize,
    pub(crate) rates: DVector<f64>,
    /// Standard errors \[deg/h\].
    pub(crate) sigma: DVector<f64>,
    /// Rate at each stop per unit of each parameter of the catalogue.
    responses: Vec<Vec<f64>>,
}

impl WeightedStops {
    /// Gyro `gyro` at the stops `which`.
    pub(crate) fn of(positions: &Positions, gyro: usize, which: &[usize]) -> Self {
        let pick = |values: &dyn Fn(usize) -> f64| {
            DVector::from_iterator(which.len(), which.iter().map(|stop| values(*stop)))
        };
        let sigma = pick(&|stop| positions.sigma_deg_per_h[stop][gyro]);
        let rates = pick(&|stop| positions.rate_deg_per_h[stop][gyro]);
        let start_s = positions.time_s.first().copied().unwrap_or(0.0);
        Self {
            gyro,
            rates: rates.component_div(&sigma),
            sigma,
            responses: which
                .iter()
                .map(|stop| {
                    let time_s = positions.time_s[*stop] - start_s;
                    response(gyro, &positions.force_g[*stop], time_s).to_vec()
                })
                .collect(),
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.rates.len()
    }

    /// Whitened column of a term.
    pub(crate) fn column(&self, term: Term) -> DVector<f64> {
        let parameter = term.parameter(self.gyro);
        let values = self.responses.iter().zip(self.sigma.iter());
        let values = values.map(|(response, sigma)| response[parameter] / sigma);
        DVector::from_iterator(self.len(), values)
    }

    /// Whitened columns of terms.
    pub(crate) fn columns(&self, terms: &[Term]) -> DMatrix<f64> {
        let columns: Vec<DVector<f64>> = terms.iter().map(|term| self.column(*term)).collect();
        DMatrix::from_columns(&columns)
    }
}

/// Largest condition number of the columns, each scaled to length one, of determined terms.
const WORST_CONDITION: f64 = 1e4;

/// Sum of squares that some columns leave of whitened rates; `None` where the stops do not determine them. Of as many
/// columns as stops nothing is left.
pub(crate) fn chi_square(columns: &DMatrix<f64>, rates: &DVector<f64>) -> Option<f64> {
    let (stops, terms) = columns.shape();
    let lengths: Vec<f64> = columns.column_iter().map(|column| column.norm()).collect();
    if stops < terms || lengths.contains(&0.0) {
        return None;
    }
    let scaled = DMatrix::from_fn(stops, terms, |row, term| {
        columns[(row, term)] / lengths[term]
    });
    let values = scaled.singular_values();
    if values.max() > WORST_CONDITION * values.min() {
        return None;
    }
    let span = scaled.qr().q();
    Some((rates - &span * span.tr_mul(rates)).norm_squared())
}
