//! Families of signatures: which columns stand for which effect.

use std::sync::Arc;

use gyrocal::Effect;
use gyrocal::effect::{EffectKind, Need};
use gyrocal::generated::catalogue::{EFFECTS, PARAMETERS, RATES};
use gyrocal_calibration::{Column, Extension};
use gyrocal_record::{Bench, Record};

/// Onsets that a step is looked for at: two and a half percent of the record apart, across
/// which its statistic falls by a few percent.
const ONSETS: usize = 40;

/// Time constants that a warm-up is looked for at.
const TIME_CONSTANTS: usize = 10;

/// The shortest of them, h.
const SHORTEST_TIME_CONSTANT_H: f64 = 0.3;

/// One signature, or several that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Its columns in the bank.
    pub(crate) columns: Vec<usize>,
    /// Onset in s or time constant in h, if the family has one.
    pub(crate) shape: Option<f64>,
}

/// An effect with all its candidates.
#[derive(Clone, Debug, PartialEq)]
pub struct Family {
    /// The effect.
    pub(crate) effect: &'static Effect,
    pub(crate) candidates: Vec<Candidate>,
    /// Of a random walk the columns of steps that it is made up from.
    pub(crate) walk: Option<Vec<usize>>,
    /// Whether it is a knock, which is looked for in every step by itself.
    pub(crate) knock: bool,
}

impl Family {
    /// The same family, or with nothing to look for.
    pub(crate) fn unless(&self, taken: bool) -> Self {
        Self {
            effect: self.effect,
            candidates: if taken {
                Vec::new()
            } else {
                self.candidates.clone()
            },
            walk: if taken { None } else { self.walk.clone() },
            knock: self.knock && !taken,
        }
    }

    /// Public id of the effect.
    #[must_use]
    pub fn id(&self) -> &'static str {
        self.effect.id
    }
}

/// An effect that cannot be looked for in a record, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unavailable {
    /// Public id of the effect.
    pub effect: &'static str,
    /// What is missing.
    pub why: String,
}

/// What is looked for in a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    pub(crate) families: Vec<Family>,
    /// Columns beside the catalogue's own parameters. Their place in the bank follows these.
    pub(crate) further: Vec<Column>,
    /// What cannot be looked for.
    pub(crate) unavailable: Vec<Unavailable>,
    /// For each gyro the columns of its steps, in the order of their onsets.
    pub(crate) steps: [Vec<usize>; 3],
    /// Rows of these onsets.
    pub(crate) onset_rows: Vec<usize>,
}

