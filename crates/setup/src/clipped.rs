//! Accelerometers that do not go beyond a value.

use gyrocal_record::AXES;

use crate::coded::of_rows;
use crate::finding::SetupFinding;
use crate::kind::SetupKind;
use crate::samples::Samples;
use crate::scale;
use crate::text::{number, row, rows};

/// Width of the band below an extreme, in sigmas: noise that was added after the limit, and steps.
const BAND_SIGMAS: f64 = 8.0;

/// Fewest rows in the band whose magnitude is short; of equal values the smaller number.
const LEAST_ROWS: usize = 10;
const LEAST_EQUAL_ROWS: usize = 3;

/// Least share of the rows in the band whose magnitude is short: those at both ends of a clipped
/// stretch are not yet.
const LEAST_SHORT: f64 = 0.3;

/// Largest share of rows beside the band whose magnitude is short, and of rows in the band whose
/// magnitude is too large: a limit explains neither.
const MOST_ELSEWHERE: f64 = 0.1;

/// Width of the rows beside the band, g: six degrees of the vertical near the horizontal.
const BESIDE_G: f64 = 0.1;

/// One end of the range of an accelerometer.
struct End {
    axis: usize,
    sign: f64,
    limit: f64,
    band: f64,
}

impl End {
    fn of(samples: &Samples<'_>, axis: usize, sign: f64) -> Option<Self> {
        let values = samples.accel_g.iter().map(|row| sign * row[axis]);
        let limit = values.filter(|value| !value.is_nan()).reduce(f64::max)?;
        let noise = samples.noise[axis];
        Some(Self {
            axis,
            sign,
            limit,
            band: (BAND_SIGMAS * noise.sigma_g).max(noise.step_g),
        })
    }

    /// How far a value is below the extreme.
    fn below(&self, samples: &Samples<'_>, row: usize) -> f64 {
        self.limit - self.sign * samples.accel_g[row][self.axis]
    }

    fn is_in_band(&self, samples: &Samples<'_>, row: usize) -> bool {
        self.below(samples, row) <= self.band
    }
}

/// Values at an extreme, while the magnitude shows that the force was beyond. The axis that explains
/// most rows comes first: its rows are short at the extremes of the others as well.
pub(crate) fn find(samples: &mut Samples<'_>) -> Vec<SetupFinding> {
    let mut findings = Vec::new();
    // A wrong gain makes magnitudes small wherever another axis is at its extreme.
    if scale::one_axis(samples).is_some() {
        return findings;
    }
    for _ in 0..3 {
        let ends: Vec<End> = (0..3)
            .flat_map(|axis| [1.0, -1.0].map(|sign| (axis, sign)))
            .filter_map(|(axis, sign)| End::of(samples, axis, sign))
            .collect();
        let clipped = ends.iter().filter_map(|end| {
            let rows = clipped_rows(samples, end, &ends)?;
            Some((end, rows))
        });
        let mut clipped: Vec<(&End, usize)> = clipped.collect();
        clipped.sort_by_key(|(_, rows)| core::cmp::Reverse(*rows));
        let Some(axis) = clipped.first().map(|(end, _)| end.axis) else {
            break;
        };
        let limits: Vec<&End> = clipped
            .iter()
            .map(|(end, _)| *end)
            .filter(|end| end.axis == axis)
            .collect();
        let at: Vec<usize> = (0..samples.accel_g.len())
            .filter(|row| limits.iter().any(|end| end.is_in_band(samples, *row)))
            .collect();
        findings.push(finding(samples, &limits, &at));
        samples.leave_out(at, &[axis]);
    }
    findings
}

fn finding(samples: &Samples<'_>, limits: &[&End], at: &[usize]) -> SetupFinding {
    let axis = limits[0].axis;
    let values: Vec<String> = limits
        .iter()
        .map(|end| number(end.sign * end.limit))
        .collect();
    let description = format!(
        "Accelerometer {} is clipped at {}: its range ends there; use a larger one.",
        AXES[axis],
        values.join(" and "),
    );
    let left_out = "The rows are left out.".to_owned();
    let evidence = format!(
        "{} at the extreme, the first is row {}; the magnitude is too small in them",
        rows(at.len()),
        row(at.first().copied().unwrap_or(0))
    );
    let rows = (at, samples.accel_g.len());
    of_rows(SetupKind::Clipped, [description, left_out], evidence, rows)
}

/// Number of rows whose magnitude an end makes too small; `None` if it is no limit.
fn clipped_rows(samples: &Samples<'_>, end: &End, ends: &[End]) -> Option<usize> {
    let tolerance = samples.square_tolerance_g2();
    let others = |row: usize| {
        ends.iter()
            .any(|other| other.axis != end.axis && other.is_in_band(samples, row))
    };
    let [mut within, mut short, mut long, mut equal] = [0_usize; 4];
    let [mut beside, mut short_beside] = [0_usize; 2];
    for row in 0..samples.accel_g.len() {
        let off = samples.square(row) - samples.square_g2;
        if off.is_nan() {
            continue;
        }
        if end.is_in_band(samples, row) {
            within += 1;
            short += usize::from(off < -tolerance);
            long += usize::from(off > tolerance);
            equal += usize::from(end.below(samples, row) == 0.0);
        } else if end.below(samples, row) <= end.band + BESIDE_G && !others(row) {
            beside += 1;
            short_beside += usize::from(off < -tolerance);
        }
    }
    let least = if equal >= LEAST_EQUAL_ROWS {
        LEAST_EQUAL_ROWS
    } else {
        LEAST_ROWS
    };
    let is_limit = short >= least
        && short as f64 >= LEAST_SHORT * within as f64
        && long as f64 <= MOST_ELSEWHERE * within as f64
        && beside > 0
        && short_beside as f64 <= MOST_ELSEWHERE * beside as f64;
    is_limit.then_some(short)
}
