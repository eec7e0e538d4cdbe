//! Detection of outliers: isolated samples far outside the noise.

use core::ops::Range;

use gyrocal_statistics::{robust_sigma, student_two_sided_p, theil_sen_at_zero};

/// Number of rows on either side of a sample in the comparison.
pub(super) const REACH: usize = 8;
/// Number of values of a comparison with one side alone.
const SIDE: usize = 8;
/// Rows on a side that a test of isolation looks at: twice as many as values, since some are missing, for the
/// line beside a sample, and as many for that beside the last of these.
const ROWS_BESIDE: usize = 4 * SIDE;
/// Smallest number of values on a side for the quadratic fit.
const LEAST_SIDE: usize = 3;
/// Smallest distance of an isolated sample from the line through either side alone, in standard
/// deviations. Of the first samples after a step or a kink one in four hundred exceeds it.
const ISOLATED_SIGMAS: f64 = 3.0;
/// Distance in standard deviations beyond which a sample is more likely an outlier than noise, given
/// that there are outliers: with half a percent of them at 8 sigma the densities are equal at 4.7.
/// Noise alone exceeds 4.5 once in 150 000 samples.
const OUTLIER_SIGMAS: f64 = 4.5;

/// An outlier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outlier {
    /// Row of the record, counted from 0.
    pub row: usize,
    /// Axis: 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// Distance of the sample from its neighbours \[g\].
    pub size_g: f64,
    /// The same in standard deviations of the estimated noise.
    pub deviation: f64,
}

impl Outlier {
    /// Row and axis.
    pub(crate) fn place(&self) -> [usize; 2] {
        [self.row, self.axis]
    }
}

/// Outliers of an axis and the number of samples tested.
pub(crate) struct Search {
    pub(crate) outliers: Vec<(usize, f64, f64)>,
    pub(crate) samples: usize,
}

impl Search {
    /// Two-sided p-value of a deviation of one sample, by Student's distribution, since the scale is
    /// estimated from the samples. Neighbouring residuals share samples and count half.
    pub(crate) fn single_p(&self, deviation: f64) -> f64 {
        let degrees = (0.5 * self.samples as f64).max(1.0);
        student_two_sided_p(deviation, degrees).unwrap_or(1.0)
    }
}

/// First tested row of a run. After a gap the filter settles again, and the first samples deviate
/// from their neighbours.
fn begin(run: &Range<usize>, first: usize) -> usize {
    let after_gap = if run.start > 0 { REACH } else { 0 };
    (run.start + after_gap).max(first)
}

/// Searches a series (unit: declared standard deviation; `NaN` is missing), run by run, from row
/// `first` on. An outlier is given by its row, its residual, and the residual over its standard
/// deviation.
#[expect(clippy::needless_range_loop, reason = "rows index several series")]
pub(crate) fn search(series: &[f64], runs: &[Range<usize>], first: usize) -> Search {
    let mut masked = series.to_vec();
    let mut residuals = vec![None; series.len()];
    let judge = |masked: &[f64], row: usize, run: &Range<usize>| {
        against_neighbours(series[row], masked, row, run)
    };
    for run in runs {
        for row in begin(run, first)..run.end {
            residuals[row] = judge(&masked, row, run);
        }
    }
    let mut sizes: Vec<f64> = residuals
        .iter()
        .flatten()
        .map(|r| r.deviation(1.0))
        .collect();
    let samples = sizes.len();
    let scale = robust_sigma(&mut sizes);
    let mut flagged: Vec<(usize, usize)> = Vec::new();
    if scale > 0.0 {
        // The largest of a neighbourhood first: it distorts the fit of the others.
        loop {
            let mut found = Vec::new();
            for (index, run) in runs.iter().enumerate() {
                for row in begin(run, first)..run.end {
                    let suspect = |row: usize| -> f64 {
                        if masked[row].is_nan() {
                            0.0
                        } else {
                            residuals[row].as_ref().map_or(0.0, |r| r.deviation(scale))
                        }
                    };
                    let own = suspect(row);
                    let neighbours =
                        row.saturating_sub(REACH).max(run.start)..(row + REACH + 1).min(run.end);
                    let largest = own > OUTLIER_SIGMAS
                        && neighbours
                            .clone()
                            .all(|other| other == row || suspect(other) <= own);
                    if largest && is_isolated(series[row], &masked, row, run, scale) {
                        found.push((row, index));
                    }
                }
            }
            if found.is_empty() {
                break;
            }
            for (row, _) in &found {
                masked[*row] = f64::NAN;
            }
            for (row, index) in &found {
                let run = &runs[*index];
                for other in
                    row.saturating_sub(REACH).max(begin(run, first))..(row + REACH + 1).min(run.end)
                {
                    residuals[other] = judge(&masked, other, run);
                }
            }
            flagged.extend(found);
        }
    }
    flagged.sort_unstable();
    let outliers = flagged
        .iter()
        .filter_map(|(row, _)| {
            residuals[*row]
                .as_ref()
                .map(|r| (*row, r.value, r.value / (r.spread * scale)))
        })
        .filter(|(_, _, deviation)| deviation.abs() > OUTLIER_SIGMAS)
        .collect();
    Search { outliers, samples }
}

