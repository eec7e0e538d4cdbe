//! Figures 2 to 4 and two more: estimates against time, innovations, and final estimates.

use gyrocal::{FactorisedPlatformFilter, Innovation};
use gyrocal_calibration::{Options, declared_attitude, filter_settings, run_factorised_filter};
use gyrocal_document::{
    Band, Chart, EstimateRow, Estimates, Level, Line, LineKind, Panel, TimeAxis, Tint,
    ValueWithSigma,
};
use gyrocal_evaluation::CalibrationTrial;
use gyrocal_record::AXES;
use gyrocal_report::Picture;
use gyrocal_statistics::{NORMAL_97_5, format, rms_of_present};
use gyrocal_truth::{Coefficients, Simulation, euler_rule, simulate};

use super::ways::{Found, PAPER_DAYS, SHOWN_SEED, WAYS, key, scenario};
use crate::harness::Error;

/// Number of rows between points of a curve.
const THINNED: usize = 10;

/// Part of the time that does not set the scale of a panel.
const UNSETTLED: f64 = 0.1;

/// A picture and the stem of its files.
type Named = (&'static str, Box<dyn Picture>);

type Filter = FactorisedPlatformFilter<f64>;

/// Estimates and innovations of a streaming filter over a record.
#[derive(Default)]
struct Track {
    time_s: Vec<f64>,
    estimate: Vec<[f64; 9]>,
    sigma: Vec<[f64; 9]>,
    /// Innovations of every row, g.
    innovation_g: [Vec<f64>; 3],
}

/// All pictures of the page, with what is found in the record that is shown.
pub(super) fn pictures(found: &Found) -> Result<Vec<Named>, Error> {
    let scenario = scenario(SHOWN_SEED, PAPER_DAYS);
    let by_rule = euler_rule(&scenario)?;
    let exact = simulate(&scenario)?;
    let tracks = [
        Track::of(&by_rule, &Options::paper_baseline())?,
        Track::of(&exact, &Options::paper_baseline())?,
        Track::of(&exact, &Options::streaming())?,
    ];
    let judged = [1, 2, 3].map(|way: usize| &found[&key(WAYS[way].0, PAPER_DAYS)]);
    let [x, y, z] = [0, 1, 2].map(|gyro| convergence(gyro, &tracks, judged[2]));
    let [_, paper, default] = tracks;
    Ok(vec![
        ("figure-2", Box::new(x)),
        ("figure-3", Box::new(y)),
        ("figure-4", Box::new(z)),
        ("innovations", Box::new(innovations(&exact, paper, default))),
        ("estimates", Box::new(estimates(judged))),
    ])
}

impl Track {
    fn of(simulation: &Simulation, options: &Options) -> Result<Self, Error> {
        let record = &simulation.record;
        let settings = filter_settings(&simulation.bench, options.discretisation);
        let attitude = declared_attitude(&simulation.bench)
            .ok_or("the bench file declares no initial attitude")?;
        let mut track = Self::default();
        let mut take = |row: usize, filter: &Filter, innovation: &Innovation<f64, 3>| {
            for (values, value) in track.innovation_g.iter_mut().zip(innovation.residual) {
                values.push(value);
            }
            if row.is_multiple_of(THINNED) {
                track.time_s.push(record.time_s[row]);
                track.estimate.push(filter.drift().to_array());
                track.sigma.push(filter.drift_sigma().to_array());
            }
        };
        run_factorised_filter(record, &settings, &attitude, &mut take)?;
        Ok(track)
    }

    fn coefficient(&self, letter: &str, index: usize, reference: f64) -> Panel {
        let (name, unit) = named(index);
        let pairs = || self.estimate.iter().zip(&self.sigma);
        let edge = |sigmas: f64| -> Vec<f64> {
            let edges = pairs().map(|(values, sigma)| values[index] + sigmas * sigma[index]);
            edges.collect()
        };
        let last = pairs().next_back();
        let note = last.map(|(values, sigma)| format::estimate(values[index], sigma[index]));
        let abscissa = TimeAxis::of(&self.time_s).values;
        Panel {
            name: format!("{letter}: {name}"),
            note: note.map_or_else(String::new, |both| both.join(" ± ").replace('-', "−")),
            unit: Some(unit),
            scale_from: abscissa.last().map(|last| UNSETTLED * last),
            abscissa,
            bands: vec![Band {
                label: "±2σ (95 %)".to_owned(),
                tint: Tint::Extended,
                lower: edge(-2.0),
                upper: edge(2.0),
            }],
            lines: vec![line("estimate", Tint::Extended, edge(0.0))],
            levels: vec![Level {
                label: "true value in A, batch estimate in B and C".to_owned(),
                value: reference,
            }],
            ..Panel::default()
        }
    }
}

fn line(label: &str, tint: Tint, values: Vec<f64>) -> Line {
    Line {
        label: label.to_owned(),
        tint,
        kind: LineKind::Solid,
        values,
    }
}

/// A chart over the time of a record.
fn over(time_s: &[f64], panels: Vec<Panel>) -> Chart {
    Chart {
        abscissa: "time from the first row".to_owned(),
        abscissa_unit: TimeAxis::of(time_s).unit.to_owned(),
        height_px: 150,
        panels,
        ..Chart::default()
    }
}

/// Name and unit of a coefficient.
fn named(index: usize) -> (String, String) {
    let (name, _, unit) = Coefficients::NONE.named()[index];
    (name.to_owned(), unit.replace("^2", "²"))
}

/// The three coefficients of one gyro, one a row, in the three ways, one a column.
fn convergence(gyro: usize, tracks: &[Track; 3], batch: &CalibrationTrial) -> Chart {
    let [by_rule, paper, default] = tracks;
    let panels = (3 * gyro..3 * gyro + 3).flat_map(|index| {
        let (truth, error) = (batch.truth[index], batch.error[index]);
        [
            by_rule.coefficient("A", index, truth),
            paper.coefficient("B", index, truth + error),
            default.coefficient("C", index, truth + error),
        ]
    });
    let name = AXES[gyro];
    Chart {
        title: format!(
            "Gyro {name}: the paper's filter converges only on data simulated by its own rule"
        ),
        caption: "A: paper's filter, data simulated by its own rule. B: paper's filter, exact data. C: default \
                  filter, exact data. The first tenth of the time does not set the scales."
            .to_owned(),
        columns: 3,
        ..over(&by_rule.time_s, panels.collect())
    }
}

fn innovations(exact: &Simulation, paper: Track, default: Track) -> Chart {
    let time = TimeAxis::of(&exact.record.time_s);
    let half_g = NORMAL_97_5 * exact.bench.accel_noise_g;
    let both = paper.innovation_g.into_iter().zip(default.innovation_g);
    let panels = AXES.into_iter().zip(both).map(|(name, (before, after))| {
        let micro_g = |values: &[f64]| format::short(1e6 * rms_of_present(values).0, 2);
        let level = |value| Level {
            label: "95 % of the noise of the accelerometers".to_owned(),
            value,
        };
        Panel {
            name: name.to_owned(),
            note: format!("rms {} → {} µg", micro_g(&before), micro_g(&after)),
            abscissa: time.values.clone(),
            lines: vec![
                line("paper's filter", Tint::Nominal, before),
                line("default filter", Tint::Extended, after),
            ],
            levels: [-half_g, half_g].map(level).into(),
            ..Panel::default()
        }
    });
    Chart {
        title: "On exact data the innovations of the paper's filter are far larger than the noise"
            .to_owned(),
        quantity: "innovation".to_owned(),
        unit: "g".to_owned(),
        same_scale: true,
        cut_extremes: true,
        columns: 1,
        ..over(&exact.record.time_s, panels.collect())
    }
}

fn estimates(judged: [&CalibrationTrial; 3]) -> Estimates {
    let models = [
        ("true value", Tint::Expected),
        ("paper's filter", Tint::Nominal),
        ("default filter", Tint::Extended),
        ("batch", Tint::Alternative),
    ];
    let row = |index: usize| {
        let (name, unit) = named(index);
        let truth = ValueWithSigma {
            value: judged[0].truth[index],
            sigma: f64::NAN,
        };
        let estimates = judged.iter().map(|run| ValueWithSigma {
            value: run.truth[index] + run.error[index],
            sigma: run.sigma[index],
        });
        EstimateRow {
            name,
            unit,
            values: [truth].into_iter().chain(estimates).collect(),
            note: String::new(),
            strong: false,
        }
    };
    Estimates {
        title:
            "On exact data the errors of the paper's filter are many times its standard deviations"
                .to_owned(),
        models: models.map(|(name, tint)| (name.to_owned(), tint)).into(),
        rows: (0..9).map(row).collect(),
        note_head: String::new(),
    }
}
