//! The whole diagnosis of one record.

mod audited;
mod unsettled;

use gyrocal::effect::{EffectKind, NoiseProperty};
use gyrocal::{EFFECTS, Effect};
use gyrocal_calibration::{CalibrationError, Extended, NoiseEstimate, NoiseModel, Options, Run};
use gyrocal_record::{Bench, Record};
use gyrocal_statistics::{AllanTest, NORMAL_97_5, allan_test, two_sided_p};

use crate::cause::{Finding, Ranked, SearchOptions, Unavailable, Unnamed, search};
use crate::error::DiagnosisError;
use crate::gain::{Acceptance, Gain, Validation, gain, judge, validate};
use crate::magnitude_test::{MagnitudeTest, magnitude_test};
use crate::noise::{Estimate, NoiseAudit, NoiseFinding};
use crate::remainder::{Remainder, TESTS, remainder};
use crate::request;
use crate::series::Innovations;
use audited::{Audited, audited};
use unsettled::standing_off;

/// How a record is diagnosed.
#[derive(Clone, Debug, PartialEq)]
pub struct DiagnoseOptions {
    /// Probability that a record of the nominal model with the declared noise shows anything.
    pub false_alarm_probability: f64,
    /// Effects beside those of the default search.
    pub also: Vec<String>,
    /// Seed of the draws that thresholds come from.
    pub seed: u64,
    /// How the model is integrated.
    pub calibration: Options,
}

impl Default for DiagnoseOptions {
    fn default() -> Self {
        Self {
            false_alarm_probability: 0.01,
            also: Vec::new(),
            seed: 0,
            calibration: Options::default(),
        }
    }
}

/// Shares of the probability of a false alarm: noise audit, gyro noise, search, remainder. A
/// twentieth is kept back: thresholds that are drawn and probabilities that hold for long records
/// are each a little off.
const SHARES: [f64; 4] = [0.12, 0.03, 0.7, 0.1];

/// Share of what is told of the norm and of averaging; it makes no finding.
const TOLD: f64 = 0.1;

/// Gyro noise that differs from the declared one by so many sigmas is reckoned with in the
/// search, so that it makes no causes of itself; it is named only if it still differs when the
/// causes are in the model.
const RECKONED: f64 = 3.0;

/// Logarithms of noise that differ by less are one noise: a tenth of what three days tell.
const SAME_NOISE: f64 = 0.02;

/// Rounds of noise and search: noise that a cause had raised falls when the cause is in the model.
const MOST_ROUNDS: usize = 3;

/// What a diagnosis says in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing is wrong.
    Clean,
    /// Something is wrong, and it has a name.
    EffectsFound,
    /// Something is wrong, and the catalogue does not hold it.
    Unexplained,
}

/// What was found in a record.
pub struct Diagnosis<'a> {
    /// In one word.
    pub verdict: Verdict,
    /// Probability of any finding on a sound record, as asked for.
    pub false_alarm_probability: f64,
    /// What the norm of specific force says, which no gyro enters; `None` if there are too few
    /// complete rows.
    pub norm: Option<MagnitudeTest>,
    /// How what is left averages out; `None` without a stretch that is long enough.
    pub stability: Option<AllanTest>,
    /// What is wrong with the noise.
    pub noise_findings: Vec<NoiseFinding>,
    /// The noise audit with all its figures.
    pub audit: NoiseAudit,
    /// Noise of accelerometers and gyros by maximum likelihood, over the declared one, with all
    /// causes in the model.
    pub noise: NoiseEstimate,
    /// The noise that the search believed.
    pub noise_model: NoiseModel,
    /// The causes.
    pub findings: Vec<Finding>,
    /// All families in the first search, largest first.
    pub ranking: Vec<Ranked>,
    /// What the largest of them must exceed.
    pub threshold: f64,
    /// Probability that any of them does on a sound record: the search's share of all.
    pub search_false_alarm_probability: f64,
    /// What could not be looked for.
    pub unavailable: Vec<Unavailable>,
    /// Of each cause, in the same order, whether it is in the extended model.
    pub acceptances: Vec<Acceptance>,
    /// What the extended model gains; if no cause is in it, what a model with all of them does;
    /// `None` without a cause.
    pub gain: Option<Gain>,
    /// What no effect of the catalogue explains, in the order in which it was met; it is in the
    /// extended model.
    pub unnamed: Vec<Unnamed>,
    /// What is left.
    pub remainder: Remainder,
    /// The nominal model at its best fit.
    pub nominal: Extended<'a>,
    /// The model with all causes that are accepted, if there are any.
    pub extended: Option<Extended<'a>>,
    /// Innovations of the nominal model as the streaming filter makes them.
    pub innovations: Innovations,
}

