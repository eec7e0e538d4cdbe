//! Rows that repeat the row before.

use crate::finding::SetupFinding;
use crate::kind::SetupKind;
use crate::motion;
use crate::samples::{Complete, Samples};
use crate::text::{other_runs, row, rows, span};
use crate::vector::{minus, norm};

/// The platform moved if gravity turned by so many steps of the converter during the repetition.
const STEPS: f64 = 8.0;

/// Fewest equal rows at the beginning or the end of a record, where only one side shows motion.
const LEAST_ROWS_AT_END: usize = 10;

/// Equal rows, although the platform moved. The first of them stays.
pub(crate) fn find(samples: &mut Samples<'_>) -> Vec<SetupFinding> {
    let complete = samples.complete();
    let Some(speed_rad_per_s) = motion::speed_rad_per_s(samples, &complete) else {
        return Vec::new();
    };
    let step_g = samples.noise.iter().map(|n| n.step_g).fold(0.0, f64::max);
    let moved = |time_s: f64| speed_rad_per_s * time_s * samples.rest_g > STEPS * step_g;
    let is_held =
        |run: &[Complete]| run.len() > 1 && moved(run[run.len() - 1].time_s - run[0].time_s);
    let mut runs: Vec<&[Complete]> = Vec::new();
    let mut short_ends: Vec<&[Complete]> = Vec::new();
    let mut from = 0;
    for run in complete.chunk_by(|a, b| a.force_g == b.force_g) {
        let end = from + run.len();
        // Gyros that drift fast may hold gravity for a while: it must move before and after.
        let about = [from.checked_sub(1), Some(end)].map(|at| at.and_then(|at| complete.get(at)));
        from = end;
        if !is_held(run) {
            continue;
        }
        match about {
            [Some(before), Some(after)] => {
                if norm(minus(before.force_g, after.force_g)) > STEPS * step_g {
                    runs.push(run);
                }
            }
            _ if run.len() >= LEAST_ROWS_AT_END => runs.push(run),
            _ => short_ends.push(run),
        }
    }
    // A logger that repeats rows elsewhere repeats them there too.
    if !runs.is_empty() {
        runs.extend(short_ends);
        runs.sort_by_key(|run| run[0].row);
    }
    let Some(longest) = runs.iter().max_by_key(|run| run.len()) else {
        return Vec::new();
    };
    let at: Vec<usize> = runs
        .iter()
        .flat_map(|run| run[1..].iter().map(|sample| sample.row))
        .collect();
    let several = other_runs(runs.len());
    let description = format!(
        "All accelerometers repeat row {} in {}{several}. The repeated rows are left out; look for \
         a logger that hangs, or that writes faster than it reads.",
        row(longest[0].row),
        rows(longest.len() - 1),
    );
    let evidence = format!("{} repeat the row before them", rows(at.len()));
    let finding = SetupFinding::new(SetupKind::Repeated, description, evidence).at(span(&at));
    samples.leave_out(at, &[0, 1, 2]);
    vec![finding]
}
