use gyrocal::EFFECTS;
use nalgebra::{DMatrix, DVector};

use super::*;

/// Five columns of unit length, one of three known effects each, the last two the same but for
/// rounding, with 1000 values: a size costs ln 1000 = 6.9.
fn bank(scores: [f64; 5]) -> (Bank, Vec<Entry>) {
    let mut information = DMatrix::identity(5, 5);
    (information[(3, 4)], information[(4, 3)]) = (1.0 - 1e-9, 1.0 - 1e-9);
    let bank = Bank::of(information, DVector::from_row_slice(&scores), 1000);
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
        Some(Entry {
            effect: EFFECTS.iter().find(|effect| effect.id == *id)?,
            searched_shape: false,
            signature: Signature {
                columns: vec![column],
                scale: 1.0,
            },
        })
    })
    .collect();
    (bank, library)
}

fn names(method: Method, scores: [f64; 5]) -> Vec<String> {
    let (bank, library) = bank(scores);
    let (called, _) = method.call(&bank, &library);
    assert_eq!(called.detected, !called.names.is_empty());
    called.names
}

#[test]
fn both_name_what_is_large_and_nothing_else() {
    for method in [Method::Bic, Method::Stls] {
        assert!(
            names(method, [1.0, -2.0, 0.5, 0.1, 0.1]).is_empty(),
            "{method:?}"
        );
        let found = names(method, [4.0, -7.0, 0.5, 0.1, 0.1]);
        assert_eq!(found, ["gyro_x.g_z", "gyro_x.g_y"], "{method:?}");
    }
    // 2.6 squared is less than what a size costs, 2.7 squared is more.
    assert!(names(Method::Bic, [2.6, 0.0, 0.0, 0.0, 0.0]).is_empty());
    assert_eq!(names(Method::Bic, [2.7, 0.0, 0.0, 0.0, 0.0]).len(), 1);
}

#[test]
fn of_columns_that_are_one_selection_takes_one() {
    assert_eq!(names(Method::Bic, [0.0, 0.0, 0.0, 8.0, 8.0]).len(), 1);
}
