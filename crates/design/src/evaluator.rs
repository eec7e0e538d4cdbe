//! Evaluation of one attitude and duration.

mod rows;

use gyrocal::Discretisation;
use gyrocal::effect::Continuation;
use gyrocal::trajectory::{Orientation, angles_rad, platform_c_enu, turned};
use gyrocal_calibration::{
    CalibrationError, FittedPlatform, NoiseModel, Options, PLATFORM, PlannedRun, Run,
    TemperatureScale, UnitStart,
};
use gyrocal_hypothesis::{RecordOffset, continued, continued_shapes};
use gyrocal_record::{Bench, GimbalLimits, Record};
use nalgebra::{DMatrix, DVector};

use crate::attitude::of_angles;
use crate::design_column::begins;
use crate::effect_columns::offset_after;
use crate::expected_sets::{Deviates, Posteriors, expected};
use crate::joint_unknowns::JointUnknowns;
use crate::past::Past;
use crate::result::{Forecast, Outlook, SetForecast, ratio};
use crate::run_information::{RunInformation, predicted_information};
use crate::sigma::sigmas;
pub(crate) use rows::interval_s;

/// Resolution of an evaluation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Detail {
    /// Largest number of rows; each then has the information of several samples.
    pub(crate) rows: usize,
    /// Draws of the next run for each member of a set.
    pub(crate) draws: usize,
}

/// Longest step of the integration, s: a turn of 2.5° is integrated to 1e-9 rad.
const LONGEST_STEP_S: f64 = 600.0;

/// Largest turn of a unit about the vertical that a forecast allows for, rad: from North to halfway to East.
const LARGEST_TURN_RAD: f64 = core::f64::consts::FRAC_PI_4;

/// Evaluates attitudes for one duration.
pub(crate) struct Evaluator<'a> {
    pub(crate) unknowns: &'a JointUnknowns,
    pub(crate) run: Run<'a>,
    noise: &'a NoiseModel,
    limits: GimbalLimits,
    options: Options,
    /// In the last record, and in the next run, which begins with what a step or a ramp has come to.
    parameters: Vec<f64>,
    next_parameters: Vec<f64>,
    shapes: Vec<f64>,
    next_shapes: Vec<f64>,
    /// Attitude of the platform where the last record begins.
    start: Orientation,
    /// How the last record begins, of a strapdown unit.
    unit: Option<UnitStart>,
    /// Start of the record that goes on, on the clock of all, s.
    start_s: f64,
    temperature_scale: Option<TemperatureScale>,
    now: RunInformation,
    before: Vec<Forecast>,
    posteriors: Vec<Posteriors>,
    deviates: Deviates,
    duration_s: f64,
    detail: Detail,
}

/// Result for one attitude.
pub(crate) enum Evaluation {
    /// Forecast from record and run together.
    At(Outlook),
    /// The gimbals reach a limit after this time, s.
    Stopped(f64),
}

