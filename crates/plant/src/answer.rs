//! The answer of a diagnosis, as data and in sentences.

use gyrocal_statistics::format::{p_value, significant};
use serde::Serialize;

use crate::identifiability::NullDirection;
use crate::starts::Starts;

/// A 95 % interval.
pub type Interval95 = [f64; 2];

/// Gain on a later record, nats, below which nothing is said of it.
const LEAST_GAIN: f64 = 3.0;

/// A remainder rarer than this is told.
const RARE: f64 = 0.001;

/// The answer of a diagnosis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Diagnosis {
    /// Name of the plant.
    pub plant: String,
    /// Rows of the record.
    pub rows: usize,
    /// Its duration, s.
    pub duration_s: f64,
    /// Effects that were tested.
    pub tested: usize,
    /// Inputs that never move.
    pub still_inputs: Vec<String>,
    /// Starts of the fit.
    pub starts: Starts,
    /// What the record does not determine.
    pub undetermined: Vec<NullDirection>,
    /// Detected effects with their sets.
    pub findings: Vec<Found>,
    /// Detected terms that no effect of the catalogue explains.
    pub unexplained: Vec<Unexplained>,
    /// Effects of the catalogue that the record cannot show.
    pub left_out: Vec<LeftOut>,
    /// Parameters and initial states.
    pub parameters: Vec<Estimate>,
    /// Estimated noise.
    pub noise: Vec<NoiseLevel>,
    /// Errors of simulations of this record.
    pub errors: Vec<OutputError>,
    /// Horizon of these simulations, s.
    pub horizon_s: f64,
    /// What is left.
    pub remainder: Vec<Remainder>,
    /// Gain on a later record.
    pub later_record: Option<Comparison>,
}

/// A detected effect.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Found {
    /// Id of the effect that is named.
    pub effect: String,
    /// Its meaning.
    pub name: String,
    /// Its term.
    pub formula: String,
    /// Its size, and its onset if it has one.
    pub sizes: Vec<Size>,
    /// Its size in standard deviations.
    pub z: f64,
    /// Family-wise p-value.
    pub p_value: f64,
    /// The other effects of the set with what their log-likelihood lacks, nats.
    pub rivals: Vec<(String, f64)>,
    /// Effects that no record tells from it.
    pub equivalents: Vec<String>,
    /// Probability that nothing of the catalogue is the cause.
    pub none_of_these: Option<f64>,
}

/// An estimated parameter of an effect.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Size {
    /// `size` or `onset_s`.
    pub name: String,
    /// The estimate.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: Option<f64>,
    /// 95 % interval of an onset, in pieces.
    pub interval: Option<Vec<Interval95>>,
    /// Unit.
    pub unit: String,
}

/// A detected term outside of the catalogue.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unexplained {
    /// The rate, output or parameter.
    pub channel: String,
    /// Its form.
    pub form: String,
    /// Its size.
    pub size: f64,
    /// Unit of the size.
    pub unit: String,
    /// Natural logarithm of its p-value.
    pub ln_p_value: f64,
}

/// An effect that was not tested.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeftOut {
    /// Its id.
    pub effect: String,
    /// The reason.
    pub why: String,
}

/// An estimated parameter or initial state.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Its name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Declared value.
    pub declared: f64,
    /// Estimate of the nominal model.
    pub nominal: f64,
    /// Estimate of the model with all findings.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: f64,
}

/// An estimated noise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NoiseLevel {
    /// The output or rate.
    pub of: String,
    /// Standard deviation over the declared one.
    pub ratio: f64,
    /// Its 95 % interval.
    pub interval: Interval95,
}

/// Root mean square error of an output in simulations.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutputError {
    /// The output.
    pub output: String,
    /// Unit.
    pub unit: String,
    /// With the nominal model.
    pub nominal: f64,
    /// With all findings.
    pub extended: f64,
}

/// Test of what the extended model leaves of an output.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Remainder {
    /// The output.
    pub output: String,
    /// p-value of white innovations.
    pub p_value: f64,
}

/// Both models on a later record, with the parameters of the first.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Rows of the later record.
    pub rows: usize,
    /// Logarithm of the density of the record with the findings over that without.
    pub gain_nats: f64,
    /// Horizon of the simulations, s.
    pub horizon_s: f64,
    /// Errors of the simulations.
    pub errors: Vec<OutputError>,
}

fn list(names: &[String]) -> String {
    names.join(", ")
}

impl Diagnosis {
    /// The answer in sentences, the verdict first.
    #[must_use]
    pub fn sentences(&self) -> Vec<String> {
        let verdict = core::iter::once(self.verdict());
        let facts = self.facts().into_iter().map(|(_, words)| words);
        verdict.chain(facts).collect()
    }

