use gyrocal::SavedNumber;

/// The number type of this build.
#[cfg(not(feature = "double"))]
pub type Number = f32;
/// The number type of this build.
#[cfg(feature = "double")]
pub type Number = f64;

#[cfg(not(feature = "double"))]
const BYTES: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/single.bin"));
#[cfg(feature = "double")]
const BYTES: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/double.bin"));

/// Time between two rows of the record, s.
pub const INTERVAL_S: Number = 60.0;

/// The samples of `examples/data/three_days.csv`.
pub struct Record;

impl Record {
    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        BYTES.len() / (3 * Number::BYTES)
    }

    /// True if there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        BYTES.is_empty()
    }

    /// Bytes that the record takes in memory.
    #[must_use]
    pub fn bytes(&self) -> usize {
        BYTES.len()
    }

    /// The sample of a row, g; zero beyond the end.
    #[must_use]
    pub fn sample(&self, row: usize) -> [Number; 3] {
        let mut numbers = BYTES.chunks_exact(Number::BYTES).skip(3 * row);
        [(); 3].map(|()| numbers.next().and_then(Number::read).unwrap_or(0.0))
    }
}
