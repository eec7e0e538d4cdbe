//! Diagnosis of one record, and the gain of its extended model.

use gyrocal::effect::EffectKind;
use gyrocal_calibration::{FittedPlatform, Run};
use gyrocal_design::NamedCause;
use gyrocal_diagnosis::result::Finding;
use gyrocal_diagnosis::{DiagnoseOptions, Diagnosis, DiagnosisResult, diagnose, predict_later};
use gyrocal_evaluation::{InjectedEffect, constant_of_channel, inject_any};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Hidden, Scenario, Simulation, simulate};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::Error;

/// First number of these records in the population; `gyrocal characterise` has those below.
const FIRST_NUMBER: u64 = 100_000_000;

const SECONDS_PER_DAY: f64 = 86_400.0;

/// Time from the start of the first record to that of the second: whole days, so that diurnal waves
/// have the same phase.
const LATER_S: f64 = 4.0 * SECONDS_PER_DAY;

/// Added to the seed of a first record for that of its second.
const LATER_SEED: u64 = 1 << 40;

/// Mass unbalance across the input axis, deg/h/g, which the coefficients cannot absorb.
const CROSS_AXIS: f64 = 0.05;
const CROSS_AXES: [&str; 6] = [
    "gyro_x.g_y",
    "gyro_x.g_z",
    "gyro_y.g_x",
    "gyro_y.g_z",
    "gyro_z.g_x",
    "gyro_z.g_y",
];

/// Extended model of a diagnosis.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Extension {
    /// Id of the injected effect; empty for a clean record.
    pub(super) hidden: String,
    /// Each finding with its gain, and `true` if it was accepted.
    pub(super) findings: Vec<(String, f64, bool)>,
    /// Total gain of the extended model, nats.
    pub(super) gain_nats: Option<f64>,
}

impl Extension {
    fn of(hidden: &str, found: &DiagnosisResult) -> Self {
        let cause = |cause: &Finding| {
            let gain_nats = cause.gain_nats.unwrap_or(f64::NAN);
            (cause.effect.clone(), gain_nats, is_accepted(cause))
        };
        let gain = found.gain.as_ref();
        Self {
            hidden: hidden.to_owned(),
            findings: found.causes().map(cause).collect(),
            gain_nats: gain.map(|gain| gain.cross_validated_log_score_nats),
        }
    }

    /// `true` if the model was extended.
    pub(super) fn extended(&self) -> bool {
        self.findings.iter().any(|(_, _, accepted)| *accepted)
    }
}

fn is_accepted(cause: &Finding) -> bool {
    cause.accepted == Some(true)
}

/// Effects in the extended model.
fn accepted(found: &DiagnosisResult) -> Vec<String> {
    let causes = found.causes().filter(|cause| is_accepted(cause));
    causes.map(|cause| cause.effect.clone()).collect()
}

fn scenario(seed: u64) -> Scenario {
    gyrocal_evaluation::scenario(FIRST_NUMBER + seed)
}

/// A scenario with a random effect of `strength` sigmas of its own bound.
fn drawn(seed: u64, strength: f64) -> Result<(Scenario, InjectedEffect), Error> {
    let draw = &mut Draw::new(FIRST_NUMBER + seed, 0);
    Ok(inject_any(scenario(seed), strength, draw)?)
}

fn diagnosed(simulation: &Simulation) -> Result<Diagnosis<'_>, Error> {
    let options = DiagnoseOptions::default();
    Ok(diagnose(&simulation.record, &simulation.bench, &options)?)
}

/// A clean record.
pub(super) fn clean(seed: u64) -> Result<Extension, Error> {
    let simulation = simulate(&scenario(seed))?;
    Ok(Extension::of("", &diagnosed(&simulation)?.result))
}

/// A record with one injected effect.
pub(super) fn hidden(seed: u64, strength: f64) -> Result<Extension, Error> {
    let (scenario, injected) = drawn(seed, strength)?;
    let simulation = simulate(&scenario)?;
    Ok(Extension::of(
        injected.effect.id,
        &diagnosed(&simulation)?.result,
    ))
}

/// Errors of the coefficients with a cross-axis term.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Errors {
    pub(super) effect: String,
    /// Ids of the effects in the extended model.
    pub(super) accepted: Vec<String>,
    /// Largest error of a coefficient in sigmas: nominal, extended.
    pub(super) largest: [f64; 2],
    /// Normalised squared error of the nine: nominal, extended.
    pub(super) nees: [f64; 2],
}

