//! Each failure has one message that says what to do, and leaves everything as it was.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use gyrocal_testkit::{
    Outcome, WorkspaceCopy, codegen, edit, executable, fresh_directory, run, snapshot,
    system_python,
};

use crate::SCRATCH;
use crate::tiny::TinyDerivation;

/// A tiny derivation, and an empty directory for environments.
struct Case {
    tiny: TinyDerivation,
    environments: PathBuf,
}

impl Case {
    fn new(name: &str) -> Self {
        let environments = fresh_directory(Path::new(SCRATCH).join(format!("{name}-environments")));
        Self {
            tiny: TinyDerivation::make(SCRATCH, name),
            environments,
        }
    }

    /// Writes with a changed command; whatever happens, the files must stay what they were.
    fn write(&self, change: impl FnOnce(&mut Command)) -> Outcome {
        let before = snapshot(&self.tiny.root);
        let mut command = codegen(&self.tiny.directory(), &["write"]);
        change(&mut command);
        let outcome = run(&mut command);
        // Without the contents in the message.
        assert!(snapshot(&self.tiny.root) == before, "something was written");
        outcome
    }

    /// The same without an environment to fall back on.
    fn write_without_environment(&self, change: impl FnOnce(&mut Command)) -> Outcome {
        self.write(|command| {
            command.env("GYROCAL_CODEGEN_ENV_DIR", &self.environments);
            change(command);
        })
    }

    fn no_environment_was_begun(&self) {
        assert!(
            snapshot(&self.environments).is_empty(),
            "an environment was begun"
        );
    }

    /// A directory for `PATH` with one program `python3`.
    fn fake_python(&self, script: &str) -> PathBuf {
        let directory = self.environments.with_extension("bin");
        executable(&directory.join("python3"), script);
        directory
    }
}

#[test]
fn no_python() {
    let case = Case::new("no-python");
    let empty = fresh_directory(Path::new(SCRATCH).join("empty-path"));
    case.write_without_environment(|command| {
        command.env("PATH", empty);
    })
    .failed_with(&[
        "no suitable Python",
        "apt-get install python3",
        "GYROCAL_PYTHON=",
    ]);
    case.write_without_environment(|command| {
        command.env("GYROCAL_PYTHON", "/nonexistent/python3");
    })
    .failed_with(&["/nonexistent/python3", "which GYROCAL_PYTHON names"]);
    case.no_environment_was_begun();
}

#[test]
fn python_too_old_or_broken() {
    let case = Case::new("too-old");
    let path = case.fake_python("echo 3.9.18; echo True; echo /usr/bin/python3.9");
    case.write_without_environment(|command| {
        command.env("PATH", &path);
    })
    .failed_with(&[
        "`python3` (3.9.18, which is too old)",
        "3.11",
        "GYROCAL_PYTHON=",
    ]);
    // What a version manager's shim does for a version that is not chosen.
    let path = case.fake_python("echo 'pyenv: python3: command not found' >&2; exit 127");
    case.write_without_environment(|command| {
        command.env("PATH", &path);
    })
    .failed_with(&[
        "does not run: pyenv: python3: command not found",
        "GYROCAL_PYTHON=",
    ]);
    case.no_environment_was_begun();
}

#[test]
fn python_without_venv() {
    let case = Case::new("no-venv");
    // The real interpreter, to which one module does not exist.
    let path = case.fake_python(&format!(
        "exec '{}' -I -B -c \"import sys; sys.modules['ensurepip'] = sys.modules['casadi'] = None\n$4\"",
        system_python().display()
    ));
    case.write_without_environment(|command| {
        command.env("PATH", &path);
    })
    .failed_with(&[
        "cannot make a virtual environment",
        "apt-get install python3-venv",
    ]);
    case.no_environment_was_begun();
}

#[test]
fn network_not_allowed() {
    let case = Case::new("offline");
    for (variable, value) in [("GYROCAL_OFFLINE", "1"), ("CARGO_NET_OFFLINE", "true")] {
        case.write_without_environment(|command| {
            command
                .env("GYROCAL_PYTHON", system_python())
                .env(variable, value);
            command.env_remove("PIP_NO_INDEX");
        })
        .failed_with(&[
            "CasADi 3.8.2 is needed and the network must not be used",
            "env -u GYROCAL_OFFLINE CARGO_NET_OFFLINE=false the write command",
            "export GYROCAL_PYTHON=",
        ]);
    }
    case.no_environment_was_begun();
}

