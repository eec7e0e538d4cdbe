//! The error of this program.

/// Any failure of a measurement; its message names the record or the file.
pub(crate) type Error = Box<dyn std::error::Error + Send + Sync>;
