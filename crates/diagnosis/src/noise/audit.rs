//! The audit: quantisation, outliers, spectrum, in this order.

use gyrocal_record::Record;
use gyrocal_statistics::{median_interval_s, two_sided_p, z_of_two_sided_p};

use super::decision::{decide, ratio};
use super::finding::{Cleaned, Estimate, NoiseAudit, NoiseFinding, Shares};
use super::lattice::{self, Lattice};
use super::likelihood::{CORRELATION, WALK};
use super::open_loop::{open_loop, runs};
use super::outlier::{self, Outlier};
use super::readings;
use super::spectrum::Spectrum;
use crate::error::DiagnosisError;
use crate::series::Innovations;
use gyrocal_answer::Gaps;

/// Smallest quantisation step tested for, in standard deviations of the noise: it increases the
/// variance by 2 %, the standard deviation by 1 %.
const LEAST_STEP: f64 = 0.5;
/// Limits of the number of rows at the start that are not tested for outliers, one per twelve
/// seconds of the sampling interval. The prediction of the unsettled filter jumps there from sample
/// to sample: at long intervals an unknown drift moves the platform by hundreds of standard
/// deviations per row.
const FIRST_ROW: [usize; 2] = [16, 48];

/// Smallest number of blocks of all axes for a spectrum.
const LEAST_BLOCKS: usize = 6;
const OUTLIERS: &str = "accel.outliers";
const QUANTISATION: [&str; 3] = [
    "accel_x.quantisation",
    "accel_y.quantisation",
    "accel_z.quantisation",
];

/// The declared noise, used by the filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeclaredNoise {
    /// Standard deviation of one sample of each accelerometer \[g\].
    pub accel_g: [f64; 3],
    /// Standard deviation of the white gyro noise, held over one minute \[deg/h\].
    pub gyro_deg_per_h: f64,
}

/// Options of the audit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AuditOptions {
    /// Family-wise false-alarm probability of the audit.
    pub false_alarm: f64,
    /// p-value of the correlation of innovations that a fit with white noise left. The accelerometers' noise
    /// then counts as correlated, which the spectrum of an hour may not tell from noise of the gyros.
    pub left_correlated: Option<f64>,
}

impl AuditOptions {
    /// Those of a family-wise false-alarm probability.
    #[must_use]
    pub const fn with_share(false_alarm: f64) -> Self {
        Self {
            false_alarm,
            left_correlated: None,
        }
    }
}

impl Default for AuditOptions {
    /// 0.0025: a quarter of 0.01, of which the rest is left to the search.
    fn default() -> Self {
        Self::with_share(0.0025)
    }
}

/// Audits the noise of a record, given the innovations of a filter with the declared noise.
///
/// # Errors
///
/// [`DiagnosisError::UnequalLengths`] of record and innovations, and
/// [`DiagnosisError::InvalidArgument`] for noise that is not positive or a false-alarm probability
/// outside (0, 1). A record too short for a test is not an error: its result is `None`.
pub fn audit_noise(
    record: &Record,
    innovations: &Innovations,
    declared: &DeclaredNoise,
    options: &AuditOptions,
) -> Result<NoiseAudit, DiagnosisError> {
    check(record, innovations, declared, options)?;
    let shares = Shares::of(options.false_alarm);
    let runs = runs(&record.time_s);
    let interval_s = median_interval_s(&record.time_s);
    let lattices: [Option<Lattice>; 3] = core::array::from_fn(|axis| {
        let values = record.accel_g.iter().map(|row| row[axis]);
        lattice::find(values, LEAST_STEP * declared.accel_g[axis])
    });
    let mut findings: Vec<NoiseFinding> = (0..3)
        .filter_map(|axis| lattices[axis].map(|l| quantised(axis, &l)))
        .collect();

    let mut open = open_loop(innovations, &declared.accel_g);
    let first = ((interval_s / 12.0) as usize).clamp(FIRST_ROW[0], FIRST_ROW[1]);
    let tested = (open.as_slice(), runs.as_slice(), first);
    let (outliers, finding) = outliers(record, tested, declared, shares.outliers);
    findings.extend(finding);
    for outlier in &outliers {
        open[outlier.row][outlier.axis] = f64::NAN;
    }

    let walk =
        |row: usize, axis: usize| walk_variance(innovations, declared, interval_s, row, axis);
    let spectrum = Spectrum::new(&open, walk, &runs, interval_s);
    let quantisation = core::array::from_fn(|axis| {
        lattices[axis].map_or(0.0, |l| (l.step / declared.accel_g[axis]).powi(2) / 12.0)
    });
    let decided = (spectrum.blocks() >= LEAST_BLOCKS)
        .then(|| decide(&spectrum, quantisation, &shares, options.left_correlated));
    let mut keep: Vec<[bool; 3]> = record
        .accel_g
        .iter()
        .map(|row| row.map(|value| !value.is_nan()))
        .collect();
    for outlier in &outliers {
        keep[outlier.row][outlier.axis] = false;
    }
    let (variance, correlation) = decided
        .as_ref()
        .map_or(([1.0; 3], 0.0), |d| (d.variance, d.correlation));
    let slow = (1.0 + correlation) / (1.0 - correlation);
    let cleaned = Cleaned {
        keep,
        sample_ratio: core::array::from_fn(|axis| (variance[axis] + quantisation[axis]).sqrt()),
        correlation,
        slow_ratio: core::array::from_fn(|axis| {
            (variance[axis] * slow + quantisation[axis]).sqrt()
        }),
    };
    let fit = decided.map(|decided| {
        findings.extend(decided.findings);
        decided.fit
    });
    let mut audit = NoiseAudit {
        findings,
        accel_ratio: fit
            .as_ref()
            .map(|fit| core::array::from_fn(|axis| ratio(fit, axis))),
        correlation: fit.as_ref().map(|fit| Estimate {
            name: "correlation",
            estimate: fit.model.values[CORRELATION],
            sigma: fit.sigma[CORRELATION],
            unit: "1",
        }),
        gyro_ratio: fit.as_ref().map(|fit| ratio(fit, WALK)),
        quantisation_g: lattices.map(|lattice| lattice.map(|lattice| lattice.step)),
        outliers,
        gaps: gaps(record),
        cleaned,
    };
    audit.sort();
    Ok(audit)
}