#[derive(Clone, Debug)]
struct Residual {
    value: f64,
    /// Its standard deviation for samples of unit variance.
    spread: f64,
}

impl Residual {
    fn deviation(&self, scale: f64) -> f64 {
        (self.value / (self.spread * scale)).abs()
    }
}

/// Residual of a value from the quadratic through its neighbours on both sides, without itself.
fn against_neighbours(
    value: f64,
    masked: &[f64],
    row: usize,
    run: &Range<usize>,
) -> Option<Residual> {
    if value.is_nan() {
        return None;
    }
    let from = row.saturating_sub(REACH).max(run.start);
    let to = (row + REACH + 1).min(run.end);
    let mut moments = [0.0; 5];
    let mut sums = [0.0; 3];
    let mut sides = [0; 2];
    for other in (from..to).filter(|other| *other != row && !masked[*other].is_nan()) {
        let at = (other as f64 - row as f64) / REACH as f64;
        sides[usize::from(other > row)] += 1;
        let mut power = 1.0;
        for (i, moment) in moments.iter_mut().enumerate() {
            *moment += power;
            if i < 3 {
                sums[i] += power * masked[other];
            }
            power *= at;
        }
    }
    if sides[0] < LEAST_SIDE || sides[1] < LEAST_SIDE {
        return at_an_end(value, masked, row, run);
    }
    // Value of the quadratic at the sample: first row of the inverse of the moments.
    let [m0, m1, m2, m3, m4] = moments;
    let cofactors = [m2 * m4 - m3 * m3, m2 * m3 - m1 * m4, m1 * m3 - m2 * m2];
    let determinant = m0 * cofactors[0] + m1 * cofactors[1] + m2 * cofactors[2];
    let weights = cofactors.map(|cofactor| cofactor / determinant);
    let middle: f64 = weights.iter().zip(&sums).map(|(w, s)| w * s).sum();
    Some(Residual {
        value: value - middle,
        spread: (1.0 + weights[0]).sqrt(),
    })
}

/// Residual at the end of a run, from the mean of one side.
fn at_an_end(value: f64, masked: &[f64], row: usize, run: &Range<usize>) -> Option<Residual> {
    let mut near: Vec<f64> = Vec::new();
    for one_side in [
        side(masked, (run.start..row).rev(), row),
        side(masked, row + 1..run.end, row),
    ] {
        near.extend(one_side.iter().map(|(_, value)| value));
    }
    if near.len() < SIDE {
        return None;
    }
    let count = near.len() as f64;
    Some(Residual {
        value: value - near.iter().sum::<f64>() / count,
        spread: (1.0 + 1.0 / count).sqrt(),
    })
}

