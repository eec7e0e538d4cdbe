//! Figures 2 to 4 and two more: estimates against time, innovations, and final estimates.

use gyrocal_calibration::{Options, declared_attitude, filter_settings, run_factorised_filter};
use gyrocal_evaluation::CalibrationTrial;
use gyrocal_record::AXES;
use gyrocal_report::{
    ComparedEstimate, ComparedQuantity, Comparison, Convergence, EstimateHistory, ParameterHistory,
    Picture, ResidualChannel, Residuals,
};
use gyrocal_truth::{Coefficients, Simulation, euler_rule, simulate};

use super::ways::{Found, PAPER_DAYS, SHOWN_SEED, WAYS, key, scenario};
use crate::error::Error;

/// Number of rows between points of a curve.
const THINNED: usize = 10;

/// A picture and the stem of its files.
type Named = (&'static str, Box<dyn Picture>);

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
    let mut pictures: Vec<Named> = Vec::new();
    for (gyro, stem) in ["figure-2", "figure-3", "figure-4"].into_iter().enumerate() {
        pictures.push((stem, Box::new(convergence(gyro, &tracks, judged[2]))));
    }
    let [_, paper, default] = tracks;
    pictures.push(("innovations", Box::new(innovations(&exact, paper, default))));
    pictures.push(("estimates", Box::new(estimates(judged))));
    Ok(pictures)
}

impl Track {
    fn of(simulation: &Simulation, options: &Options) -> Result<Self, Error> {
        let record = &simulation.record;
        let settings = filter_settings(&simulation.bench, options.discretisation);
        let attitude = declared_attitude(&simulation.bench)
            .ok_or("the bench file declares no initial attitude")?;
        let mut track = Self::default();
        run_factorised_filter(
            record,
            &settings,
            &attitude,
            &mut |row, filter, innovation| {
                for (values, value) in track.innovation_g.iter_mut().zip(innovation.residual) {
                    values.push(value);
                }
                if row % THINNED == 0 {
                    track.time_s.push(record.time_s[row]);
                    track.estimate.push(filter.drift().to_array());
                    track.sigma.push(filter.drift_sigma().to_array());
                }
            },
        )?;
        Ok(track)
    }

    fn coefficient(&self, letter: &str, index: usize, reference: f64) -> ParameterHistory {
        let (name, unit) = named(index);
        ParameterHistory {
            name: format!("{letter}: {name}"),
            unit,
            estimates: EstimateHistory {
                estimate: self.estimate.iter().map(|values| values[index]).collect(),
                sigma: self.sigma.iter().map(|values| values[index]).collect(),
            },
            reference: Some(reference),
            second: None,
        }
    }
}

/// Name and unit of a coefficient.
fn named(index: usize) -> (String, String) {
    let (name, _, unit) = Coefficients::NONE.named()[index];
    (name.to_owned(), unit.replace("^2", "²"))
}

/// The three coefficients of one gyro, one a row, in the three ways, one a column.
fn convergence(gyro: usize, tracks: &[Track; 3], batch: &CalibrationTrial) -> Convergence {
    let [by_rule, paper, default] = tracks;
    let parameters = (3 * gyro..3 * gyro + 3).flat_map(|index| {
        let (truth, error) = (batch.truth[index], batch.error[index]);
        [
            by_rule.coefficient("A", index, truth),
            paper.coefficient("B", index, truth + error),
            default.coefficient("C", index, truth + error),
        ]
    });
    let name = AXES[gyro];
    Convergence {
        title: format!(
            "Gyro {name}: the paper's filter converges only on data simulated by its own rule"
        ),
        subtitle: "A: paper's filter, data simulated by its own rule. B: paper's filter, exact \
                   data. C: default filter, exact data"
            .to_owned(),
        time_s: by_rule.time_s.clone(),
        parameters: parameters.collect(),
        columns: 3,
        reference_label: "true value in A, batch estimate in B and C".to_owned(),
        estimate_label: String::new(),
        second_label: String::new(),
    }
}

fn innovations(exact: &Simulation, paper: Track, default: Track) -> Residuals {
    let both = paper.innovation_g.into_iter().zip(default.innovation_g);
    let channels = AXES
        .into_iter()
        .zip(both)
        .map(|(name, (before, after))| ResidualChannel {
            name: name.to_owned(),
            before,
            after: Some(after),
            sigma: exact.bench.accel_noise_g,
        });
    Residuals {
        title: "On exact data the innovations of the paper's filter are far larger than the noise"
            .to_owned(),
        subtitle: format!("One record, seed {SHOWN_SEED}"),
        time_s: exact.record.time_s.clone(),
        channels: channels.collect(),
        before_label: "paper's filter".to_owned(),
        after_label: "default filter".to_owned(),
        quantity: "innovation".to_owned(),
        unit: "g".to_owned(),
    }
}

fn estimates(judged: [&CalibrationTrial; 3]) -> Comparison {
    let quantity = |i: usize| {
        let (name, unit) = named(i);
        let estimates = judged.iter().map(|run| ComparedEstimate {
            value: run.truth[i] + run.error[i],
            sigma: run.sigma[i],
        });
        ComparedQuantity {
            name,
            unit,
            reference: Some(judged[0].truth[i]),
            estimates: estimates.collect(),
        }
    };
    Comparison {
        title:
            "On exact data the errors of the paper's filter are many times its standard deviations"
                .to_owned(),
        subtitle: format!("One record, seed {SHOWN_SEED}"),
        estimators: ["paper's filter", "default filter", "batch"]
            .map(str::to_owned)
            .into(),
        quantities: (0..9).map(quantity).collect(),
        columns: 3,
        tints: Vec::new(),
        reference_label: "true value".to_owned(),
    }
}
