//! Scores of a unit on one effect, whitened: standard normal numbers without the effect.

use std::ops::Range;

use gyrocal_hypothesis::{ScoreTable, ScoredEffect};
use gyrocal_statistics::deviates::Draw;
use nalgebra::{Cholesky, DMatrix, DVector};

/// Added to the diagonal of correlations: neighbouring onsets, stored in single precision, are nearly one
/// and the same. It moves a statistic by a hundred thousandth of itself.
const JITTER: f64 = 1e-5;

/// Scores of one record, or of all records of a unit where the size is the same in all of them.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// Whitened within each variant.
    pub(crate) whitened: DVector<f64>,
    /// Places of each variant.
    pub(crate) variants: Vec<Range<usize>>,
    /// Factor of the correlation of all.
    lower: DMatrix<f64>,
    /// Factor of the information, of effects without variants: score = root · whitened.
    pub(crate) root: Option<DMatrix<f64>>,
}

/// Scores of one unit.
#[derive(Clone, Debug, Default)]
pub(crate) struct UnitScores {
    pub(crate) blocks: Vec<Block>,
}

/// Of the records of a unit; no block where none of them shows the effect.
pub(crate) fn of_unit<'a>(
    effect: &str,
    tables: impl Iterator<Item = &'a ScoreTable>,
) -> UnitScores {
    let mut found = UnitScores::default();
    let mut pooled: Option<(DMatrix<f64>, DVector<f64>)> = None;
    for table in tables {
        let Some(own) = table.effects.iter().find(|own| own.id == effect) else {
            continue;
        };
        match own.variants.as_slice() {
            [columns] if own.persists => {
                let (information, score) = physical(table, columns);
                match &mut pooled {
                    Some((sum, scores)) if scores.len() == score.len() => {
                        *sum += information;
                        *scores += score;
                    }
                    Some(_) => {}
                    none => *none = Some((information, score)),
                }
            }
            _ => found.blocks.extend(of_record(table, own)),
        }
    }
    found.blocks.extend(pooled.and_then(of_sums));
    found
}

/// Information and score in the unit of the sizes.
fn physical(table: &ScoreTable, columns: &[usize]) -> (DMatrix<f64>, DVector<f64>) {
    let count = columns.len();
    let root = |place: usize| table.root_information[columns[place]];
    let information = DMatrix::from_fn(count, count, |i, j| {
        table.correlation[(columns[i], columns[j])] * root(i) * root(j)
    });
    let score = DVector::from_fn(count, |i, _| table.z[columns[i]] * root(i));
    (information, score)
}

fn of_sums((information, score): (DMatrix<f64>, DVector<f64>)) -> Option<Block> {
    let count = score.len();
    let root = Cholesky::new(information)?.unpack();
    Some(Block {
        whitened: root.solve_lower_triangular(&score)?,
        variants: std::iter::once(0..count).collect(),
        lower: DMatrix::identity(count, count),
        root: Some(root),
    })
}

/// All variants in one record.
fn of_record(table: &ScoreTable, effect: &ScoredEffect) -> Option<Block> {
    let columns: Vec<usize> = effect.variants.iter().flatten().copied().collect();
    let count = columns.len();
    let mut correlation = DMatrix::from_fn(count, count, |i, j| {
        table.correlation[(columns[i], columns[j])]
    });
    for i in 0..count {
        correlation[(i, i)] += JITTER;
    }
    let mut whitened = DVector::from_fn(count, |i, _| table.z[columns[i]]);
    let mut variants = Vec::with_capacity(effect.variants.len());
    let mut first = 0;
    for variant in &effect.variants {
        let size = variant.len();
        let own = Cholesky::new(correlation.view((first, first), (size, size)).into_owned())?;
        let own = own.unpack();
        let mut part = whitened.rows_mut(first, size);
        own.solve_lower_triangular_mut(&mut part);
        let mut rows = correlation.rows_mut(first, size);
        own.solve_lower_triangular_mut(&mut rows);
        let mut rows = correlation.columns(first, size).transpose();
        own.solve_lower_triangular_mut(&mut rows);
        correlation
            .columns_mut(first, size)
            .copy_from(&rows.transpose());
        variants.push(first..first + size);
        first += size;
    }
    Some(Block {
        whitened,
        variants,
        lower: Cholesky::new(correlation)?.unpack(),
        root: None,
    })
}

impl UnitScores {
    /// Number of variants in all records.
    pub(crate) fn variants(&self) -> usize {
        self.blocks.iter().map(|block| block.variants.len()).sum()
    }