#[test]
fn network_not_there() {
    let case = Case::new("no-network");
    case.write_without_environment(|command| {
        // Port 9 (discard) of this machine refuses connections.
        command
            .env("GYROCAL_PYTHON", system_python())
            .env("PIP_INDEX_URL", "http://127.0.0.1:9/simple")
            .env("PIP_CONFIG_FILE", "/dev/null")
            .env("PIP_RETRIES", "0")
            .env("PIP_NO_CACHE_DIR", "1")
            .env_remove("PIP_FIND_LINKS")
            .env_remove("PIP_EXTRA_INDEX_URL")
            .env("NO_PROXY", "127.0.0.1");
    })
    .failed_with(&[
        "pip install failed",
        "No matching distribution",
        "PIP_PROXY",
        "GYROCAL_PYTHON=",
    ]);
    let left: Vec<_> = snapshot(&case.environments).into_keys().collect();
    assert!(
        left.iter()
            .all(|path| path.extension().is_some_and(|e| e == "lock")),
        "{left:?}"
    );
}

#[test]
fn an_exception_names_its_file_and_line() {
    let case = Case::new("exception");
    edit(case.tiny.script(), "x * y + 2", "x * z + 2");
    case.write(|_| {}).failed_with(&[
        "the derivation `derive` failed at main.py, line 12",
        "NameError: name 'z' is not defined",
        "correct the Python",
    ]);
    edit(case.tiny.script(), "x * z + 2", "x * (y + 2");
    case.write(|_| {})
        .failed_with(&["failed at main.py, line 12", "SyntaxError"]);
}

#[test]
fn what_a_program_cannot_hold_is_refused() {
    let case = Case::new("refused");
    let mut now = "x * y + 2".to_owned();
    for (expression, message) in [
        (
            "x.printme(y)",
            "uses the CasADi operation OP_PRINTME, which is not supported; it prints",
        ),
        (
            "x * other",
            "has the free variable(s) other; add the group that declares them",
        ),
        ("x * ca.SX(float('inf'))", "constants must be finite"),
        ("ca.MX.sym('m')", "expected casadi.SX"),
    ] {
        edit(
            case.tiny.script(),
            &format!("value = {now}"),
            &format!("value = {expression}"),
        );
        expression.clone_into(&mut now);
        case.write(|_| {})
            .failed_with(&["the derivation `derive` was refused", message]);
    }
}

#[test]
fn arguments_without_names_are_refused() {
    let case = Case::new("unnamed");
    edit(
        case.tiny.script(),
        "\"none\", [point]",
        "\"none\", [point.sx]",
    );
    case.write(|_| {})
        .failed_with(&["the derivation `derive` was refused", "Group"]);
}

#[test]
fn a_program_of_another_schema_version() {
    let case = Case::new("schema");
    edit(
        case.tiny.script(),
        "def derive(output):",
        "import casadi_program\ncasadi_program.SCHEMA_VERSION = 99\n\n\ndef derive(output):",
    );
    case.write(|_| {}).failed_with(&[
        "tiny.json",
        "schema_version: found 99, expected 1",
        "derive",
    ]);
}

#[test]
fn a_file_that_is_declared_and_not_written() {
    let case = Case::new("no-output");
    edit(
        case.tiny.script(),
        "output / \"tiny.json\"",
        "output / \"other.json\"",
    );
    case.write(|_| {})
        .failed_with(&["wrote no `tiny.json`", "derivation.toml"]);
}

#[test]
fn a_declaration_that_is_wrong() {
    let case = Case::new("declaration");
    let declaration = case.tiny.directory().join("derivation.toml");
    edit(&declaration, "minimum = \"3.11\"", "minimun = \"3.11\"");
    case.write(|_| {})
        .failed_with(&["derivation.toml", "minimun", "line 6"]);
    edit(&declaration, "minimun = \"3.11\"", "minimum = \"2.7\"");
    case.write(|_| {})
        .failed_with(&["derivation.toml", "found `2.7`, expected a version"]);
    edit(&declaration, "\"2.7\"", "\"3.11\"");
    fs::write(
        case.tiny.directory().join("requirements.lock"),
        "numpy==1.0\n",
    )
    .unwrap();
    case.write(|_| {})
        .failed_with(&["requirements.lock", "casadi==VERSION"]);
    fs::remove_file(case.tiny.directory().join("requirements.lock")).unwrap();
    case.write(|_| {})
        .failed_with(&["cannot read", "requirements.lock"]);
}

#[test]
fn a_committed_path_that_cannot_be_written() {
    let case = Case::new("unwritable");
    fs::write(
        case.tiny.root.join("generated"),
        "a file where a directory should be",
    )
    .unwrap();
    case.write(|_| {}).failed_with(&["cannot", "generated"]);
}

/// One sign in the form of the Jacobians that saves operations.
#[test]
fn a_shorter_form_of_something_else() {
    let copy = WorkspaceCopy::make(SCRATCH, "shorter-form");
    copy.edit(
        "codegen/derive/nodal.py",
        "ca.vertcat(-relative[1], relative[0], 0)",
        "ca.vertcat(relative[1], relative[0], 0)",
    );
    let before = snapshot(&copy.root);
    run(&mut codegen(&copy.derivation(), &["write"])).failed_with(&[
        "the shorter form of `theta_dot_d_theta` gives",
        "change both or leave the shorter form out",
    ]);
    assert_eq!(snapshot(&copy.root), before, "something was written");
}
