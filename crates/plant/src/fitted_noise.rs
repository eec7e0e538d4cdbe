//! Noise of a fit.

use gyrocal_inference::{Correlated, FurtherNoise, Process};

/// Noise of a fit: sizes of what the plant declares, and what it does not declare.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FittedNoise {
    /// Variances over the declared ones: outputs, then noises of rates. Then those of `process` and `correlated` over
    /// the sizes that stand there.
    pub(crate) factors: Vec<f64>,
    /// Process noise that the plant does not declare.
    pub(crate) process: Vec<Process>,
    /// Correlated noise of outputs.
    pub(crate) correlated: Vec<Correlated>,
    /// Further variance of each state in each step, while a fit is on its way; none else.
    pub(crate) loose: Vec<f64>,
}

impl FittedNoise {
    /// Declared noise alone, of these standard deviations over the declared ones.
    pub(crate) fn of(ratios: &[f64]) -> Self {
        Self {
            factors: ratios.iter().map(|ratio| ratio * ratio).collect(),
            process: Vec::new(),
            correlated: Vec::new(),
            loose: Vec::new(),
        }
    }

    /// Whether it is what the plant declares.
    pub(crate) fn is_declared(&self) -> bool {
        self.process.is_empty() && self.correlated.is_empty()
    }

    /// Number of noises that the plant declares.
    pub(crate) fn declared(&self) -> usize {
        self.factors.len() - self.process.len() - self.correlated.len()
    }

    /// The declared part, with further variance of the states.
    pub(crate) fn loosened(&self, loose: Vec<f64>) -> Self {
        Self {
            factors: self.factors[..self.declared()].to_vec(),
            loose,
            ..Self::of(&[])
        }
    }

    /// Standard deviations of the declared noises over the declared ones.
    pub(crate) fn ratios(&self) -> Vec<f64> {
        let declared = self.factors[..self.declared()].iter();
        declared.map(|factor| factor.sqrt()).collect()
    }

    /// All unknowns as positive numbers: standard deviations of all noises over their sizes, then correlation times,
    /// s.
    pub(crate) fn unknowns(&self) -> Vec<f64> {
        let sizes = self.factors.iter().map(|factor| factor.sqrt());
        sizes
            .chain(self.correlated.iter().map(|one| one.time_s))
            .collect()
    }

    /// The same noises with other [`Self::unknowns`].
    pub(crate) fn with_unknowns(&self, unknowns: &[f64]) -> Self {
        let (sizes, times) = unknowns.split_at(self.factors.len());
        let correlated = self.correlated.iter().zip(times);
        Self {
            factors: sizes.iter().map(|size| size * size).collect(),
            correlated: correlated
                .map(|(one, time_s)| Correlated {
                    time_s: *time_s,
                    ..*one
                })
                .collect(),
            ..self.clone()
        }
    }

    /// The same with a correlation time.
    pub(crate) fn with_time(&self, index: usize, time_s: f64) -> Self {
        let mut changed = self.clone();
        changed.correlated[index].time_s = time_s;
        changed
    }

    /// Variance of the correlated noise of an output.
    pub(crate) fn correlated_variance(&self, output: usize) -> f64 {
        let first = self.factors.len() - self.correlated.len();
        let all = self.correlated.iter().zip(&self.factors[first..]);
        all.filter(|(one, _)| one.output == output)
            .map(|(one, factor)| one.variance * factor)
            .sum()
    }

    /// What a pass is to know of it beyond its factors.
    pub(crate) fn further(&self) -> FurtherNoise<'_> {
        FurtherNoise {
            process: &self.process,
            correlated: &self.correlated,
            ..FurtherNoise::default()
        }
    }
}
