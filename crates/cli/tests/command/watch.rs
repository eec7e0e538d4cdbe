//! `gyrocal watch`: the fault of the example record is named, the sound record has no alarm.

use serde_json::Value;

use crate::folder::{Folder, repository};

fn watch(folder: &Folder, record: &str, more: &[&str]) -> (String, Value) {
    let csv = repository(&format!("examples/data/{record}.csv"));
    let bench = repository(&format!("examples/data/{record}.bench.toml"));
    let mut words = vec![
        "watch",
        csv.to_str().unwrap(),
        "--bench",
        bench.to_str().unwrap(),
    ];
    words.extend(["--json", "o.json"]);
    words.extend(more);
    let text = folder.succeed(&words);
    let json: Value = folder.json("o.json");
    (text, json["watch"].clone())
}

#[test]
fn the_fault_is_named_and_a_sound_record_is_quiet() {
    let folder = Folder::new();
    let (text, sound) = watch(&folder, "three_days", &[]);
    assert!(text.contains("No alarm."), "{text}");
    assert_eq!(sound["alarms"].as_array().unwrap().len(), 0);
    for more in [&[][..], &["--single"]] {
        let (text, answer) = watch(&folder, "hidden_fault", more);
        let alarm = &answer["alarms"][0];
        let causes = alarm["refined"].as_array().unwrap();
        let truth = causes
            .iter()
            .find(|cause| cause["id"] == "gyro_y.g_z")
            .unwrap();
        // The scenario's size, within four sigma of an estimate that was chosen for being large.
        let [estimate, sigma] = ["estimate", "sigma"].map(|key| truth[key].as_f64().unwrap());
        assert!((estimate - 1.2e-3).abs() < 4.0 * sigma, "{text}");
        assert!(text.contains("gyro_y.g_z"), "{text}");
    }
}

#[test]
fn a_missing_bench_is_told() {
    let folder = Folder::new();
    folder.put(
        "r.csv",
        "time_s,accel_x_g,accel_y_g,accel_z_g\n0,0,0,1\n60,0,0,1\n",
    );
    let errors = folder.fail("watch r.csv --bench b.toml");
    assert!(errors.contains("b.toml"), "{errors}");
}
