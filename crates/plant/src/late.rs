//! Inputs that act late, by a dead time that is a parameter.
//!
//! Over a step from row to row, what acts is taken as the line of the same mean and the same first moment: exact where
//! it is a line there, and to third order in the step where it jumps or bends within.

use crate::description::Delay;
use crate::record::PlantRecord;

/// An input over a step: its mean, its slope per step, and the derivatives of both by the dead time, per second.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Line {
    mean: f64,
    slope: f64,
    mean_by_time: f64,
    slope_by_time: f64,
}

/// An input that acts late, along a record.
#[derive(Clone, Debug)]
pub(crate) struct LateInput {
    pub(crate) delay: Delay,
    /// The dead time that the lines are of; none at first.
    time_s: Option<f64>,
    lines: Vec<Line>,
    /// What the parameter has beside the lateness.
    pub(crate) beside: f64,
    /// Derivative of what acts by the dead time, at the place that was asked for last.
    pub(crate) by_time: f64,
}

/// An input of one record as a function of time.
struct Signal<'a> {
    time_s: &'a [f64],
    values: &'a [f64],
    interpolate: bool,
}

impl LateInput {
    pub(crate) fn new(delay: Delay) -> Self {
        Self {
            delay,
            time_s: None,
            lines: Vec::new(),
            beside: 0.0,
            by_time: 0.0,
        }
    }

    /// Sets the dead time; the input is one of so many.
    pub(crate) fn set(
        &mut self,
        time_s: f64,
        record: &PlantRecord,
        inputs: usize,
        interpolate: bool,
    ) {
        if self.time_s == Some(time_s) {
            return;
        }
        self.time_s = Some(time_s);
        self.lines.clear();
        for rows in record.records() {
            // None is asked for between two records.
            self.lines.resize(rows.start, Line::default());
            let own = rows.clone();
            let values: Vec<f64> = own
                .map(|row| record.inputs[row * inputs + self.delay.input])
                .collect();
            let signal = Signal {
                time_s: &record.time_s[rows],
                values: &values,
                interpolate,
            };
            let steps = signal.time_s.windows(2);
            self.lines
                .extend(steps.map(|step| signal.line(step[0] - time_s, step[1] - time_s)));
        }
    }

    /// What acts at a share of the step after a row less what is logged; keeps its derivative by the dead time.
    pub(crate) fn less(&mut self, row: usize, share: f64, logged: f64) -> f64 {
        let line = self.lines.get(row).copied().unwrap_or_default();
        self.by_time = line.mean_by_time + line.slope_by_time * (share - 0.5);
        match self.time_s {
            Some(time_s) if time_s != 0.0 && row < self.lines.len() => {
                line.mean + line.slope * (share - 0.5) - logged
            }
            _ => 0.0,
        }
    }
}

