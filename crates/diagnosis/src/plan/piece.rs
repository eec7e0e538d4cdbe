//! Columns of a run that does not have its rows yet.

use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal_calibration::Column;
use gyrocal_record::Record;

use crate::cause::{jump, warm_up};

/// A column by what it is; which rows it means depends on the run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Piece {
    /// A parameter of the catalogue's model.
    Parameter(usize),
    /// The first attitude, about an axis.
    Start(usize),
    /// A knock about an axis.
    Jump { onset_s: f64, axis: usize },
    /// A parameter from a time on.
    Onset { parameter: usize, onset_s: f64 },
    /// A parameter that decays.
    WarmUp {
        parameter: usize,
        time_constant_h: f64,
    },
    /// A further column that the fit has already: of the first record only.
    Own(usize),
}

impl Piece {
    /// Its column in a run with these rows; `None` of what the pass has as a column anyway.
    pub(crate) fn column(&self, record: &Record) -> Option<Column> {
        let first_s = record.time_s.first().copied().unwrap_or(0.0);
        match self {
            Self::Parameter(_) | Self::Own(_) => None,
            Self::Start(axis) => Some(Column::Start { axis: *axis }),
            Self::Jump { onset_s, axis } => jump(record, *onset_s).into_iter().nth(*axis),
            Self::Onset { parameter, onset_s } => Some(Column::Onset {
                parameter: *parameter,
                row: record.time_s.partition_point(|t| t - first_s < *onset_s),
            }),
            Self::WarmUp {
                parameter,
                time_constant_h,
            } => Some(warm_up(record, *parameter, *time_constant_h)),
        }
    }
}

/// The columns of all pieces in a run: parameters of the model by their index, and others.
pub(crate) struct Columns {
    /// Parameters, each once.
    pub(crate) active: Vec<usize>,
    /// The others.
    pub(crate) further: Vec<Column>,
    /// For each piece its place: among the active parameters first, then the further columns.
    pub(crate) places: Vec<usize>,
}

impl Columns {
    /// Of pieces none of which is one of a fit's own. Columns that follow a parameter need it to
    /// be active: the pass knows what an active parameter does in each step.
    pub(crate) fn new(pieces: &[Piece], record: &Record) -> Self {
        let mut active: Vec<usize> = pieces
            .iter()
            .filter_map(|piece| match piece {
                Piece::Parameter(parameter)
                | Piece::Onset { parameter, .. }
                | Piece::WarmUp { parameter, .. } => Some(*parameter),
                _ => None,
            })
            .collect();
        active.sort_unstable();
        active.dedup();
        debug_assert!(active.iter().all(|parameter| *parameter < PARAMETERS.len()));
        let mut further = Vec::new();
        let places = pieces
            .iter()
            .map(|piece| match (piece, piece.column(record)) {
                (_, Some(column)) => {
                    further.push(column);
                    active.len() + further.len() - 1
                }
                (Piece::Parameter(parameter), None) => {
                    active.partition_point(|other| other < parameter)
                }
                (_, None) => usize::MAX,
            })
            .collect();
        Self {
            active,
            further,
            places,
        }
    }
}
