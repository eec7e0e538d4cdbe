//! Tables and numbers of the page.

use gyrocal::EARTH_RATE_RAD_PER_S;
use gyrocal_evaluation::CalibrationTrial;
use gyrocal_record::AXES;
use gyrocal_statistics::{
    NORMAL_97_5, Proportion, mean, mean_square_band, median, quantile, root_mean_square,
};
use gyrocal_truth::{Scenario, euler_rule, simulate};

use super::ways::{
    COORDINATES, EARTH_RATES, Found, PAPER_DAYS, SEEDS, SHOWN_SEED, WAYS, as_printed, key, nis,
    scenario,
};
use crate::harness::Error;
use crate::values::{Values, fixed, table, two_digits};

/// Median of the chi-square distribution with nine degrees of freedom.
const MEDIAN_OF_CONSISTENT: f64 = 8.343;
/// From here on a mean NIS is printed as a power of ten.
const LARGE: f64 = 1e4;

/// The trials of a filter, in the order of the seeds.
type Trials<'a> = Vec<&'a CalibrationTrial>;

/// A column of a table: its heading, and its cell for the trials of a row.
type Column = (&'static str, fn(&[&CalibrationTrial]) -> String);

const NIS: Column = ("mean NIS, median", |of| {
    match median(&of.iter().map(|trial| nis(trial)).collect::<Vec<_>>()) {
        large if large > LARGE => format!("{large:.2e}"),
        nis => fixed(nis, 2),
    }
});
const IN_SIGMAS: Column = ("errors in sigmas, RMS of all nine", |of| {
    fixed(root_mean_square(in_sigmas(of)), 2)
});
const HELD: Column = ("% of 95% intervals that hold the truth", |of| {
    let held = in_sigmas(of)
        .into_iter()
        .map(|error| error.abs() < NORMAL_97_5);
    fixed(100.0 * Proportion::of(held).share(), 1)
});
const NEES: [Column; 4] = [
    ("NEES, median", |of| two_digits(median(&nees(of)))),
    ("middle 80%", |of| {
        let at = |share| two_digits(quantile(&nees(of), share));
        [0.1, 0.9].map(at).join(" to ")
    }),
    ("mean", |of| two_digits(mean(nees(of)))),
    HELD,
];
const OF_KINDS: [Column; 5] = [
    NIS,
    ("D_F: RMS error (deg/h)", rms_of_kind::<0>),
    ("D_I: RMS error (deg/h/g)", rms_of_kind::<1>),
    ("D_II: RMS error (deg/h/g²)", rms_of_kind::<2>),
    ("mean error of the three D_I (deg/h/g)", |of| {
        fixed(mean(of_kind(of, 1)), 4)
    }),
];

/// Estimates of the paper's Table 2, as printed.
const PRINTED: [f64; 9] = [
    0.49681, -0.20185, -0.09824, -0.50340, 0.19826, 0.10176, 0.49712, 0.20153, -0.09835,
];

/// Integration rules of the default filter.
const SUB_STEPS: [(&str, &str); 5] = [
    ("euler_1", "first order, one step"),
    ("euler_4", "first order, 4 sub-steps"),
    ("euler_16", "first order, 16 sub-steps"),
    ("euler_64", "first order, 64 sub-steps"),
    ("every", "RK4, one step"),
];

fn in_sigmas(of: &[&CalibrationTrial]) -> Vec<f64> {
    let each = |trial: &&CalibrationTrial| trial.error.into_iter().zip(trial.sigma);
    let all = of.iter().flat_map(each);
    all.map(|(error, sigma)| error / sigma).collect()
}

fn nees(of: &[&CalibrationTrial]) -> Vec<f64> {
    of.iter().map(|trial| trial.nees).collect()
}

/// Errors of the coefficients of one kind.
fn of_kind(of: &[&CalibrationTrial], kind: usize) -> Vec<f64> {
    let each = |trial: &&CalibrationTrial| trial.error.into_iter().skip(kind).step_by(3);
    of.iter().flat_map(each).collect()
}

/// Errors in percent of the coefficients.
fn percent(trial: &CalibrationTrial) -> [f64; 9] {
    core::array::from_fn(|i| 100.0 * trial.error[i] / trial.truth[i])
}

fn rms_of_kind<const KIND: usize>(of: &[&CalibrationTrial]) -> String {
    fixed(root_mean_square(of_kind(of, KIND)), 4)
}

/// All texts of the page that are of the population.
pub(super) fn fill(values: &mut Values, found: &[Found]) -> Result<(), Error> {
    let trials = |name: &str, days| -> Trials<'_> {
        let key = key(name, days);
        found.iter().map(|found| &found[&key]).collect()
    };
    // A row for each filter after each number of days, which are told if there are several.
    let mut put =
        |place: &str, label, columns: &[Column], filters: &[(&str, &str)], days: &[u32]| {
            let first = usize::from(days.len() == 1);
            let mut header = ["days", label][first..].to_vec();
            header.extend(columns.iter().map(|(heading, _)| *heading));
            let of_days = |days| filters.iter().map(move |of| (days, *of));
            let each = days.iter().copied().flat_map(of_days);
            let rows = each.map(|(days, (key, name))| {
                let trials = trials(key, days);
                let labels = [days.to_string(), name.to_owned()];
                let cells = columns.iter().map(|(_, cell)| cell(&trials));
                labels.into_iter().skip(first).chain(cells).collect()
            });
            values.put(place, table(&header, rows));
        };
    let (paper, both) = (&[PAPER_DAYS], &[1, PAPER_DAYS]);
    let fit = &[NIS, IN_SIGMAS, HELD];
    let label = "integration of a sample's interval";
    put("table_fit", "filter and data", fit, &WAYS, paper);
    put("table_sub_steps", label, &fit[..2], &SUB_STEPS, paper);
    put("table_nees", "estimator", &NEES, &COORDINATES, both);
    put(
        "table_printed",
        "Earth rate",
        &OF_KINDS,
        &EARTH_RATES,
        paper,
    );
    for (key, _) in COORDINATES {
        values.put(format!("nees_{key}"), (NEES[0].1)(&trials(key, 1)));
    }
    for (key, _) in WAYS.into_iter().chain(EARTH_RATES) {
        values.put(format!("nis_{key}"), (NIS.1)(&trials(key, PAPER_DAYS)));
    }
    describe(values);
    of_errors(values, &WAYS.map(|(key, _)| trials(key, PAPER_DAYS)));
    without_noise(values)
}

