//! Missing values that are written as numbers.

use crate::finding::SetupFinding;
use crate::kind::SetupKind;
use crate::samples::Samples;
use crate::text::{accelerometers, number, row, rows, span};

/// A value is a code if it comes so often, ...
const LEAST_ROWS: usize = 3;

/// ... and is zero or this many times the median magnitude ...
const WILD: f64 = 5.0;

/// ... while the squared magnitude is off that of the rows about it by this share, 1 % of the
/// magnitude: a zero that is measured is no code.
const OFF: f64 = 0.02;

/// Beyond this share of the rows a record does not stand for the platform.
const STOPPING_SHARE: f64 = 0.2;

/// A finding of rows that are left out, of a record of `all` rows: where they are too many it stops, and says
/// so in the place of `left_out`.
pub(crate) fn of_rows(
    kind: SetupKind,
    [description, left_out]: [String; 2],
    evidence: String,
    (at, all): (&[usize], usize),
) -> SetupFinding {
    let share = at.len() as f64 / all as f64;
    if share <= STOPPING_SHARE {
        let description = format!("{description} {left_out}");
        return SetupFinding::new(kind, description, evidence).at(span(at));
    }
    let description = format!(
        "{description} These are {:.1} % of the rows. Where more than {:.0} % are lost, a record is not used.",
        100.0 * share,
        100.0 * STOPPING_SHARE
    );
    let found = SetupFinding::new(kind, description, evidence);
    found.at(span(at)).stopping()
}

/// Numbers that stand for missing values: 0, -999 and the like.
pub(crate) fn find(samples: &mut Samples<'_>) -> Vec<SetupFinding> {
    let mut found: Vec<(f64, Vec<usize>, Vec<usize>)> = Vec::new();
    for axis in 0..3 {
        for code in codes(samples, axis) {
            let at = places(samples, axis, code);
            if at.len() < LEAST_ROWS {
                continue;
            }
            match found.iter_mut().find(|(known, ..)| *known == code) {
                Some((_, axes, known)) => {
                    axes.push(axis);
                    known.extend(at);
                }
                None => found.push((code, vec![axis], at)),
            }
        }
    }
    let mut findings = Vec::new();
    for (code, axes, mut at) in found {
        at.sort_unstable();
        at.dedup();
        for row in &at {
            for axis in &axes {
                if samples.accel_g[*row][*axis] == code {
                    samples.accel_g[*row][*axis] = f64::NAN;
                }
            }
        }
        findings.push(finding(samples, code, &axes, &at));
    }
    if !findings.is_empty() {
        samples.look_again();
    }
    findings
}

fn finding(samples: &Samples<'_>, code: f64, axes: &[usize], at: &[usize]) -> SetupFinding {
    let description = format!(
        "Missing values of {} are written as {}: write `nan` for what was not measured.",
        accelerometers(axes),
        number(code),
    );
    let left_out = "They are left out.".to_owned();
    let evidence = format!(
        "{}, the first is row {}; the magnitude is off by more than 1 % there",
        rows(at.len()),
        row(at[0])
    );
    let rows = (at, samples.accel_g.len());
    of_rows(
        SetupKind::MissingCoded,
        [description, left_out],
        evidence,
        rows,
    )
    .or(
        SetupKind::Stuck,
        format!("an accelerometer that fails and reads {}", number(code)),
    )
}

/// Values of a column that may be codes, the most frequent first.
fn codes(samples: &Samples<'_>, axis: usize) -> Vec<f64> {
    let mut squares: Vec<f64> = (0..samples.accel_g.len())
        .map(|row| samples.square(row))
        .filter(|square| !square.is_nan())
        .collect();
    let median = gyrocal_statistics::upper_median(&mut squares).unwrap_or(1.0);
    let wild = WILD * median.sqrt();
    let mut values: Vec<f64> = samples
        .accel_g
        .iter()
        .map(|row| row[axis])
        .filter(|value| *value == 0.0 || value.abs() > wild)
        .collect();
    values.sort_by(f64::total_cmp);
    values
        .chunk_by(|a, b| a == b)
        .filter(|equal| equal.len() >= LEAST_ROWS)
        .map(|equal| equal[0])
        .collect()
}

/// Rows of a code: all of them if the magnitude is off in three.
fn places(samples: &Samples<'_>, axis: usize, code: f64) -> Vec<usize> {
    let rows = samples.accel_g.len();
    let is_code = |row: usize| samples.accel_g[row][axis] == code;
    // The nearest rows before and after that have another value and a magnitude.
    let nearest = |from: usize, order: &mut dyn Iterator<Item = usize>| {
        let mut last = f64::NAN;
        let mut squares = vec![f64::NAN; from];
        for row in order {
            if !is_code(row) && !samples.square(row).is_nan() {
                last = samples.square(row);
            }
            squares[row] = last;
        }
        squares
    };
    let before = nearest(rows, &mut (0..rows));
    let after = nearest(rows, &mut (0..rows).rev());
    let off = |row: &usize| {
        let square = samples.square(*row);
        let far = |other: f64| other.is_nan() || (square / other - 1.0).abs() > OFF;
        let known = !before[*row].is_nan() || !after[*row].is_nan();
        code != 0.0 || (known && far(before[*row]) && far(after[*row]))
    };
    let coded: Vec<usize> = (0..rows).filter(|row| is_code(*row)).collect();
    if coded.iter().filter(|row| off(row)).count() < LEAST_ROWS {
        return Vec::new();
    }
    coded
}
