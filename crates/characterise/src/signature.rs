//! Which columns of the linearised model stand for an effect.

use gyrocal::Effect;
use gyrocal::effect::EffectKind;
use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal_calibration::{BIASES, Column};
use gyrocal_record::Record;

/// The columns of one effect at one onset or time constant.
#[derive(Debug, Clone, PartialEq)]
pub struct Signature {
    /// Their numbers: parameters of the catalogue, then those of [`Columns::further`].
    pub columns: Vec<usize>,
    /// What a size in the unit of the effect's table is in the unit of its columns.
    pub scale: f64,
}

/// Columns beside the catalogue's own parameters.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Columns {
    /// These.
    pub further: Vec<Column>,
}

impl Columns {
    /// The signature of an effect; `shape` is its onset in s or its time constant in h. `None` for
    /// what has none: noise, and an effect whose shape is not given.
    pub fn signature(
        &mut self,
        effect: &Effect,
        record: &Record,
        shape: Option<f64>,
    ) -> Option<Signature> {
        let first_s = record.time_s.first().copied().unwrap_or(0.0);
        let last_step = record.len().saturating_sub(2);
        let rows_before = |onset_s: f64| {
            record
                .time_s
                .partition_point(|time_s| time_s - first_s < onset_s)
        };
        let further = match (effect.kind, shape, effect.rate()) {
            (EffectKind::InitialState, ..) => [0, 1, 2].map(|axis| Column::Start { axis }).to_vec(),
            (EffectKind::StateJump, Some(onset_s), _) => {
                let row = rows_before(onset_s).saturating_sub(1).min(last_step);
                [0, 1, 2].map(|axis| Column::Jump { row, axis }).to_vec()
            }
            (EffectKind::Step, Some(onset_s), Some(gyro)) => vec![Column::Onset {
                parameter: BIASES[gyro],
                row: rows_before(onset_s).min(last_step),
            }],
            (EffectKind::Exponential, Some(time_constant_h), Some(gyro)) => {
                // In the middle of each step, as the model takes it.
                let share = |pair: &[f64]| {
                    let middle_s = 0.5 * (pair[0] + pair[1]) - first_s;
                    libm::exp(-middle_s / (3600.0 * time_constant_h))
                };
                vec![Column::Course {
                    parameter: BIASES[gyro],
                    steps: record.time_s.windows(2).map(share).collect(),
                }]
            }
            _ if effect.has_term() && effect.shape().is_none() => {
                let columns = effect.model_parameters().collect();
                let scale = 1.0;
                return Some(Signature { columns, scale });
            }
            _ => return None,
        };
        let first = PARAMETERS.len() + self.further.len();
        let columns = (first..first + further.len()).collect();
        self.further.extend(further);
        let scale = effect.parameters.first().map_or(1.0, |size| size.scale);
        Some(Signature { columns, scale })
    }
}
