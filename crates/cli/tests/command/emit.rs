//! `gyrocal emit`: one Rust file. That it compiles and holds its numbers, `crates/emit` tests.

use crate::folder::{Folder, assert_says, repository};

const MODEL: &str = "schema_version = 1\neffects = [\"gyro_y.g_z\"]\n";

#[test]
fn the_nominal_filter_is_written_and_the_way_on_is_told() {
    let folder = Folder::new();
    let said = folder.succeed_as_is("emit --out filter.rs");
    let text = folder.text("filter.rs");
    assert!(text.contains("pub type Number = f32;"));
    assert_says(&said, "rustc --edition 2024 --crate-type lib filter.rs");
}

#[test]
fn an_extended_filter_needs_the_module_of_its_model_file() {
    let folder = Folder::new();
    folder.put("extended.model.toml", MODEL);
    folder.put("other.model.toml", MODEL);
    let module = repository("examples/extended/src/generated/extended.rs");
    let module = module.to_string_lossy().into_owned();
    let rest = ["--module", &module, "--number", "f64", "--out", "filter.rs"];
    folder.succeed_as_is([&["emit", "extended.model.toml"], &rest[..]].concat());
    let text = folder.text("filter.rs");
    assert!(text.contains("pub type Number = f64;"));
    assert!(text.contains("\"gyro_y.g_z\", [0.0, "));
    let said = folder.fail([&["emit", "other.model.toml"], &rest[..]].concat());
    assert_says(&said, "other.rs: found no `pub struct Other;`");
}
