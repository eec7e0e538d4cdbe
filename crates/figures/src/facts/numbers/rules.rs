//! What numbers of a page follow from.

use std::collections::BTreeSet;

use gyrocal::EFFECTS;
use gyrocal_statistics::{chi_square_quantile, chi_square_tail, p_of_least};

use super::formulas::{findings, largest_changes, monte_carlo, nis, plan, uncertainty};
use super::{Checks, Line, Part, name_of, over};
use crate::facts::values::leading;

/// Quantities that a page shows at several places: below each the patterns of [`Part::found`], with a tab for `|` and
/// a factor where the unit is another.
pub(super) const SAME: &str = include_str!("same.txt");

/// Micro-g of a g.
const MICRO: f64 = 1e6;

type Rule = (&'static str, fn(&Part, &mut Checks));

/// All rules but those of [`SAME`].
pub(super) const RULES: [Rule; 19] = [
    (
        "change of an estimate, and over the nominal sigma",
        |part, to| {
            let from = ["nominal model", "extended model", "nominal model#1"];
            to.columns(part, "change", &from[..2], |x| x[1] - x[0]);
            let heads = [
                "change, sigma of the nominal fit",
                "in sigma of the nominal fit",
                "in sigmas",
            ];
            for head in heads {
                to.columns(part, head, &from, |x| (x[1] - x[0]) / x[2]);
            }
        },
    ),
    ("estimate or sigma in another table", |part, to| {
        let heads = [
            "nominal model|estimate",
            "extended model|with the effects|with *.*",
            "estimate ± sigma|extended law",
        ];
        for head in heads {
            to.again(part, head);
            to.again(part, &format!("{head}#1"));
        }
        // Those of each record.
        to.0.retain(|check| !check.place.starts_with("initial "));
    }),
    ("largest changes on the first screen", largest_changes),
    ("bias by the site over the sigma", |part, to| {
        for (table, row) in part.rows("latitude +*") {
            let of = |cell: &String| Some(leading(cell)?.0);
            let sigma = table.number(row, "sigma");
            if part.rows("first row, deg").count() < 2 {
                let heads = ["extended model#1", "nominal model#1"];
                let mut fits = heads
                    .iter()
                    .filter_map(|head| part.elsewhere(name_of(row), head));
                to.is(&row[0], sigma, fits.next().map(|found| found.1));
            }
            for pair in row[2..].chunks_exact(2) {
                to.is(
                    &row[0],
                    of(&pair[1]),
                    over(&[of(&pair[0]), sigma], |x| x[0] / x[1]),
                );
            }
        }
    }),
    ("sigmas and p of a finding", findings),
    ("size over its sigma", |part, to| {
        for (table, row) in part.rows("parameter") {
            // Of effects with one parameter: others go on in rows without a name. That of noise is of a test of its
            // own, and that of a random walk, which has no sigma, of its likelihood.
            let of = table.rows.iter().skip_while(|own| *own != row).nth(1);
            let is_own = row.iter().any(|cell| cell.contains('±')) && !is_noise(&row[0]);
            if is_own && of.is_none_or(|next| !next[0].is_empty()) {
                let size = ["estimate", "estimate#1"].map(|head| table.number(row, head));
                to.is(
                    &row[0],
                    table.number(row, "z"),
                    over(&size, |x| (x[0] / x[1]).abs()),
                );
            }
        }
        to.columns(
            part,
            "sigmas",
            &["estimate ± sigma", "estimate ± sigma#1"],
            |x| (x[0] / x[1]).abs(),
        );
        to.last(part, "): size # ± # *; # standard deviations", |x| {
            (x[0] / x[1]).abs()
        });
    }),
    ("open-loop error of all axes", |part, to| {
        let axes = part.found("open-loop simulation error, g rms\t#\t#\t#");
        let axes: Vec<_> = axes.concat().into_iter().map(Some).take(3).collect();
        let rms = |x: &[f64]| MICRO * (x.iter().map(|one| one * one).sum::<f64>() / 3.0).sqrt();
        if axes.len() == 3 {
            let patterns = ["open-loop error # → # µg", "# µg rms; accelerometer noise"];
            let shown = patterns.iter().find_map(|pattern| part.first(pattern));
            to.is("open-loop error", shown, over(&axes, rms));
        }
    }),
    ("open-loop error of an output", |part, to| {
        for (table, row) in part.rows("nominal model, rms") {
            if table.title.starts_with("Open-loop error in the diagnosed") {
                let pattern = format!("Simulated over * output {} is off by # ", row[0]);
                to.is(
                    &row[0],
                    part.first(&pattern),
                    table.number(row, "nominal model, rms"),
                );
                let pattern = format!("output {} is off by # * and by # ", row[0]);
                let found = part.found(&pattern).pop().map(|both| both[1]);
                to.is(
                    &row[0],
                    found.filter(|_| part.with("verdict alone").next().is_none()),
                    table.number(row, "with what was found, rms"),
                );
            }
        }
    }),
    ("p of a correlation over rows", |part, to| {
        let pattern = "correlation over rows (Ljung-Box)\t# for # degrees of freedom\t#";
        to.last(part, pattern, |x| {
            chi_square_tail(x[0], x[1].round()).unwrap_or(f64::NAN)
        });
    }),
    ("p and band of the mean innovation squared", nis),
    ("p of all residual tests", |part, to| {
        let rows = part
            .lines
            .iter()
            .filter(|line| line.text.starts_with("with all causes\t"));
        let p = |line: &Line| Some(leading(line.cells.last()?)?.0);
        let (terms, mut tests): (Vec<_>, Vec<_>) =
            rows.partition(|line| line.cells[1].starts_with("outside of"));
        let Some(whole) = tests.pop() else { return };
        let tests: Vec<_> = tests.into_iter().map(p).collect();
        let of_tests = over(&tests, |x| {
            p_of_least(x.iter().copied().fold(1.0, f64::min), x.len() as f64)
        });
        let least: Vec<_> = terms.into_iter().map(p).chain([of_tests]).collect();
        let computed = over(&least, |x| x.iter().copied().fold(1.0, f64::min));
        to.is("all residual tests together", p(whole), computed);
    }),
    (
        "effects ranked and left out, not tested, missing",
        |part, to| {
            let reasons = ["# effect not tested (", "# effects not tested ("];
            let counts = reasons.map(|pattern| part.found(pattern).concat());
            let counts: Vec<_> = counts.concat().into_iter().map(Some).collect();
            let untested = over(&counts, |x| x.iter().map(|count| count.round()).sum());
            let rows = |head: &str| part.rows(head).count() as f64;
            let bars = part.rows("score statistic*");
            let bars = bars.filter(|(table, row)| table.number(row, "value").is_some());
            // One may be an alternative of several.
            let bars: BTreeSet<&str> = bars.map(|(_, row)| name_of(row)).collect();
            let more = part.count("# more effects are not shown");
            let all = bars.len() as f64 + more.unwrap_or(0.0);
            to.is(
                "Ranking",
                part.first("among # effects tested"),
                Some([all; 2]),
            );
            to.is(
                "Ranking",
                part.first("None of # effects exceeds"),
                Some([all; 2]),
            );
            to.is(
                "not tested",
                part.first("# effects (missing inputs"),
                untested,
            );
            to.is(
                "missing",
                part.first("law lacks # terms"),
                Some([rows("p, family-wise"); 2]),
            );
        },
    ),
    (
        "statistic or likelihood of an effect in another table",
        |part, to| {
            to.columns(part, "statistic", &["value"], |x| x[0]);
            // That of an alternative of several is of the first.
            let mut names = BTreeSet::new();
            for (table, row) in part.rows("likelihood") {
                let remark = part.elsewhere(name_of(row), "remark");
                let remark = remark.filter(|_| names.insert(name_of(row)));
                to.is(
                    name_of(row),
                    table.number(row, "likelihood"),
                    remark.map(|found| found.1),
                );
            }
        },
    ),
    ("autocorrelations outside by chance", |part, to| {
        for all in part.found("is outside by chance: # of #") {
            to.is(
                "by chance",
                Some(all[0]),
                over(&[Some(all[1])], |x| (x[0].round() / 20.0).floor()),
            );
        }
    }),
    ("sigmas after a run", plan),
    (
        "expanded and combined uncertainty, coverage factor",
        uncertainty,
    ),
    ("p of the scatter over two runs", |part, to| {
        let from = [
            "standard deviation between runs",
            "expected of the uncertainties",
        ];
        to.columns(part, "p", &from, |x| {
            chi_square_tail((x[0] / x[1]).powi(2), 1.0).unwrap_or(f64::NAN)
        });
    }),
    ("statistics of a Monte Carlo", monte_carlo),
    ("interval of an Allan deviation", |part, to| {
        let confidence = part.first("intervals at a confidence of # %");
        for (table, row) in part.rows("averaging time, s") {
            for (head, sign) in [("low", 1.0), ("high", -1.0)] {
                let from =
                    ["deviation, *", "degrees of freedom"].map(|head| table.number(row, head));
                let computed = over(&[from[0], from[1], confidence], |x| {
                    let quantile = chi_square_quantile(0.5 + sign * x[2] / 200.0, x[1]);
                    quantile.map_or(f64::NAN, |quantile| x[0] * (x[1] / quantile).sqrt())
                });
                to.is(head, table.number(row, head), computed);
            }
        }
    }),
];

fn is_noise(name: &str) -> bool {
    EFFECTS.iter().any(|one| one.id == name && one.is_noise())
}