fn check(
    record: &Record,
    innovations: &Innovations,
    declared: &DeclaredNoise,
    options: &AuditOptions,
) -> Result<(), DiagnosisError> {
    let rows = record.time_s.len();
    if record.accel_g.len() != rows {
        return Err(DiagnosisError::UnequalLengths {
            what: "accelerometer samples",
            found: record.accel_g.len(),
            expected: rows,
        });
    }
    innovations.check(rows)?;
    let positive = |value: f64| value > 0.0 && value.is_finite();
    let [x, y, z] = declared.accel_g;
    for (what, found) in [
        ("the declared noise of accelerometer x", x),
        ("the declared noise of accelerometer y", y),
        ("the declared noise of accelerometer z", z),
        ("the declared noise of the gyros", declared.gyro_deg_per_h),
    ] {
        if !positive(found) {
            let expected = "a positive number";
            return Err(DiagnosisError::InvalidArgument {
                what,
                found,
                expected,
            });
        }
    }
    if options.false_alarm > 0.0 && options.false_alarm < 1.0 {
        Ok(())
    } else {
        Err(DiagnosisError::InvalidArgument {
            what: "the false-alarm probability",
            found: options.false_alarm,
            expected: "a number between 0 and 1",
        })
    }
}

/// Variance that the gyro noise adds to the open-loop residual over one interval, in declared
/// variances. Only rotations perpendicular to specific force change an output.
fn walk_variance(
    innovations: &Innovations,
    declared: &DeclaredNoise,
    interval_s: f64,
    row: usize,
    axis: usize,
) -> f64 {
    let noise_rad_per_s = (declared.gyro_deg_per_h / 3600.0).to_radians();
    let angle_variance = noise_rad_per_s * noise_rad_per_s * 60.0 * interval_s;
    let force = innovations.specific_force_g[row];
    let across: f64 = (0..3)
        .filter(|other| *other != axis)
        .map(|other| force[other].powi(2))
        .sum();
    angle_variance * across / declared.accel_g[axis].powi(2)
}

fn quantised(axis: usize, lattice: &Lattice) -> NoiseFinding {
    NoiseFinding {
        effect: QUANTISATION[axis],
        parameters: vec![Estimate {
            name: "size",
            estimate: lattice.step,
            sigma: lattice.sigma,
            unit: "g",
        }],
        z: lattice.z,
        p_value: two_sided_p(lattice.z),
    }
}

