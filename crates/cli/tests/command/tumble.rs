//! `gyrocal tumble` on the recording that ships with the repository.

use crate::folder::{Folder, assert_says, repository, repository_argument};

const LOG: &str = "tests/data/measured/xsens_38_positions/imu_counts.csv";
const DESCRIPTION: &str = "tests/data/measured/xsens_38_positions/log.toml";

fn arguments<'a>(log: &'a str, description: &'a str) -> [&'a str; 6] {
    [
        "tumble",
        log,
        "--log-description",
        description,
        "--json",
        "o.json",
    ]
}

#[test]
fn the_nominal_law_of_the_recorded_instrument_is_wrong_and_cross_axis_terms_are_why() {
    let folder = Folder::new();
    let (log, description) = (repository_argument(LOG), repository_argument(DESCRIPTION));
    let text = folder.succeed(arguments(&log, &description));
    assert_says(&text, "38 static stops");
    let json: serde_json::Value = folder.json("o.json");
    let sensors = &json["sensors"];
    for gyro in 0..3 {
        // The scale published with the recording is about 4770, accurate to half a percent.
        let outputs = sensors["gyro_outputs_per_rad_per_s"][gyro]
            .as_f64()
            .unwrap();
        assert!((outputs / 4770.0 - 1.0).abs() < 5e-3, "{outputs}");
    }
    let test = &json["test"];
    let mut found: Vec<&str> = test["findings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|finding| finding["effect"].as_str().unwrap())
        .collect();
    found.sort_unstable();
    let cross_axis = [
        "gyro_x.g_y",
        "gyro_x.g_z",
        "gyro_y.g_x",
        "gyro_y.g_z",
        "gyro_z.g_x",
        "gyro_z.g_y",
    ];
    assert_eq!(found, cross_axis);
    for gyro in test["gyros"].as_array().unwrap() {
        // 35 degrees of freedom: by far.
        let p_value = gyro["nominal"]["p_value"].as_f64().unwrap();
        assert!(p_value < 1e-10, "{p_value}");
        // The scatter of the stops is about as large as their standard errors.
        let scatter = &gyro["extended"]["noise"]["scatter_deg_per_h"];
        assert!(scatter[0].as_f64().unwrap() < 60.0, "{scatter}");
    }
    // The same terms by another least-squares program, in counts per g: 6.61, 2.94, -13.16,
    // 8.19, -7.98, -6.89, times 43.2 deg/h a count. Other weights, one sigma at the most.
    let another = [
        ("gyro_x.g_z", 286.0),
        ("gyro_x.g_y", 127.0),
        ("gyro_y.g_x", -569.0),
        ("gyro_y.g_z", 354.0),
        ("gyro_z.g_y", -345.0),
        ("gyro_z.g_x", -298.0),
    ];
    for finding in test["findings"].as_array().unwrap() {
        let name = finding["effect"].as_str().unwrap();
        let (_, expected) = another.iter().find(|(other, _)| *other == name).unwrap();
        let (estimate, sigma) = (
            finding["estimate"].as_f64().unwrap(),
            finding["sigma"].as_f64().unwrap(),
        );
        assert!(
            (estimate - expected).abs() < sigma,
            "{name}: {estimate} {sigma}"
        );
        assert!(finding["p_value"].as_f64().unwrap() <= 0.01);
    }
    let gain = &test["gain"];
    let nats = gain["cross_validated_log_score_nats"].as_f64().unwrap();
    let error = gain["standard_error_nats"].as_f64().unwrap();
    assert!(nats > 5.0 * error, "{nats} {error}");
}

/// Width of the pictures as PNG, px.
const PNG_WIDTH_PX: u32 = 1200;

#[test]
fn causes_are_drawn_as_the_readme_shows_them() {
    let folder = Folder::new();
    let (log, description) = (repository_argument(LOG), repository_argument(DESCRIPTION));
    let arguments = arguments(&log, &description);
    let text = folder.succeed([&arguments[..4], &["--figures", "pictures"]].concat());
    assert_says(&text, "pictures: 3 pictures");
    let terms = folder.text("pictures/terms.svg");
    for cause in ["gyro_x.g_y", "gyro_y.g_z", "gyro_z.g_x"] {
        assert!(terms.contains(cause), "{cause}");
    }
    // One dot for each stop in each of six panels, and one in the key.
    assert_eq!(terms.matches("<circle").count(), 6 * 38 + 1);
    assert_says(&folder.text("pictures/residual.svg"), "extended law");
    assert!(folder.text("pictures/laws.svg").contains("nominal law"));
    // The picture of the README is the one that its command draws.
    let shown = std::fs::read(repository("docs/pictures/xsens-causes.png")).unwrap();
    assert!(shown.len() < 200_000);
    assert!(
        shown == gyrocal_report::to_png(&terms, PNG_WIDTH_PX).unwrap(),
        "docs/pictures/xsens-causes.png differs: copy the terms.png that a build with --features \
         png draws there"
    );
}

#[test]
fn outputs_go_into_a_folder_that_the_command_makes_but_not_over_each_other() {
    let folder = Folder::new();
    let (log, description) = (repository_argument(LOG), repository_argument(DESCRIPTION));
    let arguments = arguments(&log, &description);
    let command = &arguments[..4];
    let refused = |more: &[&str]| {
        let output = folder.run([command, more].concat());
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8(output.stderr).unwrap()
    };
    let errors = refused(&["--figures", "new", "--json", "new/terms.svg"]);
    let expected = "--json new/terms.svg is among the pictures of --figures new";
    assert!(errors.contains(expected), "{errors}");
    let errors = refused(&["--figures", "new", "--json", "new"]);
    assert_says(&errors, "--json new would overwrite --figures new");
    // One stop is too few, which is found later.
    let few = ["--stop", "1:50", "--figures", "n", "--json", "n/s/o.json"];
    let errors = folder.fail([command, &few].concat());
    assert_says(&errors, "n/s/o.json: cannot be written");
    let outputs = ["--figures", "new/pictures", "--json", "new/o.json"];
    folder.succeed([command, &outputs].concat());
    assert!(folder.path("new/o.json").exists());
    assert!(folder.path("new/pictures/terms.svg").exists());
}

#[test]
fn a_rare_false_alarm_does_not_hide_what_is_there() {
    let folder = Folder::new();
    let (log, description) = (repository_argument(LOG), repository_argument(DESCRIPTION));
    let arguments = arguments(&log, &description);
    let text = folder.succeed([&arguments[..4], &["--false-alarm", "1e-5"]].concat());
    // The largest p of the six terms is half of it.
    assert_says(&text, "the nominal drift law lacks 6 terms");
}

#[test]
fn a_log_that_is_never_static_is_told() {
    // The unit rotates all the time: all stops are removed, and the turns between them are joined on
    // one clock.
    let log = std::fs::read_to_string(repository(LOG)).unwrap();
    let folder = Folder::new();
    let mut lines = log.lines();
    let mut moving = lines.next().unwrap().to_owned() + "\n";
    let names: Vec<&str> = log.lines().next().unwrap().split(',').collect();
    let accel_x = names
        .iter()
        .position(|name| *name == "accel_x_counts")
        .unwrap();
    for (row, line) in lines.take(6000).enumerate() {
        let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
        // Swung by a quarter of g at half a hertz.
        let count: f64 = fields[accel_x].parse().unwrap();
        let swing = 1000.0 * (row as f64 * 0.01 * core::f64::consts::PI).sin();
        fields[accel_x] = format!("{:.0}", count + swing);
        moving += &(fields.join(",") + "\n");
    }
    folder.put("l.csv", moving);
    let description = repository_argument(DESCRIPTION);
    let errors = folder.fail(arguments("l.csv", &description));
    assert_says(&errors, "static");
}

#[test]
fn bad_input_is_told() {
    let log = std::fs::read_to_string(repository(LOG)).unwrap();
    let description = std::fs::read_to_string(repository(DESCRIPTION)).unwrap();
    let refused = |log: &str, description: &str| {
        let folder = Folder::new();
        folder.put("l.csv", log);
        folder.put("l.toml", description);
        folder.fail(arguments("l.csv", "l.toml"))
    };
    let without_scale = description.replace("counts_per_g = \"from-stops\"\n", "");
    let cases = [
        (
            refused(&log, &without_scale),
            "`[accel]` in counts without `counts_per_g`",
        ),
        (
            // A y axis that points the other way, in gyros and accelerometers.
            refused(
                &log,
                &description.replace(
                    "unit = \"counts\"",
                    "unit = \"counts\"\naxes = [\"x\", \"-y\", \"z\"]",
                ),
            ),
            "left-handed axes",
        ),
        (
            refused(
                &log,
                &description.replace("gyro_x_counts\", \"gyro_y", "gyro_y_counts\", \"gyro_x"),
            ),
            "gyros x, y, z turn about y, x, z",
        ),
        (
            refused(
                &log,
                &description.replace("counts_per_g = \"from-stops\"", "counts_per_g = 2000"),
            ),
            "a norm of specific force at rest of",
        ),
        (
            refused(
                &log,
                &description.replace(
                    "counts_per_rad_per_s = \"from-turns\"",
                    "counts_per_rad_per_s = 83",
                ),
            ),
            "gyros that read",
        ),
        (
            // The first thousand rows and those after two thousand.
            refused(
                &log.lines()
                    .enumerate()
                    .filter(|(row, _)| !(1000..2000).contains(row))
                    .map(|(_, line)| line.to_owned() + "\n")
                    .collect::<String>(),
                &description,
            ),
            "gap(s) in the time stamps",
        ),
        (
            // The stop at the start alone.
            refused(
                &log.lines().take(4000).collect::<Vec<_>>().join("\n"),
                &description,
            ),
            "1 static stops",
        ),
        (
            refused(&log.replace("accel_z_counts", "accel_up"), &description),
            "l.csv:1:1: found a header without it, expected a column `accel_z_counts`",
        ),
    ];
    for (errors, message) in cases {
        assert!(errors.contains(message), "{message}\nis not in\n{errors}");
    }
}

#[test]
fn stops_can_be_given_and_too_few_are_told() {
    let folder = Folder::new();
    let (log, description) = (repository_argument(LOG), repository_argument(DESCRIPTION));
    let two = ["--stop", "1:50", "--stop", "56:63"];
    let errors = folder.fail([&arguments(&log, &description)[..4], &two].concat());
    assert_says(&errors, "found 2 static stops");
    for wrong in [
        &["--stop", "5"][..],
        &["--shortest-stop-s", "nan"],
        &["--quiet-factor", "inf"],
        // They have no effect on given stops.
        &["--stop", "1:50", "--shortest-stop-s", "3"],
        &["--stop", "1:50", "--quiet-factor", "3"],
    ] {
        let output = folder.run([&arguments(&log, &description)[..4], wrong].concat());
        assert_eq!(output.status.code(), Some(2), "{wrong:?}");
    }
}

#[test]
fn too_few_stops_to_leave_some_out_are_told() {
    let folder = Folder::new();
    let (log, description) = (repository_argument(LOG), repository_argument(DESCRIPTION));
    let arguments = arguments(&log, &description);
    let text = folder.succeed([&arguments[..4], &["--left-out", "1000"]].concat());
    let expected = "cannot be measured: without 1000 successive";
    assert!(text.contains(expected), "{text}");
    assert_says(&text, "Give a smaller --left-out");
}

/// A log of one position at 50 Hz for 20 s, of a unit whose gyro x drifts by 400 deg/h/g along z.
fn position(force: [f64; 3], seed: u64) -> String {
    let mut state = seed;
    let mut noise = || {
        // Sum of twelve uniform numbers.
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    };
    let mut text = "gx,gy,gz,ax,ay,az\n".to_owned();
    let gyros = [0.3 + 400.0 / 3600.0 * force[2], -0.2, 0.1];
    for _ in 0..1000 {
        let [gx, gy, gz] = gyros.map(|rate| rate + 0.05 * noise());
        let [ax, ay, az] = force.map(|force| 9.81 * (force + 0.01 + 1e-3 * noise()));
        text += &format!("{gx},{gy},{gz},{ax},{ay},{az}\n");
    }
    text
}

const SIX: &str = "[time]\nrate_hz = 50\n[gyro]\ncolumns = [\"gx\", \"gy\", \"gz\"]\nunit = \
                   \"deg/s\"\n[accel]\ncolumns = [\"ax\", \"ay\", \"az\"]\nunit = \"m/s2\"\n[site]\n\
                   gravity_m_per_s2 = 9.81\n";

#[test]
fn six_logs_are_six_positions() {
    let folder = Folder::new();
    folder.put("log.toml", SIX);
    let mut names = Vec::new();
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let mut force = [0.0; 3];
            force[axis] = sign;
            let name = format!("{}.csv", names.len());
            folder.put(&name, position(force, names.len() as u64));
            names.push(name);
        }
    }
    let mut arguments = vec!["tumble"];
    arguments.extend(names.iter().map(String::as_str));
    arguments.extend(["--log-description", "log.toml", "--json", "o.json"]);
    let text = folder.succeed(&arguments);
    assert_says(&text, "0.csv and 5 further logs: 6 static stops");
    assert_says(&text, "accel_x.bias");
    assert_says(
        &text,
        "Not determined by these positions: accel_x.misalignment_y",
    );
    // Two of them tell nothing of the noise between stops.
    let two = folder.succeed("tumble 4.csv 5.csv --log-description log.toml");
    assert!(two.starts_with("NOT TESTED  too few stops"), "{two}");
    assert_says(&two, "a test needs six");
    assert!(!two.contains("how sure"), "{two}");
    let json: serde_json::Value = folder.json("o.json");
    let finding = &json["test"]["findings"][0];
    assert_eq!(finding["effect"], "gyro_x.g_z");
    let [estimate, sigma] = ["estimate", "sigma"].map(|key| finding[key].as_f64().unwrap());
    assert!((estimate - 400.0).abs() < 4.0 * sigma, "{estimate} {sigma}");
    assert_eq!(json["sensors"]["stops"].as_array().unwrap().len(), 6);
    let bias = &json["sensors"]["accel_errors"]["coefficients"][0];
    assert!(
        (bias["estimate"].as_f64().unwrap() - 0.01).abs() < 1e-3,
        "{bias}"
    );
    // Positions that are one determine nothing more.
    let errors = folder.fail("tumble 0.csv 0.csv --log-description log.toml");
    assert_says(&errors, "all in one position");
}
