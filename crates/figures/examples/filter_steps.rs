//! Runs a number of filter steps and nothing else, for profilers and instruction counters:
//! `cargo run --release --package gyrocal-figures --example filter_steps -- euler|rk4 STEPS`.

use gyrocal::{Discretisation, FilterSettings, InitialAttitude, Integration, PlatformFilter, Site};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [integration, steps] = arguments.as_slice() else {
        return Err("expected two arguments: euler or rk4, and the number of steps".into());
    };
    let integration = match integration.as_str() {
        "euler" => Integration::EULER,
        "rk4" => Integration::RK4,
        other => return Err(format!("expected euler or rk4, found {other}").into()),
    };
    let settings = FilterSettings {
        discretisation: Discretisation {
            integration,
            ..Discretisation::default()
        },
        ..FilterSettings::at_site(Site::at_latitude_deg(39.1))
    };
    let mut filter = PlatformFilter::<f64>::new(&settings, &InitialAttitude::aligned())?;
    let sample = [0.0, 0.0, 1.0];
    let mut nis_sum = 0.0;
    for _ in 0..steps.parse::<u32>()? {
        nis_sum += filter.step(60.0, &sample)?.nis;
    }
    println!("{nis_sum:e}");
    Ok(())
}