impl<'a> Evaluator<'a> {
    #[expect(
        clippy::too_many_arguments,
        reason = "what one plan is made of, put together in one place"
    )]
    pub(crate) fn new(
        unknowns: &'a JointUnknowns,
        fitted: &FittedPlatform<'_>,
        past: &'a Past<'_>,
        noise: &'a NoiseModel,
        information: &RunInformation,
        limits: GimbalLimits,
        options: Options,
        (duration_s, detail, seed): (f64, Detail, u64),
    ) -> Option<Self> {
        let now = unknowns.of_first(information);
        let (before, _) = sigmas(unknowns, &now.information)?;
        let posteriors = unknowns
            .cases
            .iter()
            .map(|case| Posteriors::new(case, &unknowns.list, &now))
            .collect();
        let last = past.records() - 1;
        let run = past.last();
        let shapes = fitted.shapes_in(last);
        let (next_parameters, next_shapes) = if past.is_several() {
            let next = one_more(unknowns, fitted.shared_parameters());
            (next, shapes.clone())
        } else {
            let offset = offset_after(run.record.duration_s());
            let next = next_parameters(unknowns, &fitted.parameters(), &offset);
            (next, continued_shapes(&PLATFORM, &shapes, &offset))
        };
        Some(Self {
            unknowns,
            run,
            noise,
            limits,
            options: Options {
                discretisation: Discretisation {
                    longest_step_s: options.discretisation.longest_step_s.max(LONGEST_STEP_S),
                    ..options.discretisation
                },
                ..options
            },
            next_parameters,
            parameters: fitted.parameters_in(last),
            next_shapes,
            shapes,
            start: *fitted.points().get(past.first_row())?,
            unit: fitted.unit_start(last),
            start_s: past.start_s,
            temperature_scale: fitted.temperature_scale(),
            now,
            before,
            posteriors,
            deviates: Deviates::new(unknowns.list.len(), detail.draws, seed),
            duration_s,
            detail,
        })
    }

    /// Forecast from the record alone.
    pub(crate) fn present(&self) -> Option<Outlook> {
        let (coefficients, sizes) = sigmas(self.unknowns, &self.now.information)?;
        let sets = self
            .unknowns
            .cases
            .iter()
            .filter_map(|case| {
                let size = case.members.len();
                let one_left = f64::from(u8::from(size == 1));
                case.forecast(size as f64, one_left, |index| {
                    f64::from(u8::from(index == 0))
                })
            })
            .collect();
        Some(Outlook {
            sigma_ratio: 1.0,
            coefficients,
            sizes,
            sets,
        })
    }

    /// A run from angles of the platform at its first row, or of a strapdown unit at rest.
    ///
    /// A unit stands as its heading is known: the forecast is the worse one of a turn by a standard deviation to
    /// either side. A gyro that is exactly along North does not see an error of the heading, and stands there by
    /// chance only.
    pub(crate) fn evaluate(&self, angles_deg: [f64; 3]) -> Result<Evaluation, CalibrationError> {
        let start = of_angles(angles_deg);
        let Some(unit) = self.unit.as_ref().map(UnitStart::along_instruments) else {
            return self.evaluate_from(angles_deg, start, None);
        };
        let turn = unit.heading_sigma_rad().min(LARGEST_TURN_RAD);
        let beside = |turn: f64| {
            let start = turned(&start, &start[1].map(|component| turn * component));
            self.evaluate_from(angles_deg, start, Some(unit))
        };
        Ok(match (beside(turn)?, beside(-turn)?) {
            (Evaluation::At(one), Evaluation::At(other)) => {
                Evaluation::At(one.worse(other, &self.before))
            }
            (Evaluation::At(_), stopped) | (stopped, _) => stopped,
        })
    }

    fn evaluate_from(
        &self,
        angles_deg: [f64; 3],
        start: Orientation,
        unit: Option<UnitStart>,
    ) -> Result<Evaluation, CalibrationError> {
        let (mut record, noise_factor) = self.rows(self.duration_s);
        // Where the bench gives no attitude the first samples have to tell it.
        let up = start[1].map(|component| component * self.run.bench.specific_force_at_rest());
        record.accel_g.fill(up);
        let given = self.run.bench.initial_angles_deg.is_some();
        let bench = Bench {
            initial_angles_deg: given.then_some(angles_deg),
            accel_noise_g: noise_factor * self.run.bench.accel_noise_g,
            ..self.run.bench.clone()
        };
        let model = (&self.next_parameters[..], &self.next_shapes[..]);
        let planned = self.planned(&record, &bench, (start, unit), model);
        let points = planned.trajectory(&self.options)?;
        if let Some(row) = self.stop(&points) {
            return Ok(Evaluation::Stopped(
                record.time_s[row.saturating_sub(1)] - record.time_s[0],
            ));
        }
        let columns = &self.unknowns.next;
        let information = predicted_information(&planned, columns, 0, points, &self.options)?;
        let next = self.unknowns.of_next(&silent(information)).information;
        Ok(self
            .outlook(&next)
            .map_or(Evaluation::Stopped(0.0), Evaluation::At))
    }

    /// Forecast for continuing the last record for the duration of the next run.
    pub(crate) fn continued(&self) -> Result<Option<Outlook>, CalibrationError> {
        let first_s = self.run.record.duration_s();
        let (mut record, noise_factor) = self.rows(first_s + self.duration_s);
        let given = self.run.bench.initial_angles_deg.is_some();
        if !given {
            let up = self.start[1].map(|x| x * self.run.bench.specific_force_at_rest());
            record.accel_g.fill(up);
        }
        let bench = Bench {
            accel_noise_g: noise_factor * self.run.bench.accel_noise_g,
            ..self.run.bench.clone()
        };
        let model = (&self.parameters[..], &self.shapes[..]);
        let planned = self.planned(&record, &bench, (self.start, self.unit), model);
        let points = planned.trajectory(&self.options)?;
        let from = record.time_s.partition_point(|t| *t <= first_s);
        // A fit's own columns, which are of the record's own rows, say nothing here.
        let columns = self.unknowns.first.iter();
        let columns: Vec<_> = columns.map(|column| column.in_last(self.start_s)).collect();
        let information = predicted_information(&planned, &columns, from, points, &self.options)?;
        let next = self.unknowns.of_first(&silent(information)).information;
        Ok(self.outlook(&next))
    }

    fn outlook(&self, next: &DMatrix<f64>) -> Option<Outlook> {
        let total = &self.now.information + next;
        let (coefficients, sizes) = sigmas(self.unknowns, &total)?;
        let sets: Option<Vec<SetForecast>> = self
            .unknowns
            .cases
            .iter()
            .zip(&self.posteriors)
            .map(|(case, posteriors)| {
                expected(
                    case,
                    &self.unknowns.list,
                    posteriors,
                    &self.now,
                    next,
                    &self.deviates,
                )
            })
            .collect();
        Some(Outlook {
            sigma_ratio: ratio(&coefficients, &self.before),
            coefficients,
            sizes,
            sets: sets?,
        })
    }

    /// First row at which the gimbals are at a limit. A strapdown unit rests in an attitude that was tried
    /// because it is within them.
    fn stop(&self, points: &[Orientation]) -> Option<usize> {
        if self.unit.is_some() {
            return None;
        }
        points.iter().position(|point| !self.allowed(point))
    }

    fn allowed(&self, point: &Orientation) -> bool {
        let angles = angles_rad(&platform_c_enu(point)).map(f64::to_degrees);
        // The same attitude by the other way round.
        let other = [angles[0] + 180.0, 180.0 - angles[1], angles[2] + 180.0];
        self.limits.hold(angles) || self.limits.hold(other)
    }

    fn planned<'b>(
        &'b self,
        record: &'b Record,
        bench: &'b Bench,
        (start, unit): (Orientation, Option<UnitStart>),
        (parameters, shapes): (&'b [f64], &[f64]),
    ) -> PlannedRun<'b> {
        PlannedRun {
            run: Run { record, bench },
            start,
            unit,
            parameters,
            shapes: core::array::from_fn(|index| shapes[index]),
            noise: self.noise,
            temperature_scale: self.temperature_scale,
        }
    }
}

