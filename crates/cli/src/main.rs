//! The command `gyrocal`: [`gyrocal_cli::run`] with the arguments of the process.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(gyrocal_cli::run(std::env::args_os()))
}
