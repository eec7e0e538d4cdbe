//! Outliers of the innovations, looked for in the readings.

use super::outlier::{Outlier, REACH};

/// Half of an outlier over the standard deviation of a prediction from its neighbours above which that must show
/// it: noise hides one such in a hundred.
const SHOWN_SIGMAS: f64 = 2.3;

/// Part of an outlier by which readings may miss the way of those on one side of it and be on it: outliers, whose sizes
/// are arbitrary, are by chance in one of ten.
const ON_THE_WAY: f64 = 0.1;

/// Keeps the outliers of an axis that the readings \[g\] show as well. A filter without a large effect that
/// changes fast is led astray, and its innovations jump from row to row; the readings follow the motion. After a
/// jump of the attitude they go on from the row of the jump.
pub(crate) fn retain_those_in_readings(outliers: &mut Vec<Outlier>, accel_g: &[[f64; 3]]) {
    let mut sound = vec![true; accel_g.len()];
    for outlier in outliers.iter() {
        sound[outlier.row] = false;
    }
    outliers.retain(|one| {
        let by_sound = shown_by(one, accel_g, |row| sound[row]);
        // Amid many outliers no reading is sound: all are taken.
        by_sound.or_else(|| shown_by(one, accel_g, |_| true)) != Some(false)
            && !belongs_to_a_side(one, accel_g, |row| sound[row])
    });
}

/// Whether a reading is on the way of the nearest of the readings `taken` on one side, as far as noise lets tell: that of
/// an outlier and the next one on that side, each by the parabola through the three behind it. Where rows are so far
/// apart that a parabola misses the next one as well, nothing is told.
fn belongs_to_a_side(
    outlier: &Outlier,
    accel_g: &[[f64; 3]],
    taken: impl Fn(usize) -> bool,
) -> bool {
    let own = (0.0, accel_g[outlier.row][outlier.axis]);
    let is_told = |spread: f64| ON_THE_WAY * outlier.deviation.abs() > SHOWN_SIGMAS * spread;
    let follows = |(at, value): (f64, f64), behind: &[(f64, f64)]| {
        let behind: Vec<_> = behind.iter().map(|(row, one)| (row - at, *one)).collect();
        let (predicted, spread) = at_zero(&behind);
        is_told(spread) && (value - predicted).abs() < ON_THE_WAY * outlier.size_g.abs()
    };
    sides(outlier, accel_g, taken)
        .iter()
        .any(|side| side.len() == 4 && follows(side[0], &side[1..]) && follows(own, &side[..3]))
}

/// Up to four of the nearest readings `taken` of the axis of an outlier, before it and after it, with their
/// distances in rows.
fn sides(
    outlier: &Outlier,
    accel_g: &[[f64; 3]],
    taken: impl Fn(usize) -> bool,
) -> [Vec<(f64, f64)>; 2] {
    let Outlier { row, axis, .. } = *outlier;
    let value = |other: &usize| taken(*other) && !accel_g[*other][axis].is_nan();
    let at = |other: usize| (other as f64 - row as f64, accel_g[other][axis]);
    let near = row.saturating_sub(REACH)..(row + REACH + 1).min(accel_g.len());
    let before = (near.start..row).rev().filter(&value).map(at).take(4);
    let after = (row + 1..near.end).filter(&value).map(at).take(4);
    [before.collect(), after.collect()]
}

/// Whether a prediction from the nearest of the readings `taken` shows an outlier: the cubic through two on
/// either side, or the parabola through three of one; `None` if noise may hide it from each.
fn shown_by(
    outlier: &Outlier,
    accel_g: &[[f64; 3]],
    taken: impl Fn(usize) -> bool,
) -> Option<bool> {
    let own = accel_g[outlier.row][outlier.axis];
    let [before, after] = sides(outlier, accel_g, taken);
    let two_of_each = before.len() >= 2 && after.len() >= 2;
    let both = two_of_each.then(|| [&before[..2], &after[..2]].concat());
    let one_side = [before, after]
        .into_iter()
        .filter_map(|side| Some(side.get(..3)?.to_vec()));
    let shows = |points: Vec<(f64, f64)>| {
        let (predicted, spread) = at_zero(&points);
        let half = 0.5 * outlier.deviation.abs();
        (half > SHOWN_SIGMAS * spread)
            .then_some((own - predicted).abs() > 0.5 * outlier.size_g.abs())
    };
    both.into_iter()
        .chain(one_side)
        .filter_map(shows)
        .reduce(|any, one| any || one)
}

