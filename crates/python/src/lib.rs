//! The extension module of the Python package `gyrocal`: records and bench descriptions in memory,
//! and the computations on them. The package around it has the functions that users call.
//!
//! Numbers come in as views of NumPy arrays or of Arrow buffers and are copied once, into the rows of
//! a record; they go out as views of those rows. Results go out as JSON, the same text that the command
//! writes. The lock of the interpreter is released while anything is read or computed, and what may take long goes
//! through one function (`job`), which an interrupt stops.

mod arrow_abi;
mod arrow_stream;
mod axes;
mod bench;
mod calibrate;
mod characterise;
mod diagnose;
mod error;
mod fleet;
mod job;
mod names;
mod origin;
mod plan;
mod plant;
mod plant_record;
mod plant_series;
mod record;
mod report;
mod simulate;

use mimalloc::MiMalloc;
use pyo3::prelude::*;

/// The allocator of glibc returns memory to the system between the steps of a search, which costs page faults
/// in a worker of Dask. This one keeps it. Its feature `local_dynamic_tls` is that of a library which is loaded by
/// `dlopen`, as an extension module is: the room for thread-local variables of the other model may be used up.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

/// The computations of the package.
#[pymodule]
mod _gyrocal {
    use std::ffi::OsString;

    use gyrocal_fleet::FleetOptions;
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::bench::HeldBench;
    #[pymodule_export]
    use crate::calibrate::calibrate;
    #[pymodule_export]
    use crate::characterise::characterise;
    #[pymodule_export]
    use crate::diagnose::diagnose;
    #[pymodule_export]
    use crate::fleet::summarise_fleet;
    #[pymodule_export]
    use crate::plan::plan;
    #[pymodule_export]
    use crate::plant::{HeldPage, HeldPlant};
    #[pymodule_export]
    use crate::plant_record::HeldPlantRecord;
    #[pymodule_export]
    use crate::record::HeldRecord;
    #[pymodule_export]
    use crate::report::{html_of, report, text_of, words_of};
    #[pymodule_export]
    use crate::simulate::simulate;

    use crate::names::check_names;

    /// The version of the package.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");

    /// Hash of the symbolic model.
    #[pymodule_export]
    const MODEL_HASH: &str = gyrocal::generated::MODEL_HASH;

    /// Share of false ones among the causes that recur.
    #[pymodule_export]
    const FALSE_DISCOVERY_RATE: f64 = FleetOptions::DEFAULT.false_discovery_rate;

    /// Family-wise probability that a fleet without differences shows a batch or site.
    #[pymodule_export]
    const GROUP_PROBABILITY: f64 = FleetOptions::DEFAULT.group_probability;

    /// Family-wise probability that a coefficient without outliers shows one.
    #[pymodule_export]
    const OUTLIER_PROBABILITY: f64 = FleetOptions::DEFAULT.outlier_probability;

    /// Runs the command `gyrocal` with its arguments, the first of which is the name of the program;
    /// the exit code.
    #[pyfunction]
    fn command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
        py.detach(|| gyrocal_cli::run(arguments))
    }

    /// Refuses names that the columns of a record do not have.
    #[pyfunction]
    fn check_columns(names: Vec<String>, frame: &str) -> PyResult<()> {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        Ok(check_names(&names, frame)?)
    }
}
