//! Accelerometers without values.

use gyrocal_record::capitalised;

use crate::finding::SetupFinding;
use crate::kind::SetupKind;
use crate::samples::Samples;
use crate::text::{accelerometers, rows};

/// An accelerometer that has a value in a smaller share of the rows is missing.
const LEAST_SHARE: f64 = 0.05;

/// Columns that are empty or nearly so. Two accelerometers of a platform whose attitude is declared
/// are enough for a calibration; otherwise nothing tells the sign of the third component.
pub(crate) fn find(samples: &mut Samples<'_>) -> Vec<SetupFinding> {
    let measured = samples.measured_rows();
    let counts: [usize; 3] = core::array::from_fn(|axis| {
        let values = samples.accel_g.iter().map(|row| row[axis]);
        values.filter(|value| !value.is_nan()).count()
    });
    let empty: Vec<usize> = (0..3)
        .filter(|axis| (counts[*axis] as f64) < LEAST_SHARE * measured as f64)
        .collect();
    if empty.is_empty() {
        return Vec::new();
    }
    let verb = if empty.len() == 1 { "has" } else { "have" };
    let description = format!(
        "{} {verb} no values. Record all three components of specific force.",
        capitalised(&accelerometers(&empty)),
    );
    let least = empty.iter().map(|axis| counts[*axis]).min().unwrap_or(0);
    let evidence = format!("values in {least} of {}", rows(measured));
    let mut finding = SetupFinding::new(SetupKind::Missing, description, evidence);
    let is_enough = empty.len() == 1 && samples.bench.initial_angles_deg.is_some();
    finding.stops = !is_enough;
    vec![finding]
}
