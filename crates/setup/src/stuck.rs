//! Accelerometers that repeat one value.

use gyrocal_record::{AXES, counted, most_equal};

use crate::coded::of_rows;
use crate::finding::SetupFinding;
use crate::kind::SetupKind;
use crate::samples::Samples;
use crate::text::{number, other_runs, row, rows};

/// Equal values in so many successive rows may be stuck; the magnitude decides.
const LEAST_ROWS: usize = 3;

/// Runs of equal values during which the magnitude shows that the force moved.
pub(crate) fn find(samples: &mut Samples<'_>) -> Vec<SetupFinding> {
    if let Some(finding) = frozen(samples) {
        return vec![finding];
    }
    let tolerance = samples.square_tolerance_g2();
    let mut findings = Vec::new();
    let mut taken: Vec<(usize, Vec<usize>)> = Vec::new();
    for axis in 0..3 {
        let runs: Vec<Vec<usize>> = equal_runs(samples, axis)
            .into_iter()
            .filter(|run| moves(samples, run, tolerance))
            .collect();
        if let Some(finding) = finding(samples, axis, &runs) {
            findings.push(finding);
            taken.push((axis, runs.concat()));
        }
    }
    for (axis, at) in taken {
        samples.leave_out(at, &[axis]);
    }
    findings
}

/// All accelerometers repeat their values: the logger hangs.
fn frozen(samples: &Samples<'_>) -> Option<SetupFinding> {
    let [x, y, z] = most_equal(&samples.accel_g)?;
    let description =
        "The readings hardly ever change, while gravity turns against a platform that \
                       gyros hold. Look for accelerometers, or a logger, that hang."
            .to_owned();
    let evidence = format!(
        "of x, y and z {x}, {y} and {z} values are the same, in {}",
        rows(samples.accel_g.len())
    );
    Some(
        SetupFinding::new(SetupKind::Stuck, description, evidence)
            .stopping()
            .or(
                SetupKind::Still,
                "a platform that stands still on the Earth, read in large steps",
            ),
    )
}

/// Whether the squared magnitude varies within a run by more than the tolerance and is wrong, without
/// the row that is farthest off: another accelerometer may have an outlier there.
fn moves(samples: &Samples<'_>, run: &[usize], tolerance: f64) -> bool {
    let squares = run
        .iter()
        .map(|row| samples.square(*row) - samples.square_g2);
    let mut off: Vec<f64> = squares.filter(|off| !off.is_nan()).collect();
    let farthest = (0..off.len()).max_by(|a, b| off[*a].abs().total_cmp(&off[*b].abs()));
    if let Some(farthest) = farthest {
        off.swap_remove(farthest);
    }
    let (least, most) = off
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), x| {
            (least.min(*x), most.max(*x))
        });
    most - least > tolerance && f64::max(least.abs(), most.abs()) > tolerance
}

/// Runs of equal values of a column; rows without a value do not end one.
fn equal_runs(samples: &Samples<'_>, axis: usize) -> Vec<Vec<usize>> {
    let value = |row: usize| samples.accel_g[row][axis];
    let rows: Vec<usize> = (0..samples.accel_g.len())
        .filter(|row| !value(*row).is_nan())
        .collect();
    rows.chunk_by(|a, b| value(*a) == value(*b))
        .filter(|run| run.len() >= LEAST_ROWS)
        .map(<[usize]>::to_vec)
        .collect()
}

fn finding(samples: &Samples<'_>, axis: usize, runs: &[Vec<usize>]) -> Option<SetupFinding> {
    let longest = runs.iter().max_by_key(|run| run.len())?;
    let at = runs.concat();
    let value = samples.accel_g[longest[0]][axis];
    let several = other_runs(runs.len());
    let description = format!(
        "Accelerometer {} reads {} in {} from row {} on, while gravity moved{several}: look for an \
         accelerometer, or a logger, that hangs.",
        AXES[axis],
        number(value),
        rows(longest.len()),
        row(longest[0]),
    );
    let left_out = "It is left out there.".to_owned();
    let evidence = format!(
        "{} in {} of equal values; the squared magnitude varies by more than {} in each",
        rows(at.len()),
        counted(runs.len(), "run"),
        number(samples.square_tolerance_g2()),
    );
    let all = samples.accel_g.len();
    Some(of_rows(
        SetupKind::Stuck,
        [description, left_out],
        evidence,
        (&at, all),
    ))
}
