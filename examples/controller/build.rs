//! The samples that stand for the accelerometers: a record as binary numbers.

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

const RECORD: &str = "../data/three_days.csv";

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed={RECORD}");
    println!("cargo::rerun-if-changed=build.rs");
    let mut samples = Vec::new();
    for line in fs::read_to_string(RECORD)?.lines().skip(1) {
        for field in line.split(',').skip(1) {
            samples.extend((field.parse::<f64>()? as f32).to_le_bytes());
        }
    }
    let out = PathBuf::from(env::var("OUT_DIR")?);
    fs::write(out.join("samples.bin"), samples)?;
    Ok(())
}
