//! A record replayed through the watch of a controller.

use gyrocal::effect::EffectKind;
use gyrocal::watch::{
    Candidate, EFFECTS_BY_DEFAULT, Grid, PlatformWatch, WatchSettings, WatchedEffect,
};
use gyrocal::{
    ControllerError, Discretisation, Drift, EFFECTS, FilterSettings, InitialAttitude, Limits, Real,
    SavedNumber, Site,
};
use gyrocal_calibration::{CalibrationError, declared_attitude, filter_settings};
use gyrocal_record::{AXES, Bench, Manifest, Record, SCHEMA_VERSION};
use serde::Serialize;

use crate::error::DiagnosisError;

/// Longest gap in a record that is passed over, s: thirty years.
const LONGEST_S: f64 = 1e9;

/// Options of a replay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WatchOptions {
    /// Largest probability of a false alarm in a year.
    pub false_alarms_per_year: f64,
    /// Random walk of the drift of each gyro that filter and watch expect, deg/h/√h.
    pub walk_deg_per_h_per_sqrt_h: f64,
    /// Compute in single precision, as the controller does.
    pub single: bool,
}

impl Default for WatchOptions {
    fn default() -> Self {
        let settings = WatchSettings::<f64>::default();
        let [walk, ..] = settings.walk_deg_per_h_per_sqrt_h;
        Self {
            false_alarms_per_year: settings.false_alarms_per_year,
            walk_deg_per_h_per_sqrt_h: walk,
            single: false,
        }
    }
}

/// Result of `gyrocal watch`.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WatchResult {
    /// [`SCHEMA_VERSION`] at the time of writing.
    pub schema_version: u32,
    /// Program, inputs and command that made the result.
    pub manifest: Manifest,
    /// The watch.
    pub watch: WatchReplay,
}

impl WatchResult {
    /// The result of a replay.
    #[must_use]
    pub fn new(manifest: Manifest, watch: WatchReplay) -> Self {
        Self {
            schema_version: SCHEMA_VERSION,
            manifest,
            watch,
        }
    }
}

/// The watch over a record.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WatchReplay {
    /// Rows of the record.
    pub rows: usize,
    /// Rows that were not taken: a component is missing or out of range, or the NIS is too large.
    pub refused_rows: usize,
    /// Probability of a false alarm in a year.
    pub false_alarms_per_year: f64,
    /// Declared random walk of each gyro, deg/h/√h.
    pub walk_deg_per_h_per_sqrt_h: f64,
    /// Alarms in their order. After each the watch went on with new onsets.
    pub alarms: Vec<WatchAlarm>,
    /// Evidence at the end, over its threshold: of effects, and of jumps.
    pub evidence_at_end: [f64; 2],
}

/// An alarm.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WatchAlarm {
    /// Row of the alarm, counted from 1.
    pub row: usize,
    /// Its time, s.
    pub time_s: f64,
    /// True for a jump of the attitude, which has a grid of its own.
    pub jump: bool,
    /// Row at which the set was asked for again: after twice the delay, before an onset of the set is
    /// dropped, or at the end of the record.
    pub refined_row: usize,
    /// Effects that cannot be told apart at the alarm, the most likely one first.
    pub at_alarm: Vec<WatchCause>,
    /// The same when it was refined.
    pub refined: Vec<WatchCause>,
    /// Random walks of gyros, larger than declared, that cannot be told apart from an effect of either set.
    pub walks: Vec<&'static str>,
}

/// An effect that an alarm may stand for.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WatchCause {
    /// Id of the effect in the catalogue.
    pub id: String,
    /// Axis that the attitude jumped about, from zero; `None` for other effects.
    #[serde(skip)]
    pub jump_axis: Option<usize>,
    /// Gyro whose random walk, larger than declared, cannot be told apart from it.
    #[serde(skip)]
    pub walking_gyro: Option<usize>,
    /// Estimate of its size.
    pub estimate: f64,
    /// Standard deviation of the estimate, from the declared noise.
    pub sigma: f64,
    /// Unit of both.
    pub unit: &'static str,
    /// Time since which it is there, s.
    pub since_s: f64,
    /// Twice the logarithm of its likelihood ratio.
    pub deviance: f64,
}

/// Replays a record through filter and watch as they run on a controller.
///
/// # Errors
/// [`DiagnosisError::Calibration`] if the bench declares no attitude, or if the filter stops;
/// [`DiagnosisError::InvalidArgument`] for an option without meaning.
pub fn watch_record(
    record: &Record,
    bench: &Bench,
    options: &WatchOptions,
) -> Result<WatchReplay, DiagnosisError> {
    if options.single {
        Replay::<f32>::start(record, bench, options)?.run()
    } else {
        Replay::<f64>::start(record, bench, options)?.run()
    }
}