/// Whether a value is far from what either side alone predicts. Where there is one side only, it must be
/// farther too than the values of that side are from what those behind them predict: a series that bends,
/// as that of a filter without a large effect, is off everywhere alike, and its last value is no outlier.
fn is_isolated(value: f64, masked: &[f64], row: usize, run: &Range<usize>, scale: f64) -> bool {
    let before: Vec<usize> = (run.start..row).rev().take(ROWS_BESIDE).collect();
    let after: Vec<usize> = (row + 1..run.end).take(ROWS_BESIDE).collect();
    let of_sides = [&before, &after].map(|rows| distance(value, row, masked, rows));
    let scale = match of_sides {
        [Some(_), None] => scale.max(usual_distance(masked, &before)),
        [None, Some(_)] => scale.max(usual_distance(masked, &after)),
        _ => scale,
    };
    let mut distances = of_sides.into_iter().flatten();
    distances.all(|distance| distance > ISOLATED_SIGMAS * scale)
}

/// Distance of a value of a row from the line through other rows, over its standard deviation for samples of
/// unit variance; `None` of fewer than [`LEAST_SIDE`].
fn distance(value: f64, row: usize, masked: &[f64], rows: &[usize]) -> Option<f64> {
    let near = side(masked, rows.iter().copied(), row);
    if near.len() < LEAST_SIDE {
        return None;
    }
    theil_sen_at_zero(&near).map(|(line, spread)| (value - line).abs() / spread)
}

/// The same of the nearest of these rows, each from those behind it: a robust root mean square.
fn usual_distance(masked: &[f64], rows: &[usize]) -> f64 {
    let places = rows.iter().enumerate();
    let mut distances: Vec<f64> = places
        .filter(|(_, row)| !masked[**row].is_nan())
        .take(SIDE)
        .filter_map(|(place, row)| distance(masked[*row], *row, masked, &rows[place + 1..]))
        .collect();
    robust_sigma(&mut distances)
}

/// The nearest values on one side, with their distances in rows.
fn side(masked: &[f64], rows: impl Iterator<Item = usize>, from: usize) -> Vec<(f64, f64)> {
    rows.take(2 * SIDE)
        .map(|row| (row as f64 - from as f64, masked[row]))
        .filter(|(_, value)| !value.is_nan())
        .take(SIDE)
        .collect()
}

#[cfg(test)]
mod tests {
    use gyrocal_statistics::deviates::Draw;

    use super::search;

    /// Noise of unit variance about a parabola that rises by `bend` over the first row.
    fn bent(seed: u64, bend: f64) -> Vec<f64> {
        let mut random = Draw::new(seed, 0);
        (0..300)
            .map(|row| bend * f64::from(row * row) + random.normal())
            .collect()
    }

    #[test]
    fn the_end_of_a_bent_series_holds_no_outliers() {
        // One row beyond a line through eight, a parabola is off by some fifteen of its bends.
        for (seed, bend) in (0_u64..40).zip([0.0, 0.1, 1.0, 10.0].into_iter().cycle()) {
            let found = search(&bent(seed, bend), &[0..150, 150..300], 16);
            assert!(found.outliers.is_empty(), "{seed}: {:?}", found.outliers);
        }
    }

    #[test]
    fn an_outlier_at_the_end_of_a_run_is_found() {
        for seed in 0..10 {
            let mut series = bent(seed, 0.0);
            series[149] += 15.0;
            series[299] -= 15.0;
            let found = search(&series, &[0..150, 150..300], 16);
            let rows: Vec<usize> = found.outliers.iter().map(|one| one.0).collect();
            assert_eq!(rows, [149, 299], "{seed}");
        }
    }

    #[test]
    fn an_outlier_after_missing_values_is_found() {
        for seed in 0..10 {
            let mut series = bent(seed, 0.0);
            series[60..108].fill(f64::NAN);
            series[108] += 15.0;
            let found = search(&series, &[0..100, 100..300], 16);
            let rows: Vec<usize> = found.outliers.iter().map(|one| one.0).collect();
            assert_eq!(rows, [108], "{seed}");
        }
    }
}
