//! Hidden effects in scenario files.

use gyrocal_truth::{Coefficients, Hidden, Scenario};

use crate::{example, quiet};

#[test]
fn every_effect_is_read_as_it_was_written() {
    for id in Hidden::ids() {
        let scenario = Scenario {
            // A file goes with a bench description, whose sigmas are positive.
            initial_angles_sigma_deg: [0.01; 3],
            accel_noise_g: 1e-5,
            gyro_noise_deg_per_h: 0.002,
            hidden: vec![example(&id)],
            ..quiet(Coefficients::PAPER_LIKE)
        };
        let text = scenario.to_toml();
        assert!(text.contains(&format!("effect = \"{id}\"")), "{text}");
        assert_eq!(Scenario::parse(&text, "s.toml").unwrap(), scenario, "{id}");
    }
}

#[test]
fn an_empty_temperature_table_is_the_usual_temperature() {
    let text = Scenario::default().to_toml();
    assert_eq!(Scenario::parse(&text, "s.toml").unwrap().temperature, None);
    let scenario = Scenario::parse(&(text + "[temperature]\n"), "s.toml").unwrap();
    assert_eq!(
        scenario.temperature,
        Some(gyrocal_truth::Temperature::default())
    );
}

#[test]
fn a_mistake_is_shown_where_it_is() {
    let good = Scenario::default().to_toml();
    let line = good.lines().count() + 1;
    // What is appended, line and column in it, and what is said.
    let cases = [
        (
            "[[hidden]]\neffect = \"gyro_y.gz\"\nsize = 1\n",
            "2:10: found the unknown effect `\"gyro_y.gz\"`, expected the id of an effect",
        ),
        (
            "[[hidden]]\neffect = \"gyro_y.g_z\"\nsice = 1\n",
            "3:1: found the unknown key `sice`, expected `size`, the parameters of gyro_y.g_z",
        ),
        (
            "[[hidden]]\neffect = \"gyro_y.g_z\"\n",
            "2:10: found gyro_y.g_z without it, expected `size = ` a number from -10000 to 10000",
        ),
        (
            "[[hidden]]\neffect = \"gyro_y.g_z\"\nsize = nan\n",
            "3:8: found `nan`, expected a number from -10000 to 10000",
        ),
        (
            "[[hidden]]\neffect = \"gyro_y.g_z\"\nsize = \"1\"\n",
            "3:8: found `\"1\"`, expected a finite number",
        ),
        (
            "[[hidden]]\nsize = 1\n",
            "1:1: found `[[hidden]]` without it, expected `effect = ` the id of an effect",
        ),
        (
            "[[hidden]]\neffect = 1\n",
            "2:10: found `1`, expected the id of an effect in quotes",
        ),
        (
            "[hidden]\neffect = \"gyro_y.g_z\"\nsize = 1\n",
            "1:1: found `[hidden]`, expected tables `[[hidden]]`",
        ),
        (
            "[[hidden]]\neffect = \"gyro_x.ramp\"\nsize = 1\n\
             [[hidden]]\neffect = \"gyro_x.temperature\"\nsize = 1\n",
            "5:10: found the effect gyro_x.temperature without a temperature",
        ),
        (
            "[temperature]\ndaily = 1\n",
            "2:1: found the unknown key `daily` in `[temperature]`",
        ),
    ];
    for (added, message) in cases {
        let error = Scenario::parse(&format!("{good}{added}"), "s.toml").unwrap_err();
        let shown = error.to_string();
        let (row, rest) = message.split_once(':').unwrap();
        let row = line - 1 + row.parse::<usize>().unwrap();
        let expected = format!("s.toml:{row}:{rest}");
        assert!(shown.starts_with(&expected), "{expected}\nis not\n{shown}");
    }
}
