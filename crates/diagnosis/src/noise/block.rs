//! Discrete cosine transform of blocks of rows, with low orders removed: a smooth trajectory does
//! not enter.

/// Degree of the polynomial that is removed from each block.
const DEGREE: usize = 3;
/// Smallest fraction of present values in a block.
const LEAST_PRESENT: f64 = 0.75;

/// Orthonormal basis of a block: cosines of increasing frequency, orthogonal to its polynomials.
pub(crate) struct Basis {
    polynomials: Vec<Vec<f64>>,
    cosines: Vec<Vec<f64>>,
    /// Autocorrelation of each cosine vector at the lags 0, 1, …, [`LAGS`].
    lags: Vec<Vec<f64>>,
    /// Power of a random walk with unit variance of its steps in each cosine.
    walk: Vec<f64>,
}

/// Largest lag of the autocorrelations: 0.95 to this power is below 0.04.
const LAGS: usize = 63;

impl Basis {
    pub(crate) fn new(rows: usize) -> Self {
        let middle = (rows as f64 - 1.0) / 2.0;
        let powers = (0..=DEGREE).map(|power| {
            let value = |row: usize| ((row as f64 - middle) / middle.max(1.0)).powi(power as i32);
            (0..rows).map(value).collect::<Vec<f64>>()
        });
        let waves = (DEGREE + 1..rows).map(|wave| {
            let phase = |row: usize| wave as f64 * (row as f64 + 0.5) / rows as f64;
            (0..rows)
                .map(|row| (core::f64::consts::PI * phase(row)).cos())
                .collect::<Vec<f64>>()
        });
        let mut vectors: Vec<Vec<f64>> = Vec::new();
        for mut vector in powers.chain(waves) {
            // Twice: one Gram-Schmidt pass leaves rounding errors.
            for _ in 0..2 {
                for earlier in &vectors {
                    let along = dot(earlier, &vector);
                    subtract(&mut vector, along, earlier);
                }
            }
            let norm = dot(&vector, &vector).sqrt();
            vector.iter_mut().for_each(|value| *value /= norm);
            vectors.push(vector);
        }
        let cosines = vectors.split_off(DEGREE + 1);
        Self {
            lags: cosines
                .iter()
                .map(|vector| autocorrelation(vector))
                .collect(),
            walk: cosines.iter().map(|vector| walk_power(vector)).collect(),
            polynomials: vectors,
            cosines,
        }
    }

    /// Number of rows of a block.
    pub(crate) fn rows(&self) -> usize {
        self.polynomials.len() + self.cosines.len()
    }

    /// Number of cosines.
    pub(crate) fn len(&self) -> usize {
        self.cosines.len()
    }

    /// Power of a random walk with unit variance of its steps in a cosine.
    pub(crate) fn walk(&self, cosine: usize) -> f64 {
        self.walk[cosine]
    }

    /// Power in a cosine of first-order autoregressive noise of unit variance, and its derivative by
    /// the correlation from row to row.
    pub(crate) fn coloured(&self, cosine: usize, correlation: f64) -> [f64; 2] {
        let lags = &self.lags[cosine];
        let (mut power, mut slope, mut factor) = (lags[0], 0.0, 1.0);
        for (lag, shared) in lags.iter().enumerate().skip(1) {
            slope += 2.0 * shared * lag as f64 * factor;
            factor *= correlation;
            power += 2.0 * shared * factor;
        }
        [power, slope]
    }

