//! A simulated record, and the integration that makes it.

use super::{Setting, Stream};

/// Steps of the simulation between two rows: finer than those of any model.
const FINE: usize = 10;

/// The same where inputs change within a row: their places are met to a two-hundredth of it.
const FINER: usize = 200;

/// Kutta's 3/8 rule: the place of each stage in the step, with the weights of the rates before it. The
/// classical rule of the platform's simulator would change all records in their last digits.
const STAGES: [(f64, &[f64]); 4] = [
    (0.0, &[]),
    (1.0 / 3.0, &[1.0 / 3.0]),
    (2.0 / 3.0, &[-1.0 / 3.0, 1.0]),
    (1.0, &[1.0, -1.0, 1.0]),
];

/// Its weights of the rates over the whole step.
const WHOLE: [f64; 4] = [0.125, 0.375, 0.375, 0.125];

/// Dead time of the inputs, rows.
const LATE: &str = "drive.late_rows";

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
        let mut text = [&["time_s"], inputs, outputs].concat().join(",") + "\n";
        for row in 0..self.time_s.len() {
            let mut fields = vec![format!("{:.3}", self.time_s[row])];
            fields.extend(self.inputs[row].iter().map(|value| format!("{value:.6}")));
            fields.extend(self.outputs[row].iter().map(|value| format!("{value:.5}")));
            text += &(fields.join(",") + "\n");
        }
        text
    }
}

/// A moment of a simulation.
pub(super) struct Moment<'a, const N: usize> {
    /// Share of the record that has passed.
    pub(super) share: f64,
    pub(super) state: &'a [f64; N],
    pub(super) input: &'a [f64],
}

/// The record of a plant by its rates and outputs; `input` gives the inputs of a row from its time and the
/// readings of the row before. With `replayed` inputs nothing is fed back.
pub(super) fn run<const N: usize>(
    setting: &Setting,
    rates: impl Fn(&Moment<'_, N>) -> [f64; N],
    outputs: impl Fn(&Moment<'_, N>) -> Vec<f64>,
    mut input: impl FnMut(f64, &[f64]) -> Vec<f64>,
    replayed: Option<&[Vec<f64>]>,
) -> Run {
    let facts = setting.kind.facts();
    // Half the width of the play between the first input, as it is logged, and what acts.
    let play = setting.size("drive.play");
    // What no catalogue has: correlation of the noise from row to row, noise of the last state per root
    // second, feedback of a row's own readings.
    let correlation = setting.size("noise.correlation");
    let shaken = setting.size("rate.noise") * libm::sqrt(facts.step_s);
    // A dead time of all inputs, rows; readings see none of it.
    let late = setting.size(LATE);
    let is_immediate = setting.size("feedback.same_row") > 0.0;
    let [mut noise, mut shakes] = [2, 3].map(|purpose| Stream::new(setting.seed, purpose));
    let fresh = libm::sqrt(1.0 - correlation * correlation);
    let mut errors = vec![0.0; facts.sigmas.len()];
    let mut state: [f64; N] = core::array::from_fn(|i| setting.initial[i]);
    let mut run = Run::default();
    let mut given = |row: usize, readings: &[f64]| match replayed {
        Some(inputs) => inputs[row.min(inputs.len() - 1)].clone(),
        None => input(row as f64 * facts.step_s, readings),
    };
    let mut here = given(0, &vec![0.0; facts.sigmas.len()]);
    let mut behind = here[0];
    for row in 0..setting.rows {
        let mut acting = here.clone();
        if play > 0.0 {
            behind = behind.max(here[0] - play).min(here[0] + play);
            acting[0] = behind;
        }
        let part = 1.0 / (setting.rows - 1) as f64;
        let share = row as f64 / (setting.rows - 1) as f64;
        let mut readings = outputs(&Moment {
            share,
            state: &state,
            input: &acting,
        });
        for ((reading, sigma), error) in readings.iter_mut().zip(facts.sigmas).zip(&mut errors) {
            *error = correlation * *error + fresh * noise.normal();
            *reading += setting.noise * sigma * *error;
        }
        if is_immediate {
            here = given(row, &readings);
            acting.clone_from(&here);
        }
        let next = given(row + 1, &readings);
        let end = if facts.interpolate { &next } else { &acting };
        let known = |wanted: usize| match wanted.checked_sub(row) {
            None => &run.inputs[wanted],
            Some(0) => &here,
            Some(_) => &next,
        };
        let rates = |place: f64, state: &[f64; N]| {
            let input = match late > 0.0 {
                true => {
                    let acts = (row as f64 + place - late).max(0.0);
                    let share = if facts.interpolate { acts.fract() } else { 0.0 };
                    let first = acts as usize;
                    between(known(first), known(first + 1), share)
                }
                false => between(&acting, end, place),
            };
            rates(&Moment {
                share: share + part * place,
                state,
                input: &input,
            })
        };
        let parts = if late > 0.0 { FINER } else { FINE };
        state = step(facts.step_s, parts, state, rates);
        if shaken > 0.0 {
            state[N - 1] += shaken * shakes.normal();
        }
        run.time_s.push(row as f64 * facts.step_s);
        run.inputs.push(core::mem::replace(&mut here, next));
        run.outputs.push(readings);
    }
    run
}

/// Inputs at a share of the way from some to others.
fn between(from: &[f64], to: &[f64], share: f64) -> Vec<f64> {
    let inputs = from.iter().zip(to);
    inputs.map(|(a, b)| a + share * (b - a)).collect()
}

/// The state after one step, in many parts; rates are given by the place in the step and the state.
fn step<const N: usize>(
    step_s: f64,
    parts: usize,
    mut state: [f64; N],
    rates: impl Fn(f64, &[f64; N]) -> [f64; N],
) -> [f64; N] {
    let h = step_s / parts as f64;
    for index in 0..parts {
        let mut slopes: Vec<[f64; N]> = Vec::with_capacity(STAGES.len());
        let moved = |weights: &[f64], slopes: &[[f64; N]]| -> [f64; N] {
            core::array::from_fn(|i| {
                let terms = weights.iter().zip(slopes);
                state[i] + h * terms.map(|(weight, slope)| weight * slope[i]).sum::<f64>()
            })
        };
        for (place, weights) in STAGES {
            let place = (index as f64 + place) / parts as f64;
            slopes.push(rates(place, &moved(weights, &slopes)));
        }
        state = moved(&WHOLE, &slopes);
    }
    state
}

/// A sum of sines with random frequencies and phases.
pub(super) struct Multisine(Vec<[f64; 3]>);

impl Multisine {
    /// Of a root mean square, between two frequencies, Hz.
    pub(super) fn new(random: &mut Stream, rms: f64, [low, high]: [f64; 2]) -> Self {
        const LINES: usize = 10;
        let amplitude = rms * libm::sqrt(2.0 / LINES as f64);
        let line = |_| {
            let frequency = random.log_between(low, high);
            [amplitude, frequency, random.uniform()]
        };
        Self((0..LINES).map(line).collect())
    }

    pub(super) fn at(&self, time_s: f64) -> f64 {
        let line = |[amplitude, frequency, phase]: &[f64; 3]| {
            amplitude * libm::sin(core::f64::consts::TAU * (frequency * time_s + phase))
        };
        self.0.iter().map(line).sum()
    }
}
