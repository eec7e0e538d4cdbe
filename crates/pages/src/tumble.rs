//! The page of a multi-position test.

mod charts;
mod screen;
mod sensors;

use gyrocal_document::{EstimateRow, Estimates, Item, List, Part, Section, Table};
use gyrocal_instruments::multi_position::{
    FEWEST_STOPS_OF_GAIN, Finding, LawReport, MultiPositionReport, PreparedTest, TumbleResult,
};
use gyrocal_record::Manifest;
use gyrocal_statistics::format;
use gyrocal_words::joined;

use crate::origin::{file_name, part};
use crate::words::section;

/// A multi-position test.
#[derive(Clone, Copy, Debug)]
pub struct TumbleAnswer<'a> {
    /// Origin of the answer: the logs and their description.
    pub manifest: &'a Manifest,
    /// The stops.
    pub prepared: &'a PreparedTest,
    /// The result.
    pub result: &'a TumbleResult,
    /// Family-wise false-alarm probability.
    pub false_alarm: f64,
    /// Successive stops that were held out together.
    pub left_out: u32,
    /// What there is to tell of the clocks of the logs.
    pub clocks: &'a [String],
}

/// The page of a multi-position test with its first screen.
#[must_use]
pub fn of_tumble(answer: &TumbleAnswer<'_>) -> Part {
    let report = &answer.result.test;
    let lead = "Gyro output less drift law at each static stop, before and after the terms that the search added.";
    let items = vec![Item::Chart(charts::residuals(answer.prepared, report))];
    let residual = section("residual", "Residual at the stops", lead, items);
    let mut sections = vec![residual, terms(answer, report), laws(answer, report)];
    sections.extend(gain(answer, report));
    sections.push(sensors::section_of(answer));
    let name = file_name(answer.manifest, 0, "log");
    let size = format!("{} static stops", answer.prepared.stops.len());
    part(answer.manifest, name, size, screen::first(answer), sections)
}

fn no_term(answer: &TumbleAnswer<'_>, report: &MultiPositionReport) -> Item {
    Item::text(match report.tells_noise() {
        true => format!(
            "No significant term beyond the nominal law (false-alarm probability {}).",
            answer.false_alarm
        ),
        false => "Too few stops to tell a term from the noise between them.".to_owned(),
    })
}

fn terms(answer: &TumbleAnswer<'_>, report: &MultiPositionReport) -> Section {
    let mut items = vec![no_term(answer, report)];
    if !report.findings.is_empty() {
        let rows = report.findings.iter().map(|one| {
            [
                one.effect.clone(),
                format::estimate(one.estimate, one.sigma).join(" ± "),
                one.unit.clone(),
                format!("{:.1}", one.estimate.abs() / one.sigma),
                format::p_cell(one.p_value),
            ]
        });
        let title = "Significant terms, in the order of finding";
        let heads = "term | > estimate ± σ | unit | > sigmas | > p, family-wise";
        items = vec![
            Item::Chart(charts::contributions(answer.prepared, report)),
            Table::of(title, heads, rows).into(),
        ];
        let title = "What else each may be, with what its log-likelihood lacks";
        let list = List::of(title, report.findings.iter().map(rivals));
        items.extend(list.map(Item::from));
    }
    if !report.not_confirmed.is_empty() {
        items.push(Item::text(format!(
            "Significant, but held-out stops are predicted worse, so not in the law: {}.",
            report.not_confirmed.join(", ")
        )));
    }
    let lead = "Held against the noise that may be between these stops. Gyro output less all other terms of the \
                extended law, against the regressor of the term: a line through the points is the term.";
    section("terms", "Terms that the nominal law lacks", lead, items)
}

/// What else a term may be.
fn rivals(finding: &Finding) -> String {
    let effect = &finding.effect;
    let rivals = finding.alternatives.iter();
    let rivals =
        rivals.map(|one| format!("{} ({:.1} nats)", one.effect, one.log_likelihood_deficit));
    let mut text = match &*joined(rivals, ", ") {
        "" => format!("{effect}: no alternative in the catalogue"),
        names => format!("{effect}: alternatives: {names}"),
    };
    if let Some(nearest) = &finding.nearest_ruled_out {
        text += &format!(
            "; nearest excluded term: {} ({:.1} nats)",
            nearest.effect, nearest.log_likelihood_deficit
        );
    }
    if !finding.equivalents.is_empty() {
        text += &format!(
            "; exact equivalent, with the opposite sign: {}",
            finding.equivalents.join(", ")
        );
    }
    if let Some(angle) = finding.misalignment_needed_rad {
        text += &format!("; as a misalignment of the accelerometers: {angle:.1} rad");
    }
    text
}

