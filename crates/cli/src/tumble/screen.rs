//! The first screen of `gyrocal tumble`.

use gyrocal_document::{Screen, Standing};
use gyrocal_instruments::multi_position::{FewPositionReport, MultiPositionReport, PreparedTest};
use gyrocal_statistics::format;
use gyrocal_words::{counted, few};

use super::{Report, TumbleArguments, named};
use crate::outputs::command_line;

/// Terms that are told one by one.
const TERMS_SHOWN: usize = 6;
/// Names of a list that are shown.
const NAMES_SHOWN: usize = 3;

/// What the nominal law lacks, how sure that is, and what it changes.
pub(super) fn first(
    arguments: &TumbleArguments,
    prepared: &PreparedTest,
    report: &Report,
) -> Screen {
    let mut screen = match report {
        Report::Many(report) => many(report),
        Report::Few(report) => few_positions(report),
    };
    screen.fact(
        "how sure",
        format!(
            "{} of sound instruments would show any term by chance",
            format::percent(arguments.false_alarm)
        ),
    );
    screen.fact(
        "not told",
        match prepared.instrument.latitude_deg {
            Some(_) => "squares along all three axes from the bias (they sum to 1 g²)",
            None => "squares along all three axes from the bias; g_i from Earth rate (no latitude)",
        },
    );
    screen.fact(
        "log",
        format!(
            "{}: {}",
            named(arguments),
            counted(prepared.stops.len(), "static stop")
        ),
    );
    if !arguments.views.are_asked() && matches!(report, Report::Many(_)) {
        screen.then(format!("{} --figures figures", command_line()), "pictures");
    }
    screen
}

fn verdict(terms: usize, names: &str) -> Screen {
    match terms {
        0 => Screen::new(
            Standing::Good,
            "LAW HOLDS",
            "no significant term beyond the nominal drift law",
        ),
        terms => Screen::new(
            Standing::Bad,
            "TERMS MISSING",
            format!(
                "the nominal drift law lacks {}{names}",
                counted(terms, "term")
            ),
        ),
    }
}

fn many(report: &MultiPositionReport) -> Screen {
    let mut screen = verdict(report.findings.len(), "");
    for finding in report.findings.iter().take(TERMS_SHOWN) {
        let names: Vec<&str> = finding
            .alternatives
            .iter()
            .map(|one| &*one.effect)
            .collect();
        let others = match &names[..] {
            [] => "nothing else of the catalogue".to_owned(),
            names => format!("may also be {}", few(names, NAMES_SHOWN)),
        };
        screen.fact(
            &finding.effect,
            format!(
                "{} {}, {}; {others}",
                format::with_sigma(finding.estimate, finding.sigma),
                finding.unit,
                format::p_value(finding.p_value)
            ),
        );
    }
    more(&mut screen, report.findings.len());
    for one in &report.log_biases {
        let differences = one.differences_deg_per_h.iter().zip(&one.sigmas_deg_per_h);
        let differences: Vec<String> = differences
            .map(|(difference, sigma)| format::with_sigma(*difference, *sigma))
            .collect();
        screen.fact(
            "logs differ",
            format!(
                "{}.bias by {} deg/h from the first log on, {}: another turn-on, or another unit, whose \
                 logs are evaluated alone",
                one.gyro,
                differences.join(", "),
                format::p_value(one.test.p_value)
            ),
        );
    }
    screen.fact("no gain", report.not_confirmed.join(", "));
    if let Some(gain) = &report.cross_validation {
        let list = |values: [f64; 3]| values.map(|value| format!("{value:.0}")).join(", ");
        screen.fact(
            "what they do",
            format!(
                "rms of gyros x, y, z on left-out stops {} → {} deg/h (noise {}); {:+.1} ± {:.1} nats",
                list(gain.rms_before_deg_per_h),
                list(gain.rms_after_deg_per_h),
                list(gain.noise_deg_per_h),
                gain.cross_validated_log_score_nats,
                gain.standard_error_nats
            ),
        );
    }
    let extended = report.gyros.iter().map(|gyro| {
        let law = &gyro.extended;
        format!("{} {}", gyro.gyro, format::short(law.excess_deg_per_h, 2))
    });
    screen.fact(
        "left over",
        format!(
            "scatter beyond the noise of the stops, deg/h: {}",
            extended.collect::<Vec<_>>().join(", ")
        ),
    );
    let controls = &report.controls;
    screen.fact(
        "controls",
        format!(
            "terms found in {} of {} data sets with permuted stops",
            controls.shuffles_with_findings, controls.shuffles
        ),
    );
    screen
}

fn few_positions(report: &FewPositionReport) -> Screen {
    let mut screen = verdict(report.findings.len(), "");
    for finding in report.findings.iter().take(TERMS_SHOWN) {
        let names: Vec<&str> = finding.alternatives.iter().map(|name| &**name).collect();
        let others = match &names[..] {
            [] => "nothing else of the catalogue".to_owned(),
            names => format!("may also be {}", few(names, NAMES_SHOWN)),
        };
        screen.fact(
            &finding.effect,
            format!(
                "{} {}, {}; {others}",
                format::with_sigma(finding.estimate, finding.sigma),
                finding.unit,
                format::p_value(finding.p_value)
            ),
        );
    }
    more(&mut screen, report.findings.len());
    for gyro in &report.gyros {
        let law = gyro.coefficients.iter().map(|one| {
            let size = format::with_sigma(one.estimate, one.sigma);
            format!("{} {size} {}", one.name, one.unit)
        });
        screen.fact(
            &gyro.gyro,
            law.take(NAMES_SHOWN).collect::<Vec<_>>().join(", "),
        );
        let open: Vec<&str> = gyro.undetermined.iter().map(|name| &**name).collect();
        if !open.is_empty() {
            screen.fact("not determined", few(&open, NAMES_SHOWN));
        }
    }
    screen
}

fn more(screen: &mut Screen, terms: usize) {
    if terms > TERMS_SHOWN {
        screen.fact("and", format!("{} more: --verbose", terms - TERMS_SHOWN));
    }
}