    /// Squared coefficients of a block and its fraction of present values; `None` if too many values
    /// are `NaN`.
    pub(crate) fn powers(&self, block: &[f64]) -> Option<(Vec<f64>, f64)> {
        let missing: Vec<usize> = (0..block.len())
            .filter(|row| block[*row].is_nan())
            .collect();
        let present = 1.0 - missing.len() as f64 / block.len() as f64;
        if present < LEAST_PRESENT {
            return None;
        }
        let mut filled = block.to_vec();
        missing.iter().for_each(|row| filled[*row] = 0.0);
        // Missing values are replaced by the polynomial through the others. Each pass reduces the
        // error by their share in the polynomial, at worst one half.
        for pass in 0.. {
            let along: Vec<f64> = self.polynomials.iter().map(|p| dot(p, &filled)).collect();
            if missing.is_empty() || pass == 30 {
                for (polynomial, along) in self.polynomials.iter().zip(&along) {
                    subtract(&mut filled, *along, polynomial);
                }
                break;
            }
            for row in &missing {
                filled[*row] = self
                    .polynomials
                    .iter()
                    .zip(&along)
                    .map(|(p, a)| a * p[*row])
                    .sum();
            }
        }
        let power = |cosine: &Vec<f64>| dot(cosine, &filled).powi(2);
        Some((self.cosines.iter().map(power).collect(), present))
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn subtract(from: &mut [f64], factor: f64, vector: &[f64]) {
    from.iter_mut()
        .zip(vector)
        .for_each(|(value, v)| *value -= factor * v);
}

fn autocorrelation(vector: &[f64]) -> Vec<f64> {
    (0..vector.len().min(LAGS + 1))
        .map(|lag| dot(&vector[lag..], vector))
        .collect()
}

/// Power of a random walk in a vector: each step enters all later rows.
fn walk_power(vector: &[f64]) -> f64 {
    let mut later = 0.0;
    vector
        .iter()
        .rev()
        .map(|value| {
            later += value;
            later * later
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cosines_are_orthonormal_and_see_no_cubic() {
        for rows in [16, 64] {
            let basis = Basis::new(rows);
            assert_eq!(basis.rows(), rows);
            let cubic: Vec<f64> = (0..rows)
                .map(|row| 1.0 + (row as f64 / rows as f64 - 0.3).powi(3))
                .collect();
            for (i, one) in basis.cosines.iter().enumerate() {
                for (j, other) in basis.cosines.iter().enumerate() {
                    // Sums of 64 numbers below one: roundings.
                    assert!((dot(one, other) - f64::from(u8::from(i == j))).abs() < 1e-13);
                }
                assert!(dot(one, &cubic).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn a_block_with_missing_values_sees_no_cubic_either() {
        let basis = Basis::new(32);
        let mut block: Vec<f64> = (0..32).map(|row| (f64::from(row) - 11.0).powi(3)).collect();
        for row in [3, 4, 17, 31] {
            block[row] = f64::NAN;
        }
        let powers = basis.powers(&block);
        let largest = powers.map(|(powers, _)| powers.into_iter().fold(0.0, f64::max));
        // Values up to 8000; thirty passes leave what is missing at rounding but for the last row,
        // whose part in a cubic is the largest.
        assert!(largest.is_some_and(|power| power < 1e-6), "{largest:?}");
        block[..9].fill(f64::NAN);
        assert!(basis.powers(&block).is_none());
    }

    #[test]
    fn powers_of_coloured_noise_and_walk_are_quadratic_forms() {
        let basis = Basis::new(16);
        let (phi, rise) = (0.4_f64, 1e-6);
        for cosine in [0, 5, 11] {
            let vector = &basis.cosines[cosine];
            let (mut coloured, mut walk) = (0.0, 0.0);
            for k in 0..16 {
                for l in 0..16 {
                    coloured += vector[k] * vector[l] * phi.powi(k.abs_diff(l) as i32);
                    walk += vector[k] * vector[l] * (k.min(l) + 1) as f64;
                }
            }
            let [power, slope] = basis.coloured(cosine, phi);
            assert!((power - coloured).abs() < 1e-12 && (basis.walk(cosine) - walk).abs() < 1e-10);
            // Central difference: error of the square of the step, rounding of 1e-16 / 1e-6.
            let difference =
                basis.coloured(cosine, phi + rise)[0] - basis.coloured(cosine, phi - rise)[0];
            assert!((slope - difference / (2.0 * rise)).abs() < 1e-8);
        }
    }
}
