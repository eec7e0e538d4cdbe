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
    let (mut from, mut to) = (0, 0);
    (0..count)
        .map(|at| {
            while times[at] - times[from] > half_width {
                from += 1;
            }
            while to < count && times[to] - times[at] <= half_width {
                to += 1;
            }
            if to - from < 3 {
                let near = at.saturating_sub(1)..(at + 2).min(count);
                RunningSums::new(&times[near.clone()], &values[near.clone()]).slope(0, near.len())
            } else {
                sums.slope(from, to)
            }
        })
        .collect()
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

    /// Slope over the elements `from..to`.
    fn slope(&self, from: usize, to: usize) -> f64 {
        let [time, value, square, product] =
            core::array::from_fn(|place| self.0[to][place] - self.0[from][place]);
        let count = (to - from) as f64;
        let spread = square - time * time / count;
        if to - from < 2 || spread <= 0.0 {
            return 0.0;
        }
        (product - time * value / count) / spread
    }
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
    fn a_play_follows_outside_of_its_width() {
        // By hand: a play of one stays until the value is one away, then follows.
        let inputs = [0.0, 0.5, 2.0, 1.5, 0.0, -1.0];
        assert_eq!(
            followed_with_play(&inputs, 1.0),
            [0.0, 0.0, 1.0, 1.0, 1.0, 0.0]
        );
    }
}
