//! Allan deviations against those of another library.

use gyrocal_statistics::allan::allan_deviation;

use super::Measured;
use crate::error::Error;
use crate::figure::Figure;

/// Made by crates/statistics/tests/data/allan_reference.py with the library named there.
const REFERENCE: &str = include_str!("../../../statistics/tests/data/allan_reference.csv");

const ONE_SIGMA: f64 = 0.682_689_492_137_085_9;

pub(super) fn measure(measured: &mut Measured) -> Result<(), Error> {
    let (mut rows, mut worst, mut worst_interval) = (0, 0.0_f64, 0.0_f64);
    for line in REFERENCE.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |field: usize| fields[field].parse::<f64>();
        let averaging = [number(1)? as usize];
        let points = allan_deviation(&series(fields[0]), 1.0, &averaging, ONE_SIGMA)?;
        for point in points {
            worst = worst.max((point.deviation / number(2)? - 1.0).abs());
            for (end, field) in point.interval.iter().zip([5, 6]) {
                worst_interval = worst_interval.max((end / number(field)? - 1.0).abs());
            }
        }
        rows += 1;
    }
    let scientific = |name: &str, bound: f64, found: f64| Figure {
        target: format!("<= {bound:e}"),
        measured: format!("{found:.1e}"),
        ..Figure::within(name, [0.0, bound], found)
    };
    measured.figures.extend([
        // Rounding of a thousand sums of numbers of order one.
        scientific(
            "Allan deviation: largest relative difference from the reference",
            1e-11,
            worst,
        )
        .over(rows, ""),
        // The quantiles of both libraries are iterated to about nine digits.
        scientific(
            "Allan deviation: the same of the ends of confidence intervals",
            1e-7,
            worst_interval,
        )
        .over(rows, ""),
    ]);
    Ok(())
}

/// The series of the reference: the 1000 numbers of NIST SP 1065, section 12.4, their differences, and
/// their sums.
fn series(name: &str) -> Vec<f64> {
    const MODULUS: u64 = 2_147_483_647;
    let numbers = std::iter::successors(Some(1_234_567_890_u64), |n| Some(16_807 * n % MODULUS));
    let white: Vec<f64> = numbers
        .take(1000)
        .map(|n| n as f64 / MODULUS as f64)
        .collect();
    match name {
        "white" => white,
        "difference" => white.windows(2).map(|pair| pair[1] - pair[0]).collect(),
        _ => white
            .iter()
            .scan(0.0, |sum, value| {
                *sum += value - 0.5;
                Some(*sum)
            })
            .collect(),
    }
}
