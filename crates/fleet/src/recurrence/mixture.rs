//! The evidence that a cause recurs: its likelihood ratio over many units, averaged over what is unknown.
//!
//! A cause of strength d (standard deviations of a unit's own estimate) is in a share π of the units, in each
//! with a random direction (a sign, where it has one size) and at a random onset v of those that are
//! searched. With w the whitened scores of unit i, in k dimensions at each onset,
//!
//! ```text
//! L_i(d)   = mean over v of exp(−d²/2) · ₀F₁(k/2; d² |w_v|²/4)                  (2)
//! E        = mean over (d, π) of Π_i (1 − π + π L_i(d))                         (3)
//! ```
//!
//! ₀F₁ is the mean of exp(d u·w) over directions u: cosh(d w) where k = 1. Of effects whose size is the same
//! in all records, half of E is that of one size in all units: with the scores and informations of all
//! units added, L(d) of their sum. E has the mean one without the cause, so that P(E ≥ 1/α) ≤ α whatever
//! depends on whatever: it is an *e-value* (Vovk, Wang, Ann. Statist. 49, 1736, 2021).

use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::math::{exp, ln, ln_1p};
use nalgebra::{Cholesky, DMatrix, DVector};

use super::scores::{UnitScores, direction};

/// Strengths in a unit: from half of what one record shows by itself to where it shows it.
pub(crate) const STRENGTHS: [f64; 5] = [1.0, 1.5, 2.0, 3.0, 4.0];

/// Shares of the units.
pub(crate) const SHARES: [f64; 6] = [0.02, 0.05, 0.1, 0.2, 0.5, 1.0];

/// Strengths of one size in all units, all of them together.
const COMMON: [f64; 5] = [2.0, 3.0, 4.0, 6.0, 8.0];

/// Largest argument of an exponential.
const LARGEST: f64 = 600.0;

/// Likelihood ratio (2) of one onset: a cause of strength `d` in a random direction of `size` dimensions,
/// where the squares of the whitened scores sum up to `square`.
pub(crate) fn in_random_direction(size: usize, square: f64, d: f64) -> f64 {
    let x = (d * square.sqrt()).min(LARGEST);
    let damped = exp(x - 0.5 * d * d);
    let back = exp(-2.0 * x);
    match size {
        1 => 0.5 * damped * (1.0 + back),
        3 if x > 1e-3 => 0.5 * damped * (1.0 - back) / x,
        _ => exp(-0.5 * d * d) * hypergeometric(0.5 * size as f64, 0.25 * x * x),
    }
}

/// ₀F₁(b; x): all its terms are positive.
fn hypergeometric(b: f64, x: f64) -> f64 {
    let (mut sum, mut term, mut index) = (1.0, 1.0, 0.0);
    while term > 1e-16 * sum {
        term *= x / ((b + index) * (index + 1.0));
        sum += term;
        index += 1.0;
    }
    sum
}

/// Likelihood ratios of a unit at each strength.
pub(crate) type UnitRatios = [f64; STRENGTHS.len()];

/// Those of (2); one of a unit that does not show the effect.
pub(crate) fn ratios(unit: &UnitScores) -> UnitRatios {
    let count = unit.variants();
    if count == 0 {
        return [1.0; STRENGTHS.len()];
    }
    let mut sums = [0.0; STRENGTHS.len()];
    for block in &unit.blocks {
        for span in &block.variants {
            let own = block.whitened.rows(span.start, span.len());
            let square = own.norm_squared();
            for (sum, d) in sums.iter_mut().zip(STRENGTHS) {
                *sum += in_random_direction(span.len(), square, d);
            }
        }
    }
    sums.map(|sum| sum / count as f64)
}

/// Logarithms of the likelihood ratios of each cell of (3), strength by strength.
pub(crate) fn cells(units: &[UnitRatios]) -> Vec<f64> {
    let mut cells = Vec::with_capacity(STRENGTHS.len() * SHARES.len());
    for strength in 0..STRENGTHS.len() {
        for share in SHARES {
            let terms = units
                .iter()
                .map(|unit| ln_1p(share * (unit[strength] - 1.0)));
            cells.push(terms.sum());
        }
    }
    cells
}

/// Logarithm of the mean of exponentials.
pub(crate) fn ln_mean_exp(logarithms: &[f64]) -> f64 {
    let largest = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if !largest.is_finite() {
        return largest;
    }
    let sum: f64 = logarithms.iter().map(|one| exp(one - largest)).sum();
    largest + ln(sum / logarithms.len() as f64)
}

/// Scores and informations of all units added.
pub(crate) struct Pooled {
    /// Factor of the sum of the informations.
    root: DMatrix<f64>,
    /// The size, in its unit, and its covariance.
    pub(crate) size: DVector<f64>,
    pub(crate) covariance: DMatrix<f64>,
    whitened: DVector<f64>,
}

impl Pooled {
    /// `None` of effects whose size is not the same in all records.
    pub(crate) fn of(units: &[UnitScores]) -> Option<Self> {
        let blocks = units.iter().flat_map(|unit| &unit.blocks);
        let (mut information, mut score): (Option<DMatrix<f64>>, Option<DVector<f64>>) =
            (None, None);
        for block in blocks {
            let root = block.root.as_ref()?;
            let own = root * root.transpose();
            information = Some(information.map_or_else(|| own.clone(), |sum| sum + &own));
            let own = root * &block.whitened;
            score = Some(score.map_or_else(|| own.clone(), |sum| sum + &own));
        }
        let score = score?;
        let cholesky = Cholesky::new(information?)?;
        let size = cholesky.solve(&score);
        let covariance = cholesky.inverse();
        let root = cholesky.unpack();
        Some(Self {
            whitened: root.solve_lower_triangular(&score)?,
            root,
            size,
            covariance,
        })
    }

