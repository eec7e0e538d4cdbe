//! A simulated record, and the integration that makes it.

use crate::random::Stream;

/// Steps of the simulation between two rows: finer than those of any model.
const FINE: usize = 12;

/// A simulated record.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// Time of each row, s.
    pub time_s: Vec<f64>,
    /// Inputs of each row.
    pub inputs: Vec<Vec<f64>>,
    /// Outputs of each row.
    pub outputs: Vec<Vec<f64>>,
}

impl Run {
    /// The record as CSV with these names of columns.
    #[must_use]
    pub fn csv(&self, inputs: &[&str], outputs: &[&str]) -> String {
        let mut names = vec!["time_s"];
        names.extend_from_slice(inputs);
        names.extend_from_slice(outputs);
        let mut text = names.join(",") + "\n";
        for row in 0..self.time_s.len() {
            let mut fields = vec![format!("{:.3}", self.time_s[row])];
            fields.extend(self.inputs[row].iter().map(|value| format!("{value:.9}")));
            fields.extend(self.outputs[row].iter().map(|value| format!("{value:.9}")));
            text += &(fields.join(",") + "\n");
        }
        text
    }
}

/// Moves a state over one step between rows: the mean of many midpoint steps, with an input that goes in a
/// straight line or is held, and a random push on rates, held over the step.
pub(crate) fn step<const N: usize>(
    state: [f64; N],
    (from_s, step_s): (f64, f64),
    rates: impl Fn(f64, f64, &[f64; N]) -> [f64; N],
) -> [f64; N] {
    let h = step_s / FINE as f64;
    let mut here = state;
    let moved = |from: &[f64; N], by: &[f64; N], h: f64| -> [f64; N] {
        core::array::from_fn(|i| from[i] + h * by[i])
    };
    for index in 0..FINE {
        let share = index as f64 / FINE as f64;
        let half = 0.5 / FINE as f64;
        let time = from_s + step_s * share;
        // Kutta's 3/8 rule.
        let third = 2.0 * half / 3.0;
        let k1 = rates(time, share, &here);
        let k2 = rates(time + h / 3.0, share + third, &moved(&here, &k1, h / 3.0));
        let mut at = moved(&here, &k2, h);
        at = moved(&at, &k1, -h / 3.0);
        let k3 = rates(time + 2.0 * h / 3.0, share + 2.0 * third, &at);
        let mut at = moved(&here, &k1, h);
        at = moved(&at, &k2, -h);
        at = moved(&at, &k3, h);
        let k4 = rates(time + h, share + 2.0 * half, &at);
        here = core::array::from_fn(|i| {
            here[i] + h / 8.0 * (k1[i] + 3.0 * (k2[i] + k3[i]) + k4[i])
        });
    }
    here
}

/// A sum of sines with random frequencies and phases.
#[derive(Clone, Debug)]
pub(crate) struct Multisine(Vec<[f64; 3]>);

impl Multisine {
    /// Of a root mean square, between two frequencies, Hz.
    pub(crate) fn new(random: &mut Stream, rms: f64, [low, high]: [f64; 2]) -> Self {
        const LINES: usize = 10;
        let amplitude = rms * libm::sqrt(2.0 / LINES as f64);
        let line = |_| {
            let frequency = random.log_between(low, high);
            [amplitude, frequency, random.uniform()]
        };
        Self((0..LINES).map(line).collect())
    }

    pub(crate) fn at(&self, time_s: f64) -> f64 {
        let line = |[amplitude, frequency, phase]: &[f64; 3]| {
            amplitude * libm::sin(core::f64::consts::TAU * (frequency * time_s + phase))
        };
        self.0.iter().map(line).sum()
    }
}
