//! Hypotheses: the effects that are tested, each with the signatures that stand for it.

use gyrocal_scalar::effect::{Effect, EffectKind, Role};
use gyrocal_statistics::math::pow;

use crate::model::ModelExtension;
use crate::plant::Plant;
use crate::rows::Rows;
use crate::signature::{Source, signature};
use gyrocal_inference::Column;

/// Onsets on the grid of the search: they are two and a half percent of the record apart, across
/// which the statistic of a step falls by a few percent.
const ONSETS: usize = 40;

/// Fewest onsets in one of several records.
const LEAST_ONSETS: usize = 24;

/// Time constants on the grid of the search.
const TIME_CONSTANTS: usize = 10;

/// The shortest of them, h.
const SHORTEST_TIME_CONSTANT_H: f64 = 0.3;

/// One variant of a hypothesis: its signature at one onset or time constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// Its columns in the score bank.
    pub(crate) columns: Vec<usize>,
    /// Onset, s, or time constant, h, if the effect has one.
    pub(crate) shape: Option<f64>,
}

impl Variant {
    /// Onset, s, or time constant, h, if the effect has one.
    #[must_use]
    pub fn shape(&self) -> Option<f64> {
        self.shape
    }
}

/// An effect with all variants that are tested.
#[derive(Clone, Debug, PartialEq)]
pub struct Hypothesis {
    /// The effect.
    pub(crate) effect: &'static Effect,
    pub(crate) variants: Vec<Variant>,
    /// Whether it is a jump of states, which is tested in every step by itself.
    pub(crate) is_jump: bool,
    /// Whether it may be named: others are compared with what is named, in sets alone.
    pub(crate) can_be_named: bool,
}

impl Hypothesis {
    /// The same hypothesis, or one without variants if it is masked.
    pub(crate) fn masked(&self, masked: bool) -> Self {
        if !masked {
            return self.clone();
        }
        Self {
            effect: self.effect,
            variants: Vec::new(),
            is_jump: false,
            can_be_named: self.can_be_named,
        }
    }

    /// The effect.
    #[must_use]
    pub fn effect(&self) -> &'static Effect {
        self.effect
    }

    /// Public id of the effect.
    #[must_use]
    pub fn id(&self) -> &'static str {
        self.effect.id
    }

    /// Its variants.
    #[must_use]
    pub fn variants(&self) -> &[Variant] {
        &self.variants
    }
}

/// An effect that a record cannot show, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unavailable {
    /// Public id of the effect.
    pub effect: &'static str,
    /// The missing data.
    pub why: String,
}

/// Effects that are tested in a record.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Selection {
    /// Effects to test, in the order of the plant's table.
    pub effects: Vec<&'static Effect>,
    /// Effects that are not named, and that a set holds where the record does not tell them from a named one.
    pub rivals: Vec<&'static Effect>,
    /// Effects that the record cannot show.
    pub unavailable: Vec<Unavailable>,
}

/// All hypotheses that are tested in a record.
#[derive(Clone, Debug, PartialEq)]
pub struct HypothesisSet {
    pub(crate) hypotheses: Vec<Hypothesis>,
    /// Columns beside the parameters of the model; in the bank they follow these.
    pub(crate) extra: Vec<Column>,
    /// Rows of these onsets.
    pub(crate) onset_rows: Vec<usize>,
}

