//! Stops in parts: the rates of one gyro with the covariance of its noise within and between stops.

use gyrocal_statistics::math::ln;
use gyrocal_statistics::upper_median;
use nalgebra::{DMatrix, DVector};

use super::positions::Positions;
use super::regression::chi_square;
use super::terms::{Term, response};
use crate::interval_noise::{flicker, walk};

/// Most parts of all stops together: a covariance is factored at each level of flicker and walk. More stops than these
/// have one part each.
const MOST_PARTS: usize = 64;

/// Logarithm of the longest time of the flicker over the duration of a test.
const BEYOND: f64 = 3.0;

/// Least share of fast noise in the variance of a stop: a held output has none.
const LEAST_WHITE: f64 = 1e-4;

/// Least duration of a stop \[s\], where the instants of a stop are not known.
const SHORTEST_S: f64 = 1e-3;

/// Rates of one gyro in parts of its stops.
pub(super) struct StopParts {
    pub(super) terms: Vec<Term>,
    /// Standard error whose information is the mean one of the stops \[deg/h\].
    pub(super) unit_deg_per_h: f64,
    rates: DVector<f64>,
    /// Rate of each part per unit of each term.
    by_terms: DMatrix<f64>,
    /// Stop and log of each part.
    stop: Vec<usize>,
    log: Vec<usize>,
    /// Variance of the mean of a part by fast noise, and that of its stop by the heading.
    white: Vec<f64>,
    heading: Vec<f64>,
    /// Variance of the mean of a part by the steps of its angles; those at the ends of two parts are the same.
    quantisation: Vec<f64>,
    flicker: DMatrix<f64>,
    walk: DMatrix<f64>,
}

/// Covariance of the rates \[deg²/h²\] without scatter of the stops, in differences of parts and means of stops.
pub(super) struct Covariance {
    /// Number of differences, which come first.
    pub(super) differences: usize,
    /// Rates, terms, and biases of logs.
    pub(super) columns: DMatrix<f64>,
    /// What no level changes.
    pub(super) fixed: DMatrix<f64>,
    /// Flicker and walk of a level of one.
    pub(super) flicker: DMatrix<f64>,
    pub(super) walk: DMatrix<f64>,
}

impl StopParts {
    /// One gyro at all stops.
    pub(super) fn of(positions: &Positions, gyro: usize) -> Self {
        let stops = positions.time_s.len();
        let most = most_parts(positions);
        let logs = positions.logs();
        let mut terms = Term::NOMINAL.to_vec();
        terms.extend(Term::catalogue(gyro));
        // Times are those of the middle of each stop.
        let long_s = |stop: usize| positions.duration_s[stop].max(SHORTEST_S);
        let from_s = |stop: usize| positions.time_s[stop] - 0.5 * long_s(stop);
        let start_s = (0..stops).map(from_s).fold(f64::INFINITY, f64::min);
        let mut spans = Vec::new();
        let (mut rates, mut stop, mut log) = (Vec::new(), Vec::new(), Vec::new());
        let (mut white, mut heading, mut rows) = (Vec::new(), Vec::new(), Vec::new());
        let mut quantisation = Vec::new();
        for number in 0..stops {
            let own = joined(&positions.parts_deg_per_h[number], most);
            let count = own.len().max(1);
            let each_s = long_s(number) / count as f64;
            for part in 0..count {
                let from_s = from_s(number) - start_s + each_s * part as f64;
                spans.push([from_s, from_s + each_s]);
                let off = own.get(part).map_or(0.0, |off| off[gyro]);
                rates.push(positions.rate_deg_per_h[number][gyro] + off);
                let [total, by_heading, by_steps] = [
                    &positions.sigma_deg_per_h,
                    &positions.heading_sigma_deg_per_h,
                    &positions.quantisation_sigma_deg_per_h,
                ]
                .map(|sigma| sigma[number][gyro].powi(2));
                let fast = (total - by_heading - by_steps).max(LEAST_WHITE * total);
                white.push(fast * count as f64);
                quantisation.push(by_steps * (count * count) as f64);
                heading.push(by_heading);
                stop.push(number);
                log.push(
                    logs.iter()
                        .position(|log| *log == positions.log[number])
                        .unwrap_or(0),
                );
                rows.push(response(
                    gyro,
                    &positions.force_g[number],
                    from_s + 0.5 * each_s,
                ));
            }
        }
        // The stops that tell most have a level of noise in sight.
        let informations = positions
            .sigma_deg_per_h
            .iter()
            .map(|sigma| sigma[gyro].powi(-2));
        let unit = (informations.sum::<f64>() / stops as f64).sqrt().recip();
        let variance = unit * unit;
        let spacing_s = spacing_s(positions);
        // Slower noise than that of the test is bias, which takes this constant up.
        let end_s = spans
            .iter()
            .map(|span: &[f64; 2]| span[1])
            .fold(SHORTEST_S, f64::max);
        let constant = ln(end_s) + BEYOND;
        Self {
            by_terms: DMatrix::from_fn(rows.len(), terms.len(), |row, term| {
                rows[row][terms[term].parameter(gyro)]
            }),
            terms,
            unit_deg_per_h: unit,
            flicker: of_pairs(&spans, |one, other| {
                variance * (constant + flicker(one, other)) / core::f64::consts::PI
            }),
            walk: of_pairs(&spans, |one, other| variance * walk(one, other) / spacing_s),
            rates: DVector::from_vec(rates),
            stop,
            log,
            white,
            heading,
            quantisation,
        }
    }

