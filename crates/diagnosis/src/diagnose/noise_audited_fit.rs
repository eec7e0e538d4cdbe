//! Noise audit, and the nominal model fitted with the noise that it found.

use gyrocal::{Discretisation, Drift, FilterSettings, InitialAttitude, Innovation};
use gyrocal_calibration::{
    FittedPlatform, GyroAxes, NoiseModel, Options, Run, filter_settings, gross_errors,
    run_factorised_filter, run_strapdown_filter,
};
use gyrocal_record::{Bench, Record};
use gyrocal_setup::shown_noise_g;

use super::untestable_rows::{detect_outliers, untestable_rows};
use crate::error::DiagnosisError;
use crate::noise::{AuditOptions, DeclaredNoise, NoiseAudit, Outlier, audit_noise};
use crate::series::Innovations;

/// Standard deviation given to the fitted first attitude about each axis, deg: wide against the noise
/// of a sample, so that the first rows correct the attitude.
const FITTED_ATTITUDE_SIGMA_DEG: f64 = 0.01;

/// Noise that neighbouring rows show over the declared one, beyond which that is not believed at all:
/// smaller ratios are found by the audit.
const OTHER_UNIT: f64 = 20.0;

/// The nominal model, fitted with the noise that the audit found.
pub(super) struct AuditedFit<'a> {
    pub(super) nominal: FittedPlatform<'a>,
    pub(super) noise_model: NoiseModel,
    pub(super) innovations: Innovations,
    pub(super) audit: NoiseAudit,
    /// Suspected outliers: not testable by the audit, not explained by the nominal model. They are
    /// left out of the fit.
    pub(super) suspects: Vec<Outlier>,
}

/// Audits the noise of a record and fits the nominal model with what it finds; `before` is the noise
/// assumed until then, `axes` are those of the instruments of a strapdown unit.
pub(super) fn noise_audited_fit<'a>(
    run: &Run<'a>,
    axes: Option<&GyroAxes>,
    before: &NoiseModel,
    audit: &AuditOptions,
    options: &Options,
) -> Result<AuditedFit<'a>, DiagnosisError> {
    let Run { record, bench } = *run;
    let gross = gross_errors(record, bench.accel_noise_g);
    let whole: Vec<[usize; 2]> = gross
        .iter()
        .flat_map(|row| (0..3).map(|axis| [*row, axis]))
        .collect();
    let mut noise_model = before.clone();
    leave_out(&mut noise_model, record.len(), &whole);
    noise_model.accel_ratio = first_ratio(&noise_model, run);
    let first = FittedPlatform::nominal_of_unit(run, axes, options, &noise_model)?;
    let mut screened = record.without(whole.iter().copied());
    let mut seen = innovations(&screened, bench, axes, &first)?;
    let mut audit = audit_noise(
        &screened,
        &seen,
        &DeclaredNoise {
            accel_g: [bench.accel_noise_g; 3],
            gyro_deg_per_h: bench.gyro_noise_deg_per_h,
        },
        audit,
    )?;
    noise_model = NoiseModel {
        gyro_ratio: before.gyro_ratio,
        gyro_walk_deg_per_h_per_sqrt_h: before.gyro_walk_deg_per_h_per_sqrt_h,
        ..noise_from_audit(&audit, record)
    };
    let noise_g = noise_model
        .accel_ratio
        .map(|ratio| ratio * bench.accel_noise_g);
    let mut suspects = detect_outliers(record, &untestable_rows(record, &gross), &first, noise_g);
    let known = |one: &Outlier| audit.outliers.iter().any(|o| o.place() == one.place());
    suspects.retain(|one| !known(one));
    let places: Vec<[usize; 2]> = suspects.iter().map(Outlier::place).collect();
    if !places.is_empty() {
        leave_out(&mut noise_model, record.len(), &places);
        for [row, axis] in &places {
            audit.cleaned.keep[*row][*axis] = false;
        }
        screened = screened.without(places);
        seen = innovations(&screened, bench, axes, &first)?;
    }
    let nominal = if noise_model == *before {
        first
    } else {
        match first.with_noise(bench, &noise_model) {
            Ok(nominal) => nominal,
            // A gross mismatch may look like noise with which no fit converges: use the declared one.
            Err(_) => {
                noise_model = before.clone();
                noise_model.accel_ratio = first_ratio(before, run);
                leave_out(&mut noise_model, record.len(), &whole);
                first
            }
        }
    };
    Ok(AuditedFit {
        nominal,
        noise_model,
        innovations: seen,
        audit,
        suspects,
    })
}

