//! The content of input files, decompressed.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use encoding_rs::Encoding;
use encoding_rs_io::DecodeReaderBytesBuilder;
use flate2::bufread::MultiGzDecoder;
use ruzstd::decoding::StreamingDecoder;
use sha2::{Digest, Sha256};

use crate::error::{Error, unreadable};

/// First bytes of gzip and of Zstandard.
const GZIP: &[u8] = &[0x1f, 0x8b];
const ZSTANDARD: &[u8] = &[0x28, 0xb5, 0x2f, 0xfd];

/// Sizes above which a compressed file is no measurement but a way to fill the memory: content of so many MiB, that
/// is [`LARGE_RATIO`] times larger than the file. Records come to 3 to 10 times, one that repeats a reading to some ten.
pub const LARGE_MIB: u64 = 64;
/// How many times larger than the file.
pub const LARGE_RATIO: u64 = 100;

/// What this process knows of the files that it has opened.
static OPENED: Mutex<Opened> = Mutex::new(Opened {
    keeps_streams: false,
    streams: BTreeMap::new(),
    digests: BTreeMap::new(),
});

struct Opened {
    /// Whether streams are kept.
    keeps_streams: bool,
    /// What came through each stream.
    streams: BTreeMap<PathBuf, Arc<[u8]>>,
    /// SHA-256 of each file that was read to its end.
    digests: BTreeMap<PathBuf, String>,
}

/// From now on a stream (a pipe, the standard input) that is opened as an input file is read once and kept, so
/// that it can be opened again under its path. A process that meets each path once, as a command does, may
/// want this; else a stream is refused.
pub fn keep_streams() {
    opened().keeps_streams = true;
}

/// Opens an input file for reading from its beginning. One that begins as gzip or Zstandard does is
/// decompressed while it is read, whatever its name is.
///
/// # Errors
///
/// [`Error::Unreadable`]; of a stream too, unless [`keep_streams`] was called; and while a compressed file is read,
/// if its content has more than 64 MiB and more than 100 times its size.
pub fn open_content(path: &Path) -> Result<Box<dyn BufRead>, Error> {
    open(path).map_err(unreadable(path))
}

/// Opens an input file as [`open_content`] does, decoded to UTF-8 from the encoding of a label of the Encoding
/// Standard (`utf-16le`, `latin1`). A byte-order mark of UTF-16 takes precedence; without both the bytes are as they stand.
///
/// # Errors
///
/// As [`open_content`].
pub fn open_text(path: &Path, encoding: Option<&str>) -> Result<Box<dyn BufRead>, Error> {
    Ok(Box::new(BufReader::new(decoded(
        open_content(path)?,
        encoding,
    ))))
}

/// Whether a label is that of an encoding.
#[must_use]
pub fn is_encoding(label: &str) -> bool {
    Encoding::for_label_no_replacement(label.as_bytes()).is_some()
}

/// The bytes of a text as UTF-8.
pub(crate) fn decoded<R: Read>(bytes: R, encoding: Option<&str>) -> impl Read + use<R> {
    DecodeReaderBytesBuilder::new()
        .encoding(encoding.and_then(|label| Encoding::for_label(label.as_bytes())))
        .bom_override(true)
        .utf8_passthru(true)
        .build(bytes)
}

/// The whole content of an input file, decompressed.
///
/// # Errors
///
/// As [`open_content`].
pub fn read_content(path: &Path) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    open_content(path)?
        .read_to_end(&mut bytes)
        .map_err(unreadable(path))?;
    Ok(bytes)
}

/// SHA-256 of a text in hexadecimal.
#[must_use]
pub fn digest_of_text(text: &str) -> String {
    hexadecimal(Sha256::new_with_prefix(text))
}

