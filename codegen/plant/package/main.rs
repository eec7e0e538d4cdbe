//! Diagnosis of records of this plant: `cargo run -- diagnose data.csv --columns columns.toml`.

include!(concat!(env!("OUT_DIR"), "/plant.rs"));

fn main() -> std::process::ExitCode {
    std::process::ExitCode::from(gyrocal_cli::run_plant(std::env::args_os(), plant()))
}
