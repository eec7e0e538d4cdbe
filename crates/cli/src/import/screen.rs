//! The first screen of `gyrocal import strapdown`.

use gyrocal_document::{Screen, Standing};
use gyrocal_instruments::strapdown::ImportReport;
use gyrocal_record::shell_quoted;

use super::{FAR_SIGMAS, StrapdownArguments, disturbed_s};

/// Rows, the rates that can be held against Earth rate, noise, and what to run next.
pub(super) fn first(arguments: &StrapdownArguments, report: &ImportReport) -> Screen {
    let pairs = [
        (
            "horizontal",
            report.horizontal_rate_deg_per_h,
            report.expected_horizontal_rate_deg_per_h,
        ),
        (
            "vertical",
            report.vertical_rate_deg_per_h,
            report.expected_vertical_rate_deg_per_h,
        ),
    ];
    let is_far =
        |([rate, sigma], expected): ([f64; 2], f64)| (rate - expected).abs() > FAR_SIGMAS * sigma;
    let far = pairs
        .iter()
        .any(|(_, rate, expected)| is_far((*rate, *expected)));
    let what = format!(
        "{} rows of {} s from {} samples over {:.1} s",
        report.rows, arguments.averaging_s, report.samples, report.duration_s
    );
    let mut screen = match far {
        true => Screen::new(
            Standing::Doubtful,
            "IMPORTED, BUT FAR FROM EARTH RATE",
            what,
        ),
        false => Screen::new(Standing::Good, "IMPORTED", what),
    };
    for (name, [rate, sigma], expected) in pairs {
        let words = format!(
            "{rate:.4} ± {sigma:.4} deg/h, Earth {expected:.4}, difference {:.4}",
            rate - expected
        );
        screen.fact(&format!("{name} rate"), words);
    }
    if far {
        screen.fact(
            "what to do",
            "check latitude, units and axes in the log description, and the gyros",
        );
    }
    record(arguments, report, &mut screen);
    next_step(arguments, &mut screen);
    screen
}

/// Heading, disturbed rows, noise, and what a static log does not tell.
fn record(arguments: &StrapdownArguments, report: &ImportReport, screen: &mut Screen) {
    screen.fact(
        "heading",
        format!("body y points {:.3} deg from north", report.heading_deg),
    );
    let words = format!(
        "{:.0} s in {} windows, {}",
        disturbed_s(report),
        report.disturbed_s.len(),
        if arguments.keep_disturbed {
            "kept"
        } else {
            "written as missing"
        }
    );
    screen.fact("disturbed", words);
    let words = format!(
        "{:.2e} g per row, gyros at most {:.4} deg/h held over one minute",
        report.accel_noise_g, report.gyro_noise_deg_per_h
    );
    screen.fact("noise", words);
    screen.fact(
        "not told",
        "bias from terms in specific force; drift toward east from the heading",
    );
}

/// The calibration of what was written.
fn next_step(arguments: &StrapdownArguments, screen: &mut Screen) {
    if let Some(bench) = &arguments.bench_out {
        let path = |path: &std::path::Path| shell_quoted(&path.to_string_lossy());
        let axes = arguments
            .axes_out
            .as_ref()
            .map_or_else(String::new, |axes| format!(" --gyro-axes {}", path(axes)));
        screen.then(
            format!(
                "gyrocal calibrate {} --bench {}{axes}",
                path(&arguments.out),
                path(bench)
            ),
            "errors of the gyros",
        );
    }
}
