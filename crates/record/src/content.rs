//! The content of input files, decompressed.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;
use ruzstd::decoding::StreamingDecoder;

use crate::error::Error;

/// First bytes of gzip and of Zstandard.
const GZIP: &[u8] = &[0x1f, 0x8b];
const ZSTANDARD: &[u8] = &[0x28, 0xb5, 0x2f, 0xfd];

/// Opens an input file for reading from its beginning. One that begins as gzip or Zstandard does is
/// decompressed while it is read, whatever its name is.
///
/// # Errors
///
/// [`Error::Unreadable`].
pub fn open_content(path: &Path) -> Result<Box<dyn BufRead>, Error> {
    open(path).map_err(|reason| unreadable(path, reason))
}

/// The whole content of an input file, decompressed.
pub(crate) fn read_content(path: &Path) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    open_content(path)?
        .read_to_end(&mut bytes)
        .map_err(|reason| unreadable(path, reason))?;
    Ok(bytes)
}

fn open(path: &Path) -> io::Result<Box<dyn BufRead>> {
    let mut file = BufReader::new(File::open(path)?);
    let first = file.fill_buf()?;
    if first.starts_with(GZIP) {
        return Ok(Box::new(BufReader::new(MultiGzDecoder::new(file))));
    }
    if first.starts_with(ZSTANDARD) {
        let decoder = StreamingDecoder::new(file).map_err(io::Error::other)?;
        return Ok(Box::new(BufReader::new(decoder)));
    }
    Ok(Box::new(file))
}

fn unreadable(path: &Path, reason: io::Error) -> Error {
    Error::Unreadable {
        path: path.to_owned(),
        reason,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn members_of_gzip_follow_each_other() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        let mut file = File::create(&path).unwrap();
        for text in ["a,b\n", "1,2\n"] {
            let mut encoder = flate2::write::GzEncoder::new(&mut file, flate2::Compression::fast());
            encoder.write_all(text.as_bytes()).unwrap();
            encoder.finish().unwrap();
        }
        assert_eq!(read_content(&path).unwrap(), b"a,b\n1,2\n");
    }

    #[test]
    fn a_compressed_file_that_is_cut_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv.gz");
        std::fs::write(&path, [0x1f, 0x8b, 8, 0, 0, 0]).unwrap();
        let refused = read_content(&path);
        assert!(matches!(refused, Err(Error::Unreadable { .. })));
    }
}