/// Table 1, and further constants of the bench.
fn describe(values: &mut Values) {
    let scenario = scenario(SHOWN_SEED, PAPER_DAYS);
    let of = scenario.coefficients.named();
    let gyro = |axis: usize| {
        let own = of[3 * axis..3 * axis + 3].iter();
        let coefficients = own.map(|(_, value, _)| fixed(*value, 2));
        core::iter::once(AXES[axis].to_owned())
            .chain(coefficients)
            .collect()
    };
    let header = ["gyro", "D_F (deg/h)", "D_I (deg/h/g)", "D_II (deg/h/g²)"];
    let printed_deg = as_printed(scenario.latitude_deg);
    let (sine, cosine) = scenario.latitude_deg.to_radians().sin_cos();
    let excess = EARTH_RATE_RAD_PER_S.to_degrees() * 3600.0 * (cosine - sine);
    let turn_rad = EARTH_RATE_RAD_PER_S * scenario.interval_s;
    let [angle_sigma_deg, ..] = scenario.initial_angles_sigma_deg;
    let [prior_sigma_deg_per_h, ..] = scenario.prior.bias_sigma_deg_per_h;
    for (place, text) in [
        ("table_1", table(&header, (0..3).map(gyro))),
        ("latitude", fixed(scenario.latitude_deg, 1)),
        ("interval", fixed(scenario.interval_s, 0)),
        ("days", PAPER_DAYS.to_string()),
        ("accel_noise", format!("{:e}", scenario.accel_noise_g)),
        ("gyro_noise", fixed(scenario.gyro_noise_deg_per_h, 3)),
        ("angle_sigma", fixed(angle_sigma_deg, 2)),
        ("prior_sigma", fixed(prior_sigma_deg_per_h, 0)),
        ("runs", SEEDS.to_string()),
        ("nees_consistent", fixed(MEDIAN_OF_CONSISTENT, 1)),
        ("seeds", format!("{SHOWN_SEED} to {SEEDS}")),
        ("shown_seed", SHOWN_SEED.to_string()),
        // Earth rate as printed in (6).
        ("co_latitude", fixed(printed_deg, 1)),
        ("vertical_excess", fixed(excess, 2)),
        ("north_deficit", fixed(excess, 2)),
        // The Earth turns by this in one step, and half its square is left out.
        ("turn_deg", fixed(turn_rad.to_degrees(), 2)),
        ("left_out", format!("{:.1e}", 0.5 * turn_rad * turn_rad)),
    ] {
        values.put(place, text);
    }
}

