//! Programs and packages that a build does not bring. What needs a missing one is left out, with a remark
//! on stderr. In continuous integration (`CI` is `true` or `1`) nothing may pass by being left out: there
//! it is a panic with what to install.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A program of the system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tool {
    /// A browser that runs without a screen.
    Chromium,
    /// Callgrind, which counts instructions.
    Valgrind,
    /// A compiler with the sources of `core`; that of Debian unless a variable names another.
    TargetCompiler,
    /// C compiler and linker for a Cortex-M4F.
    ArmGcc,
    /// Emulator of a Cortex-M4F.
    Qemu,
    /// A Python that makes virtual environments.
    Python,
    /// A Python with the wheel of `crates/python` and Spark.
    Spark,
}

/// What is known of a tool.
struct Entry {
    purpose: &'static str,
    /// Names of the program; the first that serves counts.
    names: &'static [&'static str],
    /// Variable that names a program in place of these.
    variable: Option<&'static str>,
    serves: fn(&Path) -> bool,
    /// Packages of Debian that bring it.
    packages: &'static str,
}

/// Value of an environment variable.
type Variables<'a> = &'a dyn Fn(&str) -> Option<OsString>;

impl Tool {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Chromium,
        Self::Valgrind,
        Self::TargetCompiler,
        Self::ArmGcc,
        Self::Qemu,
        Self::Python,
        Self::Spark,
    ];

    #[rustfmt::skip] // a table
    fn entry(self) -> Entry {
        match self {
            Self::Chromium => Entry {
                variable: Some("GYROCAL_CHROMIUM"),
                ..entry("pages in a browser", &["chromium", "chromium-browser", "google-chrome"], "chromium")
            },
            Self::Valgrind => entry("instruction counts", &["valgrind"], "valgrind"),
            Self::TargetCompiler => Entry {
                variable: Some("GYROCAL_TARGET_RUSTC"),
                serves: has_sources_of_core,
                ..entry("builds for a Cortex-M4F", &["rustc"], "rustc-web rust-web-src")
            },
            Self::ArmGcc => entry("builds for a Cortex-M4F", &["arm-none-eabi-gcc"], "gcc-arm-none-eabi"),
            Self::Qemu => entry("firmware on an emulated Cortex-M4F", &["qemu-system-arm"], "qemu-system-arm"),
            Self::Python => Entry {
                serves: |program| succeeds(program, &["-I", "-c", "import ensurepip, venv"]),
                ..entry(
                    "packages of Python",
                    &["python3.11", "python3.12", "python3.13", "python3.14", "python3"],
                    "python3 python3-venv",
                )
            },
            Self::Spark => Entry {
                variable: Some("GYROCAL_SPARK_PYTHON"),
                serves: |program| succeeds(program, &["-c", "import pyspark, gyrocal"]),
                ..entry(
                    "a fleet of records under Spark",
                    &[],
                    "default-jre-headless, and pip install of pyspark and the wheel in a virtual environment",
                )
            },
        }
    }

    /// That the tool is missing, what it is for, and what to install.
    pub fn missing(self) -> String {
        let Entry {
            purpose,
            names,
            variable,
            packages,
            ..
        } = self.entry();
        let name = names.first().copied().or(variable).unwrap_or_default();
        let or = variable.map(|variable| format!("; or name a program in {variable}"));
        let or = or.unwrap_or_default();
        format!("{name} is missing, for {purpose}: apt-get install {packages}{or}")
    }
}

