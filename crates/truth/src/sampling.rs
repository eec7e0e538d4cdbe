//! From exact samples to a record: noise, gaps and missing components.

use gyrocal_record::Record;

use crate::random::{Purpose, Stream};
use crate::scenario::Scenario;
use crate::term::Term;

/// Which rows a scenario has and what the logger makes of them.
pub(crate) struct Sampling<'a> {
    scenario: &'a Scenario,
    terms: &'a [Term],
    accel_noise: Stream,
    gyro_noise: Stream,
    missing: Stream,
    record: Record,
}

impl<'a> Sampling<'a> {
    pub(crate) fn new(scenario: &'a Scenario, terms: &'a [Term]) -> Self {
        let stream = |purpose| Stream::new(scenario.seed, purpose);
        Self {
            scenario,
            terms,
            accel_noise: stream(Purpose::AccelNoise),
            gyro_noise: stream(Purpose::GyroNoise),
            missing: stream(Purpose::Missing),
            record: Record::default(),
        }
    }

    /// Time since the first row of each row of the regular grid, by the record's clock.
    pub(crate) fn grid_s(&self) -> impl Iterator<Item = f64> + use<> {
        let interval_s = self.scenario.interval_s;
        (0..self.scenario.grid_rows()).map(move |row| row as f64 * interval_s)
    }

    /// The gyros' noise of the next interval \[deg/h\].
    pub(crate) fn held_gyro_noise_deg_per_h(&mut self) -> [f64; 3] {
        let sigma = self.scenario.held_gyro_noise_deg_per_h();
        self.gyro_noise.three_normals().map(|normal| sigma * normal)
    }

    /// Logs one row of the grid; says whether the record has it.
    pub(crate) fn log(&mut self, row: usize, since_first_s: f64, accel_g: [f64; 3]) -> bool {
        let noise = self.accel_noise.three_normals();
        let mut sample: [f64; 3] =
            core::array::from_fn(|axis| accel_g[axis] + self.scenario.accel_noise_g * noise[axis]);
        for term in self.terms {
            if let Term::Noise(change) = term {
                sample = change(row, sample);
            }
        }
        for component in &mut sample {
            if self.missing.uniform() < self.scenario.missing_fraction {
                *component = f64::NAN;
            }
        }
        let gaps_s = &self.scenario.gaps_s;
        if gaps_s
            .iter()
            .any(|gap| (gap[0]..gap[1]).contains(&since_first_s))
        {
            return false;
        }
        self.record
            .time_s
            .push(self.scenario.start_s + since_first_s);
        self.record.accel_g.push(sample);
        true
    }

    /// The record so far.
    pub(crate) fn into_record(self) -> Record {
        self.record
    }
}
