//! Rows at which a fast record jumps.

use gyrocal_record::Record;

/// A difference of means of rows of white noise exceeds this in one of some thousand records of a million rows; a block
/// that is divided there loses its smaller part.
const JUMP_SIGMAS: f64 = 6.0;

/// Length of the rows that are compared over that without a gap, beyond which they are not.
const GAP: f64 = 1.01;

/// Least share of the rows of a mean that are not missing.
const ENOUGH: f64 = 0.5;

/// Rows at which the specific force jumps: the means of two blocks on both sides differ by more than the slope of two
/// further ones makes of it. A jump that is too small for that moves the mean of its block by four of its standard
/// deviations at most.
pub(super) fn jumps(
    record: &Record,
    (interval_s, rows): (f64, usize),
    noise_g: [f64; 3],
) -> Vec<usize> {
    let width = 2 * rows;
    if record.len() < 4 * width {
        return Vec::new();
    }
    // Running sums and counts, in standard deviations.
    let mut sums: [Vec<(f64, f64)>; 3] = Default::default();
    for (axis, (own, noise_g)) in sums.iter_mut().zip(noise_g).enumerate() {
        let values: Vec<f64> = record.accel_g.iter().map(|row| row[axis]).collect();
        let whole = without_holes(&values);
        let first = whole.first().copied().unwrap_or(0.0);
        let (mut sum, mut count) = (0.0, 0.0);
        own.push((sum, count));
        for (value, whole) in values.iter().zip(whole) {
            sum += (whole - first) / noise_g;
            count += f64::from(u8::from(!value.is_nan()));
            own.push((sum, count));
        }
    }
    // Difference of neighbouring means less a third of that of those beyond them: variance 2 (1 + 1/9) over the width.
    let spread = (20.0 / 9.0 / width as f64).sqrt();
    let difference = |own: &[(f64, f64)], row: usize| -> f64 {
        let mean = |from: usize| {
            let ((a, before), (b, after)) = (own[from], own[from + width]);
            let is_whole = after - before >= ENOUGH * width as f64;
            if is_whole {
                (b - a) / width as f64
            } else {
                f64::NAN
            }
        };
        let [first, left, right, last] =
            [2, 1, 0, -1].map(|back: isize| mean(row.wrapping_add_signed(-back * width as isize)));
        (right - left - (last - first) / 3.0) / spread
    };
    let mut jumps: Vec<(usize, f64)> = Vec::new();
    for row in 2 * width..=record.len() - 2 * width {
        let span_s = record.time_s[row + 2 * width - 1] - record.time_s[row - 2 * width];
        if span_s > GAP * (4 * width) as f64 * interval_s {
            continue;
        }
        // A missing mean is NaN, which the maximum leaves out.
        let most = sums
            .iter()
            .fold(0.0_f64, |most, own| most.max(difference(own, row).abs()));
        if most < JUMP_SIGMAS {
            continue;
        }
        match jumps.last_mut().filter(|(last, _)| row - *last < width) {
            Some(last) if last.1 >= most => {}
            Some(last) => *last = (row, most),
            None => jumps.push((row, most)),
        }
    }
    jumps.into_iter().map(|(row, _)| row).collect()
}

/// Values with lines over the missing ones: the specific force may change by many standard deviations from row to row, so
/// that a mean without them would stand at another time. Before the first and behind the last stand these.
fn without_holes(values: &[f64]) -> Vec<f64> {
    let mut whole = values.to_vec();
    let mut last: Option<usize> = None;
    for (row, value) in values.iter().enumerate() {
        if value.is_nan() {
            continue;
        }
        if last.is_none() {
            whole[..row].fill(*value);
        }
        if let Some(last) = last {
            let holes = whole[last..row].iter_mut().enumerate().skip(1);
            for (place, hole) in holes {
                let share = place as f64 / (row - last) as f64;
                *hole = values[last] + share * (value - values[last]);
            }
        }
        last = Some(row);
    }
    if let Some(last) = last {
        whole[last..].fill(values[last]);
    }
    whole
}