impl Signal<'_> {
    /// The piece that begins last before a time, and the value there as that piece has it.
    fn before(&self, time_s: f64) -> f64 {
        let piece = self.time_s.partition_point(|own| *own < time_s);
        self.in_piece(piece, time_s)
    }

    /// The value in a piece, which ends at the row of this index.
    fn in_piece(&self, end: usize, time_s: f64) -> f64 {
        let last = self.values.len() - 1;
        match end {
            0 => self.values[0],
            end if end > last => self.values[last],
            end if self.interpolate => {
                let (from, to) = (self.time_s[end - 1], self.time_s[end]);
                let share = (time_s - from) / (to - from);
                self.values[end - 1] + share * (self.values[end] - self.values[end - 1])
            }
            end => self.values[end - 1],
        }
    }

    /// The line over a window.
    fn line(&self, from_s: f64, to_s: f64) -> Line {
        let (length, middle) = (to_s - from_s, 0.5 * (from_s + to_s));
        let (mut area, mut moment) = (0.0, 0.0);
        let mut left = from_s;
        let mut end = self.time_s.partition_point(|own| *own <= from_s);
        while left < to_s {
            let right = self.time_s.get(end).map_or(to_s, |own| own.min(to_s));
            let (first, last) = (self.in_piece(end, left), self.in_piece(end, right));
            area += 0.5 * (right - left) * (first + last);
            let (x, y) = (left - middle, right - middle);
            moment += (right - left) / 6.0 * (x * (2.0 * first + last) + y * (first + 2.0 * last));
            left = right;
            end += 1;
        }
        let (enters, leaves) = (self.before(from_s), self.before(to_s));
        let moment_by_time = area - 0.5 * length * (enters + leaves);
        Line {
            mean: area / length,
            slope: 12.0 * moment / (length * length),
            mean_by_time: (enters - leaves) / length,
            slope_by_time: 12.0 * moment_by_time / (length * length),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A record of one input, its rows uneven.
    fn record() -> PlantRecord {
        PlantRecord {
            time_s: vec![0.0, 1.0, 2.5, 3.0, 4.0],
            inputs: vec![0.0, 10.0, 4.0, 0.2, 6.0],
            ..PlantRecord::default()
        }
    }

    fn late(time_s: f64, interpolate: bool) -> LateInput {
        let delay = Delay {
            input: 0,
            constant: 0,
            time: 0,
        };
        let mut late = LateInput::new(delay);
        late.set(time_s, &record(), 1, interpolate);
        late
    }

    /// Mean and first moment of a signal over a step, by a fine sum that shares nothing with the lines.
    fn summed(time_s: f64, row: usize, interpolate: bool) -> [f64; 2] {
        const PARTS: usize = 200_000;
        let record = record();
        let (from, to) = (record.time_s[row], record.time_s[row + 1]);
        let at = |time: f64| {
            if time <= 0.0 {
                return record.inputs[0];
            }
            let next = record
                .time_s
                .iter()
                .position(|own| *own > time)
                .unwrap_or(4);
            let (a, b) = (record.inputs[next - 1], record.inputs[next]);
            let share =
                (time - record.time_s[next - 1]) / (record.time_s[next] - record.time_s[next - 1]);
            if interpolate { a + share * (b - a) } else { a }
        };
        let mut sums = [0.0, 0.0];
        for part in 0..PARTS {
            let share = (part as f64 + 0.5) / PARTS as f64;
            let value = at(from + share * (to - from) - time_s) / PARTS as f64;
            sums[0] += value;
            sums[1] += value * (share - 0.5);
        }
        sums
    }

    #[test]
    fn the_line_has_the_mean_and_the_first_moment_of_the_input() {
        for interpolate in [false, true] {
            for time_s in [0.3, 1.0, 1.7, 3.1] {
                let late = late(time_s, interpolate);
                for (row, line) in late.lines.iter().enumerate() {
                    let [mean, moment] = summed(time_s, row, interpolate);
                    // The sum misses a jump by a part of 200 000.
                    assert!((line.mean - mean).abs() < 1e-4, "{time_s} {row}: {line:?}");
                    assert!(
                        (line.slope - 12.0 * moment).abs() < 1e-3,
                        "{time_s} {row}: {line:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        const STEP_S: f64 = 1e-6;
        for interpolate in [false, true] {
            for time_s in [0.0, 0.3, 1.7] {
                let [here, further] = [time_s, time_s + STEP_S].map(|own| late(own, interpolate));
                for (line, other) in here.lines.iter().zip(&further.lines) {
                    let mean = (other.mean - line.mean) / STEP_S;
                    let slope = (other.slope - line.slope) / STEP_S;
                    // One-sided differences of quadratic functions whose curvature is some tens.
                    assert!(
                        (mean - line.mean_by_time).abs() < 1e-3,
                        "{time_s}: {line:?} {mean}"
                    );
                    assert!(
                        (slope - line.slope_by_time).abs() < 1e-3,
                        "{time_s}: {line:?} {slope}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_delay_of_whole_rows_is_the_input_rows_before() {
        let even = PlantRecord {
            time_s: vec![0.0, 1.0, 2.0, 3.0],
            inputs: vec![3.0, -1.0, 5.0, 2.0],
            ..PlantRecord::default()
        };
        let mut late = late(0.0, false);
        late.set(1.0, &even, 1, false);
        assert!((late.less(2, 0.5, 5.0) - (-6.0)).abs() < 1e-12);
        assert!((late.less(0, 0.0, 3.0)).abs() < 1e-12);
    }
}
