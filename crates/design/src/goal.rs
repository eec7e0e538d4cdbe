//! The goal of a run.

use gyrocal::generated::platform::DRIFT;

use crate::error::DesignError;
use crate::result::Outlook;

/// A set counts as resolved if one member is left with this probability.
const RESOLVED: f64 = 0.95;

/// Goal of a run; empty by default.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Goal {
    /// Coefficients by id, with the standard deviation that each is to have at most.
    pub sigmas: Vec<(String, f64)>,
    /// Whether one name is to be left of every set, with a probability of 95 %.
    pub one_name: bool,
}

impl Goal {
    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.sigmas.is_empty() && !self.one_name
    }

    pub(crate) fn check(&self) -> Result<(), DesignError> {
        for (name, _) in &self.sigmas {
            if !DRIFT.iter().any(|coefficient| coefficient.id == name) {
                let known: Vec<&str> = DRIFT.iter().map(|coefficient| coefficient.id).collect();
                return Err(DesignError::UnknownCoefficient {
                    name: name.clone(),
                    known: known.join(", "),
                });
            }
        }
        Ok(())
    }

    /// The goal in words; `None` if there is none.
    #[must_use]
    pub fn in_words(&self) -> Option<String> {
        let sigmas = self.sigmas.iter();
        let sigmas = sigmas.map(|(id, sigma)| format!("a sigma of {id} of at most {sigma:e}"));
        let one_name = self
            .one_name
            .then(|| "one member in each confidence set with a probability of 95 %".to_owned());
        let wishes: Vec<String> = sigmas.chain(one_name).collect();
        (!wishes.is_empty()).then(|| wishes.join(" and "))
    }

    pub(crate) fn is_met(&self, outlook: &Outlook) -> bool {
        let small = self.sigmas.iter().all(|(name, wanted)| {
            let mut found = outlook.coefficients.iter();
            found.any(|coefficient| coefficient.name == *name && coefficient.sigma <= *wanted)
        });
        let resolved = outlook.sets.iter().all(|set| set.one_left >= RESOLVED);
        small && (resolved || !self.one_name)
    }
}
