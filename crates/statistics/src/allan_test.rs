//! Allan test: do whitened innovations average out as white noise does?

use crate::allan::{AllanPoint, NoiseType, allan_deviation, octaves};
use crate::error::StatisticsError;
use crate::probability::{chi_square_tail, p_of_least};
use crate::sampling::median_interval_s;

/// Fewer rows in a stretch say nothing of long times.
const LEAST_ROWS: usize = 64;

/// Intervals that differ from the median by more than this share end a stretch.
const EQUAL: f64 = 0.01;

/// Probability that the interval of a deviation holds it.
const CONFIDENCE: f64 = 0.95;

/// Course of noise that is averaged over longer and longer times.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoiseCourse {
    /// It falls as white noise of the believed size does.
    White,
    /// It is larger than believed, and falls as white noise does.
    LargerWhite,
    /// It stops falling: flicker.
    Flicker,
    /// It rises: a random walk, or something slow.
    Slow,
}

impl NoiseCourse {
    /// In words.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::White => "white",
            Self::LargerWhite => "white, but larger than believed",
            Self::Flicker => "flicker: averaging does not lower it",
            Self::Slow => "a random walk or something slow: averaging raises it",
        }
    }
}

/// The Allan deviations of the whitened innovations over the longest stretch without a gap.
#[derive(Debug, Clone, PartialEq)]
pub struct AllanTest {
    /// Time between rows.
    pub interval_s: f64,
    /// Rows of the stretch.
    pub rows: usize,
    /// For x, y, z: deviations in believed standard deviations, which for white noise are one
    /// over the root of the number of rows averaged.
    pub points: [Vec<AllanPoint>; 3],
    /// Course of the noise.
    pub course: NoiseCourse,
    /// Upper bound of the probability that white noise of the believed size exceeds its expectation as
    /// much anywhere: averaging times that share samples are counted as if they did not.
    pub p_value: f64,
    /// Largest excess: channel and averaging time \[s\].
    pub most: Option<(usize, f64)>,
}

/// Tests whitened innovations, row by row, against white noise of unit variance at all averaging
/// times in octaves. Only an excess counts: what a fit takes up lowers the longest ones.
///
/// # Errors
///
/// [`StatisticsError::TooShort`] without a stretch of 64 complete rows at equal intervals, and
/// [`StatisticsError::UnequalLengths`].
pub fn allan_test(
    time_s: &[f64],
    whitened: &[[f64; 3]],
    false_alarm: f64,
) -> Result<AllanTest, StatisticsError> {
    if time_s.len() != whitened.len() {
        return Err(StatisticsError::UnequalLengths {
            what: "innovations",
            found: whitened.len(),
            expected: time_s.len(),
        });
    }
    let interval_s = median_interval_s(time_s);
    let stretch = longest_stretch(time_s, whitened, interval_s);
    let too_short = StatisticsError::TooShort {
        test: "the Allan deviation",
        found: stretch.len(),
        expected: LEAST_ROWS,
    };
    if stretch.len() < LEAST_ROWS {
        return Err(too_short);
    }
    let averaging = octaves(stretch.len());
    let mut points: [Vec<AllanPoint>; 3] = Default::default();
    for (axis, points) in points.iter_mut().enumerate() {
        let series: Vec<f64> = whitened[stretch.clone()]
            .iter()
            .map(|row| row[axis])
            .collect();
        // Equal intervals and finite values: nothing to refuse.
        *points = allan_deviation(&series, interval_s, &averaging, CONFIDENCE)
            .map_err(|_| too_short.clone())?;
    }
    let excess = |point: &AllanPoint| {
        let freedom = NoiseType::WhiteRate.degrees_of_freedom(stretch.len() + 1, point.averaging);
        // White noise averaged over m rows has variance 1/m.
        let ratio = point.deviation * point.deviation * point.averaging as f64;
        chi_square_tail(freedom * ratio, freedom).unwrap_or(1.0)
    };
    let count = points.iter().map(Vec::len).sum::<usize>() as f64;
    let most = points
        .iter()
        .enumerate()
        .flat_map(|(axis, points)| points.iter().map(move |point| (axis, point)))
        .map(|(axis, point)| (excess(point), axis, *point))
        .min_by(|a, b| {
            let larger = b.2.averaging.cmp(&a.2.averaging);
            a.0.total_cmp(&b.0).then(larger)
        });
    let (p_value, course, at) = match most {
        Some((p, axis, point)) if p_of_least(p, count) < false_alarm => {
            let course = match point.noise {
                NoiseType::FlickerRate => NoiseCourse::Flicker,
                NoiseType::RandomWalkRate | NoiseType::RateRamp => NoiseCourse::Slow,
                _ => NoiseCourse::LargerWhite,
            };
            (p_of_least(p, count), course, Some((axis, point.tau_s)))
        }
        Some((p, ..)) => (p_of_least(p, count), NoiseCourse::White, None),
        None => (1.0, NoiseCourse::White, None),
    };
    Ok(AllanTest {
        interval_s,
        rows: stretch.len(),
        points,
        course,
        p_value,
        most: at,
    })
}

fn longest_stretch(
    time_s: &[f64],
    whitened: &[[f64; 3]],
    interval_s: f64,
) -> core::ops::Range<usize> {
    let (mut longest, mut start) = (0..0, 0);
    for row in 0..=time_s.len() {
        let complete = row < time_s.len() && whitened[row].iter().all(|value| value.is_finite());
        let joined = complete
            && row > start
            && ((time_s[row] - time_s[row - 1]) / interval_s - 1.0).abs() < EQUAL;
        if joined {
            continue;
        }
        if row - start > longest.len() {
            longest = start..row;
        }
        start = if complete { row } else { row + 1 };
    }
    longest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_and_missing_values_end_a_stretch() {
        let mut time_s: Vec<f64> = (0..20).map(|row| 60.0 * f64::from(row)).collect();
        let mut whitened = vec![[0.0; 3]; 20];
        assert_eq!(longest_stretch(&time_s, &whitened, 60.0), 0..20);
        whitened[4][1] = f64::NAN;
        assert_eq!(longest_stretch(&time_s, &whitened, 60.0), 5..20);
        for time in &mut time_s[8..] {
            *time += 30.0;
        }
        assert_eq!(longest_stretch(&time_s, &whitened, 60.0), 8..20);
        whitened[19][0] = f64::NAN;
        assert_eq!(longest_stretch(&time_s, &whitened, 60.0), 8..19);
    }

    #[test]
    fn too_few_rows_are_refused() {
        let time_s: Vec<f64> = (0..63).map(f64::from).collect();
        let error = allan_test(&time_s, &[[0.0; 3]; 63], 0.01);
        assert!(matches!(
            error,
            Err(StatisticsError::TooShort { found: 63, .. })
        ));
    }
}