/// Noise of the accelerometers over the declared one in the first fit: as assumed, or, if it is
/// declared in another unit, as neighbouring rows show it. A fit with a hundredth of the noise does
/// not converge.
fn first_ratio(assumed: &NoiseModel, run: &Run<'_>) -> [f64; 3] {
    let declared_g = run.bench.accel_noise_g;
    let shown = shown_noise_g(run.record).map(|shown_g| shown_g / declared_g);
    core::array::from_fn(|axis| {
        let assumed = assumed.accel_ratio[axis];
        if shown[axis] > OTHER_UNIT * assumed {
            shown[axis]
        } else {
            assumed
        }
    })
}

/// Sets the weight of values, each a row and an axis, to zero.
fn leave_out(noise_model: &mut NoiseModel, rows: usize, places: &[[usize; 2]]) {
    if places.is_empty() {
        return;
    }
    let weights = noise_model
        .weights
        .get_or_insert_with(|| vec![[1.0; 3]; rows]);
    for [row, axis] in places {
        weights[*row][*axis] = 0.0;
    }
}

/// Noise of the accelerometers as the audit found it.
fn noise_from_audit(audit: &NoiseAudit, record: &Record) -> NoiseModel {
    let cleaned = &audit.cleaned;
    let dropped = cleaned
        .keep
        .iter()
        .zip(&record.accel_g)
        .any(|(keep, row)| (0..3).any(|axis| !keep[axis] && !row[axis].is_nan()));
    NoiseModel {
        accel_ratio: cleaned.slow_ratio,
        gyro_ratio: [1.0; 3],
        gyro_walk_deg_per_h_per_sqrt_h: [0.0; 3],
        weights: dropped.then(|| {
            cleaned
                .keep
                .iter()
                .map(|keep| keep.map(|keep| f64::from(u8::from(keep))))
                .collect()
        }),
    }
}

/// Innovations of the streaming filter from the fitted first attitude.
fn innovations(
    record: &Record,
    bench: &Bench,
    axes: Option<&GyroAxes>,
    fitted: &FittedPlatform<'_>,
) -> Result<Innovations, DiagnosisError> {
    let settings = FilterSettings {
        drift: Drift::from_array(core::array::from_fn(|i| fitted.values()[i])),
        ..filter_settings(bench, Discretisation::default())
    };
    let attitude = InitialAttitude::Orientation {
        north_and_up: fitted.points()[0],
        sigma_rad: [FITTED_ATTITUDE_SIGMA_DEG.to_radians(); 3],
    };
    let mut innovations = Innovations::default();
    let mut refused = None;
    let mut push = |row: usize, force_g: [f64; 3], innovation: &Innovation<f64, 3>| {
        let residual_g = core::array::from_fn(|axis| {
            if innovation.observed[axis] {
                innovation.residual[axis]
            } else {
                f64::NAN
            }
        });
        let covariance = innovation.covariance();
        let pushed = innovations.push(record.time_s[row], residual_g, &covariance, force_g);
        refused = refused.take().or(pushed.err());
    };
    match axes {
        Some(axes) => run_strapdown_filter(record, axes, &settings, &attitude, &mut push),
        None => run_factorised_filter(
            record,
            &settings,
            &attitude,
            &mut |row, filter, innovation| {
                push(row, filter.kernel().inputs().inputs().f_0, innovation);
            },
        ),
    }?;
    if let Some(error) = refused {
        return Err(error);
    }
    Ok(innovations)
}
