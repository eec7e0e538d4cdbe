//! Scores of a record as bytes: what travels from where a record is diagnosed to where the fleet is looked at.
//!
//! ```text
//! "gyroscr1", length of the header (u32), header (JSON: effects and their columns),
//! z, root of the information, correlations below the diagonal row by row (f32 each), little-endian
//! ```
//!
//! Single precision keeps a z to 1e-7 of itself, far below what it is uncertain by.

use gyrocal_hypothesis::{ScoreTable, ScoredEffect};
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::error::FleetError;

const MAGIC: &[u8; 8] = b"gyroscr1";

/// Most columns: more are no scores of a record.
const MOST_COLUMNS: usize = 20_000;

#[derive(Serialize, Deserialize)]
struct Header {
    columns: usize,
    effects: Vec<EffectHeader>,
    in_model: Vec<String>,
}

#[derive(Serialize, Deserialize)]
struct EffectHeader {
    id: String,
    unit: String,
    persists: bool,
    variants: Vec<Vec<usize>>,
}

/// Scores as bytes.
#[must_use]
pub fn to_bytes(table: &ScoreTable) -> Vec<u8> {
    let count = table.z.len();
    let header = Header {
        columns: count,
        effects: table
            .effects
            .iter()
            .map(|effect| EffectHeader {
                id: effect.id.clone(),
                unit: effect.unit.clone(),
                persists: effect.persists,
                variants: effect.variants.clone(),
            })
            .collect(),
        in_model: table.in_model.clone(),
    };
    // Plain data without maps: writing them does not fail.
    let header = serde_json::to_vec(&header).unwrap_or_default();
    let mut bytes = Vec::with_capacity(header.len() + 2 * count * (count + 3) + 12);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&(header.len() as u32).to_le_bytes());
    bytes.extend_from_slice(&header);
    let below = (0..count).flat_map(|i| (0..i).map(move |j| table.correlation[(i, j)]));
    let numbers = table.z.iter().chain(&table.root_information).copied();
    for number in numbers.chain(below) {
        bytes.extend_from_slice(&(number as f32).to_le_bytes());
    }
    bytes
}

/// Scores of bytes.
///
/// # Errors
/// [`FleetError::Scores`] if they are no scores.
pub fn from_bytes(bytes: &[u8]) -> Result<ScoreTable, FleetError> {
    let rest = bytes
        .strip_prefix(MAGIC)
        .ok_or(FleetError::Scores("found other bytes"))?;
    let (length, rest) = rest
        .split_first_chunk::<4>()
        .ok_or(FleetError::Scores("found no header"))?;
    let length = u32::from_le_bytes(*length) as usize;
    let (header, numbers) = rest
        .split_at_checked(length)
        .ok_or(FleetError::Scores("the header is cut off"))?;
    let header: Header = serde_json::from_slice(header)
        .map_err(|_| FleetError::Scores("the header is no JSON of scores"))?;
    let count = header.columns;
    let columns = header.effects.iter().flat_map(|effect| &effect.variants);
    if count > MOST_COLUMNS || columns.flatten().any(|column| *column >= count) {
        return Err(FleetError::Scores(
            "the header names columns that are not there",
        ));
    }
    let numbers = numbers.as_chunks::<4>();
    let expected = 2 * count + count * count.saturating_sub(1) / 2;
    if numbers.0.len() != expected || !numbers.1.is_empty() {
        return Err(FleetError::Scores(
            "found another number of values than the header tells",
        ));
    }
    let mut numbers = numbers
        .0
        .iter()
        .map(|one| f64::from(f32::from_le_bytes(*one)));
    let mut take = |count: usize| -> Vec<f64> { numbers.by_ref().take(count).collect() };
    let z = take(count);
    let root_information = take(count);
    let mut correlation = DMatrix::identity(count, count);
    for i in 0..count {
        for (j, value) in take(i).into_iter().enumerate() {
            correlation[(i, j)] = value;
            correlation[(j, i)] = value;
        }
    }
    let finite = z.iter().chain(&root_information).chain(correlation.iter());
    if !finite.into_iter().all(|value| value.is_finite()) {
        return Err(FleetError::Scores("found a value that is not finite"));
    }
    Ok(ScoreTable {
        effects: header
            .effects
            .into_iter()
            .map(|effect| ScoredEffect {
                id: effect.id,
                unit: effect.unit,
                persists: effect.persists,
                variants: effect.variants,
            })
            .collect(),
        in_model: header.in_model,
        z,
        root_information,
        correlation,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> ScoreTable {
        ScoreTable {
            effects: vec![ScoredEffect {
                id: "gyro_x.step".to_owned(),
                unit: "deg/h".to_owned(),
                persists: false,
                variants: vec![vec![0], vec![1]],
            }],
            in_model: vec!["gyro_x.g_y".to_owned()],
            z: vec![1.5, -0.25],
            root_information: vec![1000.0, 0.125],
            correlation: DMatrix::from_row_slice(2, 2, &[1.0, 0.5, 0.5, 1.0]),
        }
    }

    #[test]
    fn bytes_are_read_back() {
        // Values that single precision holds.
        let table = table();
        assert_eq!(from_bytes(&to_bytes(&table)).unwrap(), table);
        let empty = ScoreTable::default();
        assert_eq!(from_bytes(&to_bytes(&empty)).unwrap(), empty);
    }

    #[test]
    fn bytes_that_are_cut_off_or_changed_are_refused() {
        let bytes = to_bytes(&table());
        for end in 0..bytes.len() {
            assert!(from_bytes(&bytes[..end]).is_err(), "{end}");
        }
        let mut other = bytes.clone();
        let last = other.len() - 4;
        other[last..].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(from_bytes(&other).is_err());
        let mut more = bytes;
        more.push(0);
        assert!(from_bytes(&more).is_err());
    }
}
