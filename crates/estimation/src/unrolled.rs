//! Loops over `W` neighbouring numbers that the compiler turns into vector instructions.

use gyrocal_scalar::Scalar;

/// `W` consecutive numbers of `slice` from `at`.
#[inline(always)]
pub(crate) fn load<T: Scalar, const W: usize>(slice: &[T], at: usize) -> [T; W] {
    let mut lanes = [T::from_f64(0.0); W];
    lanes.copy_from_slice(&slice[at..at + W]);
    lanes
}

/// `W` consecutive numbers from `at` of each of the first `R` rows of a matrix.
///
/// A loop and not `array::from_fn`: a closure that is not inlined hides from the compiler that
/// the stride is a constant.
#[inline(always)]
pub(crate) fn load_rows<T: Scalar, const R: usize, const W: usize>(
    matrix: &[T],
    stride: usize,
    at: usize,
) -> [[T; W]; R] {
    let mut rows = [[T::from_f64(0.0); W]; R];
    for (i, row) in rows.iter_mut().enumerate() {
        *row = load(matrix, i * stride + at);
    }
    rows
}

/// Writes `lanes` to `slice` from `at`.
#[inline(always)]
pub(crate) fn store<T: Scalar, const W: usize>(slice: &mut [T], at: usize, lanes: [T; W]) {
    slice[at..at + W].copy_from_slice(&lanes);
}

/// `a * factor + b`, lane by lane.
#[inline(always)]
pub(crate) fn mul_add<T: Scalar, const W: usize>(a: [T; W], factor: T, b: [T; W]) -> [T; W] {
    let mut result = b;
    for (sum, term) in result.iter_mut().zip(a) {
        *sum = term.mul_add(factor, *sum);
    }
    result
}

/// `a * b + c`, lane by lane.
#[inline(always)]
pub(crate) fn multiply_add<T: Scalar, const W: usize>(a: [T; W], b: [T; W], c: [T; W]) -> [T; W] {
    let mut result = c;
    for (sum, (a, b)) in result.iter_mut().zip(a.into_iter().zip(b)) {
        *sum = a.mul_add(b, *sum);
    }
    result
}

/// Product of two small matrices. Each sum begins with its first term: adding to zero is an operation
/// that a compiler must not leave out.
#[inline(always)]
pub(crate) fn small_product<T: Scalar, const M: usize>(
    a: &[[T; M]; M],
    b: &[[T; M]; M],
) -> [[T; M]; M] {
    let mut product = [[T::from_f64(0.0); M]; M];
    for i in 0..M {
        product[i] = b[0].map(|value| value * a[i][0]);
        for j in 1..M {
            product[i] = mul_add(b[j], a[i][j], product[i]);
        }
    }
    product
}
