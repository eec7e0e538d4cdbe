//! A small derivation.

use std::fs;
use std::path::{Path, PathBuf};

use gyrocal_testkit::{fresh_directory, workspace};

/// A derivation of one function, with the workspace's lock file (so with its environment).
pub(crate) struct TinyDerivation {
    /// Directory that holds `derive` and, once written, `generated`.
    pub(crate) root: PathBuf,
}

const DECLARATION: &str = r#"
source = "derive"
write_command = "the write command"

[python]
minimum = "3.11"
newest = "3.14"
requirements = "requirements.lock"

[[module]]
program = "tiny"
rust = "../generated/tiny.rs"
json = "../generated/tiny.json"
"#;

const SCRIPT: &str = r#"
import casadi as ca

from casadi_program import Element, Function, Group, Output, Program

point = Group("point", "A point.", [Element("x", "m", "abscissa"), Element("y", "m", "ordinate")])
other = ca.SX.sym("other")
x, y = point["x"], point["y"]


def derive(output):
    value = x * y + 2
    function = Function("tiny", "A function.", "none", [point], [Output("value", value, "m^2", "value")])
    Program("tiny", "A tiny program.", [function]).write(output / "tiny.json")
"#;

impl TinyDerivation {
    /// Makes it in `NAME` below `scratch`, anew.
    pub(crate) fn make(scratch: &str, name: &str) -> Self {
        let root = fresh_directory(Path::new(scratch).join(name));
        let derive = root.join("derive");
        fs::create_dir(&derive).unwrap();
        fs::write(derive.join("derivation.toml"), DECLARATION).unwrap();
        fs::write(derive.join("main.py"), SCRIPT).unwrap();
        let lock = workspace().join("codegen/derive/requirements.lock");
        fs::copy(lock, derive.join("requirements.lock")).unwrap();
        Self { root }
    }

    /// The derivation directory.
    pub(crate) fn directory(&self) -> PathBuf {
        self.root.join("derive")
    }

    /// The script.
    pub(crate) fn script(&self) -> PathBuf {
        self.directory().join("main.py")
    }

    /// The committed Rust file.
    pub(crate) fn rust(&self) -> PathBuf {
        self.root.join("generated/tiny.rs")
    }

    /// The committed program.
    pub(crate) fn program(&self) -> PathBuf {
        self.root.join("generated/tiny.json")
    }
}