struct Replay<'a, T: SavedNumber> {
    record: &'a Record,
    watched: Box<PlatformWatch<T>>,
    answer: WatchReplay,
    /// The last alarm, until its set is refined, and the row for that.
    open: Option<(WatchAlarm, usize)>,
}

impl<'a, T: SavedNumber> Replay<'a, T> {
    fn start(
        record: &'a Record,
        bench: &Bench,
        options: &WatchOptions,
    ) -> Result<Self, DiagnosisError> {
        let attitude = declared_attitude(bench).ok_or(CalibrationError::NoAttitude)?;
        let number = T::from_f64;
        let intervals = record.time_s.windows(2).map(|pair| pair[1] - pair[0]);
        let shortest_s = intervals.fold(f64::INFINITY, f64::min);
        let watch = WatchSettings {
            false_alarms_per_year: number(options.false_alarms_per_year),
            interval_s: number(shortest_s),
            walk_deg_per_h_per_sqrt_h: [number(options.walk_deg_per_h_per_sqrt_h); 3],
            ..WatchSettings::default()
        };
        let settings = filter_settings(bench, Discretisation::default());
        let limits = Limits {
            longest_interval_s: number(LONGEST_S),
            ..Limits::default()
        };
        let mut watched = Box::new(PlatformWatch::<T>::default());
        watched
            .start(
                &in_numbers(&settings),
                &attitude_in_numbers(&attitude),
                limits,
                &watch,
            )
            .map_err(|error| stopped(record, 0, error))?;
        Ok(Self {
            record,
            watched,
            answer: WatchReplay {
                rows: record.len(),
                refused_rows: 0,
                false_alarms_per_year: options.false_alarms_per_year,
                walk_deg_per_h_per_sqrt_h: options.walk_deg_per_h_per_sqrt_h,
                alarms: Vec::new(),
                evidence_at_end: [0.0; 2],
            },
            open: None,
        })
    }

    fn run(mut self) -> Result<WatchReplay, DiagnosisError> {
        let record = self.record;
        let last = record.len().saturating_sub(1);
        for row in 0..record.len() {
            let sample = record.accel_g[row].map(T::from_f64);
            if row == 0 {
                match self.watched.update(&sample) {
                    Err(error) if is_refusal(error) => self.answer.refused_rows += 1,
                    Err(error) => return Err(stopped(record, row, error)),
                    Ok(_) => {}
                }
                continue;
            }
            let interval_s = T::from_f64(record.time_s[row] - record.time_s[row - 1]);
            let alarm = match self.watched.step(interval_s, &sample) {
                Ok(step) => step.alarm,
                Err(error) if error.has_coasted() => {
                    self.answer.refused_rows += 1;
                    let alarm = self.watched.alarm();
                    if alarm.is_none() && error == ControllerError::Diverged {
                        let reopened = self.watched.reopen(&sample);
                        reopened.map_err(|error| stopped(record, row, error))?;
                    }
                    alarm
                }
                Err(error) if is_refusal(error) => {
                    self.answer.refused_rows += 1;
                    self.watched
                        .coast(interval_s)
                        .map_err(|error| stopped(record, row, error))?;
                    None
                }
                Err(error) => return Err(stopped(record, row, error)),
            };
            self.note(row, alarm, last);
        }
        self.answer.evidence_at_end = self.watched.evidence().map(|share| share.to_f64());
        Ok(self.answer)
    }

    /// Opens an alarm, and closes it when its set is refined.
    fn note(&mut self, row: usize, alarm: Option<Grid>, last: usize) {
        if let (None, Some(grid)) = (&self.open, alarm) {
            let at_alarm = self.causes(row);
            let since_s = at_alarm.first().map_or(0.0, |cause| cause.since_s);
            let time_s = self.record.time_s[row];
            let again_s = time_s + (time_s - since_s);
            let refined_row = self.record.time_s.partition_point(|time| *time < again_s);
            // Before an onset of the set is dropped.
            let refined_row = refined_row.min(row + self.steps_left());
            let alarm = WatchAlarm {
                row: row + 1,
                time_s,
                jump: grid == Grid::Jumps,
                refined_row: refined_row.min(last) + 1,
                at_alarm,
                refined: Vec::new(),
                walks: Vec::new(),
            };
            self.open = Some((alarm, refined_row.min(last)));
        }
        if self.open.as_ref().is_some_and(|(_, again)| row >= *again)
            && let Some((mut alarm, _)) = self.open.take()
        {
            alarm.refined = self.causes(row);
            alarm.walks = walks_in(alarm.at_alarm.iter().chain(&alarm.refined));
            self.answer.alarms.push(alarm);
            self.watched.go_on();
        }
    }

