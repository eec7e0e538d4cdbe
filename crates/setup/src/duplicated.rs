//! Blocks of rows that repeat earlier rows.

use std::collections::HashMap;

use gyrocal_statistics::upper_median;

use crate::finding::SetupFinding;
use crate::jump::LEAST_BEFORE_S;
use crate::kind::SetupKind;
use crate::samples::{Complete, Samples};
use crate::text::{row, rows};
use crate::vector::angle;

/// So many equal rows in a row at one distance are a copy.
const LEAST_ROWS: usize = 5;

/// A copy begins with a leap back: so many times the usual way between two rows.
const LEAPS: f64 = 3.0;

/// Of noise that was added to a copy: so many rows agree with earlier ones within so many sigmas.
const LEAST_NOISY_ROWS: usize = 8;
const NOISY_SIGMAS: f64 = 12.0;

/// A block of complete rows that repeats earlier ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Copied {
    /// Place of its first row among the complete rows.
    pub(crate) from: usize,
    /// How far back the original is, in complete rows.
    pub(crate) lag: usize,
    /// Number of its rows.
    pub(crate) len: usize,
}

/// Copies of blocks of rows, exact or with noise added.
pub(crate) fn find(samples: &mut Samples<'_>) -> Vec<SetupFinding> {
    let complete = samples.complete();
    let leap = Leap::of(samples, &complete);
    let copies: Vec<Copied> = exact(&complete)
        .into_iter()
        .filter(|copy| leap.is_at(&complete, copy.from))
        .collect();
    let copies = if copies.is_empty() {
        noisy(samples, &complete, &leap)
    } else {
        copies
    };
    let Some(longest) = copies.iter().max_by_key(|copy| copy.len) else {
        return Vec::new();
    };
    let [first, original] = [longest.from, longest.from - longest.lag].map(|at| complete[at].row);
    let last = complete[longest.from + longest.len - 1].row;
    let count: usize = copies.iter().map(|copy| copy.len).sum();
    let description = format!(
        "Rows {} to {} are a copy of the rows from row {} on. They are left out; look for a part \
         that was written twice.",
        row(first),
        row(last),
        row(original),
    );
    let evidence = format!(
        "{} in {} copied blocks; gravity leaps back at the beginning of each",
        rows(count),
        copies.len()
    );
    let range = copies.iter().fold(first..last + 1, |range, copy| {
        let end = complete[copy.from + copy.len - 1].row + 1;
        range.start.min(complete[copy.from].row)..range.end.max(end)
    });
    let inserted = copies
        .iter()
        .find(|copy| is_inserted(&complete, copy, &leap));
    let mut finding = SetupFinding::new(SetupKind::Duplicated, description, evidence).at(range);
    if let Some(copy) = inserted {
        let sample = complete[copy.from];
        finding.description += " The rows after them go on where the copy began, so their times \
                                are wrong: they are left out too.";
        finding.stops = sample.time_s - complete[0].time_s < LEAST_BEFORE_S;
        samples.end = sample.row;
    }
    let copied = copies
        .iter()
        .flat_map(|copy| copy.from..copy.from + copy.len);
    samples.leave_out(copied.map(|at| complete[at].row), &[0, 1, 2]);
    vec![finding]
}

/// Whether gravity goes on after a copy from where it was before it, as if no time had passed.
fn is_inserted(complete: &[Complete], copy: &Copied, leap: &Leap) -> bool {
    let after = complete.get(copy.from + copy.len);
    let before = complete[copy.from - 1];
    let usual_s = complete[copy.from].time_s - before.time_s;
    after.is_some_and(|after| {
        // As near as if one row had passed.
        let soon = Complete {
            time_s: before.time_s + usual_s,
            ..*after
        };
        !leap.is_between(&before, &soon)
    })
}

/// What is no usual way between two rows.
struct Leap {
    /// Usual speed of the vertical, rad/s.
    speed_rad_per_s: f64,
    noise_rad: f64,
}