fn hexadecimal(digest: Sha256) -> String {
    let digest = digest.finalize();
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// SHA-256 of a file in hexadecimal: of the bytes that were read last, if they were all, else of those that it has
/// now.
pub(crate) fn digest_of(path: &Path) -> Result<String, Error> {
    let known = opened().digests.get(path).cloned();
    if let Some(digest) = known {
        return Ok(digest);
    }
    let read = || io::copy(&mut raw(path)?, &mut io::sink());
    read().map_err(unreadable(path))?;
    Ok(opened().digests.get(path).cloned().unwrap_or_default())
}

fn open(path: &Path) -> io::Result<Box<dyn BufRead>> {
    let file = raw(path)?;
    let compressed = file.count.clone();
    let mut file = BufReader::new(file);
    let first = file.fill_buf()?;
    let decoder: Box<dyn Read> = if first.starts_with(GZIP) {
        Box::new(MultiGzDecoder::new(file))
    } else if first.starts_with(ZSTANDARD) {
        Box::new(StreamingDecoder::new(file).map_err(io::Error::other)?)
    } else {
        return Ok(Box::new(file));
    };
    Ok(Box::new(BufReader::new(Decompressed {
        decoder,
        compressed,
        count: 0,
    })))
}

/// Opens a file as it is stored.
fn raw(path: &Path) -> io::Result<Hashed> {
    opened().digests.remove(path);
    let source: Box<dyn Read> = match std::fs::metadata(path)?.is_file() {
        true => Box::new(File::open(path)?),
        false => Box::new(Cursor::new(stream(path)?)),
    };
    Ok(Hashed {
        path: path.to_owned(),
        source,
        count: Arc::default(),
        digest: Some(Sha256::new()),
    })
}

/// All that comes through a stream.
fn stream(path: &Path) -> io::Result<Arc<[u8]>> {
    let mut opened = opened();
    if let Some(kept) = opened.streams.get(path) {
        return Ok(kept.clone());
    }
    if !opened.keeps_streams && !path.is_dir() {
        return Err(io::Error::other(
            "it is a stream, which can be read once only: write it to a file",
        ));
    }
    let mut bytes = Vec::new();
    File::open(path)?.read_to_end(&mut bytes)?;
    let bytes: Arc<[u8]> = bytes.into();
    opened.streams.insert(path.to_owned(), bytes.clone());
    Ok(bytes)
}

fn opened() -> MutexGuard<'static, Opened> {
    OPENED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file that is hashed while it is read.
struct Hashed {
    path: PathBuf,
    source: Box<dyn Read>,
    /// Bytes that were read.
    count: Arc<AtomicU64>,
    /// `None` after its end.
    digest: Option<Sha256>,
}

impl Read for Hashed {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.source.read(buffer)?;
        self.count.fetch_add(count as u64, Ordering::Relaxed);
        if let Some(digest) = &mut self.digest {
            digest.update(&buffer[..count]);
        }
        if count == 0
            && !buffer.is_empty()
            && let Some(digest) = self.digest.take()
        {
            let digest = hexadecimal(digest);
            opened().digests.insert(self.path.clone(), digest);
        }
        Ok(count)
    }
}

/// The content of a compressed file, which ends in an error where it is far larger than the file.
struct Decompressed {
    decoder: Box<dyn Read>,
    /// Bytes of the file that were read.
    compressed: Arc<AtomicU64>,
    count: u64,
}

