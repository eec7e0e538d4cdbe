use super::*;

fn of(hits: u64, trials: u64) -> Proportion {
    Proportion { hits, trials }
}

fn holds(statistic: &Statistic, target: Target, full: bool) -> Option<bool> {
    statistic.judged(target, full).holds()
}

/// Share of populations that pass, by the binomial distribution.
fn passing(rate: f64, trials: u64, passes: impl Fn(Proportion) -> bool) -> f64 {
    // By logarithms, as the first terms are too small for a double.
    let (ln_odds, mut ln_term) = (
        (rate / (1.0 - rate)).ln(),
        trials as f64 * (1.0 - rate).ln(),
    );
    let mut passing = 0.0;
    for hits in 0..=trials {
        if passes(of(hits, trials)) {
            passing += ln_term.exp();
        }
        ln_term += ln_odds + ((trials - hits) as f64 / (hits + 1) as f64).ln();
    }
    passing
}

#[test]
fn a_program_as_good_as_the_target_passes_in_nineteen_of_twenty_populations() {
    for (rate, trials) in [
        (0.95, 300),
        (0.95, 1000),
        (0.01, 300),
        (0.01, 2000),
        (0.5, 60),
    ] {
        for target in [Target::AtLeast(rate), Target::AtMost(rate)] {
            let met = |share| holds(&Statistic::Share(share), target, true) == Some(true);
            let passing = passing(rate, trials, met);
            // Exact bounds hold with at least their confidence; whole numbers give some more.
            assert!(
                (0.95..0.99).contains(&passing),
                "{target}, {trials}: {passing}"
            );
        }
        // One that is worse by five sigmas of the share fails; of few hits the distribution is skew.
        let target = Target::AtMost(rate);
        let met = |share| holds(&Statistic::Share(share), target, true) == Some(true);
        let worse = rate + 5.0 * (rate * (1.0 - rate) / trials as f64).sqrt();
        assert!(
            worse >= 1.0 || passing(worse, trials, met) < 0.1,
            "{target}"
        );
    }
}

#[test]
fn a_small_population_may_be_too_small_to_tell() {
    let least = |hits, trials| {
        holds(
            &Statistic::Share(of(hits, trials)),
            Target::AtLeast(0.9),
            false,
        )
    };
    // 0.8 of ten does not reject 0.9; 0.4 does: its 99.9 % bound is 0.83. 30 of 30 show 0.905.
    assert_eq!(least(8, 10), None);
    assert_eq!(least(4, 10), Some(false));
    assert_eq!(least(10, 10), None);
    assert_eq!(least(30, 30), Some(true));
    let most = |hits, trials| {
        holds(
            &Statistic::Share(of(hits, trials)),
            Target::AtMost(0.1),
            false,
        )
    };
    assert_eq!(
        (most(2, 10), most(0, 29), most(6, 10)),
        (None, Some(true), Some(false))
    );
    assert_eq!(least(0, 0), None);
}

#[test]
fn a_bound_meets_its_target_itself() {
    // The upper bound of 27 of 2000 is below 2 %, that of 33 is not.
    let bound = |hits| {
        holds(
            &Statistic::Bound(of(hits, 2000)),
            Target::AtMost(0.02),
            true,
        )
    };
    assert_eq!((bound(27), bound(33)), (Some(true), Some(false)));
}

#[test]
fn averages_do_not_weigh_by_trials() {
    let averaged = |full, all: &[Proportion]| {
        holds(
            &Statistic::Average(all.to_vec()),
            Target::AtLeast(0.6),
            full,
        )
    };
    let (all, few) = (of(30, 30), of(2, 10));
    assert_eq!(averaged(true, &[all, few]), Some(true));
    assert_eq!(averaged(true, &[all, few, few, few]), Some(false));
    // (0.25 + 0.27) / 2 with a sigma of about 0.07.
    assert_eq!(averaged(false, &[of(5, 20), of(6, 22)]), Some(false));
    assert_eq!(averaged(false, &[of(0, 1), of(1, 1)]), None);
    assert_eq!(averaged(false, &[of(30, 30), of(30, 30)]), Some(true));
}