    /// What the answer says after the verdict: sentences with what they are about.
    #[must_use]
    pub fn facts(&self) -> Vec<(&'static str, String)> {
        let mut all = Vec::new();
        let found = self.findings.iter();
        all.extend(found.map(|one| ("effect", one.sentence())));
        let unexplained = self.unexplained.iter();
        all.extend(unexplained.map(|one| ("unexplained", one.sentence())));
        all.extend(self.errors.iter().map(|error| {
            let words = format!(
                "Simulated over {} s, output {} is off by {} {} rms with the nominal model{}.",
                significant(self.horizon_s, 4),
                error.output,
                significant(error.nominal, 3),
                error.unit,
                with_findings(error, self.has_findings()),
            );
            ("open loop", words)
        }));
        if let Some(later) = &self.later_record {
            all.push(("later record", later.sentence(self.has_findings())));
        }
        let coloured = self.remainder.iter().filter(|one| one.p_value < RARE);
        all.extend(coloured.map(|one| {
            let words = format!(
                "What is left of output {} is not white noise ({}): the model still lacks something, or \
                 the noise is coloured. Significances rest on white noise, take them as too good.",
                one.output,
                p_value(one.p_value)
            );
            ("remainder", words)
        }));
        let undetermined = self.undetermined.iter();
        all.extend(undetermined.map(|one| ("undetermined", sentence(&one.sentence()))));
        if !self.still_inputs.is_empty() {
            let words = format!(
                "Input {} never moves in this record: nothing that depends on it can be told from a \
                 constant. Move it.",
                list(&self.still_inputs)
            );
            all.push(("inputs", words));
        }
        all
    }

    /// Whether anything is found that the model lacks.
    #[must_use]
    pub fn has_findings(&self) -> bool {
        !(self.findings.is_empty() && self.unexplained.is_empty())
    }

    /// The verdict, a sentence.
    #[must_use]
    pub fn verdict(&self) -> String {
        let (rows, tested) = (self.rows, self.tested);
        let names: Vec<String> = self.findings.iter().map(|one| one.effect.clone()).collect();
        match names.len() {
            0 if self.unexplained.is_empty() => format!(
                "Nothing is found that {} lacks: {tested} effects were tested on {rows} rows.",
                self.plant
            ),
            0 => format!(
                "{} lacks something that its catalogue has no term for.",
                self.plant
            ),
            1 => format!("{} lacks one effect: {}.", self.plant, names[0]),
            count => format!("{} lacks {count} effects: {}.", self.plant, list(&names)),
        }
    }
}

fn with_findings(error: &OutputError, has: bool) -> String {
    if !has {
        return String::new();
    }
    format!(
        " and by {} {} with what was found",
        significant(error.extended, 3),
        error.unit
    )
}

fn sentence(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters
        .next()
        .map(|letter| letter.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str() + "."
}

impl Found {
    fn sentence(&self) -> String {
        let sizes: Vec<String> = self.sizes.iter().map(Size::words).collect();
        let mut text = format!(
            "{} ({}): {}; {} standard deviations, {}.",
            self.effect,
            self.name,
            sizes.join(", "),
            significant(self.z, 3),
            p_value(self.p_value),
        );
        if self.rivals.is_empty() {
            text += " Its set has no other effect.";
        } else {
            let rivals: Vec<String> = self
                .rivals
                .iter()
                .map(|(id, deficit)| format!("{id} ({deficit:.1} nats less likely)"))
                .collect();
            text += &format!(" The cause may also be {}.", rivals.join(", "));
        }
        if !self.equivalents.is_empty() {
            text += &format!(" No record tells it from {}.", list(&self.equivalents));
        }
        if let Some(none) = self.none_of_these.filter(|none| *none > 0.05) {
            text += &format!(
                " With a probability of {} % the cause is outside of the catalogue.",
                significant(100.0 * none, 2)
            );
        }
        text
    }
}

impl Size {
    fn words(&self) -> String {
        let unit = if self.unit == "1" { "" } else { &self.unit };
        let value = match self.sigma {
            Some(sigma) => gyrocal_statistics::format::estimate(self.value, sigma).join(" ± "),
            None => significant(self.value, 4),
        };
        let text = format!("{} {value} {unit}", self.name);
        text.trim_end().to_owned()
    }
}

impl Unexplained {
    fn sentence(&self) -> String {
        format!(
            "In {}: {}, {} {} (ln p {:.0}).",
            self.channel,
            self.form,
            significant(self.size, 3),
            self.unit,
            self.ln_p_value
        )
    }
}

impl Comparison {
    fn sentence(&self, has: bool) -> String {
        if !has {
            return "Nothing was found, so there is no gain on the second record to be measured."
                .to_owned();
        }
        let errors: Vec<String> = self
            .errors
            .iter()
            .map(|error| {
                format!(
                    "output {} is off by {} instead of {} {} rms",
                    error.output,
                    significant(error.extended, 3),
                    significant(error.nominal, 3),
                    error.unit
                )
            })
            .collect();
        let judged = if self.gain_nats >= LEAST_GAIN {
            "what was found holds there"
        } else if self.gain_nats > -LEAST_GAIN {
            "the second record tells nothing of it"
        } else {
            "what was found does not hold there"
        };
        format!(
            "On the second record ({} rows), predicted with the parameters of the first, the gain is {:.1} \
             nats: {judged}. Simulated over {} s, {}.",
            self.rows,
            self.gain_nats,
            significant(self.horizon_s, 4),
            errors.join(", ")
        )
    }
}