    pub(super) fn stops(&self) -> usize {
        self.stop.last().map_or(0, |last| last + 1)
    }

    /// Column of a term.
    pub(super) fn place(&self, term: Term) -> Option<usize> {
        let mut terms = self.terms.iter();
        terms.position(|one| *one == term).map(|at| at + 1)
    }

    /// Rates, terms, and biases of the logs after the first.
    pub(super) fn columns(&self, biases: usize) -> DMatrix<f64> {
        let terms = self.terms.len();
        DMatrix::from_fn(
            self.rates.len(),
            1 + terms + biases,
            |row, column| match column {
                0 => self.rates[row],
                _ if column <= terms => self.by_terms[(row, column - 1)],
                _ => f64::from(u8::from(self.log[row] == column - terms)),
            },
        )
    }

    /// Those stops that are not held out.
    pub(super) fn without(&self, held: &[usize]) -> Self {
        let rows = 0..self.stop.len();
        let rows: Vec<usize> = rows
            .filter(|row| !held.contains(&self.stop[*row]))
            .collect();
        fn pick<T: Copy>(values: &[T], rows: &[usize]) -> Vec<T> {
            rows.iter().map(|row| values[*row]).collect()
        }
        let square = |matrix: &DMatrix<f64>| matrix.select_rows(&rows).select_columns(&rows);
        Self {
            terms: self.terms.clone(),
            unit_deg_per_h: self.unit_deg_per_h,
            rates: self.rates.select_rows(&rows),
            by_terms: self.by_terms.select_rows(&rows),
            stop: pick(&self.stop, &rows),
            log: pick(&self.log, &rows),
            white: pick(&self.white, &rows),
            heading: pick(&self.heading, &rows),
            quantisation: pick(&self.quantisation, &rows),
            flicker: square(&self.flicker),
            walk: square(&self.walk),
        }
    }

    /// Differences of successive parts of each stop, and after these the mean of each stop: the scatter of the stops is
    /// in the means alone, and of one size. Their number of differences is the second.
    fn basis(&self) -> (DMatrix<f64>, usize) {
        let count = self.stop.len();
        let is_first = |part: usize| part == 0 || self.stop[part - 1] != self.stop[part];
        let starts: Vec<usize> = (0..count).filter(|part| is_first(*part)).collect();
        let differences = count - starts.len();
        let mut basis = DMatrix::zeros(count, count);
        let later = (0..count).filter(|part| !is_first(*part));
        for (row, part) in later.enumerate() {
            basis[(row, part)] = 1.0;
            basis[(row, part - 1)] = -1.0;
        }
        for (row, start) in starts.iter().enumerate() {
            let end = starts.get(row + 1).copied().unwrap_or(count);
            let share = ((end - start) as f64).recip();
            basis
                .view_mut((differences + row, *start), (1, end - start))
                .fill(share);
        }
        (basis, differences)
    }