pub(super) fn cross_axis(seed: u64) -> Result<Errors, Error> {
    let effect = CROSS_AXES[(seed % 6) as usize];
    let simulation = simulate(&Scenario {
        hidden: vec![Hidden::new(effect, &[("size", CROSS_AXIS)])?],
        ..scenario(seed)
    })?;
    let found = diagnosed(&simulation)?;
    let truth = simulation.truth.coefficients.named().map(|(_, v, _)| v);
    let extended = found.extended.as_ref().unwrap_or(&found.nominal);
    let of = |fit: &FittedPlatform<'_>| {
        let error = DVector::from_fn(9, |i, _| fit.values()[i] - truth[i]);
        let covariance: DMatrix<f64> = fit.covariance().view((0, 0), (9, 9)).into_owned();
        let largest = (0..9).map(|i| error[i].abs() / covariance[(i, i)].sqrt());
        let largest = largest.fold(0.0, f64::max);
        let solved = covariance.cholesky().map(|c| c.solve(&error));
        (largest, solved.map_or(f64::NAN, |s| s.dot(&error)))
    };
    let (before, after) = (of(&found.nominal), of(extended));
    Ok(Errors {
        effect: effect.to_owned(),
        accepted: accepted(&found.result),
        largest: [before.0, after.0],
        nees: [before.1, after.1],
    })
}

/// Gain of an extended model on a second record.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Second {
    pub(super) effect: String,
    /// Ids of the effects in the extended model.
    pub(super) accepted: Vec<String>,
    /// Log score of the second record, extended less nominal; `None` without an extension.
    pub(super) gain_nats: Option<f64>,
    /// Angle after a day, arc minutes: nominal, extended, expected of the extended.
    pub(super) after_a_day_arcmin: Option<[f64; 3]>,
    /// The same with a model that is given the injected effect, onset or time constant included, in
    /// place of the extended one.
    pub(super) told_arcmin: [f64; 3],
}

/// Least error of the nominal model over the one expected from noise and coefficients.
const BEYOND_NOISE: f64 = 2.0;

impl Second {
    /// `true` if the extended model predicts the drift better; without a finding it cannot.
    pub(super) fn predicted_better(&self) -> bool {
        let angles = self.after_a_day_arcmin;
        angles.is_some_and(|[nominal, extended, _]| extended < nominal)
    }

    /// `true` if a model that is given the injected effect predicts the drift better.
    pub(super) fn within_reach(&self) -> bool {
        let [nominal, told, _] = self.told_arcmin;
        told < nominal
    }

    /// `true` if the error of the nominal model exceeds chance.
    pub(super) fn beyond_noise(&self) -> bool {
        let [nominal, _, expected] = self.told_arcmin;
        nominal > BEYOND_NOISE * expected
    }
}

/// Diagnoses a record with an effect of `least` to four times as many sigmas, and predicts a second
/// record of the same platform at another attitude.
pub(super) fn second(seed: u64, least: f64) -> Result<Second, Error> {
    // Log-uniform by the golden ratio: any number of seeds is spread evenly.
    let share = (seed as f64 * 0.618_033_988_749_894_9).fract();
    let (scenario, injected) = drawn(seed, least * 4.0_f64.powf(share))?;
    let first = simulate(&scenario)?;
    let found = diagnosed(&first)?;
    let later = simulate(&later(&scenario, &injected)?)?;
    let [one, other] = [&first, &later].map(|simulation| Run {
        record: &simulation.record,
        bench: &simulation.bench,
    });
    let options = DiagnoseOptions::default();
    let predicted = |extended: &FittedPlatform<'_>| {
        let models = [&found.nominal, extended];
        predict_later(models, &found.noise_model, &one, (&other, None), &options)
    };
    let of_found = found.extended.as_ref().map(predicted).transpose()?;
    let named = NamedCause {
        turn_on_sigmas: Vec::new(),
        effect: injected.effect.id.to_owned(),
        shape: injected.shape,
        rivals: Vec::new(),
    };
    let told = NamedCause::fitted(&[named], &one, &found.noise_model, &options.calibration)?;
    Ok(Second {
        effect: injected.effect.id.to_owned(),
        accepted: accepted(&found.result),
        gain_nats: of_found.as_ref().map(|found| found.gain_nats()),
        after_a_day_arcmin: of_found.map(|found| found.attitude.at_end_arcmin()),
        told_arcmin: predicted(&told)?.attitude.at_end_arcmin(),
    })
}

/// The same platform four days later at another attitude, with the injected effect as it continues.
fn later(first: &Scenario, injected: &InjectedEffect) -> Result<Scenario, Error> {
    let mut scenario = Scenario {
        seed: first.seed ^ LATER_SEED,
        start_s: first.start_s + LATER_S,
        hidden: Vec::new(),
        ..first.clone()
    };
    let effect = injected.effect;
    let size = injected.sizes[0];
    let aged = size * LATER_S / SECONDS_PER_DAY;
    match (effect.kind, effect.rate()) {
        (EffectKind::Step, Some(axis)) => scenario.coefficients.bias_deg_per_h[axis] += size,
        (EffectKind::Ramp, Some(axis)) => {
            scenario.coefficients.bias_deg_per_h[axis] += aged;
            scenario.hidden.clone_from(&first.hidden);
        }
        (EffectKind::Ramp, None) => {
            scenario.hidden.clone_from(&first.hidden);
            let constant = constant_of_channel(effect).ok_or("a ramp of no channel")?;
            let bias = Hidden::new(constant, &[("size", aged)])?;
            scenario.hidden.push(bias);
        }
        (EffectKind::StateJump | EffectKind::InitialState, _) => {}
        _ => scenario.hidden.clone_from(&first.hidden),
    }
    Ok(scenario)
}