/// Why a record could not be diagnosed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DiagnoseError {
    /// The nominal model could not be fitted.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    /// The residuals could not be examined.
    #[error(transparent)]
    Residuals(#[from] DiagnosisError),
    /// An effect was asked for that the catalogue does not hold.
    #[error("there is no effect `{id}` in the catalogue{nearest}")]
    UnknownEffect {
        /// What was asked for.
        id: String,
        /// The nearest ones, as the end of the sentence.
        nearest: String,
    },
    /// An effect was asked for that this record and its bench cannot show.
    #[error("`{effect}` cannot be looked for: {why}")]
    Unavailable {
        /// What was asked for.
        effect: &'static str,
        /// What is missing.
        why: String,
    },
}

/// Diagnoses a record.
///
/// # Errors
/// [`DiagnoseError`].
pub fn diagnose<'a>(
    record: &'a Record,
    bench: &'a Bench,
    options: &DiagnoseOptions,
) -> Result<Diagnosis<'a>, DiagnoseError> {
    request::check(&options.also, record, bench)?;
    let run = Run { record, bench };
    let [audit_share, gyro_share, search_share, remainder_share] =
        SHARES.map(|share| share * options.false_alarm_probability);
    let declared = NoiseModel::default();
    let Audited {
        mut nominal,
        mut noise_model,
        innovations,
        mut audit,
        suspects,
    } = audited(&run, &declared, audit_share, &options.calibration)?;
    let slow_noise_g = noise_model
        .accel_ratio
        .map(|ratio| ratio * bench.accel_noise_g);
    let told = TOLD * options.false_alarm_probability;
    let norm = magnitude_test(&audit.cleaned.apply(record), bench, &slow_noise_g, told).ok();
    let search_options = SearchOptions {
        false_alarm_probability: search_share,
        unnamed_probability: remainder_share / TESTS,
        also: options.also.clone(),
        seed: options.seed,
        ..SearchOptions::default()
    };
    let mut searched = search(nominal.clone(), record, bench, &search_options)?;
    let mut estimate = searched.fitted.noise()?;
    for _ in 1..MOST_ROUNDS {
        let ratios = reckoned(&estimate, &noise_model);
        let changed = ratios
            .iter()
            .zip(noise_model.gyro_ratio)
            .any(|(new, old)| (new / old).ln().abs() > SAME_NOISE);
        if !changed {
            break;
        }
        let louder = NoiseModel {
            gyro_ratio: ratios,
            ..noise_model.clone()
        };
        // What is no noise at all may not be fitted as noise: the search stands as it is.
        let Ok(refitted) = nominal.with_noise(bench, &louder) else {
            break;
        };
        (nominal, noise_model) = (refitted, louder);
        searched = search(nominal.clone(), record, bench, &search_options)?;
        estimate = searched.fitted.noise()?;
    }
    if !suspects.is_empty() {
        // What a cause explains is no outlier.
        let mut rows: Vec<usize> = suspects.iter().map(|outlier| outlier.row).collect();
        rows.dedup();
        let mut outliers = standing_off(record, &rows, &searched.fitted, slow_noise_g);
        outliers.retain(|one| suspects.iter().any(|other| other.place() == one.place()));
        audit.add_outliers(outliers, bench.accel_noise_g);
    }
    let mut noise_findings = audit.findings.clone();
    // Between the steps that it is made up from, a walk looks like white noise.
    let walks = |noise: &str| {
        let channel = effect(noise).map(|effect| effect.enters);
        let mut found = searched.findings.iter().filter_map(|f| effect(f.effect));
        found.any(|found| found.kind == EffectKind::RandomWalk && Some(found.enters) == channel)
    };
    let gyros = if audit.cleaned.correlation == 0.0 {
        gyro_noise(&estimate, &noise_model, gyro_share)
    } else {
        // The likelihood takes the slow part of correlated noise for the gyros'.
        Vec::new()
    };
    noise_findings.extend(gyros.into_iter().filter(|finding| !walks(finding.effect)));
    let mut remainder = remainder(&searched.fitted, record, remainder_share)?;
    for found in &searched.unnamed {
        remainder.add(found);
    }
    let found = !searched.findings.is_empty();
    let stability = allan_test(&record.time_s, &remainder.whitened, told).ok();
    let judged = judge(&nominal, &searched, record)?;
    let gain = match judged.scores {
        Some(scores) if found => {
            let extended = judged.extended.as_ref().unwrap_or(&searched.fitted);
            let (noise, accel_noise_g) = (&noise_model, bench.accel_noise_g);
            Some(gain(
                [&nominal, extended],
                scores,
                record,
                noise,
                accel_noise_g,
            )?)
        }
        _ => None,
    };
    let verdict = if found || !noise_findings.is_empty() {
        Verdict::EffectsFound
    } else if remainder.unexplained {
        Verdict::Unexplained
    } else {
        Verdict::Clean
    };
    Ok(Diagnosis {
        verdict,
        false_alarm_probability: options.false_alarm_probability,
        norm,
        stability,
        noise_findings,
        audit,
        noise: estimate,
        noise_model,
        ranking: searched.ranking,
        threshold: searched.threshold,
        search_false_alarm_probability: search_share,
        unavailable: searched.unavailable,
        findings: searched.findings,
        acceptances: judged.acceptances,
        gain,
        unnamed: searched.unnamed,
        remainder,
        nominal,
        extended: judged.extended,
        innovations,
    })
}

