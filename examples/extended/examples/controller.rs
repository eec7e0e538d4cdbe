//! Prediction errors of the nominal and the extended filter: three days with samples, then a day
//! without. The error is the drift that torquers cannot compensate.
//!
//! `cargo run --release --package gyrocal-extended --example controller -- RECORD.csv BENCH.toml`

use std::path::Path;

use gyrocal::{FilterSettings, InitialAttitude, PlatformFilter, Site};
use gyrocal_extended::controller;
use gyrocal_record::{Bench, Record};

/// Time with measurement updates, s.
const LEARNING_S: f64 = 3.0 * 86_400.0;
/// Interval of the printed lines, s.
const LINE_S: f64 = 3.0 * 3600.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [record, bench] = arguments.as_slice() else {
        return Err("expected two arguments: RECORD.csv and BENCH.toml".into());
    };
    let record = Record::read(Path::new(record))?;
    let bench = Bench::read(Path::new(bench))?;
    let settings = FilterSettings {
        accel_noise_g: bench.accel_noise_g,
        drift_noise_deg_per_h: bench.gyro_noise_deg_per_h,
        ..FilterSettings::at_site(Site::at_latitude_deg(bench.latitude_deg))
    };
    let attitude = attitude(&bench)?;
    let mut nominal = PlatformFilter::new(&settings, &attitude)?;
    let mut extended = controller(&settings, &attitude)?;

    println!("hours alone   nominal error    extended error    torquer command, deg/h");
    let mut next_line_s = 0.0;
    for (row, sample) in record.accel_g.iter().enumerate() {
        let time_s = record.time_s[row] - record.time_s[0];
        let interval_s = record.time_s[row] - record.time_s[row.saturating_sub(1)];
        if time_s <= LEARNING_S {
            if row > 0 {
                nominal.predict(interval_s)?;
            }
            nominal.update(sample)?;
            extended.take(interval_s, sample)?;
        } else {
            nominal.predict(interval_s)?;
            extended.coast(interval_s)?;
        }
        if time_s - LEARNING_S >= next_line_s {
            let [_, up] = nominal.kernel().inputs().orientation();
            let torque = extended.drift_deg_per_h(sample).map(|drift| -drift);
            println!(
                "{:11.0} {:8.2} arcmin {:10.2} arcmin   [{:7.4}, {:7.4}, {:7.4}]",
                next_line_s / 3600.0,
                arcminutes_between(&up, sample),
                arcminutes_between(&extended.expected_g(), sample),
                torque[0],
                torque[1],
                torque[2],
            );
            next_line_s += LINE_S;
        }
    }
    Ok(())
}

/// The declared attitude of both filters.
fn attitude(bench: &Bench) -> Result<InitialAttitude<f64>, &'static str> {
    let angles_deg = bench.initial_angles_deg;
    let angles_deg = angles_deg.ok_or("expected initial_angles_deg in the bench file")?;
    Ok(InitialAttitude::Angles {
        angles_rad: angles_deg.map(f64::to_radians),
        sigma_rad: bench.initial_angles_sigma_deg.map(f64::to_radians),
    })
}

/// The angle between two specific forces.
fn arcminutes_between(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let cross: [f64; 3] = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    });
    let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    let sine = cross.iter().map(|c| c * c).sum::<f64>().sqrt();
    sine.atan2(dot).to_degrees() * 60.0
}
