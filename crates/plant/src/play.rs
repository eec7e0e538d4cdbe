//! Play of an input, as backlash and hysteresis have: what it subtracts from what is logged, for each step of a record.

use std::sync::Arc;

use crate::record::PlantRecord;

/// Half the width of the play that its form is taken from, over the range of the input. The form hardly
/// depends on it where the input moves by much more.
const PLAY: f64 = 0.05;

/// The form in each step, of the input at this place of so many; half the width of the play multiplies it.
pub(crate) fn steps(
    record: &PlantRecord,
    (inputs, input): (usize, usize),
    interpolate: bool,
) -> Arc<[f64]> {
    let values = record.inputs.iter().skip(input).step_by(inputs);
    let form = form(&values.copied().collect::<Vec<f64>>());
    let pairs = form.windows(2);
    let steps = pairs.map(|pair| match interpolate {
        true => 0.5 * (pair[0] + pair[1]),
        false => pair[0],
    });
    steps.collect()
}

/// What play subtracts from an input at each row, over half its width.
fn form(values: &[f64]) -> Vec<f64> {
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
        let steps = steps(&record, (1, 0), false);
        // Half the width is 0.5; in the fourth row it is moved within the play.
        let expected = [0.0, -1.0, 1.0, 0.6];
        for (step, expected) in steps.iter().zip(expected) {
            assert!((step - expected).abs() < 1e-12, "{steps:?}");
        }
    }
}