/// Parameters at the start of the next run, each named effect as it continues there.
fn next_parameters(
    unknowns: &JointUnknowns,
    parameters: &[f64],
    offset: &RecordOffset,
) -> Vec<f64> {
    let mut next = parameters.to_vec();
    let named = unknowns.cases.iter();
    for named in named.filter_map(|case| case.members.first()) {
        for parameter in named.candidate.row.model_parameters() {
            next[parameter] -= parameters[parameter];
            for (target, factor) in continued(&PLATFORM, parameter, offset) {
                next[target] += factor * parameters[parameter];
            }
        }
    }
    next
}

/// Parameters of one more record of the platform: without what began in one of those so far.
fn one_more(unknowns: &JointUnknowns, mut parameters: Vec<f64>) -> Vec<f64> {
    let named = unknowns
        .cases
        .iter()
        .filter_map(|case| case.members.first());
    for row in named.map(|named| named.candidate.row) {
        if begins(row) || row.continuation == Continuation::ThisRecord {
            row.model_parameters()
                .for_each(|parameter| parameters[parameter] = 0.0);
        }
    }
    parameters
}

/// A run of which only the information is known.
fn silent(information: DMatrix<f64>) -> RunInformation {
    RunInformation {
        score: DVector::zeros(information.nrows()),
        information,
    }
}
