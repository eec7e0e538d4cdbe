use std::path::Path;

use crate::error::Error;

/// A picture that can be drawn from its data.
pub trait Picture {
    /// The picture as SVG, with a line below its description that tells what it is of; none if that is empty. The
    /// same data gives the same bytes.
    ///
    /// # Errors
    ///
    /// [`Error::UnequalLengths`], [`Error::Value`] or [`Error::Empty`] if the data cannot be drawn.
    fn to_svg_of(&self, source: &str) -> Result<String, Error>;

    /// The picture as SVG without such a line.
    ///
    /// # Errors
    ///
    /// As [`Picture::to_svg_of`].
    fn to_svg(&self) -> Result<String, Error> {
        self.to_svg_of("")
    }
}

/// Writes a picture as SVG, whole or not at all.
///
/// # Errors
///
/// As [`Picture::to_svg`], and [`Error::Unwritable`].
pub fn write_svg(picture: &dyn Picture, path: &Path) -> Result<(), Error> {
    write(path, picture.to_svg()?.as_bytes())
}

pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    gyrocal_record::write_whole(path, bytes).map_err(|source| Error::Unwritable {
        path: path.to_owned(),
        source,
    })
}
