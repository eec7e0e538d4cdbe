//! The rows of a panel that are drawn: gaps, and extremes of long columns.

use crate::polyline::longest_interval;

/// A panel of no more rows keeps all.
pub(super) const MOST_ROWS: usize = 6000;

/// Stretches of a longer one.
const STRETCHES: usize = 1500;

/// Missing values shorter than this part of a stretch are not shown in a decimated panel.
const SHORTEST_GAP: usize = 8;

/// A row to draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Row {
    /// A row of the panel.
    Of(usize),
    /// A break of all lines at this abscissa.
    Break(f64),
}

/// The rows to draw, in their order.
pub(super) fn rows<'a>(
    abscissa: &[f64],
    columns: impl Iterator<Item = &'a [f64]>,
    no_gaps: bool,
) -> Vec<Row> {
    let kept = match abscissa.len() {
        few if few <= MOST_ROWS => (0..few).collect(),
        _ => extremes(abscissa.len(), columns),
    };
    let longest = longest_interval(abscissa, no_gaps);
    let mut rows = Vec::with_capacity(kept.len());
    for (place, &row) in kept.iter().enumerate() {
        let before = place.checked_sub(1).map(|before| kept[before]);
        if let Some(start) = before.and_then(|before| gap(&abscissa[before..=row], longest)) {
            rows.push(Row::Break(start));
        }
        rows.push(Row::Of(row));
    }
    rows
}

/// The middle of the first interval that is a gap.
fn gap(abscissa: &[f64], longest: f64) -> Option<f64> {
    let mut pairs = abscissa.windows(2);
    let found = pairs.find(|pair| pair[1] - pair[0] > longest)?;
    Some(0.5 * (found[0] + found[1]))
}

/// First and last row of each stretch, and of each column its extremes and long gaps.
fn extremes<'a>(count: usize, columns: impl Iterator<Item = &'a [f64]>) -> Vec<usize> {
    let ends = |stretch: usize| stretch * count / STRETCHES;
    let mut kept = Vec::with_capacity(8 * STRETCHES);
    for stretch in 0..STRETCHES {
        kept.extend([ends(stretch), ends(stretch + 1) - 1]);
    }
    for column in columns {
        for stretch in 0..STRETCHES {
            let rows = ends(stretch)..ends(stretch + 1);
            let start = rows.start;
            let values = &column[rows];
            let present = || {
                values
                    .iter()
                    .enumerate()
                    .filter(|(_, value)| !value.is_nan())
            };
            let lowest = present().min_by(|a, b| a.1.total_cmp(b.1));
            let highest = present().max_by(|a, b| a.1.total_cmp(b.1));
            kept.extend(
                lowest
                    .into_iter()
                    .chain(highest)
                    .map(|(row, _)| start + row),
            );
            kept.extend(longest_missing(values).map(|row| start + row));
        }
    }
    kept.sort_unstable();
    kept.dedup();
    // An end of a stretch may be a single missing value.
    kept
}

/// The first row of a long run of missing values, if there is one.
fn longest_missing(values: &[f64]) -> Option<usize> {
    let enough = (values.len() / SHORTEST_GAP).max(1);
    let mut run = 0;
    for (row, value) in values.iter().enumerate() {
        run = if value.is_nan() { run + 1 } else { 0 };
        if run == enough {
            return Some(row + 1 - run);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(rows: &[Row], column: &[f64]) -> Vec<f64> {
        let values = rows.iter().map(|row| match row {
            Row::Of(row) => column[*row],
            Row::Break(_) => f64::NAN,
        });
        values.collect()
    }

    #[test]
    fn a_long_column_keeps_its_extremes_and_its_gaps() {
        let count = 1_000_000;
        let time: Vec<f64> = (0..count).map(f64::from).collect();
        let mut values: Vec<f64> = time.iter().map(|t| (0.1 * t).sin()).collect();
        values[314_159] = 7.0;
        values[271_828] = -5.0;
        values[500_000..501_000].fill(f64::NAN);
        let rows = rows(&time, core::iter::once(&*values), false);
        assert!(rows.len() < 4 * STRETCHES + 10, "{}", rows.len());
        let kept = all(&rows, &values);
        assert!(kept.contains(&7.0) && kept.contains(&-5.0));
        assert!(kept.iter().any(|value| value.is_nan()));
    }

    #[test]
    fn a_wide_interval_is_a_break() {
        let time = [0.0, 1.0, 2.0, 10.0, 11.0];
        let values = [0.0; 5];
        let with_break = rows(&time, core::iter::once(&values[..]), false);
        assert_eq!(with_break[3], Row::Break(6.0));
        let without = rows(&time, core::iter::once(&values[..]), true);
        assert_eq!(without.len(), 5);
    }
}
