//! The error budget: how much of the false-alarm probability each test may spend, and where its
//! constants come from.
//!
//! A diagnosis promises one family-wise probability α that a record of the nominal model with the
//! declared noise shows any finding. By Bonferroni's inequality the shares of its tests may add up
//! to one at most. [`TABLE`] lists all of them, and all constants that decide what is reported, as
//! `docs/method.md` prints them.

use gyrocal_calibration::GYRO_NOISE_PRIOR_SIGMA;
use gyrocal_hypothesis::{
    BESIDE_WALKS, CONFIDENCE_SET_DEVIANCE, DETECTION_PENALTY_FRACTION, FAR_OFF, NESTED_MODEL_CHI2,
    WALK_SET_DEVIANCE,
};

use gyrocal_answer::FalseAlarmShares;

/// Share of α for the noise audit of the accelerometers.
pub const NOISE_AUDIT_SHARE: f64 = 0.12;

/// Share of α for the noise of the gyros, from the likelihood of the fit.
pub const GYRO_NOISE_SHARE: f64 = 0.03;

/// Share of α for the search over the catalogue.
pub const SEARCH_SHARE: f64 = 0.6;

/// Share of α for random walks of the gyros.
pub const RANDOM_WALK_SHARE: f64 = 0.1;

/// Share of α for the test of the residuals.
pub const RESIDUAL_TEST_SHARE: f64 = 0.1;

/// Share of α for each of the tests that are reported and make no finding: the magnitude test and
/// the Allan test. They are outside of the sum.
pub const REPORTED_TEST_SHARE: f64 = 0.1;

/// Parts of the share of the noise audit: outliers, level, correlation, and one that stays unspent
/// since the noise of the gyros has a share of its own.
pub(crate) const NOISE_AUDIT_PARTS: f64 = 4.0;

/// Tests of one kind on three instruments (Bonferroni).
pub(crate) const INSTRUMENTS: f64 = 3.0;

/// Tests of the residuals: lines and correlation of the innovations, and the search for terms that
/// the catalogue does not hold.
pub(crate) const RESIDUAL_TESTS: f64 = 3.0;

/// p-value below which the consistency test of another filter is failed: it adds nothing to α.
pub const FILTER_TEST_ALPHA: f64 = 1e-6;

/// Deviation in sigmas beyond which a value that the noise audit cannot test is an outlier: of a
/// million such values of sound records not one is.
pub const UNTESTABLE_OUTLIER_Z: f64 = 7.0;

/// Least difference of a coefficient of another platform, in its standard deviations: one platform differs by as much
/// in one of two hundred thousand pairs.
pub(crate) const OTHER_PLATFORM: f64 = 5.0;

/// By how much coefficients of their own must be likelier, nats: as 150 to 1.
pub(crate) const OTHER_PLATFORM_NATS: f64 = 5.0;

/// Part of α that no test spends: drawn thresholds and asymptotic p-values are each a little off.
const RESERVE: f64 = 0.05;

/// Least coverage of confidence sets that [`CONFIDENCE_SET_DEVIANCE`] is chosen for. What was measured is in
/// [`crate::set_coverage`].
pub const CONFIDENCE_SET_COVERAGE: f64 = 0.95;

