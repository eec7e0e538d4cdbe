//! Tools that build for a Cortex-M4F and run it.

use std::path::{Path, PathBuf};
use std::process::Command;

use gyrocal_testkit::{Tool, tool};

use crate::harness::Error;
use crate::kernel::instructions::{cargo, output, root};

const TRIPLE: &str = "thumbv7em-none-eabihf";
const LINKER: &str = "arm-none-eabi-ld";

/// The tools, all of which are there.
pub(super) struct Tools {
    compiler: PathBuf,
    emulator: PathBuf,
}

impl Tools {
    /// Finds the tools; `None` if one is missing.
    pub(super) fn find() -> Option<Self> {
        // All are looked for: each that is missing is told.
        let [compiler, emulator, gcc] = [Tool::TargetCompiler, Tool::Qemu, Tool::ArmGcc].map(tool);
        let (compiler, emulator, _) = (compiler?, emulator?, gcc?);
        Some(Self { compiler, emulator })
    }

    /// Builds a package for the target; returns the directory of what was built.
    pub(super) fn build(&self, package: &str, arguments: &[&str]) -> Result<PathBuf, Error> {
        let script = root().join("examples/controller/board/memory.x");
        let flags = format!(
            "-Clinker={LINKER} -Clinker-flavor=ld -Ctarget-cpu=cortex-m4 -Clink-arg=-T{}",
            std::path::absolute(script)?.display()
        );
        let directory = root().join("target/firmware-target");
        output(
            build(package, &directory)
                .args(["--release", "--target", TRIPLE, "-Zbuild-std=core"])
                .args(arguments)
                .env("RUSTC", &self.compiler)
                .env("RUSTC_BOOTSTRAP", "1")
                .env("CARGO_TARGET_THUMBV7EM_NONE_EABIHF_RUSTFLAGS", flags),
        )?;
        Ok(directory.join(TRIPLE).join("release"))
    }

    /// Runs a firmware with a command line; returns its text.
    ///
    /// An instruction takes 64 ns of the emulated time, of which the counter of the core counts
    /// ticks of 40 ns.
    pub(super) fn run(&self, firmware: &Path, words: &str) -> Result<String, Error> {
        let arguments = match words {
            "" => String::new(),
            words => format!(",arg={words}"),
        };
        let semihosting = format!("enable=on,target=native{arguments}");
        output(
            Command::new(&self.emulator)
                .args(["-M", "mps2-an386", "-nographic", "-monitor", "none"])
                .args(["-serial", "none", "-icount", "shift=6,align=off,sleep=off"])
                .args(["-semihosting-config", &semihosting])
                .arg("-kernel")
                .arg(firmware),
        )
    }

    /// Bytes of a section of a firmware.
    pub(super) fn section(&self, firmware: &Path, name: &str) -> Result<u64, Error> {
        let text = output(Command::new("arm-none-eabi-size").arg("-A").arg(firmware))?;
        let size = text.lines().find_map(|line| {
            let mut words = line.split_whitespace();
            (words.next() == Some(name)).then(|| words.next()?.parse().ok())?
        });
        size.ok_or_else(|| format!("no section {name} in {}", firmware.display()).into())
    }

    /// Names of symbols of a firmware.
    pub(super) fn symbols(&self, firmware: &Path) -> Result<Vec<String>, Error> {
        let text = output(Command::new("arm-none-eabi-nm").arg(firmware))?;
        let names = text.lines().filter_map(|line| line.split(' ').next_back());
        Ok(names.map(str::to_owned).collect())
    }
}

/// Builds a package outside of the workspace for the host; returns the directory of what was built.
pub(super) fn build_on_host(package: &str, arguments: &[&str]) -> Result<PathBuf, Error> {
    let directory = root().join("target/firmware");
    output(build(package, &directory).args(arguments))?;
    let is_release = arguments.contains(&"--release");
    Ok(directory.join(if is_release { "release" } else { "debug" }))
}

fn build(package: &str, directory: &Path) -> Command {
    let manifest = root().join(package).join("Cargo.toml");
    let mut command = Command::new(cargo());
    command.args(["build", "--quiet", "--locked"]);
    command.arg("--manifest-path").arg(manifest);
    command.arg("--target-dir").arg(directory);
    command
}
