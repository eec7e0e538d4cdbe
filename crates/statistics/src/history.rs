//! Functions of a series that depend on what was before, and after.

/// Play of the hysteresis of a quantity over the range of it.
pub const PLAY_OF_HYSTERESIS: f64 = 0.25;

/// Slopes of values over time: at each time, of the straight line through the values within
/// `half_width` of it by least squares. Where these are fewer than three, the neighbours are taken;
/// zero where there are none.
///
/// Times rise; both slices have the same length.
#[must_use]
pub fn local_slopes(times: &[f64], values: &[f64], half_width: f64) -> Vec<f64> {
    let sums = RunningSums::new(times, values);
    let count = times.len().min(values.len());
    within(&times[..count], half_width)
        .enumerate()
        .map(|(at, (from, to))| {
            if to - from < FEWEST {
                let near = at.saturating_sub(1)..(at + 2).min(count);
                RunningSums::new(&times[near.clone()], &values[near.clone()])
                    .line(0, near.len())
                    .slope
            } else {
                sums.line(from, to).slope
            }
        })
        .collect()
}

/// Values without most of their noise: at each time that of the straight line through the values within
/// `half_width` of it by least squares. Where these are fewer than five, the value itself: they would take
/// little of the noise and much of a turn.
///
/// Times rise; both slices have the same length.
#[must_use]
pub fn local_lines(times: &[f64], values: &[f64], half_width: f64) -> Vec<f64> {
    let sums = RunningSums::new(times, values);
    within(&times[..times.len().min(values.len())], half_width)
        .zip(times.iter().zip(values))
        .map(|((from, to), (time, value))| {
            if to - from < FEWEST_SMOOTHED {
                return *value;
            }
            let line = sums.line(from, to);
            values[0] + line.value + line.slope * (time - times[0] - line.time)
        })
        .collect()
}

/// Fewest values that a straight line is put through for its slope, and for a point of it.
const FEWEST: usize = 3;
const FEWEST_SMOOTHED: usize = 5;

/// The range of the times within `half_width` of each.
fn within(times: &[f64], half_width: f64) -> impl Iterator<Item = (usize, usize)> {
    let (mut from, mut to) = (0, 0);
    times.iter().map(move |time| {
        while time - times[from] > half_width {
            from += 1;
        }
        while to < times.len() && times[to] - time <= half_width {
            to += 1;
        }
        (from, to)
    })
}

/// What follows values with a play of `half` to either side, from the first value on.
#[must_use]
pub fn followed_with_play(values: &[f64], half: f64) -> Vec<f64> {
    let mut state = values.first().copied().unwrap_or(0.0);
    values
        .iter()
        .map(|value| {
            state = state.clamp(value - half, value + half);
            state
        })
        .collect()
}

/// Sums over the elements before each, of times and values about their first.
struct RunningSums(Vec<[f64; 4]>);

impl RunningSums {
    fn new(times: &[f64], values: &[f64]) -> Self {
        let mut sum = [0.0; 4];
        let mut sums = vec![sum];
        for (time, value) in times.iter().zip(values) {
            let (time, value) = (time - times[0], value - values[0]);
            for (sum, term) in sum.iter_mut().zip([time, value, time * time, time * value]) {
                *sum += term;
            }
            sums.push(sum);
        }
        Self(sums)
    }

    /// The straight line through the elements `from..to` by least squares; its slope is zero where they do
    /// not tell it.
    fn line(&self, from: usize, to: usize) -> Line {
        let [time, value, square, product] =
            core::array::from_fn(|place| self.0[to][place] - self.0[from][place]);
        let count = (to - from) as f64;
        let spread = square - time * time / count;
        let slope = if to - from < 2 || spread <= 0.0 {
            0.0
        } else {
            (product - time * value / count) / spread
        };
        Line {
            time: time / count,
            value: value / count,
            slope,
        }
    }
}

