use std::path::PathBuf;

/// Errors of an oracle.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OracleError {
    /// A file of the oracle cannot be read.
    #[error("cannot read {path}: {source}", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Reason given by the operating system.
        source: std::io::Error,
    },
    /// The text is not JSON of the expected form.
    #[error("not of the expected form: {0}")]
    Json(#[from] serde_json::Error),
    /// The program is of another version of the schema.
    #[error("program `{program}` has schema version {found}, expected {expected}")]
    Schema {
        /// Name of the program.
        program: String,
        /// Version in the file.
        found: u64,
        /// Version that this crate reads.
        expected: u64,
    },
    /// A name that is not in the program or in the reference.
    #[error("there is no {kind} `{name}`")]
    Unknown {
        /// Kind of the name: function, group, …
        kind: &'static str,
        /// Its name.
        name: String,
    },
    /// An instruction that cannot be run.
    #[error("function `{function}`, instruction {index}: {problem}")]
    Instruction {
        /// Name of the function.
        function: String,
        /// Position in the instruction list, from 0.
        index: usize,
        /// Its fault.
        problem: String,
    },
    /// A number of scalars other than the function takes.
    #[error("function `{function}` takes {expected} scalars, {found} were given")]
    Inputs {
        /// Name of the function.
        function: String,
        /// Scalars that it takes.
        expected: usize,
        /// Scalars that were given.
        found: usize,
    },
}