/// Holds the nominal and the extended model that a diagnosis of `first` made against another, later
/// record of the same platform; `None` if no cause is in the extended model.
///
/// # Errors
/// [`DiagnoseError`].
pub fn validated(
    diagnosis: &Diagnosis<'_>,
    first: &Run<'_>,
    later: &Run<'_>,
    options: &DiagnoseOptions,
) -> Result<Option<Validation>, DiagnoseError> {
    let Some(extended) = &diagnosis.extended else {
        return Ok(None);
    };
    request::check(&[], later.record, later.bench)?;
    // Gyros as noisy as in the first record; outliers of the later one left out.
    let believed = NoiseModel {
        gyro_ratio: diagnosis.noise_model.gyro_ratio,
        ..NoiseModel::default()
    };
    let share = SHARES[0] * options.false_alarm_probability;
    let later_fit = audited(later, &believed, share, &options.calibration)?.nominal;
    let nominal = &diagnosis.nominal;
    Ok(Some(validate(nominal, extended, first, &later_fit, later)?))
}

/// The effect of the catalogue with this id.
fn effect(id: &str) -> Option<&'static Effect> {
    EFFECTS.iter().find(|effect| effect.id == id)
}

/// Logarithm of a ratio and its standard deviation.
fn logarithm(ratio: &gyrocal_calibration::NoiseRatio) -> (f64, f64) {
    let [low, high] = ratio.interval;
    (ratio.ratio.ln(), (high / low).ln() / (2.0 * NORMAL_97_5))
}

/// Gyro noise over the declared one that the search should believe; the estimate is over what
/// was believed before.
fn reckoned(estimate: &NoiseEstimate, believed: &NoiseModel) -> [f64; 3] {
    core::array::from_fn(|axis| {
        let (value, sigma) = logarithm(&estimate.gyro[axis]);
        let total = value + believed.gyro_ratio[axis].ln();
        if total.abs() > RECKONED * sigma {
            total.exp()
        } else {
            1.0
        }
    })
}

/// Gyro noise that differs from the declared one, with a share of the false alarms for all three.
fn gyro_noise(estimate: &NoiseEstimate, believed: &NoiseModel, share: f64) -> Vec<NoiseFinding> {
    let effects = EFFECTS
        .iter()
        .filter(|effect| effect.kind == EffectKind::Noise(NoiseProperty::Level))
        .filter_map(|effect| Some((effect.rate()?, effect.id)));
    effects
        .filter_map(|(axis, effect)| {
            let (value, sigma) = logarithm(&estimate.gyro[axis]);
            let total = value + believed.gyro_ratio[axis].ln();
            let z = total / sigma;
            let p_value = (3.0 * two_sided_p(z)).min(1.0);
            (p_value < share).then(|| NoiseFinding {
                effect,
                parameters: vec![Estimate {
                    name: "ratio",
                    estimate: total.exp(),
                    sigma: total.exp() * sigma,
                    unit: "1",
                }],
                z,
                p_value,
            })
        })
        .collect()
}
