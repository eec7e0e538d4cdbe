//! Rows of a planned run.

use gyrocal_record::Record;

use super::Evaluator;

/// Longest interval between rows of a planned run of a strapdown unit, s: its axes turn by 15° in the
/// platform, uniformly to 0.3 % between rows.
const LONGEST_OF_UNIT_S: f64 = 3600.0;

impl Evaluator<'_> {
    /// Rows over a duration, and what the noise of a sample is multiplied by where one of them
    /// stands for several of the logger's.
    pub(super) fn rows(&self, duration_s: f64) -> (Record, f64) {
        let logged_s = interval_s(self.run.record);
        let steps = (duration_s / logged_s).round().max(1.0);
        let least = match self.unit {
            Some(_) => (duration_s / LONGEST_OF_UNIT_S).ceil(),
            None => 1.0,
        };
        let taken = steps.min((self.detail.rows as f64).max(least)).max(1.0);
        let interval_s = duration_s / taken;
        let time_s: Vec<f64> = (0..=taken as usize)
            .map(|row| row as f64 * interval_s)
            .collect();
        let temperature_c = self.run.record.temperature_c.as_ref().map(|temperature| {
            time_s
                .iter()
                .map(|t| self.temperature_c(temperature, *t))
                .collect()
        });
        let rows = time_s.len();
        (
            Record {
                time_s,
                accel_g: vec![[0.0, 0.0, 1.0]; rows],
                temperature_c,
            },
            (logged_s / interval_s).sqrt(),
        )
    }

    /// The temperature of the record at a time since the start of a run; whole days later it is
    /// the same again.
    fn temperature_c(&self, temperature: &[f64], time_s: f64) -> f64 {
        const DAY_S: f64 = 86_400.0;
        let record = self.run.record;
        let first_s = record.time_s.first().copied().unwrap_or(0.0);
        let length_s = record.duration_s();
        let days_s = (length_s / DAY_S).floor() * DAY_S;
        let at = if days_s > 0.0 {
            time_s.rem_euclid(days_s)
        } else {
            time_s.min(length_s)
        };
        let row = record.time_s.partition_point(|t| t - first_s < at);
        temperature
            .get(row.min(temperature.len().saturating_sub(1)))
            .copied()
            .unwrap_or(0.0)
    }
}

/// The usual interval of a record, s.
pub(crate) fn interval_s(record: &Record) -> f64 {
    let mut intervals: Vec<f64> = record
        .time_s
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .collect();
    intervals.sort_unstable_by(f64::total_cmp);
    intervals.get(intervals.len() / 2).copied().unwrap_or(60.0)
}
