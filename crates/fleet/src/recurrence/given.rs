//! Scores given that other effects are in the model.

use gyrocal_hypothesis::{ScoreTable, ScoredEffect};
use nalgebra::{Cholesky, DMatrix, DVector};

/// What is left of the information of a column must be more than this share to be seen.
const VISIBLE: f64 = 1e-3;

/// Some columns with the factor of their correlation.
struct Projection {
    columns: Vec<usize>,
    lower: DMatrix<f64>,
    whitened: DVector<f64>,
}

impl Projection {
    fn of(table: &ScoreTable, columns: &[usize]) -> Option<Self> {
        let count = columns.len();
        let correlation = DMatrix::from_fn(count, count, |i, j| {
            table.correlation[(columns[i], columns[j])]
        });
        let lower = Cholesky::new(correlation)?.unpack();
        let score = DVector::from_fn(count, |i, _| table.z[columns[i]]);
        Some(Self {
            whitened: lower.solve_lower_triangular(&score)?,
            columns: columns.to_vec(),
            lower,
        })
    }

    /// Of no columns.
    fn none() -> Self {
        Self {
            columns: Vec::new(),
            lower: DMatrix::zeros(0, 0),
            whitened: DVector::zeros(0),
        }
    }
}

/// The scores of a record on `effects` with another effect in its model, at its best onset there.
pub(crate) fn given(table: &ScoreTable, named: &str, effects: &[&str]) -> ScoreTable {
    let own = table.effects.iter().find(|own| own.id == named);
    let variants = own.iter().flat_map(|own| &own.variants);
    let statistic = |columns: &[usize]| {
        let joint = Projection::of(table, columns);
        joint.map_or(f64::NEG_INFINITY, |joint| joint.whitened.norm_squared())
    };
    let best = variants.max_by(|a, b| statistic(a).total_cmp(&statistic(b)));
    let projection = best.and_then(|best| Projection::of(table, best));
    let projection = projection.unwrap_or_else(Projection::none);
    let kept = |effect: &&ScoredEffect| effect.id != named && effects.contains(&&*effect.id);
    let kept: Vec<&ScoredEffect> = table.effects.iter().filter(kept).collect();
    let mut columns: Vec<usize> = kept
        .iter()
        .flat_map(|one| one.variants.iter().flatten())
        .copied()
        .collect();
    columns.sort_unstable();
    columns.dedup();
    // L⁻¹ of the correlation of the named effect with each column: what is projected out.
    let mut taken = DMatrix::from_fn(projection.columns.len(), columns.len(), |i, j| {
        table.correlation[(projection.columns[i], columns[j])]
    });
    projection.lower.solve_lower_triangular_mut(&mut taken);
    let left: Vec<f64> = (0..columns.len())
        .map(|column| 1.0 - taken.column(column).norm_squared())
        .collect();
    let seen: Vec<usize> = (0..columns.len())
        .filter(|column| left[*column] > VISIBLE)
        .collect();
    let place = |column: &usize| {
        let before = columns.binary_search(column).ok()?;
        seen.binary_search(&before).ok()
    };
    let effects = kept.iter().filter_map(|effect| {
        let variants = effect.variants.iter();
        let variants: Vec<Vec<usize>> = variants
            .filter_map(|variant| variant.iter().map(place).collect())
            .collect();
        (!variants.is_empty()).then(|| ScoredEffect {
            variants,
            ..(*effect).clone()
        })
    });
    let root = |place: usize| left[seen[place]].sqrt();
    let taken_of = |place: usize| taken.column(seen[place]);
    ScoreTable {
        effects: effects.collect(),
        in_model: table.in_model.clone(),
        z: (0..seen.len())
            .map(|i| {
                let raw = table.z[columns[seen[i]]];
                (raw - taken_of(i).dot(&projection.whitened)) / root(i)
            })
            .collect(),
        root_information: (0..seen.len())
            .map(|i| table.root_information[columns[seen[i]]] * root(i))
            .collect(),
        correlation: DMatrix::from_fn(seen.len(), seen.len(), |i, j| {
            let raw = table.correlation[(columns[seen[i]], columns[seen[j]])];
            (raw - taken_of(i).dot(&taken_of(j))) / (root(i) * root(j))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_twin_is_left_with_what_the_named_effect_does_not_explain() {
        let effect = |id: &str, column| ScoredEffect {
            id: id.to_owned(),
            unit: String::new(),
            persists: true,
            variants: vec![vec![column]],
        };
        let table = ScoreTable {
            effects: vec![effect("a", 0), effect("b", 1), effect("same", 2)],
            in_model: Vec::new(),
            z: vec![5.0, 4.0, 5.0],
            root_information: vec![1.0, 10.0, 1.0],
            correlation: DMatrix::from_row_slice(
                3,
                3,
                &[1.0, 0.8, 1.0, 0.8, 1.0, 0.8, 1.0, 0.8, 1.0],
            ),
        };
        let left = given(&table, "a", &["a", "b", "same"]);
        // What a does not explain of b: (4 − 0.8·5)/0.6; nothing is left of an exact equivalent.
        assert_eq!(left.effects.len(), 1);
        assert_eq!(left.effects[0].id, "b");
        assert!(left.z[0].abs() < 1e-12);
        assert!((left.root_information[0] - 6.0).abs() < 1e-12);
        // An effect that the record does not show takes nothing away.
        assert_eq!(given(&table, "other", &["a", "b"]).z, [5.0, 4.0]);
    }
}
