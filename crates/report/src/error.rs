use std::path::PathBuf;

/// Why a picture could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Two columns that belong together differ in length.
    #[error("{what} has {found} values, expected {expected}, as many as {against}")]
    UnequalLengths {
        /// The column.
        what: String,
        /// Its length.
        found: usize,
        /// What it is held against.
        against: String,
        /// The length of that.
        expected: usize,
    },
    /// A value is not usable where it stands.
    #[error("{what}, value {index}: found {found}, expected {expected}")]
    Value {
        /// The column.
        what: String,
        /// Index in it, counted from 0.
        index: usize,
        /// The value.
        found: f64,
        /// What would have been usable.
        expected: &'static str,
    },
    /// The picture would have no panel, bar or row at all.
    #[error("{what} is empty, expected at least one entry; leave the picture out")]
    Nothing {
        /// The list.
        what: &'static str,
    },
    /// The drawing library refused.
    #[error("the picture could not be drawn: {reason}")]
    Drawing {
        /// What it said.
        reason: String,
    },
    /// The text is not an SVG picture.
    #[error("not an SVG picture: {reason}")]
    NotSvg {
        /// What the parser said.
        reason: String,
    },
    /// The asked size in pixels cannot be had.
    #[error("found a size of {width_px} by {height_px} pixels, expected 1 to {most} each way")]
    Size {
        /// Asked width.
        width_px: u32,
        /// Height that follows from it.
        height_px: u32,
        /// The most that is possible either way.
        most: u32,
    },
    /// The pixels could not be packed into a PNG.
    #[error("the PNG could not be encoded: {reason}")]
    Encoding {
        /// What the encoder said.
        reason: String,
    },
    /// The file could not be written; it is as it was before.
    #[error("the picture {} was not written", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// Why.
        #[source]
        source: gyrocal_record::Error,
    },
}
