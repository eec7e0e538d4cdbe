//! The sections of an uncertainty budget, and of the scatter over runs.

use gyrocal_calibration::{SiteQuantity, UncertaintySource};
use gyrocal_diagnosis::{
    CoefficientUncertainty, NOT_STATED, RecordUncertainty, RunSpread, UncertaintyResult, by_source,
};
use gyrocal_document::{Item, Screen, Section, Standing, Table};
use gyrocal_statistics::format;
use gyrocal_words::joined;

use crate::words::section;

/// The first screen of uncertainty budgets.
#[must_use]
pub fn uncertainty_screen(found: &UncertaintyResult) -> Screen {
    let what = match &found.spread {
        None => "95 % intervals of the coefficients".to_owned(),
        Some(spread) => format!("coefficients over {} runs", spread.runs),
    };
    let mut screen = Screen::new(Standing::Neutral, "UNCERTAINTY", what);
    let Some(spread) = &found.spread else {
        for one in found.records.iter().flat_map(|record| &record.coefficients) {
            let sources = by_source(one);
            let largest = sources.iter().max_by(|a, b| a.3.total_cmp(&b.3));
            let words = format!(
                "{} {} (k = {}), most by {}",
                format::with_sigma(one.estimate, one.expanded),
                one.unit,
                format::short(one.coverage_factor, 3),
                largest.map_or("", |line| line.0),
            );
            screen.fact(&one.name, words);
        }
        return screen;
    };
    // Intervals of each run are in the tables: those of many do not fit on a screen.
    for one in &spread.coefficients {
        let [mean, expected] = format::estimate(one.mean, one.expected);
        let words = format!(
            "mean {mean} {}, deviation {} ({expected} expected)",
            one.unit,
            format::short(one.standard_deviation, 2),
        );
        screen.fact(&one.name, words);
    }
    let larger = spread.coefficients.iter().filter(|one| one.is_larger);
    let words = match &*joined(larger.map(|one| &one.name), ", ") {
        "" => "consistent with the uncertainties".to_owned(),
        names => format!("larger than the uncertainties: {names}"),
    };
    screen.fact("scatter", format!("of {} runs {words}", spread.runs));
    screen
}

/// The budget of each coefficient: a table of the results, one of the contributions, one of the conditions
/// of the test.
#[must_use]
pub fn of_budget(budget: &RecordUncertainty) -> Section {
    let heads = "term | coefficient | > estimate | > standard uncertainty | > effective degrees of freedom \
                   | > coverage factor | > expanded, 95 % | unit";
    let rows = budget.coefficients.iter().map(result_row);
    let results = Table::of("Results", heads, rows);
    let rows = budget.coefficients.iter().flat_map(contribution_rows);
    let heads = "coefficient | source | type | distribution | > standard uncertainty | unit";
    let contributions = Table::of("Contributions", heads, rows);
    let mut lead = format!(
        "Combined by the GUM (JCGM 100:2008). Type A is evaluated from the record, type B from what the \
         bench description declares. {NOT_STATED}"
    );
    if budget.models.len() > 1 {
        lead += &format!(
            " The estimates are means over {} models that the record leaves open.",
            budget.models.len()
        );
    }
    let items = [results, contributions, conditions(budget)]
        .map(Item::from)
        .into();
    section("uncertainty", "Uncertainty", &lead, items)
}

/// The scatter of the coefficients over runs.
#[must_use]
pub fn of_spread(spread: &RunSpread) -> Section {
    let rows = spread.coefficients.iter().map(|one| {
        let [mean, deviation] = format::estimate(one.mean, one.standard_deviation);
        let [_, expected] = format::estimate(one.mean, one.expected);
        [
            one.term.clone(),
            one.name.clone(),
            mean,
            deviation,
            expected,
            format!("{:.2}", one.p_value),
            one.answer().to_owned(),
            one.unit.clone(),
        ]
    });
    let heads = "term | coefficient | > mean | > standard deviation between runs \
                   | > expected of the uncertainties | > p | scatter | unit";
    let title = format!("Scatter over {} runs", spread.runs);
    let table = Table::of(&title, heads, rows);
    let lead = "Each record is a run of the same platform. The scatter is larger where noise, attitude and declared \
         turn-on scatter do not explain it, by a chi-square test with a false alarm of 1 % for all \
         coefficients together.";
    section("spread", "Scatter over runs", lead, vec![Item::from(table)])
}

