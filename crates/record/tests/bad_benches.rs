//! Each way in which a bench file can be wrong.

#![cfg(test)]

use gyrocal_record::{Bench, Error};

const GOOD: &str = "\
[site]
latitude_deg = 39.1
[platform]
initial_angles_deg = [0.0, 0, 0.0]
initial_angles_sigma_deg = [0.01, 0.01, 0.01]
[noise]
accel_g = 1e-5
gyro_deg_per_h = 0.002
";

#[test]
fn the_good_one_is_good() {
    let bench = Bench::parse(GOOD, "b.toml").unwrap();
    assert_eq!(bench.latitude_deg, 39.1);
    assert_eq!(bench.accel_noise_g, 1e-5);
    assert_eq!(bench.gyro_noise_deg_per_h, 0.002);
    assert_eq!(bench.gravity, None);
    let windows = GOOD.replace('\n', "\r\n");
    assert_eq!(Bench::parse(&windows, "b.toml").unwrap(), bench);
    let prior = format!("{GOOD}[prior]\nbias_sigma_deg_per_h = 3\n");
    let prior = Bench::parse(&prior, "b.toml").unwrap().prior;
    assert_eq!(prior.bias_sigma_deg_per_h, [3.0; 3]);
    assert_eq!(prior.g_sigma_deg_per_h_per_g, [1.0; 3]);
}

#[test]
fn a_platform_without_keys_and_none_are_an_unknown_attitude() {
    let angles =
        "initial_angles_deg = [0.0, 0, 0.0]\ninitial_angles_sigma_deg = [0.01, 0.01, 0.01]\n";
    let empty = GOOD.replace(angles, "");
    let bench = Bench::parse(&empty, "b.toml").unwrap();
    assert_eq!(bench.initial_angles_deg, None);
    let none = empty.replace("[platform]\n", "");
    assert_eq!(Bench::parse(&none, "b.toml").unwrap(), bench);
}

#[test]
fn what_identifies_a_run_is_kept_as_it_is_written() {
    let text = format!(
        "{GOOD}[identification]\nunit = \"P-7\"\nserial_numbers = [\"A 1\", 0x2A]\nmass_kg = 7.50\n\
         date = 2026-03-01\nstart = 2026-03-01T08:05:00+01:00\n\"Prüfer\" = \"<b>\"\nacel_g = 1\n"
    );
    let bench = Bench::parse(&text, "b.toml").unwrap();
    let facts = bench.identification.iter();
    let facts: Vec<_> = facts.map(|(key, value)| format!("{key}={value}")).collect();
    let expected = [
        "Prüfer=<b>",
        "acel_g=1",
        "date=2026-03-01",
        "mass_kg=7.50",
        "serial_numbers=A 1, 0x2A",
        "start=2026-03-01T08:05:00+01:00",
        "unit=P-7",
    ];
    assert_eq!(facts, expected);
    let again = Bench::parse(&bench.to_toml("b.toml".as_ref()).unwrap(), "c.toml");
    assert_eq!(again.unwrap(), bench);
}

