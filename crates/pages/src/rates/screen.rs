//! The first screen of gyro outputs in the rate domain.

use gyrocal_document::{Screen, Standing};
use gyrocal_instruments::rates::{GyroRates, RateReport};
use gyrocal_record::Input;
use gyrocal_statistics::format;
use gyrocal_words::{counted, few};

use crate::origin::named;

/// Effects that are told one by one.
const EFFECTS_SHOWN: usize = 4;

/// Names of a list that are shown.
const NAMES_SHOWN: usize = 3;

/// Effects beyond the base law, biases, and what is not determined.
pub(super) fn first(logs: &[Input], report: &RateReport) -> Screen {
    let found: Vec<_> = report.gyros.iter().flat_map(GyroRates::effects).collect();
    let mut screen = match found.len() {
        0 => Screen::new(
            Standing::Good,
            "RATES",
            "no significant effect in temperature or time",
        ),
        count => Screen::new(
            Standing::Doubtful,
            "RATES CHANGE",
            format!("{} in temperature or time", counted(count, "effect")),
        ),
    };
    if report.earth_is_reversed {
        screen = Screen::new(
            Standing::Bad,
            "CHECK SIGNS",
            "the unit turns about the vertical against the Earth, at its rate",
        );
        screen.fact(
            "check first",
            "signs and axes of gyros and of accelerometers, sign of the latitude; or the bias about the vertical is twice \
             Earth rate by chance",
        );
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
        let way = format!("{names}: turn the unit over, a log each");
        screen.fact("undetermined", way);
    }
    let duration_s: f64 = report.logs.iter().map(|log| log.duration_s).sum();
    screen.fact("log", format!("{} over {duration_s:.0} s", named(logs)));
    screen
}

/// Biases of the gyros: of one log by its means, of several by the law.
fn biases(report: &RateReport, screen: &mut Screen) {
    if let [log] = &report.logs[..] {
        for (gyro, law) in report.gyros.iter().enumerate() {
            let words = format!(
                "{:.4} ± {:.4} deg/h (95 %), bias and terms in specific force",
                log.bias_deg_per_h[gyro], log.bias_half_width_deg_per_h[gyro]
            );
            screen.fact(&law.gyro, words);
        }
        let [rate, sigma] = log.vertical_deg_per_h;
        let words = format!(
            "{rate:.4} ± {sigma:.4} deg/h, Earth {:.4}",
            report.earth_vertical_deg_per_h
        );
        screen.fact("vertical", words);
        return;
    }
    for gyro in &report.gyros {
        if let Some(bias) = gyro.coefficients.first() {
            let estimate = format::estimate(bias.estimate, bias.sigma).join(" ± ");
            screen.fact(&bias.name, format!("{estimate} {}", bias.unit));
        }
    }
}