    /// The same with scores drawn without the effect.
    pub(crate) fn redrawn(&mut self, draw: &mut Draw) {
        for block in &mut self.blocks {
            let normal = DVector::from_fn(block.whitened.len(), |_, _| draw.normal());
            block.whitened = if block.lower.len() == 1 {
                normal
            } else {
                &block.lower * normal
            };
        }
    }

    /// Adds an effect of a strength, standard deviations, in a random direction at one of the variants.
    pub(crate) fn shift(&mut self, strength: f64, draw: &mut Draw) {
        let count = self.variants();
        let mut place = ((draw.uniform() * count as f64) as usize).min(count.saturating_sub(1));
        for block in &mut self.blocks {
            if let Some(span) = block.variants.get(place) {
                let direction = direction(span.len(), draw) * strength;
                // Means of all scores: their correlation with those of the variant.
                let part = block.lower.rows(span.start, span.len()).transpose() * direction;
                block.whitened += &block.lower * part;
                return;
            }
            place -= block.variants.len();
        }
    }
}

/// A unit vector in a random direction.
pub(crate) fn direction(size: usize, draw: &mut Draw) -> DVector<f64> {
    if size == 1 {
        return DVector::from_element(1, draw.sign());
    }
    loop {
        let normal = DVector::from_fn(size, |_, _| draw.normal());
        let length = normal.norm();
        if length > 0.0 {
            return normal / length;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An effect with two columns, which persists, and one with two onsets.
    fn table(z: [f64; 4]) -> ScoreTable {
        let effect = |id: &str, persists, variants| ScoredEffect {
            id: id.to_owned(),
            unit: String::new(),
            persists,
            variants,
        };
        ScoreTable {
            effects: vec![
                effect("wave", true, vec![vec![0, 1]]),
                effect("step", false, vec![vec![2], vec![3]]),
            ],
            in_model: Vec::new(),
            z: z.to_vec(),
            root_information: vec![1.0, 2.0, 1.0, 1.0],
            correlation: DMatrix::from_row_slice(
                4,
                4,
                &[
                    1.0, 0.6, 0.0, 0.0, //
                    0.6, 1.0, 0.0, 0.0, //
                    0.0, 0.0, 1.0, 0.8, //
                    0.0, 0.0, 0.8, 1.0,
                ],
            ),
        }
    }

    #[test]
    fn scores_of_what_persists_add_up_over_the_records() {
        let two = [table([1.0, 2.0, 0.0, 0.0]), table([3.0, -1.0, 0.0, 0.0])];
        let pooled = of_unit("wave", two.iter());
        let [block] = &pooled.blocks[..] else {
            panic!("one block")
        };
        // Twice the information, and the sum of the scores (4, 2) of physical size: chi-square by hand.
        let score = DVector::from_vec(vec![4.0, 2.0]);
        let information = DMatrix::from_row_slice(2, 2, &[2.0, 2.4, 2.4, 8.0]);
        let expected = score.dot(&information.try_inverse().map(|j| j * &score).unwrap());
        assert!((block.whitened.norm_squared() - expected).abs() < 1e-10);
    }

    #[test]
    fn onsets_of_each_record_stand_beside_each_other() {
        let two = [table([0.0, 0.0, 1.0, 2.0]), table([0.0, 0.0, 3.0, 4.0])];
        let found = of_unit("step", two.iter());
        assert_eq!((found.blocks.len(), found.variants()), (2, 4));
        assert!((found.blocks[1].whitened[1] - 4.0).abs() < 1e-4);
        assert_eq!(of_unit("other", two.iter()).variants(), 0);
    }

    #[test]
    fn drawn_scores_have_the_correlation_and_the_mean_of_an_effect() {
        let one = table([0.0; 4]);
        let mut unit = of_unit("step", std::iter::once(&one));
        let mut draw = Draw::new(3, 0);
        let count = 20_000;
        let mut product = 0.0;
        for _ in 0..count {
            unit.redrawn(&mut draw);
            let drawn = &unit.blocks[0].whitened;
            product += drawn[0] * drawn[1];
        }
        // Four standard errors, √((1 + 0.8²)/20000).
        assert!((product / f64::from(count) - 0.8).abs() < 0.037);
        unit.blocks[0].whitened.fill(0.0);
        unit.shift(2.0, &mut draw);
        let shifted = &unit.blocks[0].whitened;
        // Two at its own onset and 0.8 of it at the other.
        let [small, large] = [shifted.amin().abs(), shifted.amax()];
        assert!((large - 2.0).abs() < 1e-3 && (small.abs() - 1.6).abs() < 1e-3);
    }
}
