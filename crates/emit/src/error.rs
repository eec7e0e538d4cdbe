use gyrocal::EstimationError;
use thiserror::Error;

/// A file that could not be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EmitError {
    /// The name of a model file gives no name of a module.
    #[error("found the module name `{found}`, expected {expected}")]
    ModuleName {
        /// The name.
        found: String,
        /// Expected names.
        expected: &'static str,
    },
    /// The generated module is not that of the model file.
    #[error(
        "{module}: found no {missing}; is it the module that a build derived from the model file?"
    )]
    Module {
        /// Name of the module's file.
        module: String,
        /// The item that is missing.
        missing: String,
    },
    /// The gyros of the generated module are fixed to something else than the model file says.
    #[error(
        "{module}: found gyros that are `{found}`, expected `{expected}`, as the model file says; is it the \
         module that a build derived from the model file?"
    )]
    Gyros {
        /// Name of the module's file.
        module: String,
        /// Word of the module's gyros in a model file.
        found: &'static str,
        /// That of the model file.
        expected: &'static str,
    },
    /// An effect of the model file that the catalogue does not have as a term.
    #[error("the catalogue has no term `{id}`")]
    NoTerm {
        /// Id of the effect or of its parameter.
        id: String,
    },
    /// The filter that the numbers of the tests come from has stopped.
    #[error("the filter that gives the expected numbers has stopped: {0}")]
    Filter(#[from] EstimationError),
    /// The same, around a filter of a controller.
    #[error("the filter that gives the expected numbers has stopped: {0}")]
    Controller(#[from] gyrocal::ControllerError),
    /// A source file that a module declares is missing.
    #[error("no source of the module `{module}`")]
    Source {
        /// Path of the module.
        module: String,
    },
}