    /// The covariance and the columns in differences and means.
    pub(super) fn covariance(&self, biases: usize) -> Covariance {
        let count = self.stop.len();
        let mut fixed = DMatrix::zeros(count, count);
        for (i, own) in self.stop.iter().enumerate() {
            fixed[(i, i)] += self.white[i] + self.quantisation[i];
            if self.stop.get(i + 1) == Some(own) {
                fixed[(i, i + 1)] -= 0.5 * self.quantisation[i];
                fixed[(i + 1, i)] -= 0.5 * self.quantisation[i];
            }
            for (j, other) in self.stop.iter().enumerate() {
                if own == other {
                    fixed[(i, j)] += self.heading[i];
                }
            }
        }
        let (basis, differences) = self.basis();
        let columns = self.columns(biases);
        let [fixed, flicker, walk] =
            [&fixed, &self.flicker, &self.walk].map(|of| match differences {
                // Stops of one part are their means.
                0 => of.clone(),
                _ => &basis * of * basis.transpose(),
            });
        Covariance {
            differences,
            columns: basis * columns,
            fixed,
            flicker,
            walk,
        }
    }

    /// The largest level that the grid reaches: above the scatter that a law leaves, the further the fewer degrees of
    /// freedom tell it.
    pub(super) fn largest_level(&self, law: &[Term], biases: usize, freedom: usize) -> f64 {
        let columns = self.columns(biases);
        let variance = |row: usize| self.white[row] + self.heading[row] + self.quantisation[row];
        let rows = 0..self.rates.len();
        let weights: Vec<f64> = rows.map(|row| variance(row).sqrt().recip()).collect();
        let mut chosen: Vec<usize> = law.iter().filter_map(|term| self.place(*term)).collect();
        chosen.extend(1 + self.terms.len()..columns.ncols());
        let whitened = DMatrix::from_fn(columns.nrows(), chosen.len(), |i, j| {
            weights[i] * columns[(i, chosen[j])]
        });
        let rates = DVector::from_fn(columns.nrows(), |i, _| weights[i] * self.rates[i]);
        let Some(left) = chi_square(&whitened, &rates) else {
            return 0.0;
        };
        // Without stops to spare the parts within them alone tell a level.
        let spare = match freedom {
            0 => columns.nrows() - chosen.len(),
            freedom => freedom,
        };
        if spare == 0 {
            return 0.0;
        }
        let spare = spare as f64;
        (left / spare).sqrt() * (2.0 + 20.0 / spare)
    }
}

/// Most parts of a stop with which those of all stops together are few enough.
fn most_parts(positions: &Positions) -> usize {
    let mut most = MOST_PARTS;
    let all = |most: usize| -> usize {
        let parts = positions.parts_deg_per_h.iter();
        parts.map(|parts| parts.len().min(most).max(1)).sum()
    };
    while most > 1 && all(most) > MOST_PARTS {
        most /= 2;
    }
    most
}

/// At most so many parts of a stop, from those that follow one another; none of a stop in one part.
fn joined(parts: &[[f64; 3]], most: usize) -> Vec<[f64; 3]> {
    if most < 2 || parts.is_empty() {
        return Vec::new();
    }
    let together = parts.len().div_ceil(most);
    let mean = |parts: &[[f64; 3]]| {
        core::array::from_fn(|gyro| {
            parts.iter().map(|part| part[gyro]).sum::<f64>() / parts.len() as f64
        })
    };
    parts.chunks(together).map(mean).collect()
}

/// Median time from a stop to the next one of its log; of logs of one stop from log to log.
fn spacing_s(positions: &Positions) -> f64 {
    let times = positions.time_s.windows(2).zip(positions.log.windows(2));
    let steps = |within: bool| -> Vec<f64> {
        let of = times.clone().filter(|(_, log)| !within || log[0] == log[1]);
        of.map(|(time, _)| (time[1] - time[0]).abs()).collect()
    };
    let median = |mut steps: Vec<f64>| upper_median(&mut steps);
    let step = median(steps(true)).or_else(|| median(steps(false)));
    step.unwrap_or(SHORTEST_S).max(SHORTEST_S)
}

/// Covariances of all pairs of parts.
fn of_pairs(spans: &[[f64; 2]], of: impl Fn([f64; 2], [f64; 2]) -> f64) -> DMatrix<f64> {
    DMatrix::from_fn(spans.len(), spans.len(), |i, j| of(spans[i], spans[j]))
}
