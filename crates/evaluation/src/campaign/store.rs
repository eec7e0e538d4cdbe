//! The file of results: a header line, then one JSON line a finished seed, in any order.

use std::collections::BTreeMap;
use std::fs::{File, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::fingerprint::Fingerprint;
use crate::error::EvaluationError;

/// One result: the value of the job, or the message of its error.
pub(crate) type Finished<T> = Result<T, String>;

/// A file of results that only this process writes.
#[derive(Debug)]
pub(crate) struct Store {
    path: PathBuf,
    /// Locked until closed.
    file: File,
}

#[derive(Serialize, Deserialize)]
struct Header {
    campaign: Fingerprint,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Line<R> {
    Done { seed: u64, result: R },
    Failed { seed: u64, message: String },
}

impl Store {
    /// Opens or creates the file; returns the results in it.
    ///
    /// A last line without its end was torn by a kill: it is cut off, and its seed is run again.
    pub(crate) fn open<T: DeserializeOwned>(
        path: &Path,
        fingerprint: &Fingerprint,
    ) -> Result<(Self, BTreeMap<u64, Finished<T>>), EvaluationError> {
        let unusable = unusable(path);
        let mut options = File::options();
        let options = options.read(true).append(true).create(true);
        let mut file = options.open(path).map_err(&unusable)?;
        let own = || path.to_owned();
        file.try_lock().map_err(|error| match error {
            TryLockError::WouldBlock => EvaluationError::Busy { path: own() },
            TryLockError::Error(reason) => unusable(reason),
        })?;
        let mut content = Vec::new();
        file.seek(SeekFrom::Start(0)).map_err(&unusable)?;
        file.read_to_end(&mut content).map_err(&unusable)?;

        let header = header_line(fingerprint).map_err(|error| unusable(error.into()))?;
        let end = content.iter().rposition(|byte| *byte == b'\n');
        let whole = end.map_or(0, |end| end + 1);
        if whole == 0 {
            // Only a torn header may be overwritten.
            if !header.starts_with(&content) {
                return Err(EvaluationError::NoResults { path: own() });
            }
            file.set_len(0).map_err(&unusable)?;
            file.write_all(&header).map_err(&unusable)?;
        }
        let known = parse(path, &content[..whole], fingerprint)?;
        if whole > 0 && whole < content.len() {
            file.set_len(whole as u64).map_err(&unusable)?;
        }
        Ok((Self { path: own(), file }, known))
    }

    /// Appends a line made by [`encode`] in one system call: a kill leaves the line whole or torn,
    /// and everything before it unchanged.
    pub(crate) fn append(&mut self, line: &[u8]) -> Result<(), EvaluationError> {
        self.file.write_all(line).map_err(unusable(&self.path))
    }

    /// Flushes the file to disk.
    pub(crate) fn finish(self) -> Result<(), EvaluationError> {
        self.file.sync_all().map_err(unusable(&self.path))
    }
}

/// The error of a file that the results cannot be kept in.
fn unusable(path: &Path) -> impl Fn(std::io::Error) -> EvaluationError {
    let path = path.to_owned();
    move |reason| EvaluationError::File {
        path: path.clone(),
        reason,
    }
}

/// The line of a result, its line end included, and the result read back from it: the same value
/// as after a resumption, by construction.
pub(crate) fn encode<T: Serialize + DeserializeOwned>(
    seed: u64,
    finished: &Finished<T>,
) -> Result<(Vec<u8>, Finished<T>), EvaluationError> {
    let unstorable = |reason| EvaluationError::Unstorable { seed, reason };
    let line: Line<&T> = match finished {
        Ok(result) => Line::Done { seed, result },
        Err(message) => Line::Failed {
            seed,
            message: message.clone(),
        },
    };
    let mut bytes = serde_json::to_vec(&line).map_err(unstorable)?;
    let (_, read) = decode(&bytes).map_err(unstorable)?;
    bytes.push(b'\n');
    Ok((bytes, read))
}

fn decode<T: DeserializeOwned>(line: &[u8]) -> Result<(u64, Finished<T>), serde_json::Error> {
    Ok(match serde_json::from_slice(line)? {
        Line::Done { seed, result } => (seed, Ok(result)),
        Line::Failed { seed, message } => (seed, Err(message)),
    })
}

fn header_line(fingerprint: &Fingerprint) -> Result<Vec<u8>, serde_json::Error> {
    let campaign = fingerprint.clone();
    let mut line = serde_json::to_vec(&Header { campaign })?;
    line.push(b'\n');
    Ok(line)
}

/// The results in complete lines.
fn parse<T: DeserializeOwned>(
    path: &Path,
    content: &[u8],
    expected: &Fingerprint,
) -> Result<BTreeMap<u64, Finished<T>>, EvaluationError> {
    let mut known = BTreeMap::new();
    for (index, line) in content.split_inclusive(|byte| *byte == b'\n').enumerate() {
        let path = || path.to_owned();
        if index == 0 {
            let Ok(header) = serde_json::from_slice::<Header>(line) else {
                return Err(EvaluationError::NoResults { path: path() });
            };
            if let Some(difference) = expected.difference(&header.campaign) {
                let path = path();
                return Err(EvaluationError::OtherCampaign { path, difference });
            }
            continue;
        }
        let wrong = |reason: String| EvaluationError::Line {
            path: path(),
            line: index + 1,
            reason,
        };
        let (seed, finished) = decode(line).map_err(|error| wrong(error.to_string()))?;
        if known.insert(seed, finished).is_some() {
            return Err(wrong(format!("a second result of seed {seed}")));
        }
    }
    Ok(known)
}