/// Origin of a constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A theorem or a table.
    Theory(&'static str),
    /// Simulated records; the command that measures it.
    Calibrated(&'static str),
    /// A choice: any value is valid, and this one divides the budget.
    Choice(&'static str),
}

/// One line of the budget.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Test or decision.
    pub test: &'static str,
    /// Probability or threshold, as it is used.
    pub value: f64,
    /// Meaning of the value.
    pub meaning: &'static str,
    /// Origin of the value.
    pub origin: Origin,
}

/// The whole budget.
pub const TABLE: [Line; 19] = [
    Line {
        test: "noise audit",
        value: NOISE_AUDIT_SHARE,
        meaning: "share of α; a quarter each for outliers, level and correlation, one unspent",
        origin: Origin::Choice("rate measured by `cargo figures diagnosis --part ground`"),
    },
    Line {
        test: "gyro noise",
        value: GYRO_NOISE_SHARE,
        meaning: "share of α; three gyros, Bonferroni",
        origin: Origin::Choice("rate measured by `cargo figures diagnosis --part naming`"),
    },
    Line {
        test: "search over the catalogue",
        value: SEARCH_SHARE,
        meaning: "share of α for the largest statistic of all hypotheses",
        origin: Origin::Choice("threshold drawn from the null distribution of each record"),
    },
    Line {
        test: "residual test",
        value: RESIDUAL_TEST_SHARE,
        meaning: "share of α; lines, correlation and unmodelled terms, Bonferroni",
        origin: Origin::Choice("p-values of Baluev (2008), Ljung and Box (1978)"),
    },
    Line {
        test: "reserve",
        value: RESERVE,
        meaning: "part of α that no test spends: drawn thresholds and asymptotic p-values are a little off",
        origin: Origin::Calibrated("`cargo figures diagnosis --part naming`, clean records"),
    },
    Line {
        test: "magnitude test, Allan test",
        value: REPORTED_TEST_SHARE,
        meaning: "share of α for each, outside of the sum: they make no finding",
        origin: Origin::Choice("rate measured by the tests of this package"),
    },
    Line {
        test: "filter test (`--filter`)",
        value: FILTER_TEST_ALPHA,
        meaning: "p-value, outside of the sum: negligible beside α",
        origin: Origin::Choice("chi-square by Wilson and Hilferty (1931)"),
    },
    Line {
        test: "untestable rows",
        value: UNTESTABLE_OUTLIER_Z,
        meaning: "sigmas beyond which a value at the start or after a gap is an outlier",
        origin: Origin::Theory("normal tail: 3e-12 per value"),
    },
    Line {
        test: "random walks",
        value: RANDOM_WALK_SHARE,
        meaning: "share of α for the likelihood ratio of walks of all gyros",
        origin: Origin::Theory("mixture of chi-square (Self, Liang 1987)"),
    },
    Line {
        test: "white noise of the gyros",
        value: GYRO_NOISE_PRIOR_SIGMA,
        meaning: "standard deviation of the logarithm over the declared noise before the record",
        origin: Origin::Choice("spends nothing: effects are tested with the noise estimated"),
    },
    Line {
        test: "walks or effects",
        value: WALK_SET_DEVIANCE,
        meaning: "twice the log-likelihood by which effects must be better than walks to stand alone",
        origin: Origin::Calibrated("`cargo figures diagnosis`, random walks"),
    },
    Line {
        test: "effects beside walks",
        value: BESIDE_WALKS,
        meaning: "twice the log-likelihood above the threshold that an effect must gain beside walks",
        origin: Origin::Calibrated("`cargo figures diagnosis`, random walks"),
    },
    Line {
        test: "detection",
        value: DETECTION_PENALTY_FRACTION,
        meaning: "fraction of the search penalty applied in the detection test; all of it applies in ranking",
        origin: Origin::Choice("the threshold is drawn with it"),
    },
    Line {
        test: "far off",
        value: FAR_OFF,
        meaning: "statistic above which the errors of the set-up and the best effects are compared by fits",
        origin: Origin::Choice("spends nothing: detection is that of every effect"),
    },
    Line {
        test: "nested models",
        value: NESTED_MODEL_CHI2,
        meaning: "chi-square by which an effect with more parameters must be better",
        origin: Origin::Theory("5 % point of chi-square, one degree of freedom"),
    },
    Line {
        test: "confidence set",
        value: CONFIDENCE_SET_DEVIANCE,
        meaning: "largest difference of penalised statistics within the set",
        origin: Origin::Calibrated(
            "`cargo figures diagnosis --part naming`: 95 % coverage at 5 sigma",
        ),
    },
    Line {
        test: "two platforms, difference",
        value: OTHER_PLATFORM,
        meaning: "standard deviations of a coefficient by which records of two platforms differ at least",
        origin: Origin::Theory("normal tail of nine coefficients: 5e-6 per pair"),
    },
    Line {
        test: "two platforms, evidence",
        value: OTHER_PLATFORM_NATS,
        meaning: "log-evidence in nats of coefficients of their own over one platform with all that was found",
        origin: Origin::Calibrated(
            "`cargo figures diagnosis --part field`, records of two platforms",
        ),
    },
    Line {
        test: "cross-validation",
        value: 0.0,
        meaning: "log score in nats that an accepted cause must exceed",
        origin: Origin::Calibrated("`cargo figures diagnosis --part gain`"),
    },
];

/// The probabilities that the tests of a diagnosis may spend of `false_alarm_probability`.
#[must_use]
pub fn shares(false_alarm_probability: f64) -> FalseAlarmShares {
    FalseAlarmShares {
        noise_audit: NOISE_AUDIT_SHARE * false_alarm_probability,
        gyro_noise: GYRO_NOISE_SHARE * false_alarm_probability,
        search: SEARCH_SHARE * false_alarm_probability,
        random_walk: RANDOM_WALK_SHARE * false_alarm_probability,
        residual_test: RESIDUAL_TEST_SHARE * false_alarm_probability,
        magnitude_test: REPORTED_TEST_SHARE * false_alarm_probability,
        allan_test: REPORTED_TEST_SHARE * false_alarm_probability,
    }
}

/// [`TABLE`] as the documentation prints it.
#[must_use]
pub fn markdown() -> String {
    let mut text = "| test | value | meaning | origin |\n|---|---|---|---|\n".to_owned();
    for line in TABLE {
        let origin = match line.origin {
            Origin::Theory(words) => format!("theory: {words}"),
            Origin::Calibrated(words) => format!("calibrated: {words}"),
            Origin::Choice(words) => format!("choice: {words}"),
        };
        let value = if line.value == 0.0 || line.value >= 1e-3 {
            line.value.to_string()
        } else {
            format!("{:e}", line.value)
        };
        let Line { test, meaning, .. } = line;
        text.push_str(&format!("| {test} | {value} | {meaning} | {origin} |\n"));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shares_are_not_overspent() {
        let spent = NOISE_AUDIT_SHARE
            + GYRO_NOISE_SHARE
            + SEARCH_SHARE
            + RANDOM_WALK_SHARE
            + RESIDUAL_TEST_SHARE;
        // Sums of decimal fractions.
        assert!((1.0 - spent - RESERVE).abs() < 1e-12, "{spent}");
    }

    #[test]
    fn the_documentation_prints_this_table() {
        let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/method.md");
        let page = std::fs::read_to_string(page).unwrap().replace("\r\n", "\n");
        let table = markdown();
        assert!(page.contains(&table), "docs/method.md lacks\n{table}");
    }
}
