//! Evidence of an effect beside those that are named: one that looks like a named effect has none.
//!
//! A named cause of which not every unit has the same size shows in the scores of all effects that overlap
//! with it, also where its best onset is taken out of each unit: the best is not the true one. So the whole
//! distribution of the scores is compared. A unit has at most one of the causes,
//!
//! ```text
//! Λ_S = Π_i (1 − Σ π_a + Σ π_a L_ia(d_a))        over the named effects a of S
//! E   = mean over (d, π) of Λ_{S + b}  /  max over (d, π) of Λ_S                   (4)
//! ```
//!
//! with L of (2). The mean of E is at most one if the causes are those of S, whatever their shares and
//! strengths are (Wasserman, Ramdas, Balakrishnan, Proc. Natl. Acad. Sci. 117, 16880, 2020): an effect that
//! looks like a named one explains no more than that one does.

use gyrocal_statistics::math::{ln, ln_1p};

use super::mixture::{Evidence, SHARES, STRENGTHS, ln_mean_exp};

/// Cells of shares and strengths of the named effects that are kept, the likeliest: what is left out
/// lowers E.
const KEPT: usize = 12;

/// Shares and strengths of the named effects.
#[derive(Clone, Debug)]
struct Cell {
    /// Σ π.
    share: f64,
    /// Σ π (L − 1) of each unit.
    excess: Vec<f64>,
    /// Logarithm of Λ.
    ln_likelihood: f64,
}

/// Effects that are named, together.
#[derive(Clone, Debug)]
pub(super) struct Named {
    cells: Vec<Cell>,
    /// Logarithm of the number of all cells.
    ln_count: f64,
}

impl Named {
    /// No effect.
    pub(super) fn none(units: usize) -> Self {
        let cell = Cell {
            share: 0.0,
            excess: vec![0.0; units],
            ln_likelihood: 0.0,
        };
        Self {
            cells: vec![cell],
            ln_count: 0.0,
        }
    }

    /// Of several effects.
    pub(super) fn of<'e>(units: usize, effects: impl Iterator<Item = &'e Evidence>) -> Self {
        effects.fold(Self::none(units), |named, one| named.with(one))
    }

    /// These and one more.
    fn with(&self, effect: &Evidence) -> Self {
        let mut cells: Vec<(Cell, usize, usize)> = Vec::new();
        for (cell, strength, share) in self.pairs() {
            let ln_likelihood = cell.ln_likelihood_with(effect, strength, share);
            let place = cells.partition_point(|one| one.0.ln_likelihood >= ln_likelihood);
            if place < KEPT {
                let next = Cell {
                    ln_likelihood,
                    ..cell.clone()
                };
                cells.insert(place, (next, strength, share));
                cells.truncate(KEPT);
            }
        }
        for (cell, strength, share) in &mut cells {
            cell.share += SHARES[*share];
            for (excess, ratios) in cell.excess.iter_mut().zip(&effect.units) {
                *excess += SHARES[*share] * (ratios[*strength] - 1.0);
            }
        }
        Self {
            cells: cells.into_iter().map(|(cell, ..)| cell).collect(),
            ln_count: self.ln_count + ln((STRENGTHS.len() * SHARES.len()) as f64),
        }
    }

    /// Each cell with each strength and share that leaves no unit with two causes.
    fn pairs(&self) -> impl Iterator<Item = (&Cell, usize, usize)> {
        self.cells.iter().flat_map(|cell| {
            let shares = (0..SHARES.len()).filter(|share| cell.share + SHARES[*share] <= 1.0);
            let both = shares.flat_map(|share| (0..STRENGTHS.len()).map(move |d| (d, share)));
            both.map(move |(strength, share)| (cell, strength, share))
        })
    }

    /// Logarithm of (4).
    pub(super) fn ln_evidence(&self, effect: &Evidence) -> f64 {
        let most = self.cells.iter().map(|cell| cell.ln_likelihood);
        let most = most.fold(f64::NEG_INFINITY, f64::max);
        let all: Vec<f64> = self
            .pairs()
            .map(|(cell, strength, share)| cell.ln_likelihood_with(effect, strength, share))
            .collect();
        ln_mean_exp(&all) + ln(all.len() as f64)
            - most
            - self.ln_count
            - ln((STRENGTHS.len() * SHARES.len()) as f64)
    }
}

impl Cell {
    /// Logarithm of Λ with one more effect.
    fn ln_likelihood_with(&self, effect: &Evidence, strength: usize, share: usize) -> f64 {
        let units = self.excess.iter().zip(&effect.units);
        let share = SHARES[share];
        units
            .map(|(excess, ratios)| ln_1p(excess + share * (ratios[strength] - 1.0)))
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recurrence::mixture::{UnitRatios, in_random_direction};

    /// An effect of one size with these scores in the units.
    fn effect(scores: &[f64]) -> Evidence {
        let ratios = |z: &f64| -> UnitRatios {
            STRENGTHS.map(|strength| in_random_direction(1, z * z, strength))
        };
        Evidence::of_ratios(scores.iter().map(ratios).collect(), None)
    }

    /// Scores of 3.5 in every `each`-th of forty units, of 0.5 in the others.
    fn scores(each: usize, first: usize) -> Vec<f64> {
        let of = |unit: usize| if unit % each == first { 3.5 } else { 0.5 };
        (0..40).map(of).collect()
    }

    #[test]
    fn beside_nothing_it_is_the_evidence_itself() {
        let one = effect(&scores(5, 0));
        let alone = Named::of(40, std::iter::empty()).ln_evidence(&one);
        assert!((alone - one.ln_e).abs() < 1e-9, "{alone} {}", one.ln_e);
    }

    #[test]
    fn a_twin_explains_nothing_more_and_another_cause_does() {
        let (one, other) = (effect(&scores(5, 0)), effect(&scores(5, 1)));
        let named = Named::of(40, std::iter::once(&one));
        assert!(named.ln_evidence(&one) < 0.0);
        assert!(named.ln_evidence(&other) > 0.5 * other.ln_e);
        assert!(other.ln_e > 10.0);
        // Beside both, neither is left.
        let named = Named::of(40, [&one, &other].into_iter());
        assert!(named.ln_evidence(&one) < 0.0 && named.ln_evidence(&other) < 0.0);
    }
}
