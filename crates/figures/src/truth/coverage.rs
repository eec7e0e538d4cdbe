//! Coverage of 95 % intervals: of shapes and sizes, and of the nine coefficients.

use gyrocal_statistics::{Judgement, Proportion, mean, standard_error};

use crate::figure::{Figure, coverage};

/// Range of a coverage of 95 % in cells of a thousand intervals and more.
const RANGE: [f64; 2] = [0.93, 0.97];

/// Fewer intervals than these hold if the exact 99.9 % interval of their coverage contains 95 %.
const FEW: usize = 1000;

/// Least coverage of the coefficients, all together.
const OF_COEFFICIENTS: f64 = 0.93;

/// One-sided points of the normal distribution at which few records show that a limit is met (95 %) or missed
/// (99.9 %).
const MET_SIGMAS: f64 = 1.645;
const MISSED_SIGMAS: f64 = 3.090;

/// The coefficients, in the order of the model.
const COEFFICIENTS: [&str; 9] = [
    "D_F of gyro x",
    "D_I of gyro x",
    "D_II of gyro x",
    "D_F of gyro y",
    "D_I of gyro y",
    "D_II of gyro y",
    "D_F of gyro z",
    "D_I of gyro z",
    "D_II of gyro z",
];

/// Coverage of independent intervals.
pub(super) fn of_intervals(name: &str, held: &[bool], seeds: &str, small: bool) -> Figure {
    let share = Proportion::of(held.iter().copied());
    let mut figure = Figure::within(name, RANGE, share.share()).of_share(share);
    let judgement = coverage(share, RANGE);
    if small {
        figure = figure.judged(judgement);
    } else if held.len() < FEW {
        figure.holds = Some(judgement != Judgement::Missed);
    }
    figure.over(held.len(), seeds)
}

/// Coverage of the coefficients: of all together, whose intervals err together within a record, and of each.
pub(super) fn of_coefficients(
    name: &str,
    records: &[&[bool]],
    seeds: &str,
    small: bool,
) -> Vec<Figure> {
    let stated: Vec<&[bool]> = records
        .iter()
        .copied()
        .filter(|held| !held.is_empty())
        .collect();
    let of_record = |held: &&[bool]| Proportion::of(held.iter().copied()).share();
    let shares: Vec<f64> = stated.iter().map(of_record).collect();
    let (share, error) = (mean(&shares), standard_error(&shares));
    let all = Proportion {
        hits: (share * stated.len() as f64).round() as u64,
        trials: stated.len() as u64,
    };
    let mut pooled = Figure::within(name, [OF_COEFFICIENTS, 1.0], share).of_share(all);
    pooled.measured = format!("{} (standard error {error:.3})", pooled.measured);
    if small {
        let met = share - MET_SIGMAS * error >= OF_COEFFICIENTS;
        let missed = share + MISSED_SIGMAS * error < OF_COEFFICIENTS;
        pooled = pooled.judged(Judgement::of(met, missed));
    }
    let mut figures = vec![pooled.over(stated.len(), seeds)];
    figures.extend(COEFFICIENTS.iter().enumerate().map(|(index, coefficient)| {
        let held = stated.iter().filter_map(|held| held.get(index).copied());
        Figure::note_share(
            &format!("{name}: {coefficient}"),
            Proportion::of(held),
            seeds,
        )
    }));
    figures
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_of_a_record_err_together() {
        // Of ten records nine hold all coefficients and one none; one states nothing.
        let (all, none) = ([true; 9], [false; 9]);
        let mut records: Vec<&[bool]> = vec![&all; 9];
        records.extend([&none[..], &[]]);
        let figures = of_coefficients("held", &records, "0..11", false);
        assert_eq!(figures.len(), 10);
        // The standard error of ten records, not of ninety coefficients.
        assert_eq!(figures[0].measured, "0.900 (standard error 0.100)");
        assert_eq!((figures[0].runs, figures[0].holds), (10, Some(false)));
        assert!(figures[1].name.ends_with("D_F of gyro x") && figures[1].runs == 10);
        assert!(figures[9].measured.starts_with("0.900 "));
    }

    #[test]
    fn few_intervals_hold_unless_95_percent_is_excluded() {
        let of = |hits: usize, all: usize| {
            let held: Vec<bool> = (0..all).map(|index| index < hits).collect();
            of_intervals("held", &held, "", false).holds
        };
        assert_eq!(of(92, 100), Some(true));
        assert_eq!(of(80, 100), Some(false));
        assert_eq!(of(920, 1000), Some(false));
        assert_eq!(of(950, 1000), Some(true));
    }
}
