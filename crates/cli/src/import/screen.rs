//! The first screen of `gyrocal import strapdown`.

use gyrocal_document::{Screen, Standing};
use gyrocal_instruments::strapdown::ImportReport;
use gyrocal_record::shell_quoted;

use super::{StrapdownArguments, TO_CHECK, compared, disturbed_s, is_far, of_disturbed};

/// Rows, the rates that can be held against Earth rate, noise, and what to run next.
pub(super) fn first(arguments: &StrapdownArguments, report: &ImportReport) -> Screen {
    let mut rates = compared(report).into_iter();
    let far = rates.any(|(_, rate, expected)| is_far(rate, expected));
    let what = format!(
        "{} rows of {} s from {} samples over {:.1} s",
        report.rows, arguments.averaging_s, report.samples, report.duration_s
    );
    let (standing, verdict) = match far {
        true => (Standing::Doubtful, "IMPORTED, BUT FAR FROM EARTH RATE"),
        false => (Standing::Good, "IMPORTED"),
    };
    let mut screen = Screen::new(standing, verdict, what);
    for (name, [rate, sigma], expected) in compared(report) {
        let words = format!(
            "{rate:.4} ± {sigma:.4} deg/h, Earth {expected:.4}, difference {:.4}",
            rate - expected
        );
        screen.fact(&format!("{name} rate"), words);
    }
    if far {
        screen.fact("what to do", TO_CHECK);
    }
    record(arguments, report, &mut screen);
    next_step(arguments, &mut screen);
    screen
}

/// Heading, disturbed rows, noise, and what a static log does not tell.
fn record(arguments: &StrapdownArguments, report: &ImportReport, screen: &mut Screen) {
    let words = format!("body y points {:.3} deg from north", report.heading_deg);
    screen.fact("heading", words);
    let words = format!(
        "{:.0} s in {} windows, {}",
        disturbed_s(report),
        report.disturbed_s.len(),
        of_disturbed(arguments)
    );
    screen.fact("disturbed", words);
    let words = format!(
        "{:.2e} g per row, gyros at most {:.4} deg/h held over one minute",
        report.accel_noise_g, report.gyro_noise_deg_per_h
    );
    screen.fact("noise", words);
    let words = "bias from terms in specific force; drift toward east from the heading";
    screen.fact("not told", words);
}

/// The calibration of what was written.
fn next_step(arguments: &StrapdownArguments, screen: &mut Screen) {
    if let Some(bench) = &arguments.bench_out {
        let path = |path: &std::path::Path| shell_quoted(&path.to_string_lossy());
        let axes = arguments.axes_out.as_ref();
        let axes = axes.map_or_else(String::new, |axes| format!(" --gyro-axes {}", path(axes)));
        let (record, bench) = (path(&arguments.out), path(bench));
        let command = format!("gyrocal calibrate {record} --bench {bench}{axes}");
        screen.then(command, "errors of the gyros");
    }
}
