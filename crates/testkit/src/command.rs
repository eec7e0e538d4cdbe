use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use crate::copy::workspace;
use crate::tools::{Tool, leave_out, tool};

/// Outcome of a command.
#[derive(Debug)]
pub struct Outcome {
    /// It ended with exit code 0.
    pub success: bool,
    /// The exit code, if it ended by itself.
    pub code: Option<i32>,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

impl Outcome {
    /// Panics with the output unless the command succeeded.
    #[track_caller]
    pub fn succeeded(self) -> Self {
        let Self {
            code,
            stdout,
            stderr,
            ..
        } = &self;
        assert!(self.success, "exit code {code:?}\n{stdout}\n{stderr}");
        self
    }

    /// Panics with the output unless the command failed with a message that has every one of
    /// `parts` and is no backtrace.
    #[track_caller]
    pub fn failed_with(self, parts: &[&str]) -> Self {
        let stderr = &self.stderr;
        assert!(!self.success, "succeeded\n{}\n{stderr}", self.stdout);
        for part in parts {
            assert!(stderr.contains(part), "no `{part}` in\n{stderr}");
        }
        for part in ["panicked at", "RUST_BACKTRACE"] {
            assert!(!stderr.contains(part), "{stderr}");
        }
        self
    }
}

/// Runs a command to its end.
pub fn run(command: &mut Command) -> Outcome {
    let output = command.output();
    let output = output.unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Outcome {
        success: output.status.success(),
        code: output.status.code(),
        stdout: text(&output.stdout),
        stderr: text(&output.stderr),
    }
}

/// Cargo in `directory`, offline, with its own target directory.
pub fn cargo(directory: &Path, target: &Path) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    without_settings(&mut command);
    command
        .current_dir(directory)
        .env("CARGO_TARGET_DIR", target)
        .env("CARGO_NET_OFFLINE", "false")
        .env("CARGO_TERM_COLOR", "never")
        .env("GYROCAL_CODEGEN_ENV_DIR", real_environments());
    command
}

/// The command `gyrocal-codegen` on the derivation in `directory`, built once.
pub fn codegen(directory: &Path, arguments: &[&str]) -> Command {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    let program = BUILT.get_or_init(|| {
        let target = target_directory();
        let build = "build --offline --package gyrocal-codegen --features cli";
        run(cargo(&workspace(), &target).args(build.split(' '))).succeeded();
        target.join("debug/gyrocal-codegen")
    });
    let mut command = Command::new(program);
    without_settings(&mut command);
    command
        .current_dir(directory.parent().unwrap())
        .env("GYROCAL_CODEGEN_ENV_DIR", real_environments())
        .arg("--derivation")
        .arg(directory)
        .args(arguments);
    command
}

/// The interpreter of a virtual environment in `directory` with packages of PyPI, made where there is none
/// for these requirements; `None`, with a remark, where there is no Python or no such packages.
///
/// # Panics
/// With what is missing in continuous integration.
#[track_caller]
pub fn python_with(directory: &Path, requirements: &str) -> Option<PathBuf> {
    let python = tool(Tool::Python)?;
    let environment = directory.join("env");
    let own = environment.join("bin/python");
    // Written last: an environment without it is half-made.
    let installed = environment.join("installed.txt");
    if std::fs::read_to_string(&installed).is_ok_and(|text| text == requirements) {
        return Some(own);
    }
    std::fs::create_dir_all(directory).unwrap();
    let wanted = directory.join("requirements.txt");
    std::fs::write(&wanted, requirements).unwrap();
    let mut venv = Command::new(python);
    run(venv.args(["-m", "venv", "--clear"]).arg(&environment)).succeeded();
    let outcome = run(Command::new(&own)
        .args(["-m", "pip", "install", "--quiet"])
        .args(["--disable-pip-version-check", "--requirement"])
        .arg(wanted));
    if !outcome.success {
        let error = outcome.stderr;
        leave_out(&format!("packages of Python cannot be had: {error}"));
        return None;
    }
    std::fs::write(installed, requirements).unwrap();
    Some(own)
}

/// The environments of the workspace itself, which tests reuse.
pub fn real_environments() -> PathBuf {
    std::env::var_os("GYROCAL_CODEGEN_ENV_DIR")
        .map_or_else(|| target_directory().join("gyrocal-codegen"), PathBuf::from)
}

/// A real interpreter, not the shim of a version manager.
pub fn system_python() -> PathBuf {
    let python = tool(Tool::Python).expect("a Python in PATH");
    let executable = ["-I", "-c", "import sys; print(sys.executable)"];
    let outcome = run(Command::new(python).args(executable)).succeeded();
    PathBuf::from(outcome.stdout.trim())
}

/// The target directory that this test program was built in.
fn target_directory() -> PathBuf {
    let program = std::env::current_exe().unwrap();
    let folders = program.ancestors();
    let marked = folders.filter(|path| path.join("CACHEDIR.TAG").is_file());
    marked.last().expect("a target directory").to_owned()
}

/// Removes variables of the caller that would change the command.
fn without_settings(command: &mut Command) {
    let names = "GYROCAL_PYTHON GYROCAL_OFFLINE CARGO_NET_OFFLINE RUST_BACKTRACE";
    for name in names.split(' ') {
        command.env_remove(name);
    }
    // Cargo describes the tested package to its tests; the next cargo must not see that.
    for (name, _) in std::env::vars_os() {
        let text = name.to_string_lossy();
        if text.starts_with("CARGO_PKG_") || text.starts_with("CARGO_MANIFEST_") {
            command.env_remove(&name);
        }
    }
}
