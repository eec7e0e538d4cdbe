//! Draws a picture of each kind from made-up data: `cargo run -p gyrocal-report --example gallery DIR`.

use std::error::Error;
use std::path::PathBuf;

use gyrocal_report::{write_png, write_svg};

#[path = "../tests/samples/mod.rs"]
mod samples;

fn main() -> Result<(), Box<dyn Error>> {
    let directory = std::env::args().nth(1).map(PathBuf::from);
    let directory = directory.ok_or("name a directory for the pictures")?;
    std::fs::create_dir_all(&directory)?;
    for (name, picture, _) in samples::all() {
        let stem = directory.join(name);
        write_svg(picture.as_ref(), &stem.with_extension("svg"))?;
        write_png(picture.as_ref(), &stem.with_extension("png"), 1920)?;
    }
    Ok(())
}
