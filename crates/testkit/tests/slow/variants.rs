//! Variants: programs defined by files of other packages.

use std::fs;
use std::path::PathBuf;

use gyrocal_codegen::build::{Settings, Variant};
use gyrocal_testkit::{edit, real_environments, workspace};

use crate::SCRATCH;
use crate::tiny::TinyDerivation;

/// Function of a tiny derivation that serves other packages; their file holds a factor.
const DERIVE_FROM: &str = r#"

def derive_from(file, name, output):
    factor = float(file.read_text())
    if factor <= 0:
        from casadi_program import ExportError
        raise ExportError(f"{file.name}: found {factor}, expected a number greater than 0")
    function = Function(name, "A function.", "none", [point], [Output("value", factor * x, "m", "value")])
    Program(name, "A program.", [function]).write(output / f"{name}.json")
"#;

/// A tiny derivation, and a package that has a variant of it.
struct Package {
    tiny: TinyDerivation,
    settings: Settings,
}

impl Package {
    fn make(name: &str) -> Self {
        let tiny = TinyDerivation::make(SCRATCH, name);
        let script = fs::read_to_string(tiny.script()).unwrap();
        fs::write(tiny.script(), script + DERIVE_FROM).unwrap();
        fs::create_dir(tiny.root.join("out")).unwrap();
        fs::write(tiny.root.join("scaled.factor"), "2.5\n").unwrap();
        let mut settings = Settings::from_env();
        settings.environments = Some(real_environments());
        settings.offline = false;
        settings.write = false;
        Self { tiny, settings }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.tiny.root.join(name)
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    fn variant(&self) -> Variant {
        Variant::open(self.tiny.directory(), self.path("scaled.factor"))
            .unwrap()
            .with_settings(self.settings.clone())
    }

    fn with_copy(&self) -> Variant {
        self.variant().committed(self.path("package/generated"))
    }

    /// The same package without Python: nothing can be derived.
    fn without_python(mut self) -> Self {
        self.settings.python = Some("/no/such/python".into());
        self
    }
}

#[test]
fn without_a_copy_the_module_is_derived_once() {
    let package = Package::make("variant-out");
    let outcome = package.variant().build(package.path("out")).unwrap();
    assert!(outcome.timings.is_some());
    let module = package.text("out/scaled.rs");
    assert!(module.contains("pub fn scaled<T: Scalar>"), "{module}");
    assert!(module.contains("from `derive, scaled.factor`"), "{module}");
    let lines = outcome.cargo_lines();
    assert!(!lines.contains("cargo::warning"), "{lines}");
    assert!(lines.contains("scaled.factor\n"), "{lines}");

    let package = package.without_python();
    let again = package.variant().build(package.path("out")).unwrap();
    assert!(again.timings.is_none(), "derived twice");
    edit(package.path("scaled.factor"), "2.5", "3.5");
    let error = package.variant().build(package.path("out")).unwrap_err();
    assert!(error.to_string().contains("no suitable Python"), "{error}");
}

#[test]
fn a_fresh_copy_needs_no_python_and_a_stale_one_is_named() {
    let package = Package::make("variant-copy");
    package.with_copy().write().unwrap();
    package.with_copy().check().unwrap();
    let package = package.without_python();
    let outcome = package.with_copy().build(package.path("out")).unwrap();
    assert!(outcome.is_fresh());
    assert_eq!(
        package.text("out/scaled.rs"),
        package.text("package/generated/scaled.rs")
    );
    // Whatever the module depends on, an edit of it is seen.
    for (file, from, to) in [
        ("scaled.factor", "2.5", "3.5"),
        ("derive/main.py", "x * y + 2", "x * y + 3"),
    ] {
        edit(package.path(file), from, to);
        assert_eq!(package.with_copy().stale().unwrap().len(), 1, "{file}");
        let error = package.with_copy().build(package.path("out")).unwrap_err();
        assert!(error.to_string().contains("scaled.rs` is stale"), "{error}");
        edit(package.path(file), to, from);
        assert!(package.with_copy().stale().unwrap().is_empty(), "{file}");
    }
}

#[test]
fn a_stale_copy_is_derived_anew_and_written_only_if_that_is_wanted() {
    let mut package = Package::make("variant-write");
    package.with_copy().write().unwrap();
    let before = package.text("package/generated/scaled.rs");
    edit(package.path("scaled.factor"), "2.5", "3.5");
    let outcome = package.with_copy().build(package.path("out")).unwrap();
    assert!(package.text("out/scaled.rs").contains("3.5e0"));
    assert_eq!(package.text("package/generated/scaled.rs"), before);
    let lines = outcome.cargo_lines();
    assert!(
        lines.contains("commit it with `GYROCAL_CODEGEN_WRITE=1 cargo build`"),
        "{lines}"
    );

    package.settings.write = true;
    let outcome = package.with_copy().build(package.path("out")).unwrap();
    assert!(outcome.is_fresh());
    assert!(!outcome.cargo_lines().contains("cargo::warning"));
    let after = package.text("package/generated/scaled.rs");
    assert!(after.contains("3.5e0"));
    assert_eq!(package.text("out/scaled.rs"), after);
}

#[test]
fn what_the_derivation_refuses_is_passed_on() {
    let package = Package::make("variant-refused");
    edit(package.path("scaled.factor"), "2.5", "-2.5");
    let error = package.variant().build(package.path("out")).unwrap_err();
    let said = "scaled.factor: found -2.5, expected a number greater than 0";
    assert!(error.to_string().contains(said), "{error}");

    edit(
        package.tiny.script(),
        "def derive_from",
        "def derive_otherwise",
    );
    let error = package.variant().build(package.path("out")).unwrap_err();
    assert!(
        error.to_string().contains("no function `derive_from"),
        "{error}"
    );
}

#[test]
fn the_copies_of_the_example_are_what_its_model_files_give() {
    let example = workspace().join("examples/extended");
    let mut settings = Settings::from_env();
    settings.environments = Some(real_environments());
    settings.offline = false;
    for file in ["extended.model.toml", "unit.model.toml"] {
        let variant = Variant::open(workspace().join("codegen/derive"), example.join(file))
            .unwrap()
            .committed(example.join("src/generated"))
            .with_settings(settings.clone());
        variant.check().unwrap();
    }
}
