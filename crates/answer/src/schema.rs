//! The JSON Schema of the contract.

use gyrocal_record::written_schema;

use crate::Answer;

/// JSON Schema (draft 2020-12) of a written [`Answer`].
#[must_use]
pub fn schema() -> schemars::Schema {
    written_schema::<Answer>()
}
