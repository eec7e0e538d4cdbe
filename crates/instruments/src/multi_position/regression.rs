//! Weighted linear regression of the rates of one gyro on terms of the drift law.

use nalgebra::{DMatrix, DVector};
use statrs::function::gamma::ln_gamma;

use super::positions::Positions;
use super::terms::{Term, response};

/// Rates and terms of one gyro at some stops, over the standard deviations of the rates.
///
/// The variance of a rate is the square of its standard error plus an excess that is the same at all
/// stops: scatter between stops that averaging within stops does not show.
#[derive(Clone)]
pub(crate) struct WeightedStops {
    pub(crate) gyro: usize,
    pub(crate) rates: DVector<f64>,
    /// Standard deviations \[deg/h\].
    pub(crate) sigma: DVector<f64>,
    /// The excess, as a standard deviation \[deg/h\].
    pub(crate) excess_deg_per_h: f64,
    standard_errors: DVector<f64>,
    /// Rate at each stop per unit of each parameter of the catalogue.
    responses: Vec<Vec<f64>>,
}

impl WeightedStops {
    /// Gyro `gyro` at the stops `which`, without an excess.
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
            standard_errors: sigma.clone(),
            sigma,
            excess_deg_per_h: 0.0,
            responses: which
                .iter()
                .map(|stop| {
                    let time_s = positions.time_s[*stop] - start_s;
                    response(gyro, &positions.force_g[*stop], time_s).to_vec()
                })
                .collect(),
        }
    }

    /// The same stops with the excess at which the residuals of a law have unit variance (Mandel and
    /// Paule 1970); without excess if it is less than one already.
    pub(crate) fn with_excess_of(&self, terms: &[Term]) -> Self {
        /// Number of bisections, for a relative accuracy of 1e-6.
        const HALVINGS: usize = 24;
        let none = self.with_excess(0.0);
        let Some(fit) = none.fit(terms).filter(|fit| fit.scale() > 1.0) else {
            return none;
        };
        // Upper limit: all scatter as excess.
        let largest = none.sigma.max();
        let (mut low, mut high) = (0.0, largest * fit.scale().sqrt());
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let too_small = self
                .with_excess(middle)
                .fit(terms)
                .is_some_and(|fit| fit.scale() > 1.0);
            *(if too_small { &mut low } else { &mut high }) = middle;
        }
        self.with_excess(high)
    }

    /// These stops with the excess of others.
    pub(crate) fn like(&self, other: &Self) -> Self {
        self.with_excess(other.excess_deg_per_h)
    }

    fn with_excess(&self, excess_deg_per_h: f64) -> Self {
        let variance = excess_deg_per_h * excess_deg_per_h;
        let sigma = self
            .standard_errors
            .map(|error| (error * error + variance).sqrt());
        Self {
            rates: self.rates.component_mul(&self.sigma).component_div(&sigma),
            sigma,
            excess_deg_per_h,
            ..self.clone()
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

    /// Fits terms; `None` if the stops do not determine them.
    pub(crate) fn fit(&self, terms: &[Term]) -> Option<Fit> {
        Fit::of(&self.columns(terms), &self.rates)
    }
}

/// Fit of whitened rates.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    pub(crate) estimates: DVector<f64>,
    /// Covariance of the estimates for right standard errors.
    pub(crate) cofactors: DMatrix<f64>,
    pub(crate) residuals: DVector<f64>,
    pub(crate) chi_square: f64,
    pub(crate) freedom: f64,
}

/// Largest condition number of the columns, each scaled to length one, of determined terms.
const WORST_CONDITION: f64 = 1e4;

impl Fit {
    pub(crate) fn of(columns: &DMatrix<f64>, rates: &DVector<f64>) -> Option<Self> {
        let (stops, terms) = columns.shape();
        if stops <= terms {
            return None;
        }
        Self::exact(columns, rates)
    }

    /// The same for as many terms as stops, which leaves no degrees of freedom.
    pub(crate) fn exact(columns: &DMatrix<f64>, rates: &DVector<f64>) -> Option<Self> {
        let (stops, terms) = columns.shape();
        if stops < terms {
            return None;
        }
        let lengths: Vec<f64> = columns.column_iter().map(|column| column.norm()).collect();
        if lengths.contains(&0.0) {
            return None;
        }
        let inverse_lengths =
            DVector::from_iterator(terms, lengths.iter().map(|length| 1.0 / length));
        let scaling = DMatrix::from_diagonal(&inverse_lengths);
        let decomposition = (columns * &scaling).svd(true, true);
        let values = &decomposition.singular_values;
        if values.max() > WORST_CONDITION * values.min() {
            return None;
        }
        let inverse = &scaling * decomposition.pseudo_inverse(0.0).ok()?;
        let estimates = &inverse * rates;
        let residuals = rates - columns * &estimates;
        Some(Self {
            cofactors: &inverse * inverse.transpose(),
            chi_square: residuals.norm_squared(),
            freedom: (stops - terms) as f64,
            estimates,
            residuals,
        })
    }

    /// Residual variance over its expectation from the standard errors.
    pub(crate) fn scale(&self) -> f64 {
        self.chi_square / self.freedom
    }

    /// Prediction of a whitened rate that was held out: its error and its log density, which is
    /// Student's t since the scale is estimated.
    pub(crate) fn predict(&self, row: &DVector<f64>, rate: f64) -> Prediction {
        let error = rate - row.dot(&self.estimates);
        let variance = self.scale() * (1.0 + row.dot(&(&self.cofactors * row)));
        let nu = self.freedom;
        let log_score = ln_gamma(0.5 * (nu + 1.0))
            - ln_gamma(0.5 * nu)
            - 0.5 * (nu * core::f64::consts::PI * variance).ln()
            - 0.5 * (nu + 1.0) * (error * error / (nu * variance)).ln_1p();
        Prediction { error, log_score }
    }
}

/// Prediction of a held-out whitened rate.
pub(crate) struct Prediction {
    pub(crate) error: f64,
    pub(crate) log_score: f64,
}
