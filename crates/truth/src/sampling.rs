//! From exact samples to a record: noise, gaps and missing components.

use gyrocal_record::Record;
use libm::rint;

use crate::effect::Effect;
use crate::random::{Purpose, Stream};
use crate::scenario::Scenario;
use crate::temperature::Point;
use crate::term::Term;

/// The logger: samples with noise, gaps and missing components.
pub(crate) struct Sampling<'a> {
    scenario: &'a Scenario,
    terms: &'a [Term],
    noise: AccelNoise,
    missing: Stream,
    temperature: Option<Vec<Point>>,
    record: Record,
    outliers: Vec<[bool; 3]>,
}

/// Noise of the accelerometers with hidden effects on it.
struct AccelNoise {
    white: Stream,
    sigma_g: [f64; 3],
    correlation: f64,
    /// The last noise of each accelerometer, in sigmas.
    last: Option<[f64; 3]>,
    outliers: Option<Outliers>,
    lsb_g: [Option<f64>; 3],
}

struct Outliers {
    stream: Stream,
    fraction: f64,
    size_g: f64,
}

impl<'a> Sampling<'a> {
    pub(crate) fn new(
        scenario: &'a Scenario,
        terms: &'a [Term],
        temperature: Option<Vec<Point>>,
    ) -> Self {
        let rows = scenario.grid_rows();
        Self {
            scenario,
            terms,
            noise: AccelNoise::new(scenario),
            missing: Stream::new(scenario.seed, Purpose::Missing),
            record: Record {
                time_s: Vec::with_capacity(rows),
                accel_g: Vec::with_capacity(rows),
                temperature_c: temperature.as_ref().map(|_| Vec::with_capacity(rows)),
            },
            temperature,
            outliers: Vec::new(),
        }
    }

    /// Logs one row of the grid; returns false if it falls into a gap.
    pub(crate) fn log(&mut self, row: usize, since_first_s: f64, output_g: [f64; 3]) -> bool {
        let (mut sample, outliers) = self.noise.sample_g(output_g);
        for term in self.terms {
            if let Term::Noise(change) = term {
                sample = change(row, sample);
            }
        }
        if self.scenario.missing_fraction > 0.0 {
            for component in &mut sample {
                if self.missing.uniform() < self.scenario.missing_fraction {
                    *component = f64::NAN;
                }
            }
        }
        if !self.scenario.logs(since_first_s) {
            return false;
        }
        let time_s = self.scenario.start_s + since_first_s;
        self.record.time_s.push(time_s);
        self.record.accel_g.push(sample);
        if let (Some(column), Some(course)) = (&mut self.record.temperature_c, &self.temperature) {
            column.extend(course.get(row).map(|point| point.temperature_c));
        }
        self.outliers.push(outliers);
        true
    }

    /// The record so far, and which of its components are outliers.
    pub(crate) fn into_record(self) -> (Record, Vec<[bool; 3]>) {
        (self.record, self.outliers)
    }
}

impl AccelNoise {
    fn new(scenario: &Scenario) -> Self {
        let mut noise = Self {
            white: Stream::new(scenario.seed, Purpose::AccelNoise),
            sigma_g: [scenario.accel_noise_g; 3],
            correlation: 0.0,
            last: None,
            outliers: None,
            lsb_g: [None; 3],
        };
        for hidden in &scenario.hidden {
            let value = hidden.value(0);
            match hidden.effect() {
                Effect::AccelNoise(axis) => noise.sigma_g[axis] *= value,
                Effect::ColouredNoise => noise.correlation = value,
                Effect::AccelQuantisation(axis) => noise.lsb_g[axis] = Some(value),
                Effect::Outliers => {
                    noise.outliers = Some(Outliers {
                        stream: Stream::new(scenario.seed, Purpose::Outliers),
                        fraction: value,
                        size_g: hidden.value(1) * scenario.accel_noise_g,
                    });
                }
                _ => {}
            }
        }
        noise
    }

    /// A noisy sample, and which components of it are outliers.
    fn sample_g(&mut self, output_g: [f64; 3]) -> ([f64; 3], [bool; 3]) {
        let fresh = self.white.three_normals();
        let noise = match self.last {
            // First-order correlation, of the same variance in every sample.
            Some(last) if self.correlation != 0.0 => {
                let share = (1.0 - self.correlation * self.correlation).sqrt();
                core::array::from_fn(|axis| self.correlation * last[axis] + share * fresh[axis])
            }
            _ => fresh,
        };
        self.last = Some(noise);
        let mut sample =
            core::array::from_fn(|axis| output_g[axis] + self.sigma_g[axis] * noise[axis]);
        let mut which = [false; 3];
        if let Some(outliers) = &mut self.outliers {
            for (component, is_outlier) in sample.iter_mut().zip(&mut which) {
                let error_g = outliers.next_g();
                *is_outlier = error_g.is_some();
                *component += error_g.unwrap_or(0.0);
            }
        }
        for (component, lsb_g) in sample.iter_mut().zip(self.lsb_g) {
            if let Some(lsb_g) = lsb_g {
                *component = rint(*component / lsb_g) * lsb_g;
            }
        }
        (sample, which)
    }
}

impl Outliers {
    /// The error of the next component, if it is an outlier, of either sign.
    fn next_g(&mut self) -> Option<f64> {
        let (chance, sign) = (self.stream.uniform(), self.stream.uniform());
        let size_g = if sign < 0.5 {
            -self.size_g
        } else {
            self.size_g
        };
        (chance < self.fraction).then_some(size_g)
    }
}