impl HypothesisSet {
    /// The hypotheses of some effects over a record.
    #[must_use]
    pub fn new(plant: &Plant, rows: &Rows, effects: &[&'static Effect]) -> Self {
        let onsets = (ONSETS / (rows.starts.len() + 1)).max(LEAST_ONSETS);
        let mut onset_rows: Vec<usize> = rows
            .records()
            .flat_map(|record| {
                let last = record.len().saturating_sub(1);
                (1..=onsets)
                    .map(move |index| index * last / (onsets + 1))
                    .filter(|row| *row > 0)
                    .map(move |row| record.start + row)
            })
            .collect();
        onset_rows.dedup();
        let mut set = Self {
            hypotheses: Vec::new(),
            extra: Vec::new(),
            onset_rows,
        };
        for effect in effects {
            set.add(plant, rows, effect);
        }
        set
    }

    /// The hypotheses.
    #[must_use]
    pub fn hypotheses(&self) -> &[Hypothesis] {
        &self.hypotheses
    }

    /// Rows of the onsets that steps are tested at.
    #[must_use]
    pub fn onset_rows(&self) -> &[usize] {
        &self.onset_rows
    }

    fn add(&mut self, plant: &Plant, rows: &Rows, effect: &'static Effect) {
        // A random walk is noise and has no signature.
        if effect.kind == EffectKind::RandomWalk {
            return;
        }
        let is_jump = effect.kind == EffectKind::StateJump;
        let shapes: Vec<Option<f64>> = match effect.shape().map(|shape| shape.role) {
            _ if is_jump => Vec::new(),
            Some(Role::Onset(_)) => {
                let onsets = self.onset_rows.iter();
                onsets.map(|row| Some(rows.since_first_s(*row))).collect()
            }
            Some(_) => time_constants_h(rows.longest_record_s())
                .into_iter()
                .map(Some)
                .collect(),
            // Each record has a first row.
            None if effect.kind == EffectKind::InitialState && !rows.starts.is_empty() => {
                let firsts = rows.records().map(|record| record.start);
                firsts.map(|row| Some(rows.since_first_s(row))).collect()
            }
            None => vec![None],
        };
        let mut variants = Vec::with_capacity(shapes.len());
        for shape in shapes {
            let Some(sources) = signature(plant, effect, shape, rows) else {
                return;
            };
            let columns = sources.into_iter().map(|source| match source {
                Source::Parameter(parameter) => parameter,
                Source::Column(column) => {
                    self.extra.push(column);
                    plant.parameters.len() + self.extra.len() - 1
                }
            });
            variants.push(Variant {
                columns: columns.collect(),
                shape,
            });
        }
        self.hypotheses.push(Hypothesis {
            effect,
            variants,
            is_jump,
            can_be_named: true,
        });
    }

    /// Adds hypotheses that are compared with what is named, and not named.
    pub(crate) fn add_rivals(&mut self, plant: &Plant, rows: &Rows, rivals: &[&'static Effect]) {
        let first = self.hypotheses.len();
        for effect in rivals {
            self.add(plant, rows, effect);
        }
        for own in &mut self.hypotheses[first..] {
            own.can_be_named = false;
        }
    }

    /// The same hypotheses with the columns of those that are `kept` alone: the others have no variant.
    pub(crate) fn restricted(&self, plant: &Plant, kept: impl Fn(&'static Effect) -> bool) -> Self {
        let first = plant.parameters.len();
        let mut set = Self {
            hypotheses: Vec::with_capacity(self.hypotheses.len()),
            extra: Vec::new(),
            onset_rows: self.onset_rows.clone(),
        };
        for hypothesis in &self.hypotheses {
            let mut own = hypothesis.masked(!kept(hypothesis.effect));
            let columns = own.variants.iter_mut().flat_map(|own| &mut own.columns);
            for column in columns.filter(|column| **column >= first) {
                set.extra.push(self.extra[*column - first].clone());
                *column = first + set.extra.len() - 1;
            }
            set.hypotheses.push(own);
        }
        set
    }

    /// Whether a hypothesis is an exact equivalent of one of some others.
    pub(crate) fn is_equivalent(&self, hypothesis: usize, others: &[usize]) -> bool {
        let id = self.hypotheses[hypothesis].id();
        let mut others = others.iter();
        others.any(|other| self.hypotheses[*other].effect.equivalents.contains(&id))
    }

    /// Index of the hypothesis of an effect.
    #[must_use]
    pub fn index_of(&self, effect: &str) -> Option<usize> {
        self.hypotheses.iter().position(|one| one.id() == effect)
    }

    /// Adds a hypothesis to a model, at an onset or with a time constant if it has one.
    pub fn add_to_model(
        &self,
        plant: &Plant,
        rows: &Rows,
        extension: &mut ModelExtension,
        hypothesis: usize,
        shape: Option<f64>,
    ) {
        let own = &self.hypotheses[hypothesis];
        if own.effect.has_term() {
            for parameter in own.effect.estimated_parameters() {
                extension.parameters.push((parameter, f64::INFINITY));
            }
            if let (Some(own), Some(shape)) = (own.effect.shape(), shape) {
                extension.set_role(own.role, shape);
            }
            return;
        }
        let sources = signature(plant, own.effect, shape, rows).unwrap_or_default();
        let columns = sources.into_iter().filter_map(|source| match source {
            Source::Column(column) => Some(column),
            Source::Parameter(_) => None,
        });
        extension.columns.extend(columns, f64::INFINITY);
    }
}

/// From the shortest to half the record, in equal ratios.
fn time_constants_h(duration_s: f64) -> Vec<f64> {
    let longest_h = (0.5 * duration_s / 3600.0).max(2.0 * SHORTEST_TIME_CONSTANT_H);
    let ratio = longest_h / SHORTEST_TIME_CONSTANT_H;
    (0..TIME_CONSTANTS)
        .map(|index| {
            SHORTEST_TIME_CONSTANT_H * pow(ratio, index as f64 / (TIME_CONSTANTS - 1) as f64)
        })
        .collect()
}
