//! The files of this crate that generated code depends on, embedded: a published crate
//! needs no path to them, and their texts take part in the fingerprint.

use std::path::Path;

use super::error::{Error, at};
use super::fingerprint::Input;

macro_rules! embedded {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!(concat!("../../", $path)))),*]
    };
}

/// The exporter, written out where it is run.
const EXPORTER: &[(&str, &str)] = embedded![
    "exporter/casadi_program.py",
    "exporter/plant.py",
    "exporter/run.py"
];

/// The emitter: every source file of the crate outside `src/build` and `src/main.rs`,
/// which decide when code is generated and not what it looks like.
const EMITTER: &[(&str, &str)] = embedded![
    "src/emit.rs",
    "src/emit/count.rs",
    "src/emit/doc.rs",
    "src/emit/explain.rs",
    "src/emit/expression.rs",
    "src/emit/function.rs",
    "src/emit/group.rs",
    "src/emit/items.rs",
    "src/emit/local.rs",
    "src/emit/model.rs",
    "src/emit/model/complete.rs",
    "src/emit/model/form.rs",
    "src/emit/model/methods.rs",
    "src/emit/noise.rs",
    "src/emit/output.rs",
    "src/emit/plan.rs",
    "src/emit/table.rs",
    "src/error.rs",
    "src/ir.rs",
    "src/ir/evaluate.rs",
    "src/ir/lower.rs",
    "src/lib.rs",
    "src/program.rs",
    "src/program/check.rs",
    "src/program/context.rs",
    "src/program/external.rs",
    "src/program/instructions.rs",
    "src/program/model.rs",
    "src/program/names.rs",
    "src/program/operation.rs",
    "src/program/schema.rs",
    "src/program/schema/instruction.rs",
    "src/program/schema/numbers.rs",
    "src/program/table.rs",
    "src/simplify.rs",
    "src/simplify/rules.rs",
];

/// Exporter and emitter as inputs of the fingerprint.
pub(super) fn inputs() -> impl Iterator<Item = Input> {
    EXPORTER
        .iter()
        .chain(EMITTER)
        .map(|(name, text)| Input::new(format!("emit/{name}"), text))
}

/// Writes the exporter into `directory` and returns nothing but success.
pub(super) fn write_exporter(directory: &Path) -> Result<(), Error> {
    for (name, text) in EXPORTER {
        let path = directory.join(name.trim_start_matches("exporter/"));
        std::fs::write(&path, text).map_err(at("write", &path))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn files(root: &Path, below: &Path, extension: &str, found: &mut BTreeSet<String>) {
        for entry in std::fs::read_dir(below).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                files(root, &path, extension, found);
            } else if path.extension().is_some_and(|found| found == extension) {
                let name = path.strip_prefix(root).unwrap().to_str().unwrap();
                found.insert(name.replace('\\', "/"));
            }
        }
    }

    #[test]
    fn no_file_is_forgotten() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut expected = BTreeSet::new();
        files(root, &root.join("src"), "rs", &mut expected);
        files(root, &root.join("exporter"), "py", &mut expected);
        expected.retain(|name| !name.starts_with("src/build/") && name != "src/main.rs");
        let embedded: BTreeSet<String> = EXPORTER
            .iter()
            .chain(EMITTER)
            .map(|(name, _)| (*name).to_owned())
            .collect();
        assert_eq!(
            embedded, expected,
            "put the new file into src/build/sources.rs"
        );
    }
}
