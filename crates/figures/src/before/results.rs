//! What commands write of a record, as it is kept. Each is a process of its own, so that a refusal or a panic is a
//! result as well.

use std::ffi::OsString;
use std::path::Path;
use std::process::Command;

use gyrocal_testkit::contracts::words;
use gyrocal_testkit::{run, workspace};
use serde_json::{Map, Value};

use super::{Case, records};
use crate::harness::Error;

/// First argument with which this program is the command `gyrocal`.
const AS_COMMAND: &str = "as-gyrocal";

/// Significant digits of the numbers that are kept: those that a tolerance of 1e-6 sigma needs where a sigma is
/// 1e-5 of its value. `compare.rs` allows for the rest.
const DIGITS: usize = 12;

/// Exit code of a panic.
const PANIC: i32 = 101;

/// Keys that are not kept, by the end of their path: they depend on sources, files and versions, which git compares.
const LEFT_OUT: [&str; 3] = [
    "manifest.version",
    "manifest.model_hash",
    "manifest.inputs[].sha256",
];

/// The arguments of the command `gyrocal`, if this process is to be that command.
pub(crate) fn as_command() -> Option<impl Iterator<Item = OsString>> {
    let mut arguments = std::env::args_os().skip(1);
    (arguments.next()? == AS_COMMAND)
        .then(|| [OsString::from("gyrocal")].into_iter().chain(arguments))
}

/// This program as the command `gyrocal` in a folder.
pub(crate) fn gyrocal(folder: &Path) -> Result<Command, Error> {
    let mut command = Command::new(std::env::current_exe()?);
    command.arg(AS_COMMAND).current_dir(folder);
    Ok(command)
}

/// Runs a line as `gyrocal`; returns the exit code and what it says on stdout and on stderr.
pub(crate) fn told(line: &str, folder: &Path) -> Result<(i32, [String; 2]), Error> {
    let mut command = gyrocal(folder)?;
    command.args(words(line, folder)).env_remove("COLUMNS");
    let outcome = run(command.env_remove("RUST_BACKTRACE"));
    let ended = || format!("`{line}` was ended by a signal");
    let code = outcome.code.ok_or_else(ended)?;
    let told = [outcome.stdout, outcome.stderr];
    Ok((code, told.map(|text| placeless(text.trim(), folder))))
}

/// A text without the places of the repository and of the folder of the record.
pub(crate) fn placeless(text: &str, folder: &Path) -> String {
    let places = [(&*workspace(), "@"), (folder, "%")];
    places.iter().fold(text.to_owned(), |text, (place, sign)| {
        text.replace(&format!("{}/", place.display()), sign)
    })
}

/// The results of all commands of a record, each by the words of its command.
pub(super) fn of(case: &Case) -> Result<Value, Error> {
    let folder = tempfile::tempdir()?;
    for line in &case.make {
        records::make(line, folder.path())?;
    }
    let mut all = Map::new();
    for line in &case.run {
        let words = line.split(' ');
        let command = words.take_while(|word| !word.starts_with(['@', '%', '-']));
        let command = command.collect::<Vec<_>>().join(" ");
        let file = format!("{}.json", command.replace(' ', "-"));
        let (code, [_, error]) = told(&format!("{line} --json %{file}"), folder.path())?;
        let mut result = match std::fs::read_to_string(folder.path().join(file)) {
            Ok(text) => serde_json::from_str(&placeless(&text, folder.path()))?,
            // What a panic says depends on the versions of packages.
            Err(_) if code == PANIC => Map::new(),
            Err(_) => Map::from_iter([("error".to_owned(), error.into())]),
        };
        result.insert("exit_code".to_owned(), code.into());
        if all.insert(command, result.into()).is_some() {
            return Err(format!("`{line}`: found this command twice, expected it once").into());
        }
    }
    let mut all = all.into();
    keep("", &mut all);
    Ok(all)
}

/// Rounds the numbers of a result and leaves out what is not kept.
pub(super) fn keep(path: &str, value: &mut Value) {
    match value {
        Value::Object(object) => object.retain(|key, value| {
            let path = format!("{path}.{key}");
            keep(&path, value);
            !LEFT_OUT.iter().any(|end| path.ends_with(end))
        }),
        Value::Array(array) => array
            .iter_mut()
            .for_each(|one| keep(&format!("{path}[]"), one)),
        Value::Number(number) => {
            if let Some(exact) = number.as_f64().filter(|_| number.is_f64()) {
                let rounded: Result<f64, _> = format!("{exact:.*e}", DIGITS - 1).parse();
                *value = rounded.unwrap_or(exact).into();
            }
        }
        _ => (),
    }
}

/// What an earlier build wrote of a record; with `write` these results take its place.
pub(super) fn renewed(
    folder: &Path,
    case: &Case,
    now: &Value,
    write: bool,
) -> Result<Value, Error> {
    let path = folder.join("results").join(format!("{}.json", case.name));
    let before = match std::fs::read_to_string(&path) {
        Ok(text) => serde_json::from_str(&text)?,
        Err(_) if write => Map::new().into(),
        Err(error) => {
            return Err(format!("{}: {error}; write it with --write", path.display()).into());
        }
    };
    if write {
        gyrocal_record::write_whole(&path, text(now, 0).as_bytes())?;
    }
    Ok(before)
}

/// Results as JSON with a line for each key of a command, so that a change is seen in its line.
fn text(value: &Value, depth: usize) -> String {
    match value {
        Value::Object(object) if depth < 2 => {
            let lines = object.iter().map(|(key, value)| {
                format!("{}: {}", Value::from(key.as_str()), text(value, depth + 1))
            });
            let end = if depth == 0 { "\n" } else { "" };
            format!("{{\n{}\n}}{end}", lines.collect::<Vec<_>>().join(",\n"))
        }
        _ => value.to_string(),
    }
}
