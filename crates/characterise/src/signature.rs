//! Which columns of the linearised model stand for an effect.

use gyrocal::EffectRow;
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

/// The effect that is a jump of the attitude.
const KNOCK: &str = "platform.knock";

impl Columns {
    /// The signature of an effect; `shape` is its onset in s or its time constant in h. `None` for
    /// what has none: noise, and an effect whose shape is not given.
    pub fn signature(
        &mut self,
        effect: &EffectRow,
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
        let gyro = ["gyro_x.", "gyro_y.", "gyro_z."]
            .iter()
            .position(|prefix| effect.id.starts_with(prefix));
        let further = match (effect.id, shape, gyro) {
            ("platform.initial_attitude", ..) => {
                [0, 1, 2].map(|axis| Column::Start { axis }).to_vec()
            }
            (KNOCK, Some(onset_s), _) => {
                let row = rows_before(onset_s).saturating_sub(1).min(last_step);
                [0, 1, 2].map(|axis| Column::Jump { row, axis }).to_vec()
            }
            (id, Some(onset_s), Some(gyro)) if id.ends_with(".step") => vec![Column::Onset {
                parameter: BIASES[gyro],
                row: rows_before(onset_s).min(last_step),
            }],
            (id, Some(time_constant_h), Some(gyro)) if id.ends_with(".warmup") => {
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
            _ if effect.kind == "term" && effect.shapes.is_empty() => {
                let place = |id: &&str| PARAMETERS.iter().position(|element| element.id == *id);
                let columns = effect.states.iter().filter_map(place).collect();
                let scale = 1.0;
                return Some(Signature { columns, scale });
            }
            _ => return None,
        };
        let first = PARAMETERS.len() + self.further.len();
        let columns = (first..first + further.len()).collect();
        self.further.extend(further);
        // Attitudes are columns in radians.
        let scale = if effect.kind == "state" {
            core::f64::consts::PI / 180.0
        } else {
            1.0
        };
        Some(Signature { columns, scale })
    }
}
