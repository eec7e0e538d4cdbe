//! Columns of a planned run, before its rows are known.

use gyrocal::Effect;
use gyrocal::effect::{EffectKind, Role};
use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal::generated::catalogue::RATES;
use gyrocal_calibration::PLATFORM;
use gyrocal_hypothesis::{Column, Rows, Source, signature};

/// A column by its meaning; its rows follow from the run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum DesignColumn {
    /// A parameter of the catalogue's model.
    Parameter(usize),
    /// A step of the drift of a gyro.
    Step {
        /// The gyro.
        rate: usize,
        /// Its onset, s.
        onset_s: f64,
    },
    /// A column of the signature of an effect.
    Signature {
        /// The effect.
        effect: &'static Effect,
        /// Its onset, s, or time constant, h.
        shape: Option<f64>,
        /// Index of the column.
        index: usize,
    },
    /// A further column of the fit, which belongs to its records alone.
    Fitted(usize),
    /// A parameter of the catalogue's model in the last record of the fit: its turn-on.
    OfLast(usize),
    /// A change in another record.
    Nothing,
}

impl DesignColumn {
    /// Whether it is of the last record of a fit alone.
    pub(crate) fn is_of_last(&self) -> bool {
        matches!(self, Self::OfLast(_))
    }

    /// The column of records as the last of them has it on its own clock, which starts this many seconds
    /// after that of all.
    pub(crate) fn in_last(&self, start_s: f64) -> Self {
        let own = |onset_s: f64| onset_s >= start_s;
        match self {
            Self::Step { rate, onset_s } if own(*onset_s) => Self::Step {
                rate: *rate,
                onset_s: onset_s - start_s,
            },
            Self::Signature {
                effect,
                shape: Some(shape),
                index,
            } if begins(effect) && own(*shape) => Self::Signature {
                effect,
                shape: Some(shape - start_s),
                index: *index,
            },
            Self::Step { .. } => Self::Nothing,
            Self::Signature { effect, .. } if begins(effect) => Self::Nothing,
            other => other.clone(),
        }
    }

    /// Whether another record of the platform has it too, as this one does.
    pub(crate) fn recurs(&self) -> bool {
        match self {
            Self::Parameter(_) => true,
            Self::Signature { effect, .. } => !begins(effect),
            _ => false,
        }
    }

    /// The column in a run with these rows; `None` for those that the pass has anyway.
    pub(crate) fn column(&self, rows: &Rows) -> Option<Column> {
        match self {
            Self::Parameter(_) | Self::Fitted(_) | Self::OfLast(_) | Self::Nothing => None,
            Self::Step { rate, onset_s } => Some(Column::Step {
                parameter: RATES[*rate].constant,
                row: rows.rows_before(*onset_s),
            }),
            Self::Signature {
                effect,
                shape,
                index,
            } => match signature(&PLATFORM, effect, *shape, rows)?.swap_remove(*index) {
                Source::Column(column) => Some(column),
                Source::Parameter(_) => None,
            },
        }
    }
}

/// Whether an effect begins at one time in one record.
pub(crate) fn begins(effect: &Effect) -> bool {
    matches!(
        effect.kind,
        EffectKind::InitialState | EffectKind::StateJump
    ) || matches!(effect.shape().map(|own| own.role), Some(Role::Onset(_)))
}

/// The columns of a run: parameters of the model by their index, and others.
pub(crate) struct RunColumns {
    /// Parameters, each once.
    pub(crate) active: Vec<usize>,
    /// The others.
    pub(crate) further: Vec<Column>,
    /// Place of each design column: among the active parameters first, then the further columns;
    /// `None` for one that is none of this run.
    pub(crate) places: Vec<Option<usize>>,
}

impl RunColumns {
    /// Of design columns in a run. Columns that are proportional to a parameter need it to be active:
    /// the pass has its effect in each step only then.
    pub(crate) fn new(columns: &[DesignColumn], rows: &Rows) -> Self {
        let made: Vec<Option<Column>> = columns.iter().map(|column| column.column(rows)).collect();
        let mut active: Vec<usize> = columns
            .iter()
            .zip(&made)
            .filter_map(|pair| match pair {
                (DesignColumn::Parameter(parameter) | DesignColumn::OfLast(parameter), _)
                | (_, Some(Column::Step { parameter, .. }))
                | (_, Some(Column::TimeProfile { parameter, .. })) => Some(*parameter),
                _ => None,
            })
            .collect();
        active.sort_unstable();
        active.dedup();
        debug_assert!(active.iter().all(|parameter| *parameter < PARAMETERS.len()));
        let mut further = Vec::new();
        let places = columns
            .iter()
            .zip(made)
            .map(|pair| match pair {
                (_, Some(column)) => {
                    further.push(column);
                    Some(active.len() + further.len() - 1)
                }
                (DesignColumn::Parameter(parameter) | DesignColumn::OfLast(parameter), None) => {
                    Some(active.partition_point(|other| other < parameter))
                }
                (_, None) => None,
            })
            .collect();
        Self {
            active,
            further,
            places,
        }
    }
}
