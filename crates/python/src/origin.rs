//! The origin of a result, and its text.

use gyrocal_answer::{Answer, write_text};
use gyrocal_record::{Input, Manifest};
use serde::Serialize;

use crate::error::{Failure, Outcome};

/// The manifest of a result of the inputs; `command` is the call.
pub(crate) fn manifest(model_hash: &str, seed: u64, inputs: Vec<Input>, command: &str) -> Manifest {
    Manifest {
        program: "gyrocal".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        model_hash: model_hash.to_owned(),
        inputs,
        seed,
        command: command.to_owned(),
    }
}

/// The text of an answer; one with a number that is not finite is refused.
pub(crate) fn answer_text(answer: &Answer) -> Outcome<String> {
    write_text(answer).map_err(|error| Failure {
        message: error.to_string(),
        ..Failure::default()
    })
}

/// The text of a result.
pub(crate) fn json(value: &impl Serialize) -> Outcome<String> {
    serde_json::to_string(value).map_err(|error| Failure {
        message: format!("the result cannot be written: {error}"),
        ..Failure::default()
    })
}
