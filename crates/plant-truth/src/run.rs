//! A simulated record, and the integration that makes it.

use crate::random::Stream;
use crate::setting::Setting;

/// Steps of the simulation between two rows: finer than those of any model.
const FINE: usize = 10;

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
            fields.extend(self.inputs[row].iter().map(|value| format!("{value:.6}")));
            fields.extend(self.outputs[row].iter().map(|value| format!("{value:.5}")));
            text += &(fields.join(",") + "\n");
        }
        text
    }
}

/// A moment of a simulation.
pub(crate) struct Moment<'a, const N: usize> {
    /// Share of the record that has passed.
    pub(crate) share: f64,
    pub(crate) state: &'a [f64; N],
    pub(crate) input: &'a [f64],
}

/// A plant as a simulator.
pub(crate) struct Simulator<'a, const N: usize> {
    pub(crate) setting: &'a Setting,
    pub(crate) step_s: f64,
    /// Inputs between rows go in a straight line; they are held otherwise.
    pub(crate) interpolate: bool,
    /// Half the width of the play between the first input, as it is logged, and what acts.
    pub(crate) play: f64,
    pub(crate) rates: &'a dyn Fn(&Moment<'_, N>) -> [f64; N],
    pub(crate) outputs: &'a dyn Fn(&Moment<'_, N>) -> Vec<f64>,
}

impl<const N: usize> Simulator<'_, N> {
    /// The record; `input` gives the inputs of a row from its time and the readings of the row before.
    /// With `replayed` inputs nothing is fed back.
    pub(crate) fn run(
        &self,
        mut input: impl FnMut(f64, &[f64]) -> Vec<f64>,
        replayed: Option<&[Vec<f64>]>,
    ) -> Run {
        let setting = self.setting;
        let sigmas = setting.kind.facts().sigmas;
        let mut noise = Stream::new(setting.seed, 2);
        let mut state: [f64; N] = core::array::from_fn(|i| setting.initial[i]);
        let mut run = Run::default();
        let mut readings = vec![0.0; sigmas.len()];
        let rows = setting.rows;
        let mut given = |row: usize, readings: &[f64]| match replayed {
            Some(inputs) => inputs[row.min(inputs.len() - 1)].clone(),
            None => input(row as f64 * self.step_s, readings),
        };
        let mut here = given(0, &readings);
        let mut behind = here.first().copied().unwrap_or(0.0);
        for row in 0..rows {
            let mut acting = here.clone();
            if self.play > 0.0 {
                behind = behind.max(here[0] - self.play).min(here[0] + self.play);
                acting[0] = behind;
            }
            let share = row as f64 / (rows - 1) as f64;
            let moment = Moment {
                share,
                state: &state,
                input: &acting,
            };
            readings = (self.outputs)(&moment);
            for (reading, sigma) in readings.iter_mut().zip(sigmas) {
                *reading += setting.noise * sigma * noise.normal();
            }
            run.time_s.push(row as f64 * self.step_s);
            run.inputs.push(here.clone());
            run.outputs.push(readings.clone());
            let next = given(row + 1, &readings);
            let end = if self.interpolate { &next } else { &acting };
            state = self.step(state, [share, 1.0 / (rows - 1) as f64], [&acting, end]);
            here = next;
        }
        run
    }

    /// Moves the state over one step, by Kutta's 3/8 rule in many parts.
    fn step(&self, state: [f64; N], [share, part]: [f64; 2], [from, to]: [&[f64]; 2]) -> [f64; N] {
        let h = self.step_s / FINE as f64;
        let mut here = state;
        let rates = |place: f64, state: &[f64; N]| {
            let input: Vec<f64> = from
                .iter()
                .zip(to)
                .map(|(a, b)| a + place * (b - a))
                .collect();
            (self.rates)(&Moment {
                share: share + part * place,
                state,
                input: &input,
            })
        };
        let sum = |terms: &[(f64, &[f64; N])], base: &[f64; N]| -> [f64; N] {
            core::array::from_fn(|i| {
                base[i] + h * terms.iter().map(|(factor, k)| factor * k[i]).sum::<f64>()
            })
        };
        for index in 0..FINE {
            let place = |part: f64| (index as f64 + part) / FINE as f64;
            let k1 = rates(place(0.0), &here);
            let k2 = rates(place(1.0 / 3.0), &sum(&[(1.0 / 3.0, &k1)], &here));
            let k3 = rates(
                place(2.0 / 3.0),
                &sum(&[(-1.0 / 3.0, &k1), (1.0, &k2)], &here),
            );
            let k4 = rates(
                place(1.0),
                &sum(&[(1.0, &k1), (-1.0, &k2), (1.0, &k3)], &here),
            );
            let eighth = 1.0 / 8.0;
            let all = [
                (eighth, &k1),
                (3.0 * eighth, &k2),
                (3.0 * eighth, &k3),
                (eighth, &k4),
            ];
            here = sum(&all, &here);
        }
        here
    }
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