    /// Steps that all onsets of the set still live.
    fn steps_left(&self) -> usize {
        let mut left = u32::MAX;
        self.watched.candidates(|_, candidate| {
            left = left.min(self.watched.steps_left(&candidate));
        });
        left.saturating_sub(1) as usize
    }

    fn causes(&self, row: usize) -> Vec<WatchCause> {
        let mut causes = Vec::new();
        self.watched.candidates(|effect, candidate| {
            causes.push(self.cause(row, effect, &candidate));
        });
        causes.sort_by(|a: &WatchCause, b| b.deviance.total_cmp(&a.deviance));
        causes
    }

    fn cause(
        &self,
        row: usize,
        effect: Option<&WatchedEffect>,
        candidate: &Candidate<T>,
    ) -> WatchCause {
        let [estimate, sigma] = [candidate.estimate, candidate.sigma].map(|number| number.to_f64());
        let since = row.saturating_sub(candidate.steps_since as usize);
        let (id, jump_axis, unit, scale) = match effect {
            Some(effect) => (effect.id.to_owned(), None, effect.unit, 1.0),
            None => {
                let axis = candidate.effect - EFFECTS_BY_DEFAULT.len();
                let letter = AXES.get(axis).copied().unwrap_or_default();
                (
                    format!("platform.knock about {letter}"),
                    Some(axis),
                    "deg",
                    1.0_f64.to_degrees(),
                )
            }
        };
        WatchCause {
            id,
            jump_axis,
            walking_gyro: effect.and_then(WatchedEffect::walking_gyro),
            estimate: scale * estimate,
            sigma: scale * sigma,
            unit,
            since_s: self.record.time_s[since],
            deviance: candidate.deviance.to_f64(),
        }
    }
}

/// The random walks that cannot be told apart from causes of a set.
fn walks_in<'c>(causes: impl Iterator<Item = &'c WatchCause>) -> Vec<&'static str> {
    let gyros: Vec<usize> = causes.filter_map(|cause| cause.walking_gyro).collect();
    let walks = EFFECTS
        .iter()
        .filter(|effect| effect.kind == EffectKind::RandomWalk);
    walks
        .filter(|walk| walk.rate().is_some_and(|rate| gyros.contains(&rate)))
        .map(|walk| walk.id)
        .collect()
}

/// Settings in the numbers of the filter.
fn in_numbers<T: Real>(settings: &FilterSettings<f64>) -> FilterSettings<T> {
    let number = T::from_f64;
    let site = Site {
        latitude_rad: number(settings.site.latitude_rad),
        earth_rate_rad_per_s: number(settings.site.earth_rate_rad_per_s),
        gravity_g: number(settings.site.gravity_g),
    };
    FilterSettings {
        drift: Drift::from_array(settings.drift.to_array().map(number)),
        drift_sigma: Drift::from_array(settings.drift_sigma.to_array().map(number)),
        accel_noise_g: number(settings.accel_noise_g),
        drift_noise_deg_per_h: number(settings.drift_noise_deg_per_h),
        ..FilterSettings::at_site(site)
    }
}

fn attitude_in_numbers<T: Real>(attitude: &InitialAttitude<f64>) -> InitialAttitude<T> {
    let numbers = |three: [f64; 3]| three.map(T::from_f64);
    match *attitude {
        InitialAttitude::Angles {
            angles_rad,
            sigma_rad,
        } => InitialAttitude::Angles {
            angles_rad: numbers(angles_rad),
            sigma_rad: numbers(sigma_rad),
        },
        InitialAttitude::Orientation {
            north_and_up,
            sigma_rad,
        } => InitialAttitude::Orientation {
            north_and_up: north_and_up.map(numbers),
            sigma_rad: numbers(sigma_rad),
        },
    }
}

fn is_refusal(error: ControllerError) -> bool {
    matches!(
        error,
        ControllerError::SampleNotFinite { .. }
            | ControllerError::SampleOutOfRange { .. }
            | ControllerError::SampleSurprising
    )
}

fn stopped(record: &Record, row: usize, error: ControllerError) -> DiagnosisError {
    match error {
        ControllerError::Failed(source) | ControllerError::Settings(source) => {
            CalibrationError::Filter {
                row: row + 1,
                time_s: record.time_s.get(row).copied().unwrap_or_default(),
                source,
            }
            .into()
        }
        _ => DiagnosisError::InvalidArgument {
            what: "the time between two rows in seconds",
            found: match row {
                0 => f64::NAN,
                row => record.time_s[row] - record.time_s[row - 1],
            },
            expected: "an interval that the filter can pass",
        },
    }
}
