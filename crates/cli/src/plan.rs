//! `gyrocal plan`: the most informative next run after a record, or after several.

mod failed;
mod found;
mod options;

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal::generated::MODEL_HASH;
use gyrocal_calibration::Run;
use gyrocal_design::{Aim, Goal, PlanOptions, plan};
use gyrocal_pages::of_plan;
use gyrocal_record::InputRole;

use crate::numbers::{Choice, one_of, positive, probability};
use crate::outputs::manifest_of;
use crate::page::Views;
use crate::progress::Progress;
use crate::records::{Given, with_role};
use crate::{Failure, Reply};
pub use failed::NotPlanned;
use options::{durations_s, limit, limits, refuse_repeated, wished_sigma};

/// Find the attitude and duration of the most informative next run.
///
/// Searches the attitudes within the gimbal limits for the run that reduces the confidence sets of
/// the findings most, or the sigmas of the coefficients, and predicts the joint result of records
/// and run. The records are diagnosed first unless a diagnosis is given. Of a strapdown unit
/// (--gyro-axes) the next run is a log at rest in another attitude of the unit. Of several records of one
/// platform the run follows the last. With --gyro-axes attitudes are those of the unit.
#[derive(Debug, Args)]
pub(crate) struct PlanArguments {
    #[command(flatten)]
    given: Given,
    /// Result of `gyrocal diagnose --json` for these records; without it they are diagnosed.
    #[arg(long, value_name = "DIAGNOSIS.json", conflicts_with_all = ["effects", "false_alarm"])]
    diagnosis: Option<PathBuf>,
    #[command(flatten)]
    views: Views,
    /// Durations of the next run, h; default: that of the last record.
    #[arg(long, value_name = "H,H", value_delimiter = ',', value_parser = positive)]
    hours: Vec<f64>,
    /// Limits of the platform angles during the whole run, or of the angles of a strapdown unit, deg:
    /// x=-30..30,y=-60..60. They override those of the bench file.
    #[arg(
        long,
        value_name = "AXIS=FROM..TO",
        value_delimiter = ',',
        value_parser = limit,
        allow_hyphen_values = true
    )]
    limits: Vec<(usize, [f64; 2])>,
    /// Criterion of the ranking; default: set, if a finding has alternatives.
    #[arg(long, value_parser = one_of(AIMS))]
    aim: Option<Aim>,
    /// Also find the shortest run after which a coefficient has this sigma: gyro_x.g_x=1e-4.
    #[arg(long, value_name = "ID=SIGMA", value_delimiter = ',', value_parser = wished_sigma)]
    sigma: Vec<(String, f64)>,
    /// Also find the shortest run after which one effect stays in each confidence set, with 95 %.
    #[arg(long)]
    one_name: bool,
    /// Also test these effects (not in the default search) when the records are diagnosed.
    #[arg(long, value_name = "ID,ID", value_delimiter = ',')]
    effects: Vec<String>,
    /// Family-wise false-alarm probability of the diagnosis.
    #[arg(long, value_name = "P", default_value_t = 0.01, value_parser = probability)]
    false_alarm: f64,
}

impl PlanArguments {
    /// The files that are read: each record with its bench file, then axes, in the order of the records.
    fn inputs(&self) -> Vec<(InputRole, &Path)> {
        let diagnosis = with_role(InputRole::Diagnosis, &self.diagnosis);
        self.given.inputs(None, diagnosis)
    }
}

/// Criteria of the ranking.
const AIMS: &[Choice<Aim>] = &[
    (
        "set",
        "Expected size of the confidence sets, then the standard deviations",
        Aim::Set,
    ),
    (
        "sigmas",
        "Standard deviations of the nine coefficients",
        Aim::Sigmas,
    ),
];

/// Share of the time of a plan that has passed after the diagnosis.
const DIAGNOSED: f64 = 0.5;

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &PlanArguments) -> Result<Reply, Failure> {
    arguments.given.check()?;
    let read = arguments.inputs();
    let inputs: Vec<&Path> = read.iter().map(|(_, path)| *path).collect();
    refuse_repeated(&arguments.limits)?;
    arguments.views.check(&inputs, &[])?;
    let (files, benches) = arguments.given.read()?;
    let rows = files.iter().map(|file| file.record().len()).sum();
    tracing::info!(rows, records = files.len(), "read");
    let mut progress = Progress::waiting("planning", rows);
    let known = found::known(arguments, &files, &benches, &mut progress)?;
    progress.stage("comparing runs", DIAGNOSED);
    let run = Run {
        record: &known.record,
        bench: &known.bench,
    };
    tracing::info!(named = known.named.len(), "known");
    let options = PlanOptions {
        durations_s: durations_s(&arguments.hours),
        limits: limits(&arguments.limits, &known.bench),
        aim: arguments.aim,
        goal: Goal {
            sigmas: arguments.sigma.clone(),
            one_name: arguments.one_name,
        },
        ..PlanOptions::default()
    };
    let mut planned = plan(&known.fitted, &run, &known.named, &options)
        .map_err(|source| NotPlanned::new(&arguments.given.records, source))?;
    drop(progress);
    planned.record = known.summary;
    planned.setup.clone_from(&known.setup);
    planned.manifest = manifest_of(MODEL_HASH, options.seed, &read, &benches)?;
    let (part, views) = (of_plan(&planned), &arguments.views);
    views.answered(arguments.given.first(), part, &planned)
}
