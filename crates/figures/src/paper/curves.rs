//! Figures 2 to 4 and two more: estimates against time, innovations, and final estimates.

use gyrocal::PlatformFilter;
use gyrocal_calibration::{Options, declared_attitude, filter_settings};
use gyrocal_record::AXES;
use gyrocal_report::{
    ComparedEstimate, ComparedQuantity, Comparison, Convergence, EstimateHistory, ParameterHistory,
    Picture, ResidualChannel, Residuals,
};
use gyrocal_truth::Simulation;

use super::Error;
use super::bench::{Data, Judged, PAPER_DAYS, SHOWN_SEED, names, scenario};
use super::result::ways;

/// Number of rows between points of a curve.
const THINNED: usize = 10;

/// A picture and the stem of its files.
pub(super) type Named = (&'static str, Box<dyn Picture>);

/// Estimates and innovations of a streaming filter over a record.
struct Track {
    time_s: Vec<f64>,
    estimate: Vec<[f64; 9]>,
    sigma: Vec<[f64; 9]>,
    /// Innovations of every row, g.
    innovation_g: [Vec<f64>; 3],
}

/// All pictures of the page.
pub(super) fn pictures() -> Result<Vec<Named>, Error> {
    let scenario = scenario(SHOWN_SEED, PAPER_DAYS);
    let by_rule = Data::PaperRule.simulate(&scenario)?;
    let exact = Data::Exact.simulate(&scenario)?;
    let tracks = [
        Track::of(&by_rule, &Options::paper_baseline())?,
        Track::of(&exact, &Options::paper_baseline())?,
        Track::of(&exact, &Options::streaming())?,
    ];
    let judged = ways()[1..]
        .iter()
        .map(|way| Judged::of(&exact, &exact.bench, &way.options))
        .collect::<Result<Vec<_>, _>>()?;
    let batch = judged.last().ok_or("no estimators")?;
    let mut pictures: Vec<Named> = Vec::new();
    for (gyro, stem) in ["figure-2", "figure-3", "figure-4"].into_iter().enumerate() {
        pictures.push((stem, Box::new(convergence(gyro, &tracks, batch))));
    }
    let [_, paper, default] = tracks;
    let innovations = innovations(&exact, paper, default);
    pictures.push(("innovations", Box::new(innovations)));
    pictures.push(("estimates", Box::new(estimates(&judged))));
    Ok(pictures)
}

impl Track {
    fn of(simulation: &Simulation, options: &Options) -> Result<Self, Error> {
        let record = &simulation.record;
        let settings = filter_settings(&simulation.bench, options.discretisation);
        let attitude = declared_attitude(&simulation.bench)
            .ok_or("the bench file declares no initial attitude")?;
        let mut filter = PlatformFilter::<f64>::new(&settings, &attitude)?;
        let mut track = Self {
            time_s: Vec::new(),
            estimate: Vec::new(),
            sigma: Vec::new(),
            innovation_g: Default::default(),
        };
        for (row, sample) in record.accel_g.iter().enumerate() {
            let innovation = if row == 0 {
                filter.update(sample)?
            } else {
                filter.step(record.time_s[row] - record.time_s[row - 1], sample)?
            };
            for (values, value) in track.innovation_g.iter_mut().zip(innovation.residual) {
                values.push(value);
            }
            if row % THINNED == 0 {
                track.time_s.push(record.time_s[row]);
                track.estimate.push(filter.drift().to_array());
                track.sigma.push(filter.drift_sigma().to_array());
            }
        }
        Ok(track)
    }

    fn coefficient(&self, letter: &str, index: usize, reference: f64) -> ParameterHistory {
        ParameterHistory {
            name: format!("{letter}: {}", names()[index]),
            unit: units()[index].to_owned(),
            estimates: EstimateHistory {
                estimate: self.estimate.iter().map(|values| values[index]).collect(),
                sigma: self.sigma.iter().map(|values| values[index]).collect(),
            },
            reference: Some(reference),
            second: None,
        }
    }
}

fn units() -> [&'static str; 9] {
    core::array::from_fn(|i| ["deg/h", "deg/h/g", "deg/h/g²"][i % 3])
}

/// The three coefficients of one gyro, one a row, in the three ways, one a column.
fn convergence(gyro: usize, tracks: &[Track; 3], batch: &Judged) -> Convergence {
    let [by_rule, paper, default] = tracks;
    let parameters = (3 * gyro..3 * gyro + 3).flat_map(|index| {
        [
            by_rule.coefficient("A", index, batch.truth[index]),
            paper.coefficient("B", index, batch.estimate[index]),
            default.coefficient("C", index, batch.estimate[index]),
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
    Residuals {
        title: "On exact data the innovations of the paper's filter are far larger than the noise"
            .to_owned(),
        subtitle: format!("One record, seed {SHOWN_SEED}"),
        time_s: exact.record.time_s.clone(),
        channels: AXES
            .into_iter()
            .zip(paper.innovation_g.into_iter().zip(default.innovation_g))
            .map(|(name, (before, after))| ResidualChannel {
                name: name.to_owned(),
                before,
                after: Some(after),
                sigma: exact.bench.accel_noise_g,
            })
            .collect(),
        before_label: "paper's filter".to_owned(),
        after_label: "default filter".to_owned(),
        quantity: "innovation".to_owned(),
        unit: "g".to_owned(),
    }
}

fn estimates(judged: &[Judged]) -> Comparison {
    let quantity = |i: usize| ComparedQuantity {
        name: names()[i].to_owned(),
        unit: units()[i].to_owned(),
        reference: Some(judged[0].truth[i]),
        estimates: judged
            .iter()
            .map(|run| ComparedEstimate {
                value: run.estimate[i],
                sigma: run.sigma[i],
            })
            .collect(),
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