impl Read for Decompressed {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.decoder.read(buffer)?;
        self.count += count as u64;
        let ratio = self.count / self.compressed.load(Ordering::Relaxed).max(1);
        let mib = self.count >> 20;
        if mib >= LARGE_MIB && ratio >= LARGE_RATIO {
            return Err(io::Error::other(format!(
                "it is compressed, and its first {mib} MiB are {ratio} times as large as what they are kept in, expected \
                 less than {LARGE_RATIO} times: decompress it first if it is a record (gzip -d, zstd -d)"
            )));
        }
        Ok(count)
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
    fn a_compressed_file_that_fills_the_memory_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv.gz");
        let mut seed = 1_u32;
        let mut noise = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 24) as u8
        };
        let mib = |count: usize, byte: &mut dyn FnMut() -> u8| -> Vec<u8> {
            (0..count << 20).map(|_| byte()).collect()
        };
        // A long content, and one that is a hundred times as large as its file, are records; both together are none.
        let mut zeros = || b'0';
        let plain = [mib(1, &mut noise), mib(70, &mut zeros)].concat();
        for (content, is_read) in [
            (plain, true),
            (mib(60, &mut zeros), true),
            (mib(70, &mut zeros), false),
        ] {
            let file = File::create(&path).unwrap();
            let mut encoder = flate2::write::GzEncoder::new(file, flate2::Compression::fast());
            encoder.write_all(&content).unwrap();
            encoder.finish().unwrap();
            match read_content(&path) {
                Ok(read) => assert!(is_read && read == content),
                Err(error) => {
                    let error = error.to_string();
                    assert!(!is_read, "{error}");
                    for words in [
                        "its first 64 MiB are ",
                        "expected less than 100 times",
                        "gzip -d",
                    ] {
                        assert!(error.contains(words), "{error}");
                    }
                }
            }
        }
    }

    #[test]
    fn texts_of_other_encodings_are_decoded() {
        let utf16 = |text: &str, big: bool| -> Vec<u8> {
            let units = text.encode_utf16();
            let bytes = units.map(|unit| {
                if big {
                    unit.to_be_bytes()
                } else {
                    unit.to_le_bytes()
                }
            });
            bytes.flatten().collect()
        };
        let text = "a,°\n1,Ċ\n";
        let marked = format!("\u{feff}{text}");
        for (bytes, encoding) in [
            (utf16(&marked, false), None),
            (utf16(&marked, true), None),
            (utf16(text, false), Some("utf-16le")),
            (utf16(text, true), Some("utf-16be")),
            (marked.clone().into_bytes(), None),
            (text.as_bytes().to_vec(), None),
        ] {
            let mut read = String::new();
            decoded(&bytes[..], encoding)
                .read_to_string(&mut read)
                .unwrap();
            assert_eq!(read.trim_start_matches('\u{feff}'), text, "{encoding:?}");
        }
        let mut read = String::new();
        decoded(&b"T [\xb0C]"[..], Some("latin1"))
            .read_to_string(&mut read)
            .unwrap();
        assert_eq!(read, "T [°C]");
        assert!(is_encoding("utf-16le") && !is_encoding("utf-17"));
    }

    #[test]
    fn a_compressed_file_that_is_cut_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv.gz");
        std::fs::write(&path, [0x1f, 0x8b, 8, 0, 0, 0]).unwrap();
        let refused = read_content(&path);
        assert!(matches!(refused, Err(Error::Unreadable { .. })));
    }

    #[test]
    fn the_hash_is_of_the_bytes_that_were_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        std::fs::write(&path, "abc").unwrap();
        read_content(&path).unwrap();
        std::fs::write(&path, "abcd").unwrap();
        // The example of FIPS 180-4, of `abc`.
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        for _ in 0..2 {
            assert_eq!(digest_of(&path).unwrap(), expected);
        }
        read_content(&path).unwrap();
        assert_ne!(digest_of(&path).unwrap(), expected);
    }

    #[test]
    fn a_file_that_was_read_in_part_is_hashed_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        std::fs::write(&path, "a".repeat(20_000)).unwrap();
        let whole = digest_of(&path).unwrap();
        open_content(&path).unwrap().fill_buf().unwrap();
        assert_eq!(digest_of(&path).unwrap(), whole);
    }

    #[test]
    #[cfg(unix)]
    fn a_stream_is_refused_unless_it_is_kept() {
        let refused = read_content(Path::new("/dev/null")).unwrap_err();
        let Error::Unreadable { reason, .. } = refused else {
            panic!("{refused}");
        };
        assert!(
            reason.to_string().contains("write it to a file"),
            "{reason}"
        );
    }
}
