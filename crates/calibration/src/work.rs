//! Work of passes over records, counted in rows and columns: the same on every machine.

use core::cell::Cell;

thread_local! {
    static SPENT: Cell<u64> = const { Cell::new(0) };
    static OF_A_ROW: Cell<u64> = const { Cell::new(0) };
}

/// Work of the step of the model and of the filter at a row, in products: it takes as long as so many of a
/// matrix multiplication, twelve thousand where that has vectors of eight numbers and four thousand where it
/// has none.
const MODEL: u64 = 8000;

/// Work of one derivative of the filter by the logarithm of a noise at a row, beside that of its columns:
/// with random walks a third of the step, without a tenth.
const DERIVATIVE: u64 = 2000;

/// Columns that the streaming filter carries: its states.
const FILTER: usize = 12;

/// Work of all passes over records that this thread has made so far, in products of the sums of their
/// Gram matrices: each row of a pass counts the square of its columns, and constants for the model and for
/// derivatives by the noise. It is proportional to the time, within a factor of two.
/// The difference of two values is the work done between them.
#[must_use]
pub fn work() -> u64 {
    SPENT.get()
}

/// The rows that follow carry so many columns.
pub(crate) fn carry(columns: usize) {
    // Residual and three moving states beside the columns; half of a symmetric matrix, three outputs.
    let columns = columns as u64 + 4;
    OF_A_ROW.set(MODEL + 3 * columns * columns / 2);
}

/// They carry derivatives of the filter by so many noises beside.
pub(crate) fn differentiate(derivatives: usize) {
    let products = derivatives as u64 * DERIVATIVE;
    OF_A_ROW.set(OF_A_ROW.get() + products);
}

/// A pass has gone over so many rows.
pub(crate) fn count_rows(rows: usize) {
    let all = OF_A_ROW.get().wrapping_mul(rows as u64);
    SPENT.set(SPENT.get().wrapping_add(all));
}

/// A streaming filter has come to a row.
pub(crate) fn count_filtered_row() {
    carry(FILTER);
    count_rows(1);
}
