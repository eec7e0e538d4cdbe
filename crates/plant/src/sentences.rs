//! The answer of a diagnosis in sentences.

use gyrocal_statistics::format::{p_value, significant};

use crate::answer::{
    Comparison, CrossValidation, Diagnosis, Found, NextRun, OutputError, RecordAnswer, Size,
    Unexplained,
};

/// Gain on a later record, nats, below which nothing is said of it.
const LEAST_GAIN: f64 = 3.0;

/// A remainder rarer than this is told.
const RARE: f64 = 0.001;

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
        all.extend(
            self.records
                .iter()
                .map(|one| ("record", one.sentence(self.has_findings()))),
        );
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
        if let Some(parts) = &self.cross_validation {
            all.push(("parts", parts.sentence()));
        }
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
        let next = self.next_runs.iter();
        all.extend(next.map(|one| ("next run", one.sentence())));
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
            0 if self.unexplained.is_empty() => {
                let of_records = match self.records.len() {
                    0 => String::new(),
                    count => format!(" of {count} records"),
                };
                format!(
                    "Nothing is found that {} lacks: {tested} effects were tested on {rows} rows{of_records}.",
                    self.plant
                )
            }
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

impl RecordAnswer {
    fn sentence(&self, has: bool) -> String {
        let errors: Vec<String> = self
            .errors
            .iter()
            .map(|error| {
                format!(
                    "{} is off by {} {} rms with the nominal model{}",
                    error.output,
                    significant(error.nominal, 3),
                    error.unit,
                    with_findings(error, has)
                )
            })
            .collect();
        format!(
            "{}, {} rows: output {}. Alone: {}",
            self.name,
            self.rows,
            errors.join(", "),
            self.alone.verdict
        )
    }
}

impl Found {
    /// The effect with its size, significance and set, a sentence or more.
    #[must_use]
    pub fn sentence(&self) -> String {
        let mut sizes: Vec<String> = self.sizes.iter().map(Size::words).collect();
        sizes.extend(self.record.map(|record| format!("in record {record}")));
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
    /// Name, value, standard deviation and unit.
    #[must_use]
    pub fn words(&self) -> String {
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
    /// A sentence.
    #[must_use]
    pub fn sentence(&self) -> String {
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

/// What a gain says of what was found; `tells` are the words for what is left open.
fn judged(gain_nats: f64, tells: &str) -> String {
    if gain_nats >= LEAST_GAIN {
        "what was found holds there".to_owned()
    } else if gain_nats > -LEAST_GAIN {
        format!("{tells} nothing of it")
    } else {
        "what was found does not hold there".to_owned()
    }
}

impl CrossValidation {
    /// Sum over the parts that can be predicted, nats.
    #[must_use]
    pub fn gain_nats(&self) -> f64 {
        self.gains_nats.iter().flatten().sum()
    }

    /// The gain in words.
    #[must_use]
    pub fn sentence(&self) -> String {
        let parts = self.gains_nats.len();
        let alone = self.gains_nats.iter().filter(|gain| gain.is_none()).count();
        if alone == parts {
            return format!(
                "Without any of {parts} parts the others do not determine what was found."
            );
        }
        let gain = self.gain_nats();
        let words = format!(
            "Each of {parts} parts predicted from the others, the gain is {gain:.1} nats: {}.",
            judged(gain, "they tell")
        );
        match alone {
            0 => words,
            1 => format!("{words} One part is left out: only there is shown what was found."),
            more => format!("{words} {more} parts are left out: only they show what was found."),
        }
    }
}

impl NextRun {
    /// The forecast, a sentence or two.
    #[must_use]
    pub fn sentence(&self) -> String {
        let told = self.told_apart.iter().map(|one| {
            format!(
                " It tells {} from {} with a probability of {} % ({} standard deviations apart, now {}).",
                one.effect,
                one.rival,
                significant(100.0 * one.probability, 2),
                significant(one.after, 2),
                significant(one.now, 2),
            )
        });
        format!(
            "{} ({} rows, {} s) brings standard deviations to {} of what they are (geometric mean).{}",
            self.name,
            self.rows,
            significant(self.duration_s, 4),
            significant(self.mean_ratio(), 2),
            told.collect::<String>()
        )
    }
}

impl Comparison {
    /// The gain in words; `has` tells whether anything was found.
    #[must_use]
    pub fn sentence(&self, has: bool) -> String {
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
        let judged = judged(self.gain_nats, "the second record tells");
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