impl Leap {
    fn of(samples: &Samples<'_>, complete: &[Complete]) -> Self {
        let mut speeds: Vec<f64> = complete
            .windows(2)
            .map(|pair| angle(pair[0].up, pair[1].up) / (pair[1].time_s - pair[0].time_s))
            .collect();
        Self {
            speed_rad_per_s: upper_median(&mut speeds).unwrap_or(0.0),
            noise_rad: NOISY_SIGMAS * samples.sigma_g() / samples.rest_g,
        }
    }

    /// Whether gravity leaps between two rows: by far more than it goes in the time between them.
    fn is_between(&self, from: &Complete, to: &Complete) -> bool {
        let usual = self.speed_rad_per_s * (to.time_s - from.time_s);
        angle(from.up, to.up) > LEAPS * usual + self.noise_rad
    }

    /// Whether gravity leaps on the way to a row and stays there: a wild row is no leap.
    fn is_at(&self, complete: &[Complete], at: usize) -> bool {
        /// Rows on either side that must lie beyond it.
        const ABOUT: usize = 2;
        (0..=ABOUT).all(|about| {
            let before = at.checked_sub(1 + about).map(|before| &complete[before]);
            match (before, complete.get(at + about)) {
                (Some(before), Some(after)) => {
                    let way = 2 * about + 1;
                    let usual = self.speed_rad_per_s * (after.time_s - before.time_s);
                    let allowed = usual * (LEAPS + way as f64 - 1.0) / way as f64;
                    angle(before.up, after.up) > allowed + self.noise_rad
                }
                (None, _) => false,
                (_, None) => about > 0,
            }
        })
    }
}

/// Blocks that equal earlier ones in every bit.
fn exact(complete: &[Complete]) -> Vec<Copied> {
    let key = |at: usize| complete[at].force_g.map(f64::to_bits);
    let mut seen: HashMap<[u64; 3], usize> = HashMap::with_capacity(complete.len());
    let mut copies: Vec<Copied> = Vec::new();
    let mut open: Option<Copied> = None;
    for at in 0..complete.len() {
        let follows = open.filter(|copy| key(at - copy.lag) == key(at));
        open = match follows {
            Some(copy) => Some(Copied {
                len: copy.len + 1,
                ..copy
            }),
            None => {
                copies.extend(open.filter(|copy| copy.len >= LEAST_ROWS));
                seen.get(&key(at)).map(|earlier| Copied {
                    from: at,
                    lag: at - earlier,
                    len: 1,
                })
            }
        };
        seen.insert(key(at), at);
    }
    copies.extend(open.filter(|copy| copy.len >= LEAST_ROWS));
    copies
}

/// Blocks that begin with a leap to where the platform was, within noise.
fn noisy(samples: &Samples<'_>, complete: &[Complete], leap: &Leap) -> Vec<Copied> {
    /// Leaps that are looked at: a record with more has other faults, and the cost stays linear.
    const MOST_LEAPS: usize = 20;
    let tolerance = NOISY_SIGMAS * samples.sigma_g();
    let equal = |a: usize, b: usize| {
        let pairs = complete[a].force_g.into_iter().zip(complete[b].force_g);
        pairs.into_iter().all(|(a, b)| (a - b).abs() <= tolerance)
    };
    let leaps = (1..complete.len()).filter(|at| leap.is_at(complete, *at));
    let mut copies: Vec<Copied> = Vec::new();
    for at in leaps.take(MOST_LEAPS) {
        let inside = |copy: &Copied| at < copy.from + copy.len;
        if copies.last().is_some_and(inside) {
            continue;
        }
        let best = (0..at)
            .filter(|earlier| equal(*earlier, at))
            .map(|earlier| {
                let lag = at - earlier;
                let len = (at..complete.len())
                    .take_while(|now| now - lag < at && equal(now - lag, *now))
                    .count();
                Copied { from: at, lag, len }
            });
        copies.extend(
            best.max_by_key(|copy| copy.len)
                .filter(|copy| copy.len >= LEAST_NOISY_ROWS),
        );
    }
    copies
}