/// Table 2: errors in percent, of the record that is shown and of all.
fn of_errors(values: &mut Values, ways: &[Trials<'_>; 4]) {
    let one: Vec<[f64; 9]> = ways.iter().map(|trials| percent(trials[0])).collect();
    let rms = ways.iter().map(|trials| {
        core::array::from_fn(|i| root_mean_square(trials.iter().map(|trial| percent(trial)[i])))
    });
    let rms: Vec<[f64; 9]> = rms.collect();
    let [first, second, third, fourth] = WAYS.map(|(_, name)| name);
    let header = ["coefficient", "true value", first, second, third, fourth];
    let truth = scenario(SHOWN_SEED, PAPER_DAYS).coefficients.named();
    for (place, columns) in [("table_2", &one), ("table_2_rms", &rms)] {
        let printed = place == "table_2";
        let mut header = header.to_vec();
        if printed {
            header.insert(2, "the paper, as printed");
        }
        let rows = truth.iter().enumerate().map(|(i, (name, truth, unit))| {
            let value = format!("{} {}", fixed(*truth, 2), unit.replace("^2", "²"));
            let printed = printed.then(|| 100.0 * (PRINTED[i] - truth) / truth);
            let columns = columns.iter().map(|column| column[i]);
            let errors = printed.into_iter().chain(columns);
            let labels = [format!("`{name}`"), value];
            let cells = errors.map(|error| fixed(error, 2));
            labels.into_iter().chain(cells).collect()
        });
        values.put(place, table(&header, rows));
    }
    for ((key, _), errors) in WAYS.iter().zip(&one) {
        let largest = errors.map(f64::abs).into_iter().fold(0.0, f64::max);
        values.put(format!("largest_percent_{key}"), fixed(largest, 1));
    }
    let shown = ways[0][0];
    let band = mean_square_band(shown.values as f64, shown.rows as f64, 0.999);
    values.put("nis_band", band.map(|bound| fixed(bound, 2)).join(" to "));
}

/// Difference of both rules from one attitude, without noise.
fn without_noise(values: &mut Values) -> Result<(), Error> {
    let noisy = scenario(SHOWN_SEED, PAPER_DAYS);
    let noise_g = noisy.accel_noise_g;
    let quiet = Scenario {
        accel_noise_g: 0.0,
        gyro_noise_deg_per_h: 0.0,
        initial_angles_sigma_deg: [0.0; 3],
        ..noisy
    };
    let exact = simulate(&quiet)?.record;
    let rule = euler_rule(&quiet)?.record;
    let both = exact.accel_g.iter().zip(&rule.accel_g);
    let apart = both.map(|(a, b)| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt());
    let apart_g: Vec<f64> = apart.collect();
    let rows = [
        ("one step", 1),
        ("one hour", 60),
        ("one day", 1440),
        ("three days", 4320),
    ];
    let rows = rows.into_iter().map(|(name, rows)| {
        let largest = apart_g[..=rows].iter().copied().fold(0.0, f64::max);
        let in_sigmas = two_digits(largest / noise_g);
        vec![name.to_owned(), format!("{largest:.1e}"), in_sigmas]
    });
    let header = [
        "after",
        "largest difference so far (g)",
        "in sigmas of a sample",
    ];
    values.put("table_rule", table(&header, rows));
    Ok(())
}
