//! What an effect does in a record, and in the run after it.

use gyrocal::EffectRow;
use gyrocal_calibration::BIASES;

use super::named::is_walk;
use super::piece::Piece;
use crate::cause::{KNOCK, axis_of, parameter};

/// A sum of pieces.
pub(crate) type Sum = Vec<(Piece, f64)>;

/// One unknown size of an effect: what a unit of it does in the record, and in the next run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Size {
    pub(crate) first: Sum,
    pub(crate) next: Sum,
}

/// When the runs are.
#[derive(Clone, Debug)]
pub(crate) struct Times {
    /// Duration of the record, s.
    pub(crate) first_s: f64,
    /// Duration of the next run, s.
    pub(crate) next_s: f64,
    /// Onsets that a random walk is made up from in the record, s.
    pub(crate) onsets_s: Vec<f64>,
}

/// The sizes of an effect; `shape` is its onset in s or time constant in h, if it has one.
pub(crate) fn sizes(row: &EffectRow, shape: Option<f64>, times: &Times) -> Vec<Size> {
    let same = |piece: Piece| Size {
        first: vec![(piece.clone(), 1.0)],
        next: vec![(piece, 1.0)],
    };
    let once = |piece: Piece| Size {
        first: vec![(piece, 1.0)],
        next: Vec::new(),
    };
    if row.id == "platform.initial_attitude" {
        return (0..3).map(|axis| once(Piece::Start(axis))).collect();
    }
    if row.id == KNOCK {
        let onset_s = shape.unwrap_or(0.0);
        let jump = |axis| once(Piece::Jump { onset_s, axis });
        return (0..3).map(jump).collect();
    }
    if is_walk(row) {
        return axis_of(row.id).map_or_else(Vec::new, |axis| walk(BIASES[axis], times));
    }
    if let (Some(axis), Some(shape)) = (axis_of(row.id), shape) {
        let parameter = BIASES[axis];
        if row.id.ends_with(".step") {
            let onset = Piece::Onset {
                parameter,
                onset_s: shape,
            };
            return vec![Size {
                first: vec![(onset, 1.0)],
                next: vec![(Piece::Parameter(parameter), 1.0)],
            }];
        }
        if row.id.ends_with(".warmup") {
            return vec![same(Piece::WarmUp {
                parameter,
                time_constant_h: shape,
            })];
        }
    }
    let states = row.states.iter().filter_map(|id| parameter(id));
    let sizes = states.map(|state| same(Piece::Parameter(state)));
    let mut sizes: Vec<Size> = sizes.collect();
    // What grows with time has grown when the record ends.
    if let Some(channel) = row.id.strip_suffix(".ramp")
        && let (Some(bias), [size]) = (parameter(&format!("{channel}.bias")), sizes.as_mut_slice())
    {
        let grown = times.first_s / 86_400.0;
        size.next.push((Piece::Parameter(bias), grown));
    }
    sizes
}

/// Increments at onsets: those of the record stay, the next run has its own. All have one
/// variance, so those of longer intervals count for more.
fn walk(parameter: usize, times: &Times) -> Vec<Size> {
    let mut sizes: Vec<Size> = times
        .onsets_s
        .iter()
        .map(|onset_s| Size {
            first: vec![(
                Piece::Onset {
                    parameter,
                    onset_s: *onset_s,
                },
                1.0,
            )],
            next: vec![(Piece::Parameter(parameter), 1.0)],
        })
        .collect();
    let ratio = times.next_s / times.first_s;
    sizes.extend(times.onsets_s.iter().map(|onset_s| Size {
        first: Vec::new(),
        next: vec![(
            Piece::Onset {
                parameter,
                onset_s: onset_s * ratio,
            },
            ratio.sqrt(),
        )],
    }));
    sizes
}
