use std::path::PathBuf;

/// The reason why a picture could not be made.
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
        /// The column that it belongs to.
        against: String,
        /// The length of that column.
        expected: usize,
    },
    /// A value cannot be drawn.
    #[error("{what}, value {index}: found {found}, expected {expected}")]
    Value {
        /// The column.
        what: String,
        /// Index in it, counted from 0.
        index: usize,
        /// The value.
        found: f64,
        /// A description of usable values.
        expected: &'static str,
    },
    /// A list without which there is nothing to draw is empty.
    #[error("{what} is empty, expected at least one entry; leave the picture out")]
    Empty {
        /// The list.
        what: &'static str,
    },
    /// The text is not an SVG picture.
    #[error("not an SVG picture: {reason}")]
    NotSvg {
        /// Message of the parser.
        reason: String,
    },
    /// The requested size in pixels is not possible.
    #[error("found a size of {width_px} by {height_px} pixels, expected 1 to {most} each way")]
    Size {
        /// Requested width.
        width_px: u32,
        /// Height that follows from it.
        height_px: u32,
        /// The largest possible width and height.
        most: u32,
    },
    /// The pixels could not be encoded as PNG.
    #[error("the PNG could not be encoded: {reason}")]
    Encoding {
        /// Message of the encoder.
        reason: String,
    },
    /// A page could not be made from its templates.
    #[error("the page could not be made: {reason}")]
    Template {
        /// Message of the template engine.
        reason: String,
    },
    /// The file could not be written; it is as it was before.
    #[error("the picture {} was not written", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// Cause.
        #[source]
        source: gyrocal_record::Error,
    },
}
