//! Detection of quantisation: the least significant bit, from the values themselves.

/// Largest distance from a lattice point, as a fraction of the step, of a value on the lattice.
const TOLERANCE: f64 = 0.05;
/// Smallest fraction of the differences of sorted values that are multiples of the step.
const LEAST_MULTIPLES: f64 = 0.98;
/// Smallest number of differences.
const LEAST_DIFFERENCES: usize = 20;
/// Smallest number of values that repeat, or whose difference is another multiple than the most
/// frequent one: the equal increments of a steady trend are not evidence.
const LEAST_OTHER_MULTIPLES: usize = 10;

/// Lattice of quantised values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lattice {
    /// Step.
    pub(crate) step: f64,
    /// Standard deviation of the step.
    pub(crate) sigma: f64,
    /// Significance of the number of differences that are multiples of the step, in standard
    /// deviations of chance.
    pub(crate) z: f64,
}

/// The coarsest lattice of the values, if its step is `least` or more.
///
/// Differences of sorted quantised values are multiples of the step. The smallest differences give
/// the step, larger ones refine it. Values with a continuous distribution have differences of any
/// size, the smallest far below `least`.
///
/// Samples at equal intervals of a uniformly rotating platform also have equal increments, without
/// quantisation. There each value is the mean of its neighbours to much less than a step.
pub(crate) fn find(values: impl Iterator<Item = f64>, least: f64) -> Option<Lattice> {
    let in_order: Vec<f64> = values.collect();
    let mut sorted: Vec<f64> = in_order.iter().copied().filter(|v| !v.is_nan()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    // Below this, two values differ by the rounding of printed decimals only.
    let same = TOLERANCE * least;
    let mut steps: Vec<f64> = sorted.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let apart = steps.len();
    steps.retain(|step| *step > same);
    let repeated = apart - steps.len();
    steps.sort_unstable_by(f64::total_cmp);
    if steps.len() < LEAST_DIFFERENCES || steps[0] < least * (1.0 - TOLERANCE) {
        return None;
    }
    let step = common_divisor(&steps)?;
    let off = |distance: &&f64| ((**distance / step) - (**distance / step).round()).abs();
    let near = steps
        .iter()
        .filter(|distance| off(distance) < TOLERANCE)
        .count();
    if (near as f64) < LEAST_MULTIPLES * steps.len() as f64
        || repeated + others(&steps, step) < LEAST_OTHER_MULTIPLES
    {
        return None;
    }
    if is_smooth(&in_order, step) {
        return None;
    }
    let squares: f64 = steps
        .iter()
        .map(|distance| (off(&distance) * step).powi(2))
        .sum();
    let weight: f64 = steps
        .iter()
        .map(|distance| (distance / step).round().powi(2))
        .sum();
    // By chance a difference is near a multiple with probability 2 TOLERANCE.
    let count = steps.len() as f64;
    let chance = 2.0 * TOLERANCE;
    Some(Lattice {
        step,
        // The factor 2 bounds the correlation of neighbouring differences, which share a value.
        sigma: (2.0 * squares / count / weight).sqrt(),
        z: (near as f64 - count * chance) / (count * chance * (1.0 - chance)).sqrt(),
    })
}

/// Whether values have equal increments without rounding to multiples of `step`. Rounding would give
/// second differences of up to 0.7 steps rms, and of 0.3 if the increments are nearly multiples.
/// Constant values are not evidence.
fn is_smooth(in_order: &[f64], step: f64) -> bool {
    const SMOOTH: f64 = 0.1;
    let (mut squares, mut moved, mut count) = (0.0, 0.0, 0.0_f64);
    for three in in_order.windows(3) {
        let second = three[0] - 2.0 * three[1] + three[2];
        if second.is_finite() {
            squares += second * second;
            moved += (three[2] - three[0]).abs();
            count += 1.0;
        }
    }
    moved > step * count && squares < (SMOOTH * step).powi(2) * count
}

/// Number of the differences, sorted, that are another multiple than the most frequent one.
fn others(steps: &[f64], step: f64) -> usize {
    let multiple = |distance: &f64| (distance / step).round();
    let most = steps
        .chunk_by(|a, b| multiple(a) == multiple(b))
        .map(<[f64]>::len)
        .max();
    steps.len() - most.unwrap_or(0)
}

/// The step suggested by the smallest differences, refined with larger ones in turn.
fn common_divisor(steps: &[f64]) -> Option<f64> {
    let candidates = [1.0, 2.0, 3.0, 4.0].map(|part| steps[0] / part);
    // The smallest difference is one step except in tiny records, where it is a few.
    candidates.into_iter().find_map(|candidate| {
        let (mut products, mut squares, mut step) = (0.0, 0.0, candidate);
        let mut whole = 0;
        for distance in steps {
            let count = (distance / step).round();
            // Only if the multiple is unambiguous.
            if (distance / step - count).abs() < 0.2 {
                whole += 1;
                products += distance * count;
                squares += count * count;
                step = products / squares;
            }
        }
        (whole as f64 >= LEAST_MULTIPLES * steps.len() as f64).then_some(step)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sweep(count: u32) -> impl Iterator<Item = f64> {
        (0..count).map(|k| (f64::from(k) * 0.0437).sin() + 1e-5 * (f64::from(k * k) * 1.3).sin())
    }

    #[test]
    fn a_lattice_is_found_with_its_step() {
        // Of a converter that divides 2 g into 2^16, printed with all and with 7 decimals.
        let step = 2.0 / 65536.0;
        for decimals in [17, 7] {
            let ten = 10.0_f64.powi(decimals);
            let lattice = find(
                sweep(2000).map(|v| ((v / step).round() * step * ten).round() / ten),
                5e-6,
            );
            let found = lattice.map_or(0.0, |lattice| lattice.step);
            // Printing to 1e-7 moves each value by less than a hundredth of a step.
            assert!((found / step - 1.0).abs() < 1e-3, "{found}");
        }
    }

    #[test]
    fn a_uniform_turn_sampled_at_equal_intervals_is_none() {
        let slow = |k: u32| 0.016 + 0.0018 * f64::from(k) + 1e-5 * (f64::from(k * k) * 1.3).sin();
        let with_gaps = (0..60).map(|k| if k % 5 == 1 { f64::NAN } else { slow(k) });
        assert_eq!(find(with_gaps, 7e-6), None);
        // The same through a converter is one, also when a row moves by some steps.
        let step = 7e-4;
        let coarse = (0..60).map(|k| (slow(k) / step).round() * step);
        assert!(find(coarse, 7e-6).is_some());
    }

    #[test]
    fn a_steady_trend_is_none() {
        // Half an hour of a platform that turns: rows are apart by 2.4e-3 g, and that changes by
        // 3 % over the record.
        let trend = |row: f64| 2.4e-3 * row * (1.0 + 5e-4 * row) + 1e-5 * (7.0 * row).sin();
        assert_eq!(find((0..29).map(|row| trend(f64::from(row))), 5e-6), None);
    }

    #[test]
    fn continuous_values_and_fine_decimals_are_none() {
        assert_eq!(find(sweep(2000), 5e-6), None);
        assert_eq!(
            find(sweep(2000).map(|v| (v * 1e6).round() / 1e6), 5e-6),
            None
        );
        assert_eq!(find(sweep(10).map(|v| (v * 1e4).round() / 1e4), 5e-6), None);
    }
}
