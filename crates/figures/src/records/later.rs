//! A second record of a platform, predicted by the extended model of a first.

use gyrocal::effect::Enters;
use gyrocal_calibration::FittedPlatform;
use gyrocal_design::NamedCause;
use gyrocal_diagnosis::{DiagnoseOptions, predict_later};
use gyrocal_evaluation::{diagnosed, effect_of, inject_any, run_of, scenario};
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::{Proportion, median};
use gyrocal_truth::{Scenario, simulate};
use serde::{Deserialize, Serialize};

use super::continued;
use crate::gain::FIRST_NUMBER;
use crate::harness::{Context, DIAGNOSIS, Error, Figure, Population, Row, of};

/// Least strength of the effect, in sigmas of its own bound; the largest is four times that.
const LEAST_STRENGTH: f64 = 12.0;

/// Time from the start of the first record to that of the second: whole days, so that diurnal waves
/// have the same phase.
const LATER_S: f64 = 4.0 * 86_400.0;

/// Added to the seed of a first record for that of its second.
const LATER_SEED: u64 = 1 << 40;

/// Least error of the nominal model over the one expected from noise and coefficients.
const BEYOND_NOISE: f64 = 2.0;

/// Gain of an extended model on a second record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Second {
    effect: String,
    /// Log score of the second record, extended less nominal; `None` without an extension.
    gain_nats: Option<f64>,
    /// Angle after a day, arc minutes: nominal, extended, expected of the extended.
    after_a_day_arcmin: Option<[f64; 3]>,
    /// The same with a model that is given the injected effect, onset or time constant included, in
    /// place of the extended one.
    told_arcmin: [f64; 3],
}

impl Second {
    /// `true` if the extended model predicts the drift better; without a finding it cannot.
    fn predicted_better(&self) -> bool {
        let angles = self.after_a_day_arcmin;
        angles.is_some_and(|[nominal, extended, _]| extended < nominal)
    }

    /// `true` if a model that is given the injected effect predicts the drift better.
    fn within_reach(&self) -> bool {
        let [nominal, told, _] = self.told_arcmin;
        told < nominal
    }

    /// `true` if the error of the nominal model exceeds chance.
    fn beyond_noise(&self) -> bool {
        let [nominal, _, expected] = self.told_arcmin;
        nominal > BEYOND_NOISE * expected
    }

    /// `true` for an error of an accelerometer.
    fn enters_outputs(&self) -> bool {
        effect_of(&self.effect).is_some_and(|effect| matches!(effect.enters, Enters::Outputs(_)))
    }
}

/// All figures of the part.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let sources = of(DIAGNOSIS, &[file!(), "crates/figures/src/gain.rs"]);
    let population = Population::new("second", [900_000, 1000, 10], sources, second);
    context.measure(&population, &rows())
}

fn rows() -> Vec<Row<'static, Second>> {
    const REASON: &str = "as often as a set of 95 % holds the cause";
    let most = 4.0 * LEAST_STRENGTH;
    let name = |what: &str| format!("second record, d = {LEAST_STRENGTH} to {most}: {what}");
    // What a model that has exactly what was hidden wins is what can be won: an error of an
    // accelerometer, say, often changes the coefficients by less than the first record leaves open
    // in them, and then chance decides which model predicts a day better.
    let better = |what: &str, among: fn(&Second) -> bool| {
        let of = move |one: &Second| among(one).then(|| one.predicted_better());
        Row::share(name(&format!("drift predicted better{what}")), of).at_least(0.95, REASON)
    };
    let by_kind = |kind: &str, is_of_outputs: bool| {
        let what = format!("drift predicted better, and by the true cause: {kind}");
        Row::words(name(&what), move |all: &[Second]| {
            let all = all.iter();
            let these = all.filter(|one| one.enters_outputs() == is_of_outputs);
            let ours = Proportion::of(these.clone().map(Second::predicted_better));
            let told = Proportion::of(these.map(Second::within_reach)).share();
            format!("{:.3}, {told:.3} of {}", ours.share(), ours.trials)
        })
    };
    let gains = |one: &Second| Some(one.gain_nats.is_some_and(|nats| nats > 0.0));
    let angles = |all: &[Second]| {
        let angles = || all.iter().filter_map(|one| one.after_a_day_arcmin);
        let of = |which: usize| angles().map(|own| own[which]).collect::<Vec<f64>>();
        [0, 1, 2]
            .map(|which| format!("{:.2}", median(&of(which))))
            .join(", ")
    };
    let told = name("median error after a day, nominal, extended, expected, arcmin");
    vec![
        better(
            ", of those that the true cause predicts better",
            Second::within_reach,
        ),
        better(
            " where the nominal error is beyond noise",
            Second::beyond_noise,
        ),
        by_kind("errors of gyros, site", false),
        by_kind("of accelerometers", true),
        Row::share(name("higher log score"), gains).at_least(0.95, REASON),
        Row::words(told, angles),
    ]
}

/// Diagnoses a record with an effect, and predicts a second record of the same platform at another attitude.
fn second(seed: u64) -> Result<Second, Error> {
    // Log-uniform by the golden ratio: any number of seeds is spread evenly.
    let share = (seed as f64 * 0.618_033_988_749_894_9).fract();
    let strength = LEAST_STRENGTH * 4.0_f64.powf(share);
    let number = FIRST_NUMBER + seed;
    let (scenario, injected) = inject_any(scenario(number), strength, &mut Draw::new(number, 0))?;
    let first = simulate(&scenario)?;
    let options = DiagnoseOptions::default();
    let found = diagnosed(&first)?;
    let later = simulate(&Scenario {
        seed: scenario.seed ^ LATER_SEED,
        start_s: scenario.start_s + LATER_S,
        hidden: continued(&scenario, LATER_S)?,
        ..scenario
    })?;
    let (one, other) = (run_of(&first), run_of(&later));
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
        gain_nats: of_found.as_ref().map(|found| found.gain_nats()),
        after_a_day_arcmin: of_found.map(|found| found.attitude.at_end_arcmin()),
        told_arcmin: predicted(&told)?.attitude.at_end_arcmin(),
    })
}
