//! Limits of the answer: effects that are indistinguishable, undetectable or untested.

use gyrocal_statistics::format::percent;

use crate::files::joined;
use gyrocal_answer::{Answer, Experiment, ExperimentKind, NotTestedReason};

/// Groups of effects and of set-ups that the record does not distinguish: their names, why, and the experiment that
/// would distinguish them.
#[must_use]
pub fn groups(result: &Answer) -> Vec<[String; 3]> {
    let effects = result.findings.iter().flat_map(|finding| {
        finding.separations.iter().map(|one| {
            let others = finding.of_kind(one.from).map(|other| &other.effect);
            let members = joined([&finding.effect].into_iter().chain(others), ", ");
            [members, one.why.clone(), one.words.clone()]
        })
    });
    let set_ups = result.set_ups.iter();
    let set_ups = set_ups.map(|one| {
        let words = one.would_separate.clone();
        [one.members.join(", "), one.why.clone(), words]
    });
    effects.chain(set_ups).collect()
}

/// Why set-ups are not distinguished where no angles are declared.
pub const SET_UPS_WITHOUT_ANGLES: &str =
    "no initial angles are declared; the coefficients then belong to other axes";

/// Reason why the members of a confidence set are not distinguished.
#[must_use]
pub fn why_not_distinguished(coverage: Option<f64>) -> String {
    let set = coverage.map(percent);
    let set = set.map_or_else(String::new, |coverage| {
        format!("; the confidence set has a coverage of {coverage}")
    });
    format!(
        "they explain this record nearly equally well, once the nine coefficients and the first \
         attitude have absorbed what they can{set}"
    )
}

/// What is to be added where time and temperature went together in the record.
#[must_use]
pub fn time_is_temperature(correlation: f64) -> String {
    format!(
        "; time and temperature go together in this record (correlation {correlation:.2}), so that effects of \
         the two are told apart by a run with the temperature held or changed otherwise"
    )
}

/// Reason why near twins are not distinguished.
#[must_use]
pub fn near_twins() -> String {
    "near twins outside the default search: at one attitude they look alike".to_owned()
}

/// Experiments that would distinguish effects, and the option that tests some of them.
#[must_use]
pub fn would_distinguish(testable: &[String], experiments: &[Experiment]) -> String {
    let option = (!testable.is_empty())
        .then(|| format!("--effects {} tests them against it", testable.join(",")));
    let experiments = experiments.iter().map(experiment);
    joined(option.into_iter().chain(experiments), "; ")
}

fn experiment(experiment: &Experiment) -> String {
    let what = experiment.what.as_deref().unwrap_or("an input");
    match experiment.kind {
        ExperimentKind::OtherAttitude => {
            "a second run from another initial attitude, which does far more than a longer run: \
             terms of specific force change their course, functions of time do not"
                .to_owned()
        }
        ExperimentKind::OtherStart => {
            "a second run from another initial attitude or started at another time of day, which \
             does far more than a longer run"
                .to_owned()
        }
        ExperimentKind::MeasureAttitude => {
            "an independent measurement of the attitude at the first row".to_owned()
        }
        ExperimentKind::ControlRegressor => {
            format!("a run with the {what} held or stepped on purpose")
        }
        ExperimentKind::ChangeInput => format!("a run with {what}"),
        ExperimentKind::StartLate => "a run that starts long after switching on".to_owned(),
        ExperimentKind::MeasureInput | ExperimentKind::Other => what.to_owned(),
    }
}

/// Reason why an effect was not tested or is not detectable; of a missing input, `missing` says
/// what is missing.
#[must_use]
pub fn not_tested(reason: NotTestedReason, missing: Option<&str>) -> String {
    match reason {
        NotTestedReason::LowPower => {
            "the record is too short: an effect of typical size would go undetected"
        }
        NotTestedReason::MissingInput => missing.unwrap_or("an input is missing"),
        NotTestedReason::FilterNotAsked => "an error of a filter: --filter euler",
        NotTestedReason::HiddenByCorrelation => "correlated noise of the accelerometers hides it",
        NotTestedReason::NoSpectrum => "the record is too short for a spectrum of its noise",
        NotTestedReason::NotDefault => "only on request: --effects",
        NotTestedReason::Unobservable => {
            "the fit of the nine coefficients absorbs it in so short a record, or so small a part \
             of the circle"
        }
    }
    .to_owned()
}