/// A program that is one if it says its version.
fn entry(purpose: &'static str, names: &'static [&'static str], packages: &'static str) -> Entry {
    Entry {
        purpose,
        names,
        variable: None,
        serves: |program| succeeds(program, &["--version"]),
        packages,
    }
}

fn succeeds(program: &Path, arguments: &[&str]) -> bool {
    let mut command = Command::new(program);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    let status = command.args(arguments).status();
    status.is_ok_and(|status| status.success())
}

fn has_sources_of_core(compiler: &Path) -> bool {
    let output = Command::new(compiler).args(["--print", "sysroot"]).output();
    output.is_ok_and(|output| {
        let sysroot = String::from_utf8_lossy(&output.stdout);
        let library = Path::new(sysroot.trim()).join("lib/rustlib/src/rust/library");
        library.join("core/src/lib.rs").is_file()
    })
}

/// The program of a tool; `None`, with a remark, where it is missing.
///
/// # Panics
/// With what to install if it is missing in continuous integration.
#[track_caller]
pub fn tool(tool: Tool) -> Option<PathBuf> {
    tool_among(tool, &|name| std::env::var_os(name))
}

#[track_caller]
fn tool_among(tool: Tool, variables: Variables) -> Option<PathBuf> {
    let Entry {
        names,
        variable,
        serves,
        ..
    } = tool.entry();
    let path = variables("PATH").unwrap_or_default();
    let found = match variable.and_then(variables) {
        Some(program) => Some(PathBuf::from(program)).filter(|program| serves(program)),
        None => names
            .iter()
            .flat_map(|name| programs(name, &path))
            .find(|program| serves(program)),
    };
    if found.is_none() {
        leave_out_among(&tool.missing(), variables);
    }
    found
}

/// Files of a name in the folders of a search path.
pub fn programs(name: &str, path: &OsStr) -> Vec<PathBuf> {
    let all = std::env::split_paths(path).map(|folder| folder.join(name));
    all.filter(|program| program.is_file()).collect()
}

/// Says that something is left out, and why.
///
/// # Panics
/// With the reason in continuous integration.
#[track_caller]
pub fn leave_out(reason: &str) {
    leave_out_among(reason, &|name| std::env::var_os(name));
}

#[track_caller]
fn leave_out_among(reason: &str, variables: Variables) {
    let ci = variables("CI").is_some_and(|value| value == "true" || value == "1");
    let rule = "nothing is left out in continuous integration";
    assert!(!ci, "{rule}: {reason}");
    eprintln!("\nLEFT OUT: {reason}\n");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::{executable, fresh_directory};

    /// Finds a tool where these are all variables.
    fn found(tool: Tool, variables: &[(&str, &str)]) -> Option<PathBuf> {
        tool_among(tool, &|name| {
            let mut all = variables.iter();
            let (_, value) = all.find(|(of, _)| *of == name)?;
            Some(value.into())
        })
    }

    #[test]
    fn a_missing_tool_is_a_failure_in_continuous_integration_and_a_remark_elsewhere() {
        let nowhere = ("PATH", "/nowhere");
        for tool in Tool::ALL {
            for ci in ["true", "1"] {
                let panic = std::panic::catch_unwind(|| found(tool, &[nowhere, ("CI", ci)]));
                let panic = panic.expect_err("a missing tool is no failure");
                let said = panic.downcast_ref::<String>().unwrap();
                assert!(said.contains("missing, for"), "{said}");
                assert!(said.contains("apt-get install"), "{said}");
            }
            assert_eq!(found(tool, &[nowhere]), None);
            assert_eq!(found(tool, &[nowhere, ("CI", "false")]), None);
        }
    }

    #[test]
    fn a_tool_is_one_that_answers() {
        let name = format!("gyrocal-tools-{}", std::process::id());
        let folder = fresh_directory(std::env::temp_dir().join(name));
        let path = [("PATH", folder.to_str().unwrap())];
        let [broken, other] = ["chromium", "google-chrome"].map(|name| folder.join(name));
        executable(&broken, "exit 1");
        assert_eq!(found(Tool::Chromium, &path), None);
        executable(&other, "exit 0");
        assert_eq!(found(Tool::Chromium, &path), Some(other.clone()));
        // The one that is named stands for all.
        let named = ("GYROCAL_CHROMIUM", broken.to_str().unwrap());
        assert_eq!(found(Tool::Chromium, &[path[0], named]), None);
        std::fs::remove_dir_all(folder).unwrap();
    }
}
