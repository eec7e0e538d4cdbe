//! Small matrices of sizes known at run time, by rows.
//!
//! A caller that gives a constant for the number of rows has the loops unrolled.

/// to = left · right; `left` is n × n, `right` has n rows of `width` numbers.
#[inline(always)]
pub(crate) fn product(left: &[f64], right: &[f64], n: usize, width: usize, to: &mut [f64]) {
    for i in 0..n {
        let target = &mut to[i * width..(i + 1) * width];
        let by = &left[i * n..(i + 1) * n];
        for (value, right) in target.iter_mut().zip(&right[..width]) {
            *value = by[0] * right;
        }
        for j in 1..n {
            // Walks, and states that others do not feel.
            if by[j] != 0.0 {
                let row = &right[j * width..(j + 1) * width];
                for (value, right) in target.iter_mut().zip(row) {
                    *value += by[j] * right;
                }
            }
        }
    }
}

/// matrix = map · matrix · mapᵀ of a symmetric matrix, symmetric to the last bit; `memory` has its size.
#[inline(always)]
pub(crate) fn sandwich(map: &[f64], matrix: &mut [f64], n: usize, memory: &mut [f64]) {
    product(map, matrix, n, n, memory);
    for i in 0..n {
        for j in 0..=i {
            let sum = dot(&memory[i * n..(i + 1) * n], &map[j * n..(j + 1) * n]);
            matrix[i * n + j] = sum;
            matrix[j * n + i] = sum;
        }
    }
}

/// The scalar product.
#[inline(always)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// to = matrix · vector.
#[inline(always)]
pub(crate) fn apply(matrix: &[f64], vector: &[f64], to: &mut [f64]) {
    let n = vector.len();
    for (i, value) in to.iter_mut().enumerate() {
        *value = dot(&matrix[i * n..(i + 1) * n], vector);
    }
}

/// vector = matrixᵀ · vector.
#[inline(always)]
pub(crate) fn apply_transposed(matrix: &[f64], vector: &mut [f64], memory: &mut [f64]) {
    memory.fill(0.0);
    for (value, row) in vector.iter().zip(matrix.chunks_exact(memory.len())) {
        for (sum, element) in memory.iter_mut().zip(row) {
            *sum += value * element;
        }
    }
    vector.copy_from_slice(memory);
}

/// Adds a lower triangle times a factor to a symmetric matrix.
#[inline(always)]
pub(crate) fn add_triangle(matrix: &mut [f64], n: usize, triangle: &[f64], factor: f64) {
    let mut elements = triangle.iter();
    for i in 0..n {
        for (j, element) in (0..=i).zip(&mut elements) {
            matrix[i * n + j] += factor * element;
            if j < i {
                matrix[j * n + i] += factor * element;
            }
        }
    }
}

/// vᵀ A⁻¹ v; `None` if A is not positive definite.
pub(crate) fn squared(matrix: &[f64], vector: &[f64]) -> Option<f64> {
    let n = vector.len();
    let mut lower = vec![0.0; n * n];
    let mut solution = vec![0.0; n];
    let mut total = 0.0;
    for i in 0..n {
        for j in 0..=i {
            let (own, other) = (&lower[i * n..i * n + j], &lower[j * n..j * n + j]);
            let sum = matrix[i * n + j] - dot(own, other);
            if j < i {
                lower[i * n + j] = sum / lower[j * n + j];
            } else if sum > 0.0 && sum.is_finite() {
                lower[i * n + i] = sum.sqrt();
            } else {
                return None;
            }
        }
        let left = vector[i] - dot(&lower[i * n..i * n + i], &solution[..i]);
        solution[i] = left / lower[i * n + i];
        total += solution[i] * solution[i];
    }
    Some(total)
}
