//! Equation (6) as printed: sine and cosine of latitude exchanged.

use gyrocal::EARTH_RATE_RAD_PER_S;
use gyrocal_calibration::Options;
use gyrocal_statistics::{mean, median, root_mean_square};
use gyrocal_truth::{Scenario, simulate};
use rayon::prelude::*;

use super::bench::{Judged, PAPER_DAYS, SEEDS, scenario, seeds};
use super::{Error, Measured};
use crate::figure::Figure;
use crate::values::{Table, fixed};

/// The same limits as for consistent records in Table 2.
const FITS: [f64; 2] = [2.95, 3.05];
/// Far beyond chance.
const DOES_NOT_FIT: [f64; 2] = [100.0, f64::INFINITY];

/// From here on a mean NIS is printed as a power of ten.
const LARGE: f64 = 1e4;

struct Case {
    name: &'static str,
    key: &'static str,
    data_as_printed: bool,
    filter_as_printed: bool,
    nis: [f64; 2],
}

const CASES: [Case; 3] = [
    Case {
        name: "data and filter with latitude",
        key: "right",
        data_as_printed: false,
        filter_as_printed: false,
        nis: FITS,
    },
    Case {
        name: "data and filter as printed",
        key: "both",
        data_as_printed: true,
        filter_as_printed: true,
        nis: FITS,
    },
    Case {
        name: "data with latitude, filter as printed",
        key: "filter",
        data_as_printed: false,
        filter_as_printed: true,
        nis: DOES_NOT_FIT,
    },
];

/// Exchanging the components is the same as exchanging latitude and co-latitude.
fn as_printed(latitude_deg: f64) -> f64 {
    90.0 - latitude_deg
}

pub(super) fn measure(measured: &mut Measured) -> Result<(), Error> {
    let latitude_deg = scenario(0, PAPER_DAYS).latitude_deg;
    let mut table = Table::new([
        "Earth rate",
        "mean NIS, median",
        "D_F: RMS error (deg/h)",
        "D_I: RMS error (deg/h/g)",
        "D_II: RMS error (deg/h/g²)",
        "mean error of the three D_I (deg/h/g)",
    ]);
    for case in CASES {
        let runs = run(&case, latitude_deg)?;
        let nis = median(&runs.iter().map(|run| run.nis_mean).collect::<Vec<_>>());
        let kind = |kind: usize| -> Vec<f64> {
            let errors = runs.iter().map(|run| run.error());
            errors
                .flat_map(|error| [error[kind], error[3 + kind], error[6 + kind]])
                .collect()
        };
        let rms = |which: usize| fixed(root_mean_square(kind(which)), 4);
        let key = format!("nis_printed_{}", case.key);
        let text = if nis > LARGE {
            format!("{nis:.2e}")
        } else {
            fixed(nis, 2)
        };
        measured.values.put(key, text.clone());
        table.row([
            case.name.to_owned(),
            text,
            rms(0),
            rms(1),
            rms(2),
            fixed(mean(kind(1)), 4),
        ]);
        let name = format!("Earth rate, {}: mean NIS, median", case.name);
        let mut figure = Figure::within(&name, case.nis, nis);
        if nis > LARGE {
            figure.measured = format!("{nis:.3e}");
        }
        measured.figures.push(figure.over(runs.len(), seeds()));
    }
    measured.values.put("table_printed", table.text());
    measured
        .values
        .put("co_latitude", fixed(as_printed(latitude_deg), 1));
    let (sine, cosine) = latitude_deg.to_radians().sin_cos();
    let rate_deg_per_h = EARTH_RATE_RAD_PER_S.to_degrees() * 3600.0;
    let [vertical, north] = [cosine - sine, cosine - sine].map(|part| rate_deg_per_h * part);
    measured.values.put("vertical_excess", fixed(vertical, 2));
    measured.values.put("north_deficit", fixed(north, 2));
    Ok(())
}

fn run(case: &Case, latitude_deg: f64) -> Result<Vec<Judged>, Error> {
    let choose = |printed: bool| {
        if printed {
            as_printed(latitude_deg)
        } else {
            latitude_deg
        }
    };
    SEEDS
        .into_par_iter()
        .map(|seed| {
            let simulation = simulate(&Scenario {
                latitude_deg: choose(case.data_as_printed),
                ..scenario(seed, PAPER_DAYS)
            })?;
            let mut bench = simulation.bench.clone();
            bench.latitude_deg = choose(case.filter_as_printed);
            Judged::of(&simulation, &bench, &Options::streaming())
        })
        .collect()
}
