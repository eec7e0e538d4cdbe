//! What became of one record: a line in the file of results.

use serde::{Deserialize, Serialize};

use crate::methods::Called;

/// One record with what was hidden in it and what was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// What was hidden.
    pub hidden: Vec<HiddenCase>,
    /// `clean`, `effects-found` or `unexplained`.
    pub verdict: String,
    /// The causes that were named, strongest first.
    pub findings: Vec<FoundCase>,
    /// Noise that was called other than declared.
    pub noise: Vec<String>,
    /// What was left unexplained; `None` if the remainder is white.
    pub unexplained: Option<String>,
    /// Effects in the first set of an oracle that knows the noise; `None` if it finds nothing.
    pub oracle_set_size: Option<usize>,
    /// Twice the log-likelihood that each effect lacks to the best in the first search, after
    /// searching is allowed for: the nearest, rising, the best itself left out.
    pub nearest: Vec<f64>,
    /// What other methods say of the same record.
    pub methods: Vec<MethodCase>,
}

/// A hidden effect and its fate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HiddenCase {
    /// Its id.
    pub effect: String,
    /// Name and value of each parameter.
    pub parameters: Vec<(String, f64)>,
    /// Its length in sigmas of its own bound; of an effect that the catalogue does not hold, beside
    /// the causes that were named.
    pub strength: f64,
    /// Whether the set of some finding holds it.
    pub in_set: bool,
    /// What was named first: 1 if it is this effect or an exact equivalent, else the cosine of
    /// the angle between the two signatures; 0 without a finding.
    pub first_cosine: f64,
    /// Whether the 95 % intervals of its sizes hold them, given the right name.
    pub covered: Option<bool>,
    /// Distance of the onset from the true one over the length of the record, given the right name.
    pub onset_error: Option<f64>,
    /// Twice the log-likelihood that it lacks to the best in the first search.
    pub deficit: Option<f64>,
}

/// A cause that was named.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FoundCase {
    /// Its id.
    pub effect: String,
    /// Its statistic as a number of sigmas.
    pub z: f64,
    /// Name and estimate of each parameter.
    pub parameters: Vec<(String, f64)>,
    /// The rest of the set with twice the log-likelihood that each lacks.
    pub rivals: Vec<(String, f64)>,
    /// Exact equivalents that were listed.
    pub equivalents: Vec<String>,
    /// Whether the catalogue has an exact equivalent that was not listed.
    pub alone: bool,
}

/// What another method says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MethodCase {
    /// Its name.
    pub method: String,
    /// What it says.
    pub called: Called,
    /// As [`HiddenCase::first_cosine`], of the first hidden effect.
    pub first_cosine: f64,
}

impl Case {
    /// Whether any physical cause was named.
    #[must_use]
    pub fn detected(&self) -> bool {
        !self.findings.is_empty()
    }

    /// Effects in the first set, equivalents not counted; 0 without a finding.
    #[must_use]
    pub fn set_size(&self) -> usize {
        self.findings
            .first()
            .map_or(0, |finding| 1 + finding.rivals.len())
    }

    /// Whether each hidden effect stands in the set of a finding of its own.
    #[must_use]
    pub fn each_in_its_set(&self) -> bool {
        let holds = |finding: &FoundCase, hidden: &HiddenCase| finding.holds(&hidden.effect);
        match self.hidden.as_slice() {
            [one, other] => (0..self.findings.len()).any(|i| {
                holds(&self.findings[i], one)
                    && (0..self.findings.len()).any(|j| j != i && holds(&self.findings[j], other))
            }),
            hidden => hidden.iter().all(|hidden| hidden.in_set),
        }
    }
}

impl FoundCase {
    /// Whether the set holds an effect or an exact equivalent of it.
    #[must_use]
    pub fn holds(&self, effect: &str) -> bool {
        same(&self.effect, effect) || self.rivals.iter().any(|(rival, _)| same(rival, effect))
    }
}

/// Whether two ids are of one effect or of exact equivalents.
#[must_use]
pub fn same(one: &str, other: &str) -> bool {
    one == other
        || gyrocal::EFFECTS
            .iter()
            .any(|effect| effect.id == one && effect.equivalents.contains(&other))
}