impl Plan {
    /// For a record: effects of the default search and those that `also` names.
    #[must_use]
    pub fn new(record: &Record, bench: &Bench, also: &[&str]) -> Self {
        let rows = record.len();
        let first_s = record.time_s.first().copied().unwrap_or(0.0);
        let last_s = record.time_s.last().copied().unwrap_or(0.0);
        let mut plan = Self {
            families: Vec::new(),
            further: Vec::new(),
            unavailable: Vec::new(),
            steps: Default::default(),
            onset_rows: (1..=ONSETS)
                .map(|index| index * (rows - 1) / (ONSETS + 1))
                .filter(|row| *row > 0)
                .collect(),
        };
        plan.onset_rows.dedup();
        let base = PARAMETERS.len();
        let mut walks = Vec::new();
        for effect in &EFFECTS {
            if !(effect.default_search || also.contains(&effect.id)) {
                continue;
            }
            if let Some(why) = missing(effect, record, bench) {
                plan.unavailable.push(Unavailable {
                    effect: effect.id,
                    why,
                });
                continue;
            }
            let candidates = match (effect.kind, effect.rate()) {
                (EffectKind::InitialState, _) => {
                    let first = base + plan.further.len();
                    plan.further
                        .extend([0, 1, 2].map(|axis| Column::Start { axis }));
                    vec![Candidate {
                        columns: (first..first + 3).collect(),
                        shape: None,
                    }]
                }
                (EffectKind::RandomWalk, _) => {
                    walks.push(effect);
                    continue;
                }
                (EffectKind::StateJump, _) => Vec::new(),
                (EffectKind::Step, Some(axis)) => {
                    let onsets = plan.onset_rows.clone();
                    onsets
                        .into_iter()
                        .map(|row| {
                            let column = base + plan.further.len();
                            plan.further.push(Column::Onset {
                                parameter: RATES[axis].constant,
                                row,
                            });
                            plan.steps[axis].push(column);
                            Candidate {
                                columns: vec![column],
                                shape: Some(record.time_s[row] - first_s),
                            }
                        })
                        .collect()
                }
                (EffectKind::Exponential, Some(axis)) => time_constants_h(last_s - first_s)
                    .into_iter()
                    .map(|time_constant_h| {
                        let column = base + plan.further.len();
                        plan.further
                            .push(warm_up(record, RATES[axis].constant, time_constant_h));
                        Candidate {
                            columns: vec![column],
                            shape: Some(time_constant_h),
                        }
                    })
                    .collect(),
                _ if effect.has_term() => vec![Candidate {
                    columns: effect.model_parameters().collect(),
                    shape: None,
                }],
                _ => continue,
            };
            plan.families.push(Family {
                effect,
                candidates,
                walk: None,
                knock: effect.kind == EffectKind::StateJump,
            });
        }
        // Last, as what every slow cause looks like.
        for effect in walks {
            let Some(axis) = effect.rate() else {
                continue;
            };
            plan.families.push(Family {
                effect,
                candidates: Vec::new(),
                walk: Some(plan.steps[axis].clone()),
                knock: false,
            });
        }
        plan
    }

    /// Time between the onsets that a random walk is made up from, h.
    pub(crate) fn onset_interval_h(&self, record: &Record) -> f64 {
        match self.onset_rows.as_slice() {
            [first, .., last] => {
                (record.time_s[*last] - record.time_s[*first])
                    / (3600.0 * (self.onset_rows.len() - 1) as f64)
            }
            _ => 1.0,
        }
    }
}

/// What a family adds to a model: at an onset or with a time constant, or, for a random walk,
/// with the variance of its increments from onset to onset.
pub(crate) fn extend(
    plan: &Plan,
    record: &Record,
    extension: &mut Extension,
    family: usize,
    shape: Option<f64>,
) {
    let effect = plan.families[family].effect;
    if let (EffectKind::StateJump, Some(onset_s)) = (effect.kind, shape) {
        extension
            .further
            .extend(jump(record, onset_s), f64::INFINITY);
        return;
    }
    if effect.kind == EffectKind::InitialState {
        let columns = [0, 1, 2].map(|axis| Column::Start { axis });
        extension.further.extend(columns, f64::INFINITY);
        return;
    }
    if let (EffectKind::RandomWalk, Some(axis), Some(variance)) =
        (effect.kind, effect.rate(), shape)
    {
        let steps = plan.steps[axis].iter();
        let columns = steps.map(|column| plan.further[column - PARAMETERS.len()].clone());
        extension.further.extend(columns, variance.sqrt());
        return;
    }
    for parameter in effect.model_parameters() {
        extension.parameters.push((parameter, f64::INFINITY));
    }
    let place = effect.shape().and_then(|own| own.role.shape_index());
    if let (Some(place), Some(shape)) = (place, shape) {
        extension.shapes[place] = shape;
    }
}

/// A turn in the step that ends at an onset, about each axis.
pub(crate) fn jump(record: &Record, onset_s: f64) -> [Column; 3] {
    let first_s = record.time_s.first().copied().unwrap_or(0.0);
    let end = record
        .time_s
        .partition_point(|time_s| time_s - first_s < onset_s);
    let row = end.saturating_sub(1).min(record.len().saturating_sub(2));
    [0, 1, 2].map(|axis| Column::Jump { row, axis })
}

/// Index of a parameter of the catalogue's model by its public id.
pub(crate) fn parameter(id: &str) -> Option<usize> {
    PARAMETERS.iter().position(|element| element.id == id)
}

