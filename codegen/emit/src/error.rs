/// Everything that can go wrong between a derivation and a Rust file.
///
/// Each message says where, what was found, what was expected and what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The text is not JSON, or not of the form of a program.
    #[error(
        "{origin}: not a program: {reason}; expected a file written by the exporter \
         `casadi_program.py`: derive it again"
    )]
    Json {
        /// File the text is from.
        origin: String,
        /// Message of the parser, with line and column.
        reason: String,
    },

    /// The program was written by another version of the exporter.
    #[error(
        "{origin}: schema_version: found {found}, expected {expected}; derive the program again \
         with the exporter that comes with this version of gyrocal-codegen"
    )]
    SchemaVersion {
        /// File the program is from.
        origin: String,
        /// Version in the file.
        found: String,
        /// Version this crate reads.
        expected: u32,
    },

    /// A name cannot stand in Rust, or stands twice.
    #[error(
        "{origin}: {place}: found the name `{name}`, expected {expected}; rename it in the derivation"
    )]
    Name {
        /// File the program is from.
        origin: String,
        /// Place in the program.
        place: String,
        /// The name.
        name: String,
        /// Expected form.
        expected: String,
    },

    /// An instruction has an operation that cannot be lowered.
    #[error(
        "{origin}: {place}: found the operation `{operation}`, expected one of {known}; write the \
         expression with these"
    )]
    Operation {
        /// File the program is from.
        origin: String,
        /// Place in the program.
        place: String,
        /// The operation.
        operation: String,
        /// The operations that can be lowered.
        known: String,
    },

    /// A program contradicts itself.
    #[error("{origin}: {place}: found {found}, expected {expected}; {remedy}")]
    Program {
        /// File the program is from.
        origin: String,
        /// Place in the program.
        place: String,
        /// Value found.
        found: String,
        /// Value expected.
        expected: String,
        /// Advice.
        remedy: String,
    },

    /// A constant, given or computed, is infinite or NaN.
    #[error(
        "{origin}: {place}: found the constant {value}, expected a finite one; look for a division \
         by zero or an overflow in the derivation"
    )]
    NotFinite {
        /// File the program is from.
        origin: String,
        /// Place in the program.
        place: String,
        /// The constant.
        value: f64,
    },

    /// An emission option cannot be used.
    #[error("{place}: found `{found}`, expected {expected}; change the caller of gyrocal-codegen")]
    Option {
        /// The option.
        place: String,
        /// Its value.
        found: String,
        /// Expected form.
        expected: String,
    },

    /// The emitter wrote something that is not Rust: a defect of this crate.
    #[error(
        "{origin}: {place}: the emitted text is not Rust ({reason}); expected valid items: report \
         this with the program as a defect of gyrocal-codegen"
    )]
    Emission {
        /// File the program is from.
        origin: String,
        /// Item that was emitted.
        place: String,
        /// Message of the parser.
        reason: String,
    },
}
