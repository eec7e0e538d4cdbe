use gyrocal::EFFECTS;
use nalgebra::{DMatrix, DVector};

use super::*;

/// Five columns of unit length, each of one effect, the last two equal up to rounding, with 1000
/// values: the penalty for a size is ln 1000 = 6.9.
fn library_with(scores: [f64; 5]) -> (ProjectedScores, Vec<LibraryEntry>) {
    let mut information = DMatrix::identity(5, 5);
    (information[(3, 4)], information[(4, 3)]) = (1.0 - 1e-9, 1.0 - 1e-9);
    let scores = ProjectedScores::of(information, DVector::from_row_slice(&scores), 1000);
    let library = [
        "gyro_x.g_y",
        "gyro_x.g_z",
        "gyro_y.g_z",
        "gyro_x.g_yy",
        "gyro_x.g_zz",
    ]
    .iter()
    .enumerate()
    .filter_map(|(column, id)| {
        Some(LibraryEntry {
            effect: EFFECTS.iter().find(|effect| effect.id == *id)?,
            has_shape: false,
            signature: Signature {
                columns: vec![column],
                scale: 1.0,
            },
        })
    })
    .collect();
    (scores, library)
}

fn names(method: BaselineMethod, scores: [f64; 5]) -> Vec<String> {
    let (scores, library) = library_with(scores);
    let (result, _) = method.apply(&scores, &library);
    assert_eq!(result.detected, !result.names.is_empty());
    result.names
}

#[test]
fn both_select_significant_effects_only() {
    for method in [BaselineMethod::Bic, BaselineMethod::Stls] {
        assert!(
            names(method, [1.0, -2.0, 0.5, 0.1, 0.1]).is_empty(),
            "{method:?}"
        );
        let found = names(method, [4.0, -7.0, 0.5, 0.1, 0.1]);
        assert_eq!(found, ["gyro_x.g_z", "gyro_x.g_y"], "{method:?}");
    }
    // 2.6 squared is below the penalty, 2.7 squared above.
    assert!(names(BaselineMethod::Bic, [2.6, 0.0, 0.0, 0.0, 0.0]).is_empty());
    assert_eq!(
        names(BaselineMethod::Bic, [2.7, 0.0, 0.0, 0.0, 0.0]).len(),
        1
    );
}

#[test]
fn of_equal_columns_one_is_selected() {
    assert_eq!(
        names(BaselineMethod::Bic, [0.0, 0.0, 0.0, 8.0, 8.0]).len(),
        1
    );
}