#[test]
fn the_least_of_several_shares_may_be_of_too_few_records() {
    let families = |least, all: &[Proportion]| {
        holds(
            &Statistic::Least(all.to_vec()),
            Target::AtLeast(least),
            true,
        )
    };
    // One of two that misses all of its twenty records.
    let (all, none) = (of(20, 20), of(0, 20));
    assert_eq!(families(0.8, &[all, none]), Some(false));
    assert_eq!(families(0.8, &[all]), Some(true));
    // 45 of 45 show no more than 0.936.
    assert_eq!(families(0.99, &[of(45, 45)]), None);
}

#[test]
fn ratios_are_of_means() {
    let ratio =
        |full, target, pairs: &[[f64; 2]]| holds(&Statistic::Ratio(pairs.to_vec()), target, full);
    let most = Target::AtMost(1.2);
    let fine = [[1.0, 1.0], [3.0, 3.0], [2.0, 2.0]];
    let large = [[3.0, 2.0], [3.0, 2.0], [3.1, 2.0]];
    for full in [true, false] {
        assert_eq!(ratio(full, most, &fine), Some(true));
        assert_eq!(ratio(full, most, &large), Some(false));
    }
    // One outlier among others does not reject, and confirms nothing.
    assert_eq!(
        ratio(false, most, &[[5.0, 1.0], [1.0, 1.0], [1.0, 1.0]]),
        None
    );
    assert_eq!(ratio(false, most, &[[1.0, 1.0]]), None);
    let band = Target::Between([0.8, 1.2]);
    assert_eq!(ratio(true, band, &fine), Some(true));
    assert_eq!(ratio(true, band, &large), Some(false));
    assert_eq!(ratio(true, Target::AtLeast(1.4), &fine), Some(false));
}

#[test]
fn ratios_of_root_mean_squares_have_no_signs() {
    let errors = Statistic::RmsRatio(vec![[3.0, 1.0], [-1.0, 2.0], [-2.0, 1.0], [2.0, -3.0]]);
    assert!((errors.value() - (18.0_f64 / 15.0).sqrt()).abs() < 1e-15);
    assert_eq!(holds(&errors, Target::AtMost(1.1), true), Some(true));
    let band = Target::Between([4.0, 5.0]);
    assert_eq!(holds(&errors, band, true), Some(false));
}

#[test]
fn medians_and_means_have_their_scatter() {
    let values: Vec<f64> = (0..101).map(f64::from).collect();
    let median = Statistic::Median(values.clone());
    // 1.645 sigmas of the count are 8.2 values about the middle, the fiftieth.
    assert_eq!(holds(&median, Target::AtLeast(58.0), true), Some(true));
    assert_eq!(holds(&median, Target::AtLeast(59.0), true), Some(false));
    let mean = Statistic::Mean(values);
    // The standard error is 2.92.
    assert_eq!(holds(&mean, Target::AtMost(45.5), true), Some(true));
    assert_eq!(holds(&mean, Target::AtMost(45.0), true), Some(false));
    assert_eq!(holds(&mean, Target::AtMost(60.0), false), Some(true));
}

#[test]
fn items_that_depend_on_each_other_count_as_fewer() {
    let share = |records: &[[bool; 4]]| {
        Statistic::each(records, |items| *items)
            .proportion()
            .unwrap()
    };
    // Items of a record that agree are one; items that scatter like independent ones are themselves.
    let agreeing = [[true; 4], [true; 4], [false; 4], [true; 4]].repeat(5);
    assert_eq!(
        share(&agreeing),
        Proportion {
            hits: 15,
            trials: 20
        }
    );
    let scattered = [
        [true, true, true, false],
        [false, true, true, true],
        [true, true, false, true],
        [true, false, true, true],
    ];
    assert_eq!(
        share(&scattered.repeat(5)),
        Proportion {
            hits: 60,
            trials: 80
        }
    );
    assert_eq!(share(&[[true; 4]; 7]), Proportion { hits: 7, trials: 7 });
    assert_eq!(share(&[]).trials, 0);
}
