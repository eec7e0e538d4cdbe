//! Errors of inputs: what acts on the plant beside what is logged, for each step of a record.

use std::sync::Arc;

use crate::record::PlantRecord;

/// Half the width of the play that its form is taken from, over the range of the input. The form hardly
/// depends on it where the input moves by much more.
const PLAY: f64 = 0.05;

/// The form of an error, which its size multiplies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InputError {
    /// The input acts late; the size is the delay, s. To first order it is minus the slope, and exact where
    /// the delay is the interval of the rows.
    Delay,
    /// The input has play, as backlash and hysteresis have; the size is half its width.
    Play,
}

impl InputError {
    /// The form in each step, of the input at this place.
    pub(crate) fn steps(
        self,
        record: &PlantRecord,
        inputs: usize,
        input: usize,
        interpolate: bool,
    ) -> Arc<[f64]> {
        let values: Vec<f64> = record
            .inputs
            .iter()
            .skip(input)
            .step_by(inputs)
            .copied()
            .collect();
        let steps = 0..values.len().saturating_sub(1);
        match self {
            Self::Delay => steps
                .map(|step| {
                    // What the input was a row before, on average over the step, less what it is: a row is
                    // the delay that a log has most often, and of that this is no approximation.
                    let before = step.saturating_sub(1);
                    let to = if interpolate { step + 1 } else { step };
                    let share = if interpolate { 0.5 } else { 1.0 };
                    let interval_s = record.time_s[step + 1] - record.time_s[step];
                    share * (values[before] - values[to]) / interval_s
                })
                .collect(),
            Self::Play => {
                let form = play(&values);
                steps
                    .map(|step| {
                        if interpolate {
                            0.5 * (form[step] + form[step + 1])
                        } else {
                            form[step]
                        }
                    })
                    .collect()
            }
        }
    }
}

/// What play subtracts from an input at each row, over half its width.
fn play(values: &[f64]) -> Vec<f64> {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let half = PLAY * (high - low);
    if half <= 0.0 {
        return vec![0.0; values.len()];
    }
    let mut behind = values.first().copied().unwrap_or(0.0);
    values
        .iter()
        .map(|value| {
            behind = behind.clamp(value - half, value + half);
            (behind - value) / half
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn play_stays_behind_on_either_side() {
        let record = PlantRecord {
            time_s: vec![0.0, 1.0, 2.0, 3.0, 4.0],
            inputs: vec![0.0, 10.0, 0.0, 0.2, 10.0],
            ..PlantRecord::default()
        };
        let steps = InputError::Play.steps(&record, 1, 0, false);
        // Half the width is 0.5; in the fourth row it is moved within the play.
        let expected = [0.0, -1.0, 1.0, 0.6];
        for (step, expected) in steps.iter().zip(expected) {
            assert!((step - expected).abs() < 1e-12, "{steps:?}");
        }
        let steps = InputError::Delay.steps(&record, 1, 0, false);
        assert_eq!(*steps, [0.0, -10.0, 10.0, -0.2]);
        // Means over a step: of the second one 5, and of the step before it 5 too.
        let steps = InputError::Delay.steps(&record, 1, 0, true);
        let expected = [-5.0, 0.0, 4.9, -5.0];
        for (step, expected) in steps.iter().zip(expected) {
            assert!((step - expected).abs() < 1e-12, "{steps:?}");
        }
    }
}
