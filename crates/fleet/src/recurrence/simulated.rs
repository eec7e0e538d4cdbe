//! Fleets whose scores are drawn, and an oracle: measures of the search for recurring causes.

use gyrocal_hypothesis::ScoreTable;
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::math::{exp, ln_1p};
use nalgebra::{Cholesky, DMatrix, DVector};

use super::UnitRecords;
use super::mixture::in_random_direction;
use super::naming::scores;
use super::scores::{UnitScores, direction};

/// Added to the diagonal of a correlation that is drawn from.
const JITTER: f64 = 1e-4;

/// A cause in a share of the units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Injected<'a> {
    /// Public id of the effect.
    pub effect: &'a str,
    /// Standard deviations of a unit's own estimate.
    pub strength: f64,
    /// Share of the units.
    pub share: f64,
}

/// Draws the scores of a record from their joint distribution.
#[derive(Clone, Debug)]
pub struct ScoreSimulator {
    table: ScoreTable,
    /// Factor of the correlation.
    lower: DMatrix<f64>,
}

impl ScoreSimulator {
    /// Of a record with these scores. `None` if their correlation is none.
    #[must_use]
    pub fn new(table: ScoreTable) -> Option<Self> {
        let mut correlation = table.correlation.clone();
        for i in 0..correlation.nrows() {
            correlation[(i, i)] += JITTER;
        }
        let lower = Cholesky::new(correlation)?.unpack();
        Some(Self { table, lower })
    }

    /// The scores of the record itself.
    #[must_use]
    pub fn table(&self) -> &ScoreTable {
        &self.table
    }

    /// Scores with a cause of a strength in a random direction at a random onset, or without. `None` if the
    /// record does not show the effect.
    #[must_use]
    pub fn draw(&self, cause: Option<(&str, f64)>, draw: &mut Draw) -> Option<ScoreTable> {
        let table = &self.table;
        let normal = DVector::from_fn(table.z.len(), |_, _| draw.normal());
        let mut z = &self.lower * normal;
        if let Some((effect, strength)) = cause {
            let own = table.effects.iter().find(|own| own.id == effect)?;
            let columns = draw.one_of(&own.variants);
            let part = table
                .correlation
                .select_rows(columns)
                .select_columns(columns);
            let root = Cholesky::new(part)?.unpack();
            // Sizes b with bᵀ J b = d².
            let sizes = root
                .transpose()
                .solve_upper_triangular(&(direction(columns.len(), draw) * strength))?;
            for (column, size) in columns.iter().zip(sizes.iter()) {
                z += table.correlation.column(*column) * *size;
            }
        }
        Some(ScoreTable {
            z: z.iter().copied().collect(),
            ..table.clone()
        })
    }
}

/// Whether the most powerful test finds a cause, at a level: the likelihood ratio for one that knows which
/// effect it is, its strength and its share, and not which units have it, with which sign and onset.
#[must_use]
pub fn oracle_finds(
    units: &[UnitRecords<'_>],
    cause: Injected<'_>,
    level: f64,
    draws: usize,
    draw: &mut Draw,
) -> bool {
    let observed = scores(units, cause.effect);
    let reached = ln_ratio(&observed, cause);
    if reached <= 0.0 {
        return false;
    }
    let mut drawn = observed;
    let mut sum = exp(-reached);
    for _ in 0..draws {
        for unit in &mut drawn {
            unit.redrawn(draw);
            if draw.uniform() < cause.share {
                unit.shift(cause.strength, draw);
            }
        }
        let own = ln_ratio(&drawn, cause);
        if own >= reached {
            sum += exp(-own);
        }
    }
    sum / (draws as f64 + 1.0) <= level
}

/// Logarithm of the likelihood ratio of a cause of known share and strength.
fn ln_ratio(units: &[UnitScores], cause: Injected<'_>) -> f64 {
    let ratio = |unit: &UnitScores| {
        let count = unit.variants();
        let blocks = unit.blocks.iter();
        let each = blocks.flat_map(|block| {
            block.variants.iter().map(|span| {
                let own = block.whitened.rows(span.start, span.len());
                in_random_direction(span.len(), own.norm_squared(), cause.strength)
            })
        });
        match count {
            0 => 0.0,
            _ => ln_1p(cause.share * (each.sum::<f64>() / count as f64 - 1.0)),
        }
    };
    units.iter().map(ratio).sum()
}