    /// Logarithm of the evidence of one size in all units.
    pub(crate) fn ln_evidence(&self) -> f64 {
        let square = self.whitened.norm_squared();
        let all = COMMON.map(|d| ln(in_random_direction(self.whitened.len(), square, d)));
        ln_mean_exp(&all)
    }

    /// Adds one size of a random strength to all units.
    fn shift(&self, units: &mut [UnitScores], draw: &mut Draw) {
        let strength = *draw.one_of(&COMMON);
        let direction = direction(self.whitened.len(), draw) * strength;
        let Some(size) = self.root.transpose().solve_upper_triangular(&direction) else {
            return;
        };
        for block in units.iter_mut().flat_map(|unit| &mut unit.blocks) {
            if let Some(root) = &block.root {
                block.whitened += root.transpose() * &size;
            }
        }
    }
}

/// The evidence (3), taken apart.
#[derive(Clone, Debug)]
pub(crate) struct Evidence {
    /// Logarithm of E.
    pub(crate) ln_e: f64,
    /// Logarithm of the evidence of one size in all units; `None` where sizes differ by nature.
    pub(crate) ln_common: Option<f64>,
    /// Of each cell.
    pub(crate) cells: Vec<f64>,
    pub(crate) units: Vec<UnitRatios>,
}

impl Evidence {
    pub(crate) fn of(units: &[UnitScores]) -> Self {
        let ln_common = Pooled::of(units).map(|pooled| pooled.ln_evidence());
        Self::of_ratios(units.iter().map(ratios).collect(), ln_common)
    }

    /// From the likelihood ratios of the units and the evidence of one size in all.
    pub(crate) fn of_ratios(ratios: Vec<UnitRatios>, ln_common: Option<f64>) -> Self {
        let cells = cells(&ratios);
        let random = ln_mean_exp(&cells);
        Self {
            ln_e: ln_common.map_or(random, |common| ln_mean_exp(&[random, common])),
            ln_common,
            cells,
            units: ratios,
        }
    }

    /// Whether one size in all units explains more than sizes of their own.
    pub(crate) fn is_common(&self) -> bool {
        let random = ln_mean_exp(&self.cells);
        self.ln_common.is_some_and(|common| common > random)
    }

    /// Means of share and strength, weighted by the likelihood of each cell.
    pub(crate) fn share_and_strength(&self) -> (f64, f64) {
        let ln_all = ln_mean_exp(&self.cells);
        let count = self.cells.len() as f64;
        let (mut share, mut strength) = (0.0, 0.0);
        for (index, cell) in self.cells.iter().enumerate() {
            let weight = exp(cell - ln_all) / count;
            share += weight * SHARES[index % SHARES.len()];
            strength += weight * STRENGTHS[index / SHARES.len()];
        }
        (share, strength)
    }

    /// Probability that a unit has the cause, given that some have.
    pub(crate) fn probability(&self, unit: usize) -> f64 {
        let ln_all = ln_mean_exp(&self.cells);
        let count = self.cells.len() as f64;
        let each = self.cells.iter().enumerate().map(|(index, cell)| {
            let share = SHARES[index % SHARES.len()];
            let ratio = share * self.units[unit][index / SHARES.len()];
            exp(cell - ln_all) / count * ratio / (1.0 - share + ratio)
        });
        each.sum()
    }
}

/// Draws units that have the cause, as (3) averages over it: their density over that without the cause is E.
pub(crate) fn draw_with_cause(units: &mut [UnitScores], pooled: Option<&Pooled>, draw: &mut Draw) {
    for unit in units.iter_mut() {
        unit.redrawn(draw);
    }
    match pooled {
        Some(pooled) if draw.uniform() < 0.5 => pooled.shift(units, draw),
        _ => {
            let strength = *draw.one_of(&STRENGTHS);
            let share = *draw.one_of(&SHARES);
            for unit in units.iter_mut() {
                if draw.uniform() < share {
                    unit.shift(strength, draw);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_random_direction_is_averaged_over() {
        // Means over directions in the plane and in space, by quadrature.
        let (square, d) = (4.0_f64, 1.5);
        let length = d * square.sqrt();
        let steps = 20_000;
        let angle = |step: i32| std::f64::consts::PI * (f64::from(step) + 0.5) / f64::from(steps);
        let plane: f64 = (0..steps)
            .map(|step| (length * angle(step).cos()).exp())
            .sum();
        let space: f64 = (0..steps)
            .map(|step| {
                let angle = angle(step);
                (length * angle.cos()).exp() * angle.sin()
            })
            .sum();
        let damp = (-0.5 * d * d).exp();
        let plane = damp * plane / f64::from(steps);
        let space = damp * space * 0.5 * std::f64::consts::PI / f64::from(steps);
        assert!((in_random_direction(2, square, d) / plane - 1.0).abs() < 1e-7);
        assert!((in_random_direction(3, square, d) / space - 1.0).abs() < 1e-7);
        assert!((in_random_direction(1, square, d) / (damp * length.cosh()) - 1.0).abs() < 1e-12);
        // The form in closed terms and the series.
        let series = exp(-0.5 * d * d) * hypergeometric(1.5, 0.25 * length * length);
        assert!((in_random_direction(3, square, d) / series - 1.0).abs() < 1e-12);
    }

    #[test]
    fn logarithms_of_means_do_not_overflow() {
        assert!((ln_mean_exp(&[1000.0, 1000.0]) - 1000.0).abs() < 1e-12);
        assert!((ln_mean_exp(&[0.0, f64::NEG_INFINITY]) + core::f64::consts::LN_2).abs() < 1e-12);
    }
}
