//! Scripts that are derived, and scripts that are refused.
#![cfg(test)]

use std::path::{Path, PathBuf};

use gyrocal_plant::LoadedPlant;
use gyrocal_plant_codegen::{derive, settings_of_a_command};

fn example(file: &str) -> PathBuf {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    examples.join("duffing").join(file)
}

fn derived(script: &str) -> Result<LoadedPlant, String> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("plant.py");
    std::fs::write(&path, script).unwrap();
    let derived = derive(&path, settings_of_a_command()).map_err(|error| error.to_string())?;
    Ok(LoadedPlant::parse(&derived.program, "plant.py").unwrap())
}

#[test]
fn the_committed_program_and_its_rust_are_those_of_the_script() {
    let derived = derive(&example("plant.py"), settings_of_a_command()).unwrap();
    for (file, text) in [
        ("plant.json", &derived.program),
        ("plant.rs", &derived.rust),
    ] {
        assert!(
            std::fs::read_to_string(example(file)).unwrap() == *text,
            "examples/duffing/{file} is stale: GYROCAL_CODEGEN_WRITE=1 cargo build -p gyrocal-example-duffing"
        );
    }
    assert_eq!(derived.model, "Duffing");
    assert!(
        derived.left_out[0].contains("nominal parameter"),
        "{:?}",
        derived.left_out
    );
}

#[test]
fn an_extended_plant_has_the_term_as_a_parameter() {
    let script = std::fs::read_to_string(example("plant.py")).unwrap();
    let with = |line: &str| {
        script.replace(
            "    plant.write()",
            &format!("    {line}\n    plant.write()"),
        )
    };
    let plant = derived(&with("plant.extend(\"v_rate.x^3\", -0.05)")).unwrap();
    let last = plant.description().parameters.last().unwrap();
    assert_eq!(
        (last.id.as_str(), last.unit.as_str(), last.value),
        ("v_rate.x^3", "m^-2 s^-2", -0.05)
    );
    assert!(
        plant
            .description()
            .effects
            .iter()
            .all(|effect| effect.id != last.id)
    );
    let refused = |line: &str| derived(&with(line)).unwrap_err();
    let error = refused("plant.extend(\"y.step\")");
    assert!(error.contains("is a function of time"), "{error}");
    let error = refused("plant.extend(\"v_rate.x3\")");
    assert!(error.contains("near names are v_rate.x^3"), "{error}");
}

#[test]
fn scripts_are_refused_with_their_line() {
    let error = derived("import casadi\n\nplant = nothing\n").unwrap_err();
    assert!(error.contains("plant.py, line 3: NameError"), "{error}");
    let error = derived("from gyrocal_plant import Plant\n").unwrap_err();
    assert!(
        error.contains("calls `write()` of a plant 0 times"),
        "{error}"
    );
}
