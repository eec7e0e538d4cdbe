//! Tools that build for a Cortex-M4F and run it: packages of Debian.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::error::Error;
use crate::kernel::instructions::{output, root};

const TRIPLE: &str = "thumbv7em-none-eabihf";
const LINKER: &str = "arm-none-eabi-ld";
const EMULATOR: &str = "qemu-system-arm";
/// Packages that bring the tools.
const PACKAGES: &str = "rustc-web rust-web-src gcc-arm-none-eabi qemu-system-arm";
/// A compiler with the sources of `core`; that of Debian unless this variable names another.
const VARIABLE: &str = "GYROCAL_TARGET_RUSTC";
const COMPILER: &str = "/usr/bin/rustc";

/// The tools, all of which are there.
pub(super) struct Tools {
    compiler: PathBuf,
}

impl Tools {
    /// Finds the tools, or says what to install.
    pub(super) fn find() -> Result<Self, String> {
        let compiler = std::env::var_os(VARIABLE).map_or_else(|| COMPILER.into(), PathBuf::from);
        let sysroot = output(Command::new(&compiler).args(["--print", "sysroot"]));
        let sources = sysroot.ok().map(|sysroot| {
            let library = Path::new(sysroot.trim()).join("lib/rustlib/src/rust/library");
            library.join("core/src/lib.rs")
        });
        let lacks_sources = !sources.is_some_and(|sources| sources.exists());
        let lacks = |tool: &str| output(Command::new(tool).arg("--version")).is_err();
        let missing: Vec<&str> = [
            (lacks_sources, "a compiler with the sources of core"),
            (lacks(LINKER), LINKER),
            (lacks("arm-none-eabi-gcc"), "arm-none-eabi-gcc"),
            (lacks(EMULATOR), EMULATOR),
        ]
        .into_iter()
        .filter_map(|(missing, tool)| missing.then_some(tool))
        .collect();
        if missing.is_empty() {
            return Ok(Self { compiler });
        }
        Err(format!(
            "{} missing; apt-get install {PACKAGES}",
            missing.join(", ")
        ))
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
            cargo(package, &directory)
                .args([
                    "--release",
                    "--locked",
                    "--target",
                    TRIPLE,
                    "-Zbuild-std=core",
                ])
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
            Command::new(EMULATOR)
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
        let names = text
            .lines()
            .filter_map(|line| line.split_whitespace().last());
        Ok(names.map(str::to_owned).collect())
    }
}

/// Builds a package outside of the workspace for the host; returns the directory of what was built.
pub(super) fn build_on_host(package: &str, arguments: &[&str]) -> Result<PathBuf, Error> {
    let directory = root().join("target/firmware");
    output(cargo(package, &directory).arg("--locked").args(arguments))?;
    let profile = if arguments.contains(&"--release") {
        "release"
    } else {
        "debug"
    };
    Ok(directory.join(profile))
}

fn cargo(package: &str, directory: &Path) -> Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command
        .arg("build")
        .arg("--quiet")
        .arg("--manifest-path")
        .arg(root().join(package).join("Cargo.toml"))
        .arg("--target-dir")
        .arg(directory);
    command
}
