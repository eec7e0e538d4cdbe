//! Turns the record of three days into binary numbers of both precisions, so that the firmware
//! holds it in its flash memory and reads it without arithmetic.

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

const RECORD: &str = "../../examples/data/three_days.csv";

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed={RECORD}");
    println!("cargo::rerun-if-changed=build.rs");
    let text = fs::read_to_string(RECORD)?;
    let (mut single, mut double) = (Vec::new(), Vec::new());
    for line in text.lines().skip(1) {
        for field in line.split(',').skip(1) {
            let number: f64 = field.parse()?;
            double.extend(number.to_le_bytes());
            single.extend((number as f32).to_le_bytes());
        }
    }
    let out = PathBuf::from(env::var("OUT_DIR")?);
    fs::write(out.join("single.bin"), single)?;
    fs::write(out.join("double.bin"), double)?;
    Ok(())
}