/// The polynomial through points at zero (Lagrange), and the standard deviation of a value there less it, for
/// values of unit variance.
fn at_zero(points: &[(f64, f64)]) -> (f64, f64) {
    let weight = |(index, (own, _)): (usize, &(f64, f64))| -> f64 {
        let others = points
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != index);
        others.map(|(_, (at, _))| at / (at - own)).product()
    };
    let weights: Vec<f64> = points.iter().enumerate().map(weight).collect();
    let value = weights
        .iter()
        .zip(points)
        .map(|(weight, (_, value))| weight * value);
    let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
    (value.sum(), (1.0 + squares).sqrt())
}

#[cfg(test)]
mod tests {
    use gyrocal_statistics::deviates::Draw;

    use super::retain_those_in_readings;
    use crate::noise::outlier::Outlier;

    /// Readings of a platform that turns with the Earth's rate, a row each four minutes, with noise of a
    /// hundred thousandth and errors of these rows in the same unit.
    fn readings(seed: u64, errors: &[(usize, f64)]) -> Vec<[f64; 3]> {
        let mut random = Draw::new(seed, 1);
        let mut all: Vec<[f64; 3]> = (0..100)
            .map(|row| {
                [
                    (0.0175 * f64::from(row)).sin() + 1e-5 * random.normal(),
                    0.0,
                    0.0,
                ]
            })
            .collect();
        for (row, error) in errors {
            all[*row][0] += 1e-5 * error;
        }
        all
    }

    fn outliers(of: &[(usize, f64)]) -> Vec<Outlier> {
        let outlier = |(row, deviation): &(usize, f64)| Outlier {
            row: *row,
            axis: 0,
            size_g: 1e-5 * deviation,
            deviation: *deviation,
        };
        of.iter().map(outlier).collect()
    }

    #[test]
    fn outliers_of_the_readings_are_kept() {
        // At both ends, among sound readings, small, and beside each other.
        let errors = [
            (0, 40.0),
            (30, 12.0),
            (50, 5.0),
            (70, 60.0),
            (71, -60.0),
            (99, -40.0),
        ];
        for seed in 0..20 {
            let mut found = outliers(&errors);
            retain_those_in_readings(&mut found, &readings(seed, &errors));
            assert_eq!(found, outliers(&errors), "{seed}");
        }
    }

    /// Rows half an hour apart: a parabola misses the next one by two hundred sigmas, as far as these outliers do.
    #[test]
    fn outliers_among_rows_that_are_far_apart_are_kept() {
        for (seed, size) in (0..200).map(|seed| (seed, 100.0 + 2.0 * seed as f64)) {
            let mut random = Draw::new(seed, 3);
            let mut readings: Vec<[f64; 3]> = (0..60)
                .map(|row| {
                    [
                        (0.131 * f64::from(row)).sin() + 1e-5 * random.normal(),
                        0.0,
                        0.0,
                    ]
                })
                .collect();
            let row = 5 + (seed % 50) as usize;
            let size = if seed % 2 == 0 { size } else { -size };
            readings[row][0] += 1e-5 * size;
            let mut found = outliers(&[(row, size)]);
            retain_those_in_readings(&mut found, &readings);
            assert_eq!(found.len(), 1, "{seed}");
        }
    }

    #[test]
    fn many_outliers_are_kept() {
        // A tenth of all values: of one in three another is within two rows.
        let mut random = Draw::new(1, 2);
        let (mut kept, mut all) = (0, 0);
        for seed in 0..200 {
            let rows = (0..100).filter(|_| random.uniform() < 0.1);
            let errors: Vec<(usize, f64)> = rows.map(|row| (row, 300.0)).collect();
            let mut found = outliers(&errors);
            retain_those_in_readings(&mut found, &readings(seed, &errors));
            kept += found.len();
            all += errors.len();
        }
        // One that is lost leads the fit astray.
        assert_eq!(kept, all);
    }

    /// The filter needs a row to follow: what it has of that row is no outlier.
    #[test]
    fn the_row_of_a_jump_is_no_outlier() {
        for (seed, row) in (0..20).zip([1, 40, 95].into_iter().cycle()) {
            let jump: Vec<(usize, f64)> = (row..100).map(|row| (row, 800.0)).collect();
            let mut found = outliers(&[(row, 800.0)]);
            retain_those_in_readings(&mut found, &readings(seed, &jump));
            assert!(found.is_empty(), "{seed}: {found:?}");
        }
    }

    #[test]
    fn outliers_that_only_the_filter_has_are_dropped() {
        let mut jumping: Vec<(usize, f64)> = (20..46).map(|row| (row, 1000.0)).collect();
        jumping.extend([(60, 12.0), (80, -30.0)]);
        for seed in 0..20 {
            let mut found = outliers(&jumping);
            retain_those_in_readings(&mut found, &readings(seed, &[]));
            assert!(found.is_empty(), "{seed}: {found:?}");
        }
    }
}
