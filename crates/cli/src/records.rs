//! Records as they stand in their files.

use std::path::Path;

use gyrocal_record::{Error, RecordFile};

use crate::terminal;

/// Reads a record; warns of a last line that seems cut off.
pub(crate) fn read(path: &Path) -> Result<RecordFile, Error> {
    let file = RecordFile::read(path)?;
    if let Some(note) = file.cut_note() {
        terminal::warn(&note);
    }
    Ok(file)
}
