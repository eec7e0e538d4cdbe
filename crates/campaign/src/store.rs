//! The file of results: a header line, then one JSON line a finished seed, in any order.

use std::collections::BTreeMap;
use std::fs::{File, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::error::CampaignError;
use crate::fingerprint::Fingerprint;

/// One result: what the job returned, or why it failed.
pub(crate) type Finished<T> = Result<T, String>;

/// A file of results that this process alone writes.
#[derive(Debug)]
pub(crate) struct Store {
    path: PathBuf,
    /// Locked until it is closed.
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
    /// Opens or makes the file; returns what is in it.
    ///
    /// A last line without its end was torn by a kill: it is cut off, and its seed is not known.
    pub(crate) fn open<T: DeserializeOwned>(
        path: &Path,
        fingerprint: &Fingerprint,
    ) -> Result<(Self, BTreeMap<u64, Finished<T>>), CampaignError> {
        let unusable = |reason| CampaignError::File {
            path: path.to_owned(),
            reason,
        };
        let mut file = File::options()
            .read(true)
            .append(true)
            .create(true)
            .open(path)
            .map_err(unusable)?;
        file.try_lock().map_err(|error| match error {
            TryLockError::WouldBlock => CampaignError::Busy {
                path: path.to_owned(),
            },
            TryLockError::Error(reason) => unusable(reason),
        })?;
        let mut content = Vec::new();
        file.seek(SeekFrom::Start(0)).map_err(unusable)?;
        file.read_to_end(&mut content).map_err(unusable)?;

        let header = header_line(fingerprint).map_err(|error| unusable(error.into()))?;
        let whole = content
            .iter()
            .rposition(|byte| *byte == b'\n')
            .map_or(0, |end| end + 1);
        if whole == 0 {
            // Nothing but a header that was torn may be written over.
            if !header.starts_with(&content) {
                return Err(CampaignError::NoResults {
                    path: path.to_owned(),
                });
            }
            file.set_len(0).map_err(unusable)?;
            file.write_all(&header).map_err(unusable)?;
        }
        let known = parse(path, &content[..whole], fingerprint)?;
        if whole > 0 && whole < content.len() {
            file.set_len(whole as u64).map_err(unusable)?;
        }
        let path = path.to_owned();
        Ok((Self { path, file }, known))
    }

    /// Appends a line that [`encode`] made. One call of the system: a kill leaves the line whole
    /// or torn, and nothing before it changed.
    pub(crate) fn append(&mut self, line: &[u8]) -> Result<(), CampaignError> {
        self.file
            .write_all(line)
            .map_err(|reason| CampaignError::File {
                path: self.path.clone(),
                reason,
            })
    }

    /// Waits until the disk has everything.
    pub(crate) fn finish(self) -> Result<(), CampaignError> {
        self.file.sync_all().map_err(|reason| CampaignError::File {
            path: self.path,
            reason,
        })
    }
}

/// The line of a result with its end, and the result as the line says it: the same as after a
/// resumption, by construction.
pub(crate) fn encode<T: Serialize + DeserializeOwned>(
    seed: u64,
    finished: &Finished<T>,
) -> Result<(Vec<u8>, Finished<T>), CampaignError> {
    let unstorable = |reason| CampaignError::Unstorable { seed, reason };
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

/// The results in lines that are whole.
fn parse<T: DeserializeOwned>(
    path: &Path,
    content: &[u8],
    expected: &Fingerprint,
) -> Result<BTreeMap<u64, Finished<T>>, CampaignError> {
    let mut known = BTreeMap::new();
    for (index, line) in content.split_inclusive(|byte| *byte == b'\n').enumerate() {
        if index == 0 {
            let Ok(header) = serde_json::from_slice::<Header>(line) else {
                return Err(CampaignError::NoResults {
                    path: path.to_owned(),
                });
            };
            if let Some(difference) = expected.difference(&header.campaign) {
                return Err(CampaignError::OtherCampaign {
                    path: path.to_owned(),
                    difference,
                });
            }
            continue;
        }
        let wrong = |reason: String| CampaignError::Line {
            path: path.to_owned(),
            line: index + 1,
            reason,
        };
        let (seed, finished) = decode(line).map_err(|error| wrong(error.to_string()))?;
        if known.insert(seed, finished).is_some() {
            return Err(wrong(format!("a second one of seed {seed}")));
        }
    }
    Ok(known)
}