/// What an effect needs and the record or its bench does not have.
pub(crate) fn missing(effect: &Effect, record: &Record, bench: &Bench) -> Option<String> {
    for need in effect.needs {
        match need {
            Need::Column(name) if record.temperature_c.is_none() => {
                return Some(format!("the record has no column `{name}`"));
            }
            Need::Column(name) if !record.temperature_changes() => {
                return Some(format!("the column `{name}` never changes"));
            }
            Need::Key(key) if bench.magnetic_field_gauss.is_none() => {
                return Some(format!("the bench file has no `{key}` in `[site]`"));
            }
            _ => {}
        }
    }
    None
}

/// Whether a family cannot be told from one that is in the model.
pub(super) fn equivalent_to(plan: &Plan, family: usize, taken: &[usize]) -> bool {
    let id = plan.families[family].effect.id;
    taken
        .iter()
        .any(|other| plan.families[*other].effect.equivalents.contains(&id))
}

/// From the shortest to half the record, in equal ratios.
fn time_constants_h(duration_s: f64) -> Vec<f64> {
    let longest_h = (0.5 * duration_s / 3600.0).max(2.0 * SHORTEST_TIME_CONSTANT_H);
    let ratio = longest_h / SHORTEST_TIME_CONSTANT_H;
    (0..TIME_CONSTANTS)
        .map(|index| {
            SHORTEST_TIME_CONSTANT_H * ratio.powf(index as f64 / (TIME_CONSTANTS - 1) as f64)
        })
        .collect()
}

/// The course of a warm-up, taken in the middle of each step as the model does.
pub(crate) fn warm_up(record: &Record, parameter: usize, time_constant_h: f64) -> Column {
    let first_s = record.time_s.first().copied().unwrap_or(0.0);
    Column::Course {
        parameter,
        steps: record
            .time_s
            .windows(2)
            .map(|pair| {
                let middle_s = 0.5 * (pair[0] + pair[1]) - first_s;
                (-middle_s / (3600.0 * time_constant_h)).exp()
            })
            .collect(),
    }
}

/// Share of a time constant over which its derivative is taken.
const NEAR: f64 = 0.05;

/// What an effect with an onset, s, or a time constant, h, does to first order when its size and
/// that change: one column each.
pub(super) fn with_shape(
    record: &Record,
    effect: &Effect,
    shape: f64,
    size: f64,
) -> Option<[Column; 2]> {
    let parameter = RATES[effect.rate()?].constant;
    if effect.kind == EffectKind::Exponential {
        let of = |time_constant_h: f64| match warm_up(record, parameter, time_constant_h) {
            Column::Course { steps, .. } => steps,
            _ => Arc::default(),
        };
        let (before, after) = (of((1.0 - NEAR) * shape), of((1.0 + NEAR) * shape));
        let slopes = before.iter().zip(after.iter());
        let steps = slopes
            .map(|(before, after)| size * (after - before) / (2.0 * NEAR * shape))
            .collect();
        let change = Column::Course { parameter, steps };
        return Some([warm_up(record, parameter, shape), change]);
    }
    if effect.kind != EffectKind::Step {
        return None;
    }
    let first_s = record.time_s.first().copied()?;
    let rows = record.len();
    let row = record.time_s.partition_point(|t| t - first_s < shape);
    // From one onset that is looked at to the next: nearer ones are not told apart.
    let (from, to) = (
        row.saturating_sub(rows / (2 * ONSETS)),
        (row + rows / (2 * ONSETS)).min(rows - 1),
    );
    let width_s = record.time_s[to] - record.time_s[from];
    let later = |step: usize| {
        if (from..to).contains(&step) {
            -size / width_s
        } else {
            0.0
        }
    };
    let change = Column::Course {
        parameter,
        steps: (0..rows.saturating_sub(1)).map(later).collect(),
    };
    Some([Column::Onset { parameter, row }, change])
}
