//! The C interface: its header, and its example on the host and on the target.

use std::ffi::OsString;
use std::path::Path;
use std::process::Command;

use gyrocal_record::Record;

use super::RECORD;
use super::target::{Tools, build_on_host};
use crate::harness::{Error, Figure};
use crate::kernel::instructions::{output, root};

const PACKAGE: &str = "crates/c-api";
const LIBRARY: &str = "libgyrocal_c.a";
/// Set to make the header instead of comparing it.
const WRITE: &str = "GYROCAL_WRITE_HEADER";
const FLAGS: &str = "-std=c11 -Wall -Wextra -Werror -Wconversion -O2";
/// Those of the target, where nothing is linked but what the compiler calls.
const ON_TARGET: &str = "-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 \
                         -ffreestanding -nostdlib -ffunction-sections -fdata-sections -lgcc";

/// Figures of the interface; `expected` are the lines that the Rust filter prints on the record.
pub(super) fn figures(tools: Option<&Tools>, expected: &[String]) -> Result<Vec<Figure>, Error> {
    let name = "C: the committed header is that of cbindgen";
    let mut figures = vec![Figure::truth(name, header()?)];
    let directory = root().join("target/firmware/c");
    std::fs::create_dir_all(&directory)?;
    let record = Record::read(&root().join(RECORD))?;
    write_record(&record, &directory)?;
    let library = build_on_host(PACKAGE, &["--release"])?.join(LIBRARY);
    let program = directory.join("host");
    let compiler = std::env::var_os("CC").unwrap_or_else(|| "cc".into());
    built(compiler, "", ["host.c".as_ref(), &library], &program)?;
    let host = output(&mut Command::new(&program))?;
    figures.push(equal("host", &host, expected));
    if let Some(tools) = tools {
        let library = tools.build(PACKAGE, &[])?.join(LIBRARY);
        let program = directory.join("target.elf");
        let memory = root().join("examples/controller/board/memory.x");
        let flags = format!("{ON_TARGET} -T{}", memory.display());
        let parts = ["target.c".as_ref(), library.as_path()];
        built("arm-none-eabi-gcc".into(), &flags, parts, &program)?;
        let target = tools.run(&program, "replay")?;
        figures.push(equal("target", &target, expected));
        figures.push(code(tools, &program, record.accel_g.len())?);
    }
    Ok(figures)
}

fn equal(machine: &str, printed: &str, expected: &[String]) -> Figure {
    let name = format!("C: all bits on the {machine} are those of Rust");
    let lines: Vec<&str> = printed.lines().collect();
    Figure::truth(&name, lines == expected && lines.len() > 19).over(1, RECORD)
}

/// Whether the committed header is what cbindgen makes of the package.
fn header() -> Result<bool, Error> {
    let package = root().join(PACKAGE);
    let path = package.join("include/gyrocal.h");
    let made = cbindgen::generate(&package).map_err(|error| error.to_string())?;
    if std::env::var_os(WRITE).is_some() {
        made.write_to_file(&path);
    }
    let mut text = Vec::new();
    made.write(&mut text);
    Ok(std::fs::read(&path)? == text)
}

/// The record as an array of C, in hexadecimal, so that no compiler rounds it.
fn write_record(record: &Record, directory: &Path) -> Result<(), Error> {
    let row = |row: &[f64; 3]| {
        let numbers = row.map(|number| hexadecimal(number as f32));
        format!("    {{{}}},\n", numbers.join(", "))
    };
    let rows: String = record.accel_g.iter().map(row).collect();
    let text = format!(
        "#include <stdint.h>\n#define RECORD_ROWS {}U\n\
         static const float RECORD_G[RECORD_ROWS][3] = {{\n{rows}}};\n",
        record.accel_g.len(),
    );
    gyrocal_record::write_whole(&directory.join("record.h"), text.as_bytes())?;
    Ok(())
}

/// A normal number or zero as a hexadecimal constant of C.
fn hexadecimal(number: f32) -> String {
    let bits = number.to_bits();
    let sign = if bits >> 31 == 1 { "-" } else { "" };
    let exponent = (bits >> 23 & 0xff) as i32 - 127;
    if number == 0.0 {
        return format!("{sign}0.0f");
    }
    format!("{sign}0x1.{:06x}p{exponent}f", (bits & 0x007f_ffff) << 1)
}

/// Compiles and links the example with the part of it that a machine needs.
fn built(
    compiler: OsString,
    flags: &str,
    [part, library]: [&Path; 2],
    program: &Path,
) -> Result<(), Error> {
    let package = root().join(PACKAGE);
    let examples = package.join("examples");
    let directory = program.parent().unwrap_or(program);
    let files = [&examples.join("replay.c"), &examples.join(part), library];
    let mut command = Command::new(compiler);
    command.args(FLAGS.split(' ')).arg("-I").arg(directory);
    command.arg("-I").arg(package.join("include")).args(files);
    command.args(flags.split_whitespace());
    output(command.arg("-Wl,--gc-sections").arg("-o").arg(program))?;
    Ok(())
}

/// Code and constants of the firmware without its record: the whole interface, start-up and replay.
fn code(tools: &Tools, firmware: &Path, rows: usize) -> Result<Figure, Error> {
    let all = tools.section(firmware, ".text")? + tools.section(firmware, ".rodata")?;
    let name = "f32: code and constants of a firmware with all calls, in C";
    let bytes = all as f64 - (12 * rows) as f64;
    Ok(Figure {
        reason: "32 000 are asked for; the gate, checks of settings and reopening take 4 500 more"
            .to_owned(),
        ..Figure::at_most(name, 37_000.0, bytes, "bytes")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_constants_are_those_of_c() {
        assert_eq!(hexadecimal(1.0), "0x1.000000p0f");
        assert_eq!(hexadecimal(-0.15625), "-0x1.400000p-3f");
        assert_eq!(hexadecimal(f32::from_bits(0x3f80_0001)), "0x1.000002p0f");
    }
}
