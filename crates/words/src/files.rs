//! The files of a result as arguments of commands, and names in short.

use gyrocal_record::{Input, InputRole, shell_quoted};

/// A path as a shell reads it; of a stream, which is gone when the next command runs, `FILE`.
fn argument(path: &str) -> String {
    let is_stream = ["/dev/", "/proc/"]
        .iter()
        .any(|folder| path.starts_with(folder));
    match is_stream {
        true => "FILE".to_owned(),
        false => shell_quoted(path),
    }
}

/// Records, bench files, axes of strapdown units and the map of columns as arguments of a command, as a shell
/// reads them. A bench file of all records is named once.
#[must_use]
pub fn command_files<'a>(inputs: impl Iterator<Item = (InputRole, &'a str)> + Clone) -> String {
    let of = |role: InputRole| -> Vec<String> {
        let own = inputs.clone().filter(|(other, _)| *other == role);
        own.map(|(_, path)| argument(path)).collect()
    };
    let mut benches = of(InputRole::Bench);
    if benches.windows(2).all(|pair| pair[0] == pair[1]) {
        benches.truncate(1);
    }
    let options = [
        ("bench", benches),
        ("gyro-axes", of(InputRole::GyroAxes)),
        ("columns", of(InputRole::Columns)),
    ];
    let mut command = of(InputRole::Record).join(" ");
    for (option, paths) in options {
        for path in paths {
            command = format!("{command} --{option} {path}");
        }
    }
    command
}

/// The files of a result, and `further` ones, as those of [`command_files`]; of a result that does not say what its
/// files are, its first two are a record and its bench file. Axes of a strapdown unit that it does not name have a
/// name to fill in.
#[must_use]
pub fn input_files(inputs: &[Input], is_strapdown: bool, further: &[(InputRole, &str)]) -> String {
    let told = inputs
        .iter()
        .filter_map(|one| Some((one.role?, &*one.path)));
    let mut files: Vec<(InputRole, &str)> = told.collect();
    let lacks = |files: &[(InputRole, &str)], role| files.iter().all(|(own, _)| *own != role);
    if lacks(&files, InputRole::Record) {
        let path = |place: usize, otherwise| inputs.get(place).map_or(otherwise, |one| &*one.path);
        files.push((InputRole::Record, path(0, "RECORD.csv")));
        files.push((InputRole::Bench, path(1, "BENCH.toml")));
    }
    if is_strapdown && lacks(&files, InputRole::GyroAxes) {
        files.push((InputRole::GyroAxes, "AXES.csv"));
    }
    command_files(files.iter().chain(further).copied())
}

/// Names in a row, with this between any two.
#[must_use]
pub fn joined(names: impl IntoIterator<Item = impl AsRef<str>>, between: &str) -> String {
    let mut row = String::new();
    for (place, name) in names.into_iter().enumerate() {
        row += if place == 0 { "" } else { between };
        row += name.as_ref();
    }
    row
}

/// The first few of several names, and how many more there are.
#[must_use]
pub fn few(names: impl IntoIterator<Item = impl AsRef<str>>, shown: usize) -> String {
    let mut names = names.into_iter();
    let first = joined(names.by_ref().take(shown), ", ");
    match names.count() {
        0 => first,
        more => format!("{first} and {more} more"),
    }
}