/// What is written, what in its place, the kind of the mistake, its place, and words of what was found and
/// of what was expected.
const MISTAKES: &str = r#"
    39.1 | 90.5 | OutOfRange | 2:16 | `90.5` | from -90 to 90
    39.1 | -91 | OutOfRange | 2:16 | `-91` | from -90 to 90
    39.1 | nan | OutOfRange | 2:16 | `nan` | from -90 to 90
    39.1 | "39.1" | NotANumber | 2:16 | `"39.1"` | a number
    39.1 | 39,1 | Syntax | 2:18 |  | valid TOML
    1e-5 | 0 | OutOfRange | 7:11 | `0` | greater than 0
    1e-5 | -1e-5 | OutOfRange | 7:11 | `-1e-5` | greater than 0
    0.002 | 0.0 | OutOfRange | 8:18 | `0.0` | greater than 0
    0.002 | inf | OutOfRange | 8:18 | `inf` | greater than 0
    [0.01, 0.01, 0.01] | [0.01, 0, 0.01] | OutOfRange | 5:35 | `0` | greater than 0
    [0.01, 0.01, 0.01] | [0.01, 0.01] | WrongType | 5:28 | `[0.01, 0.01]` | three numbers
    [0.01, 0.01, 0.01] | 0.01 | WrongType | 5:28 | `0.01` | three numbers
    [0.0, 0, 0.0] | [0.0, 0, 400.0] | OutOfRange | 4:31 | `400.0` | from -360 to 360
    latitude_deg | lattitude_deg | UnknownKey | 2:1 | `lattitude_deg` in `[site]` | `latitude_deg`
    accel_g | acel_g | UnknownKey | 7:1 | `acel_g` in `[noise]` | `accel_g`
    [noise] | [noize] | UnknownKey | 6:2 | `noize` | `noise`
    accel_g = 1e-5\n |  | MissingKey | 6:2 | `[noise]` without | `accel_g = `
    [site]\nlatitude_deg = 39.1\n |  | MissingKey | 1:1 | without | `[site]`
    [site]\nlatitude_deg | site | WrongType | 1:8 | `39.1` | a table `[site]`
    [platform] | local_gravity_m_per_s2 = 9.8\n[platform] | MissingKey | 1:2 | `[site]` | together
    [platform] | local_gravity_m_per_s2 = 980\n[platform] | OutOfRange | 3:26 | `980` | 9.7 to 9.9
    [platform] | latitude_sigma_deg = 0\n[platform] | OutOfRange | 3:22 | `0` | greater than 0
    [platform] | gravity_relative_sigma = -1e-6\n[platform] | OutOfRange | 3:26 | `-1e-6` | greater than 0
    [platform] | magnetic_field_gauss = [0, 20000, -40000]\n[platform] | OutOfRange | 3:28 | `20000` | from -1 to 1
    initial_angles_deg = [0.0, 0, 0.0]\n |  | MissingKey | 3:2 | `[platform]` without | together
    initial_angles_sigma_deg = [0.01, 0.01, 0.01]\n |  | MissingKey | 3:2 | `[platform]` without | `initial_angles_sigma_deg = [
    [noise] | [prior]\nturn_on_sigma_deg_per_h = -0.1\n[noise] | OutOfRange | 7:27 | `-0.1` | not less than 0
    [noise] | [prior]\nbias_sigma_deg_per_h = -1\n[noise] | OutOfRange | 7:24 | `-1` | greater than 0
    [noise] | [gimbal_limits_deg]\ny = [60, -60]\n[noise] | OutOfRange | 7:5 | `[60, -60]` | the lower end first
    [noise] | [gimbal_limits_deg]\nx = 60\n[noise] | WrongType | 7:5 | `60` | two numbers `[from, to]`
    [noise] | [identification.unit]\nname = 1\n[noise] | WrongType | 6:1 | `[identification.unit]` | a text, a number, a date
    [noise] | [identification]\nheated = true\n[noise] | WrongType | 7:10 | `true` | a text, a number, a date
    [site] | identification = "P-7"\n[site] | WrongType | 1:18 | `"P-7"` | a table `[identification]`
    [noise] | [identificaton]\n[noise] | UnknownKey | 6:2 | `identificaton` | `identification`
    [noise] | [noise]\naccel_g = 1e-5 | Syntax | 8:1 | `accel_g` | duplicate key
"#;

#[test]
fn each_mistake_is_shown_where_it_is() {
    for mistake in MISTAKES.trim().lines() {
        let columns: Vec<_> = mistake.split('|').map(str::trim).collect();
        let [right, wrong, kind, place, found, expected] = columns[..] else {
            panic!("{mistake}")
        };
        let [right, wrong] = [right, wrong].map(|text| text.replace("\\n", "\n"));
        assert_eq!(GOOD.matches(&right).count(), 1, "{right}");
        let error = Bench::parse(&GOOD.replace(&right, &wrong), "b.toml").unwrap_err();
        let shown = error.to_string();
        let rest = shown.strip_prefix(&format!("b.toml:{place}: found "));
        let (before, after) = rest
            .and_then(|rest| rest.split_once(", expected "))
            .unwrap_or_else(|| panic!("{wrong}: {shown}"));
        assert!(before.contains(found), "{wrong}: {shown}");
        assert!(after.contains(expected), "{wrong}: {shown}");
        let Error::Input(input) = error else { panic!() };
        assert_eq!(format!("{:?}", input.kind), kind, "{shown}");
    }
}

#[test]
fn a_slip_of_a_key_is_recognised() {
    for (typed, meant) in [
        ("lattitude_deg", "latitude_deg"),
        ("latitude", "latitude_deg"),
    ] {
        let text = GOOD.replace("latitude_deg", typed);
        let Error::Input(error) = Bench::parse(&text, "b.toml").unwrap_err() else {
            panic!()
        };
        assert_eq!(error.advice, format!("did you mean `{meant}`?"));
    }
}
