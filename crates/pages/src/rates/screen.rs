//! The first screen of gyro outputs in the rate domain.

use gyrocal_document::{Screen, Standing};
use gyrocal_instruments::rates::{GyroRates, RateReport};
use gyrocal_record::Input;
use gyrocal_statistics::{NORMAL_97_5, format};
use gyrocal_words::{counted, few};

use crate::bad_samples::left_out;
use crate::origin::named;
use crate::signs::against_the_earth;

/// Effects that are told one by one.
const EFFECTS_SHOWN: usize = 4;

/// Names of a list that are shown.
const NAMES_SHOWN: usize = 3;

/// Effects beyond the base law, biases, and what is not determined.
pub(super) fn first(logs: &[Input], report: &RateReport) -> Screen {
    let found: Vec<_> = report.gyros.iter().flat_map(GyroRates::effects).collect();
    let mut screen = match found.len() {
        0 => {
            let what = "no significant effect in temperature or time";
            Screen::new(Standing::Good, "RATES", what)
        }
        count => {
            let what = format!("{} in temperature or time", counted(count, "effect"));
            Screen::new(Standing::Doubtful, "RATES CHANGE", what)
        }
    };
    if report.earth_is_reversed {
        screen = against_the_earth();
    }
    for (effect, coefficient) in found.iter().take(EFFECTS_SHOWN) {
        let estimate = format::estimate(coefficient.estimate, coefficient.sigma).join(" ± ");
        let others = match &effect.alternatives[..] {
            [] => String::new(),
            names => format!("; may also be {}", names.join(", ")),
        };
        let words = format!(
            "{estimate} {}{}, {}{others}",
            coefficient.unit,
            effect.place(report.logs.len()),
            format::p_value(effect.p_value)
        );
        screen.fact(&effect.name, words);
    }
    screen.fact("left out", left_out(&report.bad_samples, logs.len()));
    biases(report, &mut screen);
    if let (true, Some(correlation)) = (report.time_is_temperature, report.time_and_temperature) {
        let words = format!(
            "temperature from time: their correlation is {correlation:.2}; warm the unit up and let \
             it cool down"
        );
        screen.fact("not told", words);
    }
    let undetermined = report.gyros.iter().flat_map(|gyro| &gyro.undetermined);
    let names = few(undetermined, NAMES_SHOWN);
    if !names.is_empty() {
        let way = match has_attitude(report) {
            true => format!("{names}: turn the unit over, a log each"),
            false => format!("{names}: needs accelerometers, and the unit turned over, a log each"),
        };
        screen.fact("undetermined", way);
    }
    let duration_s: f64 = report.logs.iter().map(|log| log.duration_s).sum();
    screen.fact("log", format!("{} over {duration_s:.0} s", named(logs)));
    screen
}

/// Whether the logs have accelerometers.
fn has_attitude(report: &RateReport) -> bool {
    let mut logs = report.logs.iter();
    logs.all(|log| log.vertical_deg_per_h.is_some())
}

/// Why Earth rate is not taken off.
pub(super) fn not_known(report: &RateReport) -> &'static str {
    match has_attitude(report) {
        true => "the description has no `latitude_deg`",
        false => "without accelerometers the attitude is not known",
    }
}

/// Biases of the gyros: of one log by its means, of several by the law; rates, where Earth rate is not known.
fn biases(report: &RateReport, screen: &mut Screen) {
    let earth = report.earth_vertical_deg_per_h;
    if earth.is_none() {
        let words = format!(
            "rates, that is bias and whatever turns the unit, Earth rate of up to 15.04 deg/h included: {}",
            not_known(report)
        );
        screen.fact("not bias alone", words);
    }
    if let [log] = &report.logs[..] {
        let what = match earth {
            Some(_) => "bias and terms in specific force",
            None => "mean of the log",
        };
        for (gyro, law) in report.gyros.iter().enumerate() {
            let words = format!(
                "{:.4} ± {:.4} deg/h (95 %), {what}",
                log.bias_deg_per_h[gyro], log.bias_half_width_deg_per_h[gyro]
            );
            screen.fact(&law.gyro, words);
        }
        if let (Some(earth), Some([rate, sigma])) = (earth, log.vertical_deg_per_h) {
            let half_width = NORMAL_97_5 * sigma;
            let words = format!("{rate:.4} ± {half_width:.4} deg/h (95 %), Earth {earth:.4}");
            screen.fact("vertical", words);
        }
        return;
    }
    for gyro in &report.gyros {
        if let Some(bias) = gyro.coefficients.first() {
            let estimate = format::estimate(bias.estimate, bias.sigma).join(" ± ");
            screen.fact(&bias.name, format!("{estimate} {}", bias.unit));
        }
    }
}
