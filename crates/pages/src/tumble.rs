//! The page of a multi-position test.

mod charts;
mod screen;
mod sensors;

use gyrocal_document::{EstimateRow, Estimates, Item, List, Part, Section, Table, Tint};
use gyrocal_instruments::multi_position::{
    CoefficientReport, FewPositionLaw, FewPositionReport, Finding, MultiPositionReport,
    PreparedTest, TumbleResult,
};
use gyrocal_record::Manifest;
use gyrocal_statistics::format;

use crate::diagnosis::section;
use crate::origin::{file_name, origin};

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
    let result = answer.result;
    let mut sections = Vec::new();
    if let Some(report) = &result.test {
        sections.push(section(
            "residual",
            "Residual at the stops",
            "Gyro output less drift law at each static stop, before and after the terms that the search added.",
            vec![Item::Chart(charts::residuals(answer.prepared, report))],
        ));
        sections.push(terms(answer, report));
        sections.push(laws(answer, report));
        sections.push(controls(answer, report));
    }
    if let Some(report) = &result.few_positions {
        sections.push(few_terms(answer, report));
        sections.push(few_laws(answer, report));
    }
    sections.push(sensors::section_of(answer));
    Part {
        name: file_name(answer.manifest, 0, "log"),
        size: format!("{} static stops", answer.prepared.stops.len()),
        first: screen::first(answer),
        sections,
        origin: origin(answer.manifest),
    }
}

fn no_term(answer: &TumbleAnswer<'_>) -> Item {
    Item::text(format!(
        "No significant term beyond the nominal law (false-alarm probability {}).",
        answer.false_alarm
    ))
}

const TERMS: &str = "Terms that the nominal law lacks";

fn terms(answer: &TumbleAnswer<'_>, report: &MultiPositionReport) -> Section {
    let mut items = vec![no_term(answer)];
    if !report.findings.is_empty() {
        let rows = report.findings.iter().map(|one| {
            [
                one.effect.clone(),
                format::estimate(one.estimate, one.sigma).join(" ± "),
                one.unit.clone(),
                format!("{:.1}", one.estimate.abs() / one.sigma),
                format!("{:.0}", one.f),
                format::p_cell(one.p_value),
            ]
        });
        let title = "Significant terms, in the order of finding";
        let heads = "term | > estimate ± σ | unit | > sigmas | > F | > p, family-wise";
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
            "Significant, but no gain on held-out stops, so not in the law: {}.",
            report.not_confirmed.join(", ")
        )));
    }
    section(
        "terms",
        TERMS,
        "Gyro output less all other terms of the extended law, against the regressor of the term: a line through \
         the points is the term.",
        items,
    )
}

