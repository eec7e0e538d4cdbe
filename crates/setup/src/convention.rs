//! Conventions in which initial angles are mistaken.

use crate::vector::{Vector, dot};

/// A rotation matrix by rows.
pub(crate) type Matrix = [Vector; 3];

/// The attitude that the bench file means: platform against east, north, up, by turns about x, then
/// the new y, then the new z.
pub(crate) fn platform_c_enu(angles_deg: Vector) -> Matrix {
    in_order(angles_deg, [0, 1, 2])
}

/// The attitudes that the same angles mean by other conventions, and their names.
pub(crate) fn conventions(angles_deg: Vector) -> Vec<(&'static str, Matrix)> {
    let [x, y, z] = angles_deg;
    let usual = platform_c_enu(angles_deg);
    let of = platform_c_enu;
    let against = |frame_c_enu| product(usual, frame_c_enu);
    let order = |order| in_order(angles_deg, order);
    vec![
        ("angles in radians", of(angles_deg.map(f64::to_degrees))),
        ("all angles negated", of([-x, -y, -z])),
        ("the inverse rotation", transposed(usual)),
        ("angles in the order z, y, x", order([2, 1, 0])),
        ("angles in the order z, x, y", order([2, 0, 1])),
        ("angles in the order y, x, z", order([1, 0, 2])),
        ("angles in the order y, z, x", order([1, 2, 0])),
        ("angles in the order x, z, y", order([0, 2, 1])),
        ("the third angle negated", of([x, y, -z])),
        ("the second angle negated", of([x, -y, z])),
        ("the first angle negated", of([-x, y, z])),
        ("the first two angles exchanged", of([y, x, z])),
        ("the last two angles exchanged", of([x, z, y])),
        ("the first and the last angle exchanged", of([z, y, x])),
        ("angles against north, east, down", against(NED_C_ENU)),
        ("angles against north, west, up", against(NWU_C_ENU)),
        ("the third angle off by 180 deg", of([x, y, z + 180.0])),
        ("the third angle off by 90 deg", of([x, y, z + 90.0])),
        ("the third angle off by -90 deg", of([x, y, z - 90.0])),
    ]
}

const NED_C_ENU: Matrix = [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]];
const NWU_C_ENU: Matrix = [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];

/// Turns about the axes in an order, each about the axis that the earlier ones left.
fn in_order(angles_deg: Vector, order: [usize; 3]) -> Matrix {
    let [first, second, third] = order.map(|axis| about(axis, angles_deg[axis].to_radians()));
    product(third, product(second, first))
}

/// Components in a frame that is turned about an axis.
fn about(axis: usize, angle_rad: f64) -> Matrix {
    let (sine, cosine) = angle_rad.sin_cos();
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut matrix = [[0.0; 3]; 3];
    matrix[axis][axis] = 1.0;
    matrix[next][next] = cosine;
    matrix[last][last] = cosine;
    matrix[next][last] = sine;
    matrix[last][next] = -sine;
    matrix
}

fn product(a: Matrix, b: Matrix) -> Matrix {
    let columns = transposed(b);
    a.map(|row| columns.map(|column| dot(row, column)))
}

fn transposed(a: Matrix) -> Matrix {
    core::array::from_fn(|i| core::array::from_fn(|j| a[j][i]))
}

/// A matrix times a vector.
pub(crate) fn times(matrix: Matrix, vector: Vector) -> Vector {
    matrix.map(|row| dot(row, vector))
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyrocal_truth::Attitude;

    #[test]
    fn the_usual_convention_is_that_of_the_simulator() {
        let angles_deg = [20.0, -50.0, 130.0];
        let theirs = Attitude::from_angles_rad(angles_deg.map(f64::to_radians)).matrix();
        let ours = platform_c_enu(angles_deg);
        for (a, b) in ours.iter().flatten().zip(theirs.iter().flatten()) {
            // Rounding of a few products.
            assert!((a - b).abs() < 1e-14, "{ours:?} {theirs:?}");
        }
    }
}