/// Outliers among the open-loop residuals of `runs` from the row `first` on, which the readings show too.
fn outliers(
    record: &Record,
    (open, runs, first): (&[[f64; 3]], &[core::ops::Range<usize>], usize),
    declared: &DeclaredNoise,
    share: f64,
) -> (Vec<Outlier>, Option<NoiseFinding>) {
    let mut found = Vec::new();
    let (mut samples, mut single_p) = (0, 1.0_f64);
    for axis in 0..3 {
        let series: Vec<f64> = open.iter().map(|row| row[axis]).collect();
        let search = outlier::search(&series, runs, first);
        samples += search.samples;
        let sigma_g = declared.accel_g[axis];
        let all = search.outliers.iter();
        let all = all.map(|(row, value, deviation)| Outlier {
            row: *row,
            axis,
            size_g: value * sigma_g,
            deviation: *deviation,
        });
        let mut shown: Vec<Outlier> = all.collect();
        readings::retain_those_in_readings(&mut shown, &record.accel_g);
        let sizes = shown.iter().map(|outlier| outlier.deviation.abs());
        single_p = single_p.min(search.single_p(sizes.fold(0.0, f64::max)));
        found.extend(shown);
    }
    // Bonferroni bound over all samples.
    let p_value = (samples as f64 * single_p).min(1.0);
    if found.is_empty() || p_value > share {
        return (Vec::new(), None);
    }
    found.sort_by_key(|outlier| (outlier.row, outlier.axis));
    let noise_g = declared.accel_g.iter().sum::<f64>() / 3.0;
    let finding = of_outliers(&found, samples, p_value, noise_g);
    (found, Some(finding))
}

/// The finding of these outliers among `samples` values.
fn of_outliers(found: &[Outlier], samples: usize, p_value: f64, noise_g: f64) -> NoiseFinding {
    let count = found.len() as f64;
    let sizes = || found.iter().map(|outlier| outlier.size_g.abs());
    let mean = sizes().sum::<f64>() / count;
    let scatter = sizes().map(|size_g| (size_g - mean).powi(2)).sum::<f64>();
    let fraction = count / samples as f64;
    // A single outlier has no scatter: that of the noise is used.
    let spread = if found.len() > 1 {
        (scatter / (count - 1.0)).sqrt()
    } else {
        noise_g
    };
    NoiseFinding {
        effect: OUTLIERS,
        parameters: vec![
            Estimate {
                name: "fraction",
                estimate: fraction,
                sigma: (fraction * (1.0 - fraction) / samples as f64).sqrt(),
                unit: "1",
            },
            Estimate {
                name: "size",
                estimate: mean,
                sigma: spread / count.sqrt(),
                unit: "g",
            },
        ],
        z: z_of_two_sided_p(p_value),
        p_value,
    }
}

impl NoiseAudit {
    /// Adds outliers among values that the audit did not test.
    pub(crate) fn add_outliers(&mut self, further: Vec<Outlier>, noise_g: f64) {
        if further.is_empty() {
            return;
        }
        let largest = further.iter().map(|outlier| outlier.deviation.abs());
        let largest = largest.fold(0.0, f64::max);
        self.outliers.extend(further);
        self.outliers
            .sort_by_key(|outlier| (outlier.row, outlier.axis));
        let kept = self
            .cleaned
            .keep
            .as_flattened()
            .iter()
            .filter(|keep| **keep);
        let samples = kept.count() + self.outliers.len();
        let p_value = (samples as f64 * two_sided_p(largest)).min(1.0);
        let before = self.finding(OUTLIERS).map_or(1.0, |found| found.p_value);
        self.findings.retain(|finding| finding.effect != OUTLIERS);
        self.findings.push(of_outliers(
            &self.outliers,
            samples,
            p_value.min(before),
            noise_g,
        ));
        self.sort();
    }

    /// Sorts the findings by significance.
    fn sort(&mut self) {
        self.findings
            .sort_by(|a, b| b.z.abs().total_cmp(&a.z.abs()));
    }
}

/// Missing rows and values of a record.
pub(crate) fn gaps(record: &Record) -> Gaps {
    let interval_s = median_interval_s(&record.time_s);
    let runs = runs(&record.time_s).len();
    let intervals = record.time_s.windows(2).map(|pair| pair[1] - pair[0]);
    let missing = record
        .accel_g
        .iter()
        .flatten()
        .filter(|value| value.is_nan())
        .count();
    Gaps {
        count: runs.saturating_sub(1),
        missing_s: intervals
            .clone()
            .filter(|i| *i > 1.5 * interval_s)
            .map(|i| i - interval_s)
            .sum(),
        longest_s: intervals.fold(0.0, f64::max),
        missing_values: missing as f64 / (3 * record.accel_g.len()).max(1) as f64,
    }
}
