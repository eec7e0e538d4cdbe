//! What numbers of a page follow from.

use gyrocal_statistics::{
    Proportion, chi_square_band, chi_square_quantile, chi_square_tail, chi_square_two_sided_p,
    p_of_least, rms_ratio_interval, student_quantile,
};

use super::{Checks, Part, Span, name_of, over};
use crate::facts::values::leading;

/// Quantities that a page shows at several places: below each the patterns of [`Part::found`], with a tab for `|` and
/// a factor where the unit is another.
pub(super) const SAME: &str = include_str!("same.txt");

/// False alarm of the bands of a mean NIS and a mean NEES.
const FALSE_ALARM: f64 = 1e-3;

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
    ("size over its sigma", |part, to| {
        for (table, row) in part.rows("parameter") {
            // Of effects with one parameter: others go on in rows without a name.
            let of = table.rows.iter().skip_while(|own| *own != row).nth(1);
            if of.is_none_or(|next| !next[0].is_empty()) {
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
            to.is(
                "what it does",
                part.first("open-loop error # → # µg"),
                over(&axes, rms),
            );
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
        let p: Vec<_> = rows
            .map(|line| Some(leading(line.cells.last()?)?.0))
            .collect();
        let least = |x: &[f64]| p_of_least(x.iter().copied().fold(1.0, f64::min), x.len() as f64);
        if let Some((whole, each)) = p.split_last() {
            to.is("all residual tests together", *whole, over(each, least));
        }
    }),
    (
        "effects ranked and left out, not tested, missing",
        |part, to| {
            let rows = |head: &str| part.rows(head).count() as f64;
            let bars = part
                .rows("score statistic*")
                .filter_map(|(table, row)| table.number(row, "value"));
            let all =
                bars.count() as f64 + part.count("# more effects are not shown").unwrap_or(0.0);
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
                Some([rows("typical size"); 2]),
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
            to.columns(part, "", &["remark"], |x| x[0]);
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
    ("noise over the declared one", |part, to| {
        let found = part
            .found("accelerometers #, #, #, gyros #, #, # times")
            .concat();
        let [table] = &part.with("gyros").collect::<Vec<_>>()[..] else {
            return;
        };
        for (place, shown) in found.into_iter().enumerate() {
            let head = ["accelerometers", "gyros"][place / 3];
            let row = table.rows.first().filter(|_| table.rows.len() == 1);
            let number =
                row.and_then(|row| table.number(row, &format!("{head}#{}", place % 3 * 3)));
            to.is("noise", Some(shown), number);
        }
    }),
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

/// `change by gyro_z.g_zz +2.8, gyro_z.bias -2.6 sigma; the others less`.
fn largest_changes(part: &Part, to: &mut Checks) {
    let lines = part.lines.iter();
    for line in lines.filter_map(|line| line.text.strip_prefix("change by ")) {
        for (name, number) in line.split(", ").filter_map(|text| text.split_once(' ')) {
            let computed = part.elsewhere(name, "in sigmas").map(|found| found.1);
            to.is(name, leading(number).map(|found| found.0), computed);
        }
    }
}

fn nis(part: &Part, to: &mut Checks) {
    let Some(rows) = part.count("# rows over # days") else {
        return;
    };
    let p = |x: &[f64]| chi_square_two_sided_p(x[0] * rows, 3.0 * rows).unwrap_or(f64::NAN);
    let [low, high] = chi_square_band(3.0 * rows, FALSE_ALARM).map(|bound| Some([bound / rows; 2]));
    for found in part.found("mean normalised innovation squared\t# (band # to #)\t#") {
        to.is(
            "p of the mean NIS",
            Some(found[3]),
            over(&[Some(found[0])], p),
        );
        to.is("band of the mean NIS", Some(found[1]), low);
        to.is("band of the mean NIS", Some(found[2]), high);
    }
}

/// Geometric means of ratios of sigmas, and the same ratios in the bars and in words.
fn plan(part: &Part, to: &mut Checks) {
    let mean = |head: &str| {
        let ratios = part.rows("with the best run").map(|(table, row)| {
            let pair = [head, "record so far"].map(|head| table.number(row, head));
            over(&pair, |x| (x[0] / x[1]).ln())
        });
        let ratios: Vec<Span> = ratios.collect::<Option<_>>()?;
        let sum = |end: usize| ratios.iter().map(|one| one[end]).sum::<f64>();
        Some([0, 1].map(|end| (sum(end) / ratios.len() as f64).exp()))
    };
    to.is(
        "best run",
        part.first("sigmas fall to # of the present"),
        mean("with the best run"),
    );
    to.is(
        "going on",
        part.first("in the present attitude: sigmas #"),
        mean("continued"),
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

fn uncertainty(part: &Part, to: &mut Checks) {
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

fn monte_carlo(part: &Part, to: &mut Checks) {
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
