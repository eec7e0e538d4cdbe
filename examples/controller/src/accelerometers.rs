//! The accelerometers: a record instead of a converter.

const SAMPLES: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/samples.bin"));

/// Time between two samples, s.
pub(crate) const INTERVAL_S: f32 = 60.0;

/// The sample of a minute, g; `None` at the end of the record. One of them is what a loose
/// connector gives.
pub(crate) fn sample(minute: usize) -> Option<[f32; 3]> {
    let bytes = SAMPLES.chunks_exact(12).nth(minute)?;
    let mut numbers = bytes.chunks_exact(4).map(|bytes| {
        let bits = bytes.try_into().map(u32::from_le_bytes).unwrap_or_default();
        f32::from_bits(bits)
    });
    let sample = [(); 3].map(|()| numbers.next().unwrap_or(0.0));
    if minute == 500 {
        let [x, _, z] = sample;
        return Some([x, f32::NAN, z]);
    }
    Some(sample)
}