/// What else a term may be.
fn rivals(finding: &Finding) -> String {
    let rivals = finding.alternatives.iter();
    let rivals =
        rivals.map(|one| format!("{} ({:.1} nats)", one.effect, one.log_likelihood_deficit));
    let mut text = alternatives(&finding.effect, &rivals.collect::<Vec<_>>());
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

fn alternatives(effect: &str, names: &[String]) -> String {
    match names {
        [] => format!("{effect}: no alternative in the catalogue"),
        names => format!("{effect}: alternatives: {}", names.join(", ")),
    }
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
        "Drift laws; sigmas include the scatter beyond the standard errors",
        &charts::LAWS,
        rows,
    );
    let fits = report.gyros.iter().flat_map(|gyro| {
        [
            ("nominal", &gyro.nominal, &gyro.nominal_against_catalogue),
            ("extended", &gyro.extended, &gyro.extended_against_catalogue),
        ]
        .map(|(law, fit, test)| {
            let [of, beside] = test.degrees_of_freedom;
            [
                format!("{}, {law}", gyro.gyro),
                format!("{:.1}", fit.chi_square),
                fit.degrees_of_freedom.to_string(),
                format::p_cell(fit.p_value),
                format!("{:.0}", fit.excess_deg_per_h),
                format!("F({of}, {beside}) = {:.1}", test.f),
                format::p_cell(test.p_value),
            ]
        })
    });
    let heads = "law | > chi-square | > degrees of freedom | > p | > scatter, deg/h | > all further terms | > p of these";
    let fits = Table::of(
        "Fits: scatter beyond the standard errors of the stops, and all terms of the catalogue against the law",
        heads,
        fits,
    );
    let mut items = vec![Item::Estimates(estimates), fits.into()];
    let gyros = report.gyros.iter();
    for gyro in gyros.filter(|gyro| !gyro.undetermined.is_empty()) {
        items.push(Item::text(format!(
            "{}: not identifiable from these attitudes, given the others: {}.",
            gyro.gyro,
            gyro.undetermined.join(", ")
        )));
    }
    items.extend(not_identifiable(answer));
    section(
        "laws",
        "Drift laws",
        "Coefficients of each gyro in the nominal law and in the one with the terms found.",
        items,
    )
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

fn controls(answer: &TumbleAnswer<'_>, report: &MultiPositionReport) -> Section {
    let controls = &report.controls;
    let spurious = match &*controls.forces_renamed_unexpected {
        [] => "none".to_owned(),
        names => names.join(", "),
    };
    let mut items = vec![Item::text(format!(
        "Findings in {} of {} data sets with permuted stops; with all axes renamed, the findings are {} under \
         their new names; with only the axes of the accelerometers renamed, spurious findings: {spurious}.",
        controls.shuffles_with_findings,
        controls.shuffles,
        if controls.renamed_as_expected {
            "the same"
        } else {
            "NOT the same"
        },
    ))];
    if report.cross_validation.is_none() && !report.findings.is_empty() {
        items.push(Item::text(format!(
            "The gain of the extended law on held-out stops cannot be measured: without {} successive stops the \
             others do not determine it. Give a smaller --left-out.",
            answer.left_out
        )));
    }
    if let Some(gain) = &report.cross_validation {
        let list = |values: [f64; 3]| values.map(|value| format!("{value:.0}")).join(", ");
        items.push(Item::text(format!(
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
        )));
        let found = gain.found_in_blocks.iter();
        let rows = found.map(|(term, count)| [term.clone(), format!("{count} of {}", gain.blocks)]);
        items.push(Table::of("Terms found without a block", "term | > found in", rows).into());
    }
    section(
        "controls",
        "Controls",
        "What the search finds in stops that are permuted, and how often it finds each term when a block of stops is \
         held out.",
        items,
    )
}

fn few_terms(answer: &TumbleAnswer<'_>, report: &FewPositionReport) -> Section {
    let rows = report.findings.iter().map(|one| {
        [
            one.effect.clone(),
            format::estimate(one.estimate, one.sigma).join(" ± "),
            one.unit.clone(),
            format::p_cell(one.p_value),
        ]
    });
    let heads = "term | > estimate ± σ | unit | > p, family-wise";
    let others = report.findings.iter();
    let others = others.map(|one| alternatives(&one.effect, &one.alternatives));
    let items = match List::of("What else each may be", others) {
        None => vec![no_term(answer)],
        Some(list) => vec![
            Table::of("Significant terms", heads, rows).into(),
            list.into(),
        ],
    };
    let lead = "Integrated over the noise between stops that these stops may have.";
    section("terms", TERMS, lead, items)
}

fn few_laws(answer: &TumbleAnswer<'_>, report: &FewPositionReport) -> Section {
    let coefficients = report.gyros.iter().flat_map(|gyro| &gyro.coefficients);
    let row = |one: &CoefficientReport| {
        EstimateRow::new(&one.name, &one.unit, [[one.estimate, one.sigma]])
    };
    let models = [("estimate", Tint::Extended)];
    let estimates = Estimates::new("Drift laws", &models, coefficients.map(row));
    let mut items = vec![Item::Estimates(estimates)];
    items.extend(report.gyros.iter().map(|gyro| Item::text(few_fit(gyro))));
    items.extend(not_identifiable(answer));
    let lead = format!("The terms that {} positions determine.", report.stops);
    section("laws", "Drift laws", &lead, items)
}

fn few_fit(gyro: &FewPositionLaw) -> String {
    let mut text = match gyro.p_value {
        Some(p) => format!(
            "{}: chi-square {:.1} with {} degrees of freedom, {}",
            gyro.gyro,
            gyro.chi_square,
            gyro.degrees_of_freedom,
            format::p_value(p)
        ),
        None => format!(
            "{}: no degrees of freedom are left to test the law",
            gyro.gyro
        ),
    };
    let level = |[median, most]: [f64; 2]| {
        let [median, most] = [median, most].map(|level| format::short(level, 2));
        format!("{median} (at most {most})")
    };
    text += &format!(
        "; noise between stops, deg/h: scatter {}, flicker {}, walk from stop to stop {}",
        level(gyro.noise.scatter_deg_per_h),
        level(gyro.noise.flicker_deg_per_h),
        level(gyro.noise.walk_deg_per_h)
    );
    if !gyro.undetermined.is_empty() {
        text += &format!(
            ". Not determined in addition: {}",
            gyro.undetermined.join(", ")
        );
    }
    text + "."
}
