//! Exact intervals and descriptive statistics against other libraries and their definitions.

use gyrocal_statistics::{
    Judgement, Proportion, mean, mean_square_band, median, quantile, rms_ratio_interval,
    root_mean_square, standard_error,
};

/// Relative agreement.
#[track_caller]
fn assert_near(found: f64, expected: f64, relative: f64) {
    let off = (found - expected).abs();
    assert!(
        off <= relative * expected.abs(),
        "{found} is not {expected}"
    );
}

/// Against `scipy.stats.beta.ppf` 1.x, which has another algorithm; its own last digits are good
/// to about 1e-12, and the distribution function here to about 1e-11 for thousands of trials.
const LIBRARIES: f64 = 1e-9;

#[test]
fn bounds_of_a_proportion_are_those_of_another_library() {
    let cases = [
        (
            3,
            20,
            0.95,
            [0.032_070_937_185_463_715, 0.378_926_826_545_314],
        ),
        (
            1900,
            2000,
            0.95,
            [0.939_518_277_916_848_2, 0.959_135_732_281_748_6],
        ),
        (
            1,
            2000,
            0.95,
            [1.265_882_386_855_79e-5, 0.002_782_639_834_658_946_5],
        ),
        (
            17_000,
            18_000,
            0.999,
            [0.938_610_211_398_415_3, 0.949_903_231_334_758_8],
        ),
    ];
    for (hits, trials, confidence, [low, high]) in cases {
        let interval = Proportion { hits, trials }.interval(confidence);
        assert_near(interval[0], low, LIBRARIES);
        assert_near(interval[1], high, LIBRARIES);
    }
    let rare = Proportion {
        hits: 1,
        trials: 2000,
    };
    assert_near(rare.upper_bound(0.95), 0.002_369_713_367_656_843, LIBRARIES);
    assert_near(
        rare.lower_bound(0.95),
        2.564_631_832_133_064_4e-5,
        LIBRARIES,
    );
}

#[test]
fn no_hit_and_no_miss_have_closed_forms() {
    let (trials, confidence) = (2000, 0.95);
    let none = Proportion { hits: 0, trials };
    let all = Proportion {
        hits: trials,
        trials,
    };
    // (1 - p)^n = 1 - confidence.
    let bound = 1.0 - f64::powf(1.0 - confidence, 1.0 / trials as f64);
    assert_near(none.upper_bound(confidence), bound, LIBRARIES);
    assert_near(all.lower_bound(confidence), 1.0 - bound, LIBRARIES);
    assert_eq!(none.lower_bound(confidence), 0.0);
    assert_eq!(all.upper_bound(confidence), 1.0);
    let nothing = Proportion::of([]);
    assert_eq!(nothing.interval(0.95), [0.0, 1.0]);
    assert!(nothing.share().is_nan());
}

/// 45 hits of 45 show, with 95 %, that the share is at least 0.05^(1/45) = 0.936, and no more.
#[test]
fn few_trials_cannot_confirm_a_high_limit() {
    let of = |hits, trials| Proportion { hits, trials };
    assert_eq!(of(45, 45).at_least(0.99), Judgement::TooFew);
    assert_eq!(of(45, 45).at_least(0.93), Judgement::Met);
    assert_eq!(of(300, 300).at_least(0.99), Judgement::Met);
    assert_eq!(of(30, 45).at_least(0.99), Judgement::Missed);
    assert_eq!(of(0, 45).at_most(0.02), Judgement::TooFew);
    assert_eq!(of(0, 150).at_most(0.02), Judgement::Met);
    assert_eq!(of(9, 45).at_most(0.02), Judgement::Missed);
    assert_eq!(of(0, 0).at_least(0.5), Judgement::TooFew);
    assert_eq!(Judgement::TooFew.holds(), None);
}

/// Exactness of the interval: for every true share, it holds the share with at least the stated
/// probability. The probability is summed over all outcomes, not sampled.
#[test]
fn an_interval_covers_at_least_as_often_as_it_says() {
    let trials = 25;
    for percent in 1..100 {
        let share = f64::from(percent) / 100.0;
        let mut covered = 0.0;
        let mut probability = (1.0 - share).powi(trials);
        for hits in 0..=trials {
            let [low, high] = Proportion {
                hits: hits as u64,
                trials: trials as u64,
            }
            .interval(0.9);
            if low <= share && share <= high {
                covered += probability;
            }
            probability *= f64::from(trials - hits) / f64::from(hits + 1) * share / (1.0 - share);
        }
        assert!(covered >= 0.9, "{percent} %: {covered}");
    }
}

#[test]
fn chi_square_bands_hold_up_to_tens_of_millions_of_samples() {
    // scipy.stats.chi2: ppf and isf at 0.0005.
    let cases = [
        (9.0, [0.971_699_448_957_840_2, 29.665_808_103_596_14]),
        (18_000.0, [17_382.210_671_269_844, 18_630.892_524_496_18]),
        (4.2e6, [4_190_469.698_715_562, 4_209_543.404_705_031]),
        (6e7, [59_963_960.637_244_76, 60_036_052.466_176_73]),
    ];
    for (degrees, [low, high]) in cases {
        let band = mean_square_band(degrees, 10.0, 0.999);
        // A thousandth of the width of the band decides nothing.
        let tolerance = 1e-3 * (high - low) / 10.0;
        assert!(
            (band[0] - low / 10.0).abs() < tolerance,
            "{degrees}: {band:?}"
        );
        assert!(
            (band[1] - high / 10.0).abs() < tolerance,
            "{degrees}: {band:?}"
        );
    }
}

#[test]
fn the_interval_of_a_ratio_is_that_of_a_chi_square() {
    // scipy.stats.chi2 with 2000 degrees of freedom: 2.5 % and 97.5 % points.
    let [low, high] = rms_ratio_interval(1.1, 2000, 0.95);
    assert_near(
        low,
        1.1 * (2000.0_f64 / 2_125.842_302_449_776).sqrt(),
        LIBRARIES,
    );
    assert_near(
        high,
        1.1 * (2000.0_f64 / 1_877.946_036_815_39).sqrt(),
        LIBRARIES,
    );
}

#[test]
fn moments_and_quantiles_are_those_of_their_definitions() {
    let values = [4.0, 1.0, 3.0, 2.0];
    assert_eq!(mean(values), 2.5);
    assert_eq!(median(&values), 2.5);
    assert_eq!(median(&values[..3]), 3.0);
    // R: quantile(1:4, c(0, 0.1, 1)) is 1, 1.3, 4.
    assert_eq!(quantile(&values, 0.0), 1.0);
    assert_near(quantile(&values, 0.1), 1.3, 1e-15);
    assert_eq!(quantile(&values, 1.0), 4.0);
    assert_eq!(root_mean_square([3.0, -4.0]), 12.5_f64.sqrt());
    // Scatter sqrt(5/3), four values.
    assert_near(standard_error(&values), (5.0_f64 / 12.0).sqrt(), 1e-15);
    assert!(mean([0.0; 0]).is_nan() && median(&[]).is_nan() && standard_error(&[1.0]).is_nan());
}
