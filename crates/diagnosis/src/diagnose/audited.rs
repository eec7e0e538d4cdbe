//! The nominal model of a record with the noise that the audit finds in it.

use gyrocal::estimation::Factors;
use gyrocal::{PlatformFilter, Settings};
use gyrocal_calibration::{Extended, NoiseModel, Options, Run, pass, settings};
use gyrocal_record::{Bench, Record};

use super::DiagnoseError;
use crate::noise::{AuditOptions, DeclaredNoise, NoiseAudit, audit_noise, runs};
use crate::series::Innovations;

/// The nominal model of a record with the noise that its audit left.
pub(super) struct Audited<'a> {
    pub(super) nominal: Extended<'a>,
    pub(super) noise_model: NoiseModel,
    pub(super) innovations: Innovations,
    pub(super) audit: NoiseAudit,
}

/// Audits the noise of a record, believing `before` until then.
pub(super) fn audited<'a>(
    run: &Run<'a>,
    before: &NoiseModel,
    false_alarm: f64,
    options: &Options,
) -> Result<Audited<'a>, DiagnoseError> {
    let Run { record, bench } = *run;
    let first = Extended::nominal(run, options, before)?;
    let innovations = innovations(record, bench, &first)?;
    let audit = audit_noise(
        record,
        &innovations,
        &DeclaredNoise {
            accel_g: [bench.accel_noise_g; 3],
            gyro_deg_per_h: bench.gyro_noise_deg_per_h,
        },
        &AuditOptions { false_alarm },
    )?;
    let mut noise_model = NoiseModel {
        gyro_ratio: before.gyro_ratio,
        ..believed(&audit, record)
    };
    leave_out_early(&mut noise_model, record, &first, bench.accel_noise_g);
    let nominal = if noise_model == *before {
        first
    } else {
        match first.with_noise(bench, &noise_model) {
            Ok(nominal) => nominal,
            // What the model misses by far may look like noise that no fit bears: as declared.
            Err(_) => {
                noise_model = before.clone();
                first
            }
        }
    };
    Ok(Audited {
        nominal,
        noise_model,
        innovations,
        audit,
    })
}

/// The noise of the accelerometers as the audit left it.
fn believed(audit: &NoiseAudit, record: &Record) -> NoiseModel {
    let cleaned = &audit.cleaned;
    let dropped = cleaned
        .keep
        .iter()
        .zip(&record.accel_g)
        .any(|(keep, row)| (0..3).any(|axis| !keep[axis] && !row[axis].is_nan()));
    NoiseModel {
        accel_ratio: cleaned.slow_ratio,
        gyro_ratio: [1.0; 3],
        weights: dropped.then(|| {
            cleaned
                .keep
                .iter()
                .map(|keep| keep.map(|keep| f64::from(u8::from(keep))))
                .collect()
        }),
    }
}

/// The audit does not look at the first rows of a record and of what follows a gap, where the filter
/// has not settled: values there whose smoothed residual stands off those of its neighbours by more
/// than this get no weight.
const STANDS_OFF: f64 = 7.0;
const EARLY_ROWS: usize = 48;
const ROWS_AFTER_GAP: usize = 8;

fn leave_out_early(
    noise_model: &mut NoiseModel,
    record: &Record,
    fitted: &Extended<'_>,
    noise_g: f64,
) {
    let early = runs(&record.time_s).into_iter().flat_map(|run| {
        let rows = if run.start == 0 {
            EARLY_ROWS
        } else {
            ROWS_AFTER_GAP
        };
        run.start..(run.start + rows).min(run.end)
    });
    let predicted_g = fitted.predicted_g();
    let residual =
        |row: usize, axis: usize| (record.accel_g[row][axis] - predicted_g[row][axis]) / noise_g;
    for row in early {
        for axis in 0..3 {
            let from = row.saturating_sub(4);
            let to = (row + 5).min(record.len());
            let mut around: Vec<f64> = (from..to)
                .filter(|other| *other != row)
                .map(|other| residual(other, axis))
                .filter(|value| value.is_finite())
                .collect();
            around.sort_unstable_by(f64::total_cmp);
            let Some(middle) = around.get(around.len() / 2) else {
                continue;
            };
            let ratio = noise_model.accel_ratio[axis];
            if (residual(row, axis) - middle).abs() > STANDS_OFF * ratio {
                let all = record.len();
                let weights = noise_model
                    .weights
                    .get_or_insert_with(|| vec![[1.0; 3]; all]);
                weights[row][axis] = 0.0;
            }
        }
    }
}

/// Innovations of the streaming filter from the fitted first attitude.
fn innovations(
    record: &Record,
    bench: &Bench,
    fitted: &Extended<'_>,
) -> Result<Innovations, DiagnoseError> {
    let base = settings(&Bench {
        initial_angles_deg: Some([0.0; 3]),
        initial_angles_sigma_deg: [0.01; 3],
        ..bench.clone()
    });
    let Some(base) = base else {
        return Ok(Innovations::default());
    };
    let settings = Settings {
        drift: gyrocal::Drift::from_array(core::array::from_fn(|i| fitted.values()[i])),
        ..base
    };
    let filter = PlatformFilter::<f64, Factors>::at_attitude(
        &settings,
        &fitted.points()[0],
        &settings.angles_sigma_rad,
    );
    let mut innovations = Innovations::default();
    let mut refused = None;
    pass(record, record.len(), filter, |row, filter, innovation| {
        let residual_g = core::array::from_fn(|axis| {
            if innovation.observed[axis] {
                innovation.residual[axis]
            } else {
                f64::NAN
            }
        });
        let pushed = innovations.push(
            record.time_s[row],
            residual_g,
            &innovation.covariance(),
            filter.kernel().inputs().inputs().f_0,
        );
        refused = refused.take().or(pushed.err());
    })?;
    if let Some(error) = refused {
        return Err(error.into());
    }
    Ok(innovations)
}