fn result_row(one: &CoefficientUncertainty) -> [String; 8] {
    let degrees = match one.effective_degrees_of_freedom {
        Some(few) if few < 1e6 => format!("{few:.0}"),
        _ => "∞".to_owned(),
    };
    let [estimate, combined] = format::estimate(one.estimate, one.combined);
    let [_, expanded] = format::estimate(one.estimate, one.expanded);
    [
        one.term.clone(),
        one.name.clone(),
        estimate,
        combined,
        degrees,
        format::short(one.coverage_factor, 3),
        expanded,
        one.unit.clone(),
    ]
}

/// What stands in place of a quantity that the bench description leaves out.
const NOT_DECLARED: &str = "not declared";

/// The contributions to a coefficient. A quantity of the site without a declared uncertainty has none, as it counts
/// as exact: that is told.
fn contribution_rows(one: &CoefficientUncertainty) -> Vec<[String; 6]> {
    let told = by_source(one);
    let site = SiteQuantity::ALL.into_iter().map(UncertaintySource::Site);
    let site = site.filter(|quantity| told.iter().all(|line| line.0 != quantity.name()));
    let undeclared = site.map(|one| [one.name(), "B", one.distribution(), NOT_DECLARED]);
    let undeclared = undeclared.map(|line| line.map(str::to_owned));
    let lines = told.iter().map(|(source, kind, distribution, standard)| {
        let standard = two_digits(*standard);
        let [source, kind, distribution] =
            [*source, kind.letter(), *distribution].map(str::to_owned);
        [source, kind, distribution, standard]
    });
    let lines = lines.chain(undeclared);
    let rows = lines.map(|[source, kind, distribution, standard]| {
        let (name, unit) = (one.name.clone(), one.unit.clone());
        [name, source, kind, distribution, standard, unit]
    });
    rows.collect()
}

/// A standard uncertainty with two significant digits.
fn two_digits(uncertainty: f64) -> String {
    match uncertainty < 100.0 {
        true => format::significant(uncertainty, 2),
        false => {
            let [_, rounded] = format::estimate(0.0, uncertainty);
            rounded
        }
    }
}

/// Conditions of the test.
fn conditions(budget: &RecordUncertainty) -> Table {
    let of = &budget.conditions;
    let angles = of.initial_angles_deg.map_or_else(
        || NOT_DECLARED.to_owned(),
        |[x, y, z]| format!("{x:.4}°, {y:.4}°, {z:.4}°"),
    );
    let temperature = of.temperature_c.map_or_else(
        || "not logged".to_owned(),
        |[low, high]| format!("{low:.2} °C to {high:.2} °C"),
    );
    let (accel_g, gyro) = (of.accel_noise_g, of.gyro_noise_deg_per_h);
    let noise = format!("{accel_g:e} g, {gyro} deg/h");
    let duration = format!("{:.2} h, {}", of.duration_h, of.rows);
    let (values, nis) = (budget.accelerometer_values, budget.nis_of_value);
    let nis = format!("{nis:.3}");
    let force = format!("{} g", of.specific_force_at_rest_g);
    let rows = [
        ("record", budget.name.clone()),
        ("bench", of.bench.clone()),
        ("astronomic latitude", format!("{}°", of.latitude_deg)),
        ("specific force at rest", force),
        ("duration, rows", duration),
        ("declared noise of accelerometers, of gyros", noise),
        ("accelerometer values", values.to_string()),
        ("innovation squared of a value, normalised: mean", nis),
        ("initial angles", angles),
        ("temperature", temperature),
    ];
    let rows = rows.map(|(name, value)| [name.to_owned(), value]);
    Table::of("Test conditions", "condition | value", rows)
}
