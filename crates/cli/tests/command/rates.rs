//! `gyrocal rates` on simulated logs.

use std::fmt::Write as _;

use crate::calibrate::unwrapped;
use crate::folder::Folder;

const DESCRIPTION: &str = "[time]\ncolumn = \"t\"\n[gyro]\ncolumns = [\"gx\", \"gy\", \"gz\"]\nunit = \
                           \"deg/s\"\n[accel]\ncolumns = [\"ax\", \"ay\", \"az\"]\nunit = \"g\"\n\
                           [temperature]\ncolumn = \"temp\"\nunit = \"C\"\n[site]\nlatitude_deg = 48\n";

/// A log of 2000 samples at 10 Hz with a bias of 3 deg/s of gyro x.
fn log(temperature: f64, gyro_z: impl Fn(usize, f64) -> f64) -> String {
    biased_log(3.0, temperature, gyro_z)
}

/// The same with another bias of gyro x \[deg/s\].
fn biased_log(bias_x: f64, temperature: f64, gyro_z: impl Fn(usize, f64) -> f64) -> String {
    let mut state = 3_u64;
    let mut noise = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 40) as f64 / f64::from(1_u32 << 24) - 0.5
    };
    let mut text = "t,gx,gy,gz,ax,ay,az,temp\n".to_owned();
    for sample in 0..2000 {
        let [x, y, z] = [0.02 * noise(), 0.02 * noise(), 0.02 * noise()];
        let force = [1e-3 * noise(), 1e-3 * noise(), 1.0 + 1e-3 * noise()];
        let temperature = temperature + 0.01 * noise();
        let z = gyro_z(sample, z);
        let _ = writeln!(
            text,
            "{:.1},{:.6},{y:.6},{z:.6},{:.6},{:.6},{:.6},{temperature:.4}",
            0.1 * sample as f64,
            bias_x + x,
            force[0],
            force[1],
            force[2],
        );
    }
    text
}

fn folder(log: String) -> Folder {
    let folder = Folder::new();
    folder.put("log.csv", log);
    folder.put("log.toml", DESCRIPTION);
    folder
}

const ARGUMENTS: &str = "rates log.csv --log-description log.toml --json o.json";

#[test]
fn a_bias_of_degrees_a_second_is_told_within_earth_rate() {
    let folder = folder(log(25.0, |_, z| z));
    let text = folder.succeed(ARGUMENTS);
    assert!(text.contains("gyro_x.bias"), "{text}");
    let json: serde_json::Value = folder.json("o.json");
    let log = &json["logs"][0];
    let bias = log["bias_deg_per_h"][0].as_f64().unwrap();
    let half_width = log["bias_half_width_deg_per_h"][0].as_f64().unwrap();
    // 3 deg/s; Earth rate toward an unknown heading, and noise of 0.006 deg/s over 2000 samples.
    assert!((bias - 10_800.0).abs() < half_width, "{bias} {half_width}");
    assert!(half_width < 16.0, "{half_width}");
}

#[test]
fn the_import_of_such_a_log_names_the_command_for_it() {
    let folder = folder(log(25.0, |_, z| z));
    let errors = folder
        .fail("import strapdown log.csv --log-description log.toml --out r.csv --averaging-s 10");
    assert!(errors.contains("gyrocal rates"), "{errors}");
}

#[test]
fn a_temperature_in_another_unit_is_told_with_its_line() {
    let errors = folder(log(298.0, |_, z| z)).fail(ARGUMENTS);
    assert!(errors.contains("log.csv:2"), "{errors}");
    assert!(errors.contains("unit = \"K\""), "{errors}");
}

#[test]
fn a_saturated_gyro_is_told_with_its_line() {
    let at_end = |sample: usize, z: f64| {
        if (700..760).contains(&sample) {
            300.0
        } else {
            z
        }
    };
    let errors = folder(log(25.0, at_end)).fail(ARGUMENTS);
    assert!(errors.contains("log.csv:702"), "{errors}");
    assert!(errors.contains("60 samples of `gz`"), "{errors}");
}

#[test]
fn signs_of_the_wrong_way_round_are_told() {
    let vertical_deg_per_s = 15.041_07 * 48.0_f64.to_radians().sin() / 3600.0;
    // A bias of degrees per second and an error of the level would hide the Earth.
    let right =
        folder(biased_log(0.0, 25.0, |_, z| 0.2 * z + vertical_deg_per_s)).succeed(ARGUMENTS);
    assert!(right.starts_with("RATES  "), "{right}");
    let wrong =
        folder(biased_log(0.0, 25.0, |_, z| 0.2 * z - vertical_deg_per_s)).succeed(ARGUMENTS);
    assert!(wrong.starts_with("CHECK SIGNS  "), "{wrong}");
}

#[test]
fn an_equal_bias_that_the_logs_do_not_show_is_told_as_assumed() {
    let folder = folder(log(25.0, |_, z| z));
    // The same log upside down.
    let over = |line: &str| {
        let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
        if let Ok(up) = fields[6].parse::<f64>() {
            fields[6] = (-up).to_string();
        }
        fields.join(",") + "\n"
    };
    let text = folder.text("log.csv");
    folder.put("over.csv", text.lines().map(over).collect::<String>());
    let told = |logs: &str| {
        let arguments = format!("rates {logs} --log-description log.toml --json o.json");
        let short = unwrapped(&folder.succeed_as_is(&*arguments));
        let json: serde_json::Value = folder.json("o.json");
        let long = unwrapped(&folder.succeed(&*arguments));
        let words = "an equal bias in all 2 logs";
        [
            short.contains(&format!("assumed {words}")),
            long.contains(&format!("Assumed: {words}")),
            json["gyros"][2]["assumes_equal_bias"] == true,
        ]
    };
    // Bias and a term along z take both logs; two of one position leave a difference.
    assert_eq!(told("log.csv over.csv"), [true; 3]);
    assert_eq!(told("log.csv over.csv log.csv"), [false; 3]);
    assert_eq!(told("log.csv"), [false; 3]);
}
