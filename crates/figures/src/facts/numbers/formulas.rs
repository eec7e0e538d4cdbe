//! Longer rules.

use gyrocal::generated::platform::DRIFT;
use gyrocal_statistics::{
    Proportion, chi_square_band, chi_square_two_sided_p, rms_ratio_interval, student_quantile,
};

use super::{Checks, Part, Span, captured, name_of, over};
use crate::facts::values::leading;

/// False alarm of the bands of a mean NIS and a mean NEES.
const FALSE_ALARM: f64 = 1e-3;

/// `change by gyro_z.g_zz +2.8, gyro_z.bias -2.6 sigma; the others less`.
pub(super) fn largest_changes(part: &Part, to: &mut Checks) {
    let lines = part.lines.iter();
    for line in lines.filter_map(|line| line.text.strip_prefix("change by ")) {
        for (name, number) in line.split(", ").filter_map(|text| text.split_once(' ')) {
            let computed = part.elsewhere(name, "in sigmas").map(|found| found.1);
            to.is(name, leading(number).map(|found| found.0), computed);
        }
    }
}

/// Of the number of values and rows that stand beside it.
pub(super) fn nis(part: &Part, to: &mut Checks) {
    let pattern = "mean normalised innovation squared\t# (band # to #), # value* in # row*\t#";
    for found in part.found(pattern) {
        let [values, rows] = [3, 4].map(|count| (found[count][0] + found[count][1]) / 2.0);
        let band = chi_square_band(values, FALSE_ALARM).map(|bound| Some([bound / rows; 2]));
        to.is("band of the mean NIS", Some(found[1]), band[0]);
        to.is("band of the mean NIS", Some(found[2]), band[1]);
        let p = |x: &[f64]| chi_square_two_sided_p(x[0] * rows, values).unwrap_or(f64::NAN);
        let mut p = over(&[Some(found[0])], p);
        // Between its ends a span may have the mean that is expected.
        if found[0][0] * rows <= values && values <= found[0][1] * rows {
            p = p.map(|[low, _]| [low, 1.0]);
        }
        to.is("p of the mean NIS", Some(found[5]), p);
    }
}

/// On the first screen, in the ranking and in words; the table of all has them by their effects.
pub(super) fn findings(part: &Part, to: &mut Checks) {
    to.columns(part, "z", &["remark"], |x| x[0]);
    let all: Vec<_> = part
        .rows("parameter")
        .filter(|(_, row)| !row[0].is_empty())
        .collect();
    for lines in part.lines.windows(2) {
        for (table, row) in &all {
            let is_own = lines[0].text == row[0] || lines[0].text == "how large";
            for (pattern, head) in [
                ("# sigma, search-corrected p", "z"),
                ("search-corrected p = #", "p"),
            ] {
                let shown = captured(&lines[1].text, pattern).filter(|_| is_own);
                to.is(&row[0], shown.map(|all| all[0]), table.number(row, head));
            }
        }
    }
    for (table, row) in part.rows("remark") {
        let begin = format!("{} (", row[0]);
        for line in part
            .lines
            .iter()
            .filter(|line| line.text.starts_with(&begin))
        {
            let shown = captured(&line.text, "; # standard deviations").map(|all| all[0]);
            let reported = row.iter().any(|cell| cell.starts_with("reported"));
            to.is(
                &row[0],
                shown.filter(|_| reported),
                table.number(row, "remark"),
            );
        }
    }
}

/// Geometric means of ratios of sigmas, and the same ratios in the bars and in words.
pub(super) fn plan(part: &Part, to: &mut Checks) {
    let mean = |head: &str| {
        // Of the nine coefficients, and not of the sizes of effects below them.
        let is_nominal = |row: &[String]| DRIFT.iter().any(|one| one.id == name_of(row));
        let rows = part.rows("best run");
        let ratios = rows.filter(|(_, row)| is_nominal(row)).map(|(table, row)| {
            let pair = [head, "now"].map(|head| table.number(row, head));
            over(&pair, |x| (x[0] / x[1]).ln())
        });
        let ratios: Vec<Span> = ratios.collect::<Option<_>>()?;
        let sum = |end: usize| ratios.iter().map(|one| one[end]).sum::<f64>();
        Some([0, 1].map(|end| (sum(end) / ratios.len() as f64).exp()))
    };
    to.is(
        "best run",
        part.first("sigmas fall to # of the present"),
        mean("best run"),
    );
    to.is(
        "going on",
        part.first("in the present attitude: sigmas #"),
        mean("present attitude"),
    );
    let words = part.found(" h\t#°\t#°\t#°\t#");
    for (bar, row) in part.found("°, # h\t#").iter().zip(words) {
        to.is(
            "bar of a proposal",
            Some(bar[1]),
            Some(row[3].map(|ratio| 100.0 * ratio)),
        );
    }
}

pub(super) fn uncertainty(part: &Part, to: &mut Checks) {
    to.columns(
        part,
        "expanded, 95 %",
        &["coverage factor", "standard uncertainty"],
        |x| x[0] * x[1],
    );
    to.columns(
        part,
        "coverage factor",
        &["effective degrees of freedom"],
        |x| student_quantile(0.975, x[0]).unwrap_or(f64::NAN),
    );
    for (table, row) in part.rows("standard uncertainty") {
        let sources = part
            .rows("distribution")
            .map(|(table, source)| table.number(source, &row[1]));
        let root = |x: &[f64]| x.iter().map(|one| one * one).sum::<f64>().sqrt();
        to.is(
            &row[1],
            table.number(row, "standard uncertainty"),
            over(&sources.collect::<Vec<_>>(), root),
        );
    }
}

pub(super) fn monte_carlo(part: &Part, to: &mut Checks) {
    for (table, row) in part.rows("runs that determine it") {
        let number = |head: &str| table.number(row, head);
        let middle = |head: &str| number(head).map_or(f64::NAN, |[low, high]| (low + high) / 2.0);
        let runs = middle("runs that determine it").round();
        for end in [0, 1] {
            let of = |x: &[f64]| rms_ratio_interval(x[0], runs as usize, 0.95)[end];
            to.is(
                &row[0],
                number(&format!("RMSE / sigma#{}", end + 1)),
                over(&[number("RMSE / sigma")], of),
            );
        }
        let hits = (runs * middle("in the 95 % interval")).round();
        let share = Proportion {
            hits: hits as u64,
            trials: runs as u64,
        };
        let [low, high] = share.interval(0.95);
        for (place, value) in [share.share(), low, high].into_iter().enumerate() {
            to.is(
                &row[0],
                number(&format!("in the 95 % interval#{place}")),
                Some([value; 2]),
            );
        }
    }
    to.columns(
        part,
        "standard error",
        &["RMSE", "bias", "runs that determine it"],
        |x| ((x[0].powi(2) - x[1].powi(2)) / (x[2].round() - 1.0)).sqrt(),
    );
    for head in ["RMSE / sigma", "RMSE / sigma#1", "RMSE / sigma#2", "bias"] {
        to.again(part, head);
    }
    let nees = part.found("mean #, expected # (# to #, 99.9 %)");
    if let (Some(nees), Some(runs)) = (nees.first(), part.count("# runs, # failed")) {
        let expected = (nees[1][0] + nees[1][1]) / 2.0;
        let band = chi_square_band(expected * runs, FALSE_ALARM).map(|bound| [bound / runs; 2]);
        to.is("NEES", Some(nees[2]), Some(band[0]));
        to.is("NEES", Some(nees[3]), Some(band[1]));
    }
}
