//! Signatures: the columns of the linearised model that an effect adds.
//!
//! The diagnosis constructs signatures of its own. This construction shares no code with it but the type of a column, so that
//! an error in either shows as a failure to find an injected effect.

use gyrocal::Effect;
use gyrocal::effect::EffectKind;
use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal_calibration::BIASES;
use gyrocal_hypothesis::Column;
use gyrocal_record::Record;

/// The columns of one effect at one onset or time constant.
#[derive(Debug, Clone, PartialEq)]
pub struct Signature {
    /// Column numbers: parameters of the catalogue, then those of [`SignatureColumns::further`].
    pub columns: Vec<usize>,
    /// Factor from sizes in the unit of the effect's table to the unit of its columns.
    pub scale: f64,
}

/// Columns in addition to the parameters of the catalogue.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SignatureColumns {
    /// The columns, in the order in which signatures were requested.
    pub further: Vec<Column>,
}

impl SignatureColumns {
    /// Signature of an effect; `shape` is its onset in s or its time constant in h. `None` for effects
    /// of noise, and for an effect whose shape is missing.
    pub fn signature(
        &mut self,
        effect: &Effect,
        record: &Record,
        shape: Option<f64>,
    ) -> Option<Signature> {
        let first_s = record.time_s.first().copied().unwrap_or(0.0);
        let last_step = record.len().saturating_sub(2);
        let rows_before = |onset_s: f64| {
            let times_s = &record.time_s;
            times_s.partition_point(|time_s| time_s - first_s < onset_s)
        };
        let of_states = |column: &dyn Fn(usize) -> Column| (0..3).map(column).collect();
        let further: Vec<Column> = match (effect.kind, shape, effect.rate()) {
            (EffectKind::InitialState, ..) => {
                of_states(&|state| Column::InitialState { row: 0, state })
            }
            (EffectKind::StateJump, Some(onset_s), _) => {
                let row = rows_before(onset_s).saturating_sub(1).min(last_step);
                of_states(&|state| Column::StateJump { row, state })
            }
            (EffectKind::Step, Some(onset_s), Some(gyro)) => vec![Column::Step {
                parameter: BIASES[gyro],
                row: rows_before(onset_s).min(last_step),
            }],
            (EffectKind::Exponential, Some(time_constant_h), Some(gyro)) => {
                // At the middle of each step, as the model takes it.
                let share = |pair: &[f64]| {
                    let middle_s = 0.5 * (pair[0] + pair[1]) - first_s;
                    libm::exp(-middle_s / (3600.0 * time_constant_h))
                };
                vec![Column::TimeProfile {
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