/// Nominal and extended law of each gyro.
fn laws(answer: &TumbleAnswer<'_>, report: &MultiPositionReport) -> Section {
    let gyros = report.gyros.iter();
    let rows = gyros.flat_map(|gyro| {
        gyro.extended.coefficients.iter().map(|one| {
            let mut nominal = gyro.nominal.coefficients.iter();
            let before = nominal.find(|before| before.name == one.name);
            let before = before.map_or([f64::NAN; 2], |before| [before.estimate, before.sigma]);
            EstimateRow::new(&one.name, &one.unit, [before, [one.estimate, one.sigma]])
        })
    });
    let estimates = Estimates::new(
        "Drift laws; sigmas include the noise between stops",
        &charts::LAWS,
        rows,
    );
    let fits = report.gyros.iter().flat_map(|gyro| {
        [("nominal", &gyro.nominal), ("extended", &gyro.extended)]
            .map(|(law, fit)| fit_row(format!("{}, {law}", gyro.gyro), fit))
    });
    let heads =
        "law | > chi-square | > degrees of freedom | > p | > scatter, deg/h | > flicker | > walk";
    let fits = Table::of(
        "Fits by the standard errors of the stops; noise between stops, median and (97.5 %), the walk from stop to stop",
        heads,
        fits,
    );
    let mut items = vec![Item::Estimates(estimates), fits.into()];
    let gyros = report.gyros.iter();
    for gyro in gyros.filter(|gyro| !gyro.undetermined.is_empty()) {
        items.push(Item::text(format!(
            "{}: not determined by these positions in addition: {}.",
            gyro.gyro,
            gyro.undetermined.join(", ")
        )));
    }
    items.extend(not_identifiable(answer));
    let lead = "Coefficients of each gyro in the nominal law and in the one with the terms found.";
    section("laws", "Drift laws", lead, items)
}

fn fit_row(name: String, fit: &LawReport) -> [String; 7] {
    let level = |[median, most]: [f64; 2]| {
        let [median, most] = [median, most].map(|level| format::short(level, 2));
        format!("{median} ({most})")
    };
    [
        name,
        format!("{:.1}", fit.chi_square),
        fit.degrees_of_freedom.to_string(),
        fit.p_value.map_or_else(String::new, format::p_cell),
        level(fit.noise.scatter_deg_per_h),
        level(fit.noise.flicker_deg_per_h),
        level(fit.noise.walk_deg_per_h),
    ]
}

fn not_identifiable(answer: &TumbleAnswer<'_>) -> [Item; 2] {
    [
        "Not distinguishable: squares along all three axes and the bias (they sum to 1 g²); other effects of the \
         attitude to gravity, such as convection in the unit, and sensitivity to specific force.",
        match answer.prepared.instrument.latitude_deg {
            Some(_) => {
                "Earth rate: the vertical part is subtracted; the horizontal part counts as scatter, since the \
                 heading is unknown."
            }
            None => {
                "Earth rate is not subtracted, since no latitude is given: each g_i contains up to 15.04 deg/h/g \
                 of it, and the scatter up to as much."
            }
        },
    ]
    .map(Item::text)
}

/// What the terms do on held-out stops.
fn gain(answer: &TumbleAnswer<'_>, report: &MultiPositionReport) -> Option<Section> {
    let items = match &report.cross_validation {
        None if report.findings.is_empty() => return None,
        None if report.stops < FEWEST_STOPS_OF_GAIN => vec![Item::text(format!(
            "The gain of the extended law on held-out stops is not measured with fewer than \
             {FEWEST_STOPS_OF_GAIN} stops."
        ))],
        None => vec![Item::text(format!(
            "The gain of the extended law on held-out stops cannot be measured: without {} successive stops the \
             others do not determine it. Give a smaller --left-out.",
            answer.left_out
        ))],
        Some(gain) => {
            let list = |values: [f64; 3]| values.map(|value| format!("{value:.0}")).join(", ");
            let text = Item::text(format!(
                "On held-out stops ({} blocks of up to {}, searched and fitted without them) the extended law \
                 improves the predictive log score by {:.1} ± {:.1} nats. Rms errors of gyros x, y, z: {} deg/h, \
                 nominal law {}, standard errors of the stops {}.",
                gain.blocks,
                gain.left_out,
                gain.cross_validated_log_score_nats,
                gain.standard_error_nats,
                list(gain.rms_after_deg_per_h),
                list(gain.rms_before_deg_per_h),
                list(gain.noise_deg_per_h),
            ));
            let found = gain.found_in_blocks.iter();
            let rows =
                found.map(|(term, count)| [term.clone(), format!("{count} of {}", gain.blocks)]);
            let again = Table::of("Terms found without a block", "term | > found in", rows);
            vec![text, again.into()]
        }
    };
    let lead = "What the terms do at stops that are held out, and how often the search finds each without these.";
    Some(section("gain", "Gain on held-out stops", lead, items))
}