/// A straight line: a point of it, about the first time and value, and its slope.
struct Line {
    time: f64,
    value: f64,
    slope: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_has_its_slope_everywhere() {
        // Irregular, with a gap and a time alone in it; 60 s apart, days from the first.
        let mut times: Vec<f64> = (0..200).map(|row| 60.0 * f64::from(row)).collect();
        times.push(100_000.0);
        times.extend((0..200).map(|row| 400_000.0 + 37.0 * f64::from(row)));
        let values: Vec<f64> = times.iter().map(|time| 20.0 - 3e-4 * time).collect();
        for half_width in [0.0, 600.0] {
            for slope in local_slopes(&times, &values, half_width) {
                // Sums of 200 times 1.6e11 with roundings of 1e-16 of them, over a spread of 11
                // values of 37 s.
                assert!((slope + 3e-4).abs() < 1e-6 * 3e-4, "{slope}");
            }
        }
    }

    #[test]
    fn a_window_averages_noise_and_stays_on_its_side_of_a_gap() {
        let times: Vec<f64> = (0..100)
            .map(|row| f64::from(row) + if row < 50 { 0.0 } else { 1000.0 })
            .collect();
        // Alternates by 0.1, and jumps in the gap.
        let noise = |row: u32| if row.is_multiple_of(2) { 0.1 } else { -0.1 };
        let values: Vec<f64> = (0..100)
            .map(|row| noise(row) + if row < 50 { 0.0 } else { 50.0 })
            .collect();
        let slopes = local_slopes(&times, &values, 10.0);
        // Least squares of eleven alternating values: below 0.1 · 6 · 5 / 110 = 0.03.
        assert!(slopes.iter().all(|slope| slope.abs() < 0.03), "{slopes:?}");
    }

    #[test]
    fn neighbours_give_the_slope_of_few() {
        assert_eq!(
            local_slopes(&[0.0, 1.0, 2.0], &[0.0, 1.0, 4.0], 0.0),
            [1.0, 2.0, 3.0]
        );
        assert_eq!(local_slopes(&[5.0], &[1.0], 10.0), [0.0]);
        assert_eq!(local_slopes(&[], &[], 1.0), [0.0; 0]);
    }

    #[test]
    fn local_lines_keep_a_line_and_leave_little_of_alternating_noise() {
        // Irregular, with a time alone in a gap.
        let mut times: Vec<f64> = (0..60).map(|row| 60.0 * f64::from(row)).collect();
        times.push(100_000.0);
        let line: Vec<f64> = times.iter().map(|time| 20.0 - 3e-4 * time).collect();
        // Values of 20 and roundings of sums of 1e5.
        for (smooth, value) in local_lines(&times, &line, 600.0).iter().zip(&line) {
            assert!((smooth - value).abs() < 1e-9, "{smooth} {value}");
        }
        let noise = |row: usize| if row.is_multiple_of(2) { 0.1 } else { -0.1 };
        let noisy: Vec<f64> = line
            .iter()
            .enumerate()
            .map(|(row, v)| v + noise(row))
            .collect();
        // The mean of 21 alternating values is a twenty-first of one; the end of a line through eleven
        // has at most four times the weight of one of them.
        for (smooth, value) in local_lines(&times, &noisy, 600.0)
            .iter()
            .zip(&line)
            .take(60)
        {
            assert!((smooth - value).abs() < 0.1 / 3.0, "{smooth} {value}");
        }
        assert_eq!(local_lines(&[], &[], 1.0), [0.0; 0]);
        assert_eq!(local_lines(&[1.0, 2.0], &[3.0, 5.0], 9.0), [3.0, 5.0]);
    }

    #[test]
    fn a_play_follows_outside_of_its_width() {
        // By hand: a play of one stays until the value is one away, then follows.
        let inputs = [0.0, 0.5, 2.0, 1.5, 0.0, -1.0];
        assert_eq!(
            followed_with_play(&inputs, 1.0),
            [0.0, 0.0, 1.0, 1.0, 1.0, 0.0]
        );
    }
}
