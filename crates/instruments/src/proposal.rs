//! A map for a table whose header is not that of a record.

use gyrocal_record::SourceText;

use crate::file_format::FileFormat;
use crate::log_lines::log_lines;
use crate::remedy::{delimiter_of, word_of};

/// Lines that are searched for a header.
const LONGEST_PREAMBLE: usize = 100;

/// Words in the name of a column of times, and in those of accelerometers.
const TIMES: [&str; 7] = ["time", "stamp", "zeit", "datum", "date", "sec", "epoch"];
const ACCELEROMETERS: [&str; 5] = ["acc", "force", "beschl", "sf", "a"];

/// The lines of a map for a text, by the names in its header; `None` if no line looks like one.
#[must_use]
pub fn propose_map(source: &SourceText) -> Option<String> {
    let plain = FileFormat::default();
    let first = log_lines(source, &plain)
        .take(LONGEST_PREAMBLE)
        .map(|line| &source.text()[line.span])
        .find_map(|line| Some((line, delimiter_of(line)?)).filter(|(line, _)| !is_numeric(line)));
    let (line, delimiter) = first?;
    let format = FileFormat { delimiter, ..plain };
    let header = log_lines(source, &format).find(|one| &source.text()[one.span.clone()] == line)?;
    let names: Vec<&str> = header.fields.iter().map(|(_, name)| *name).collect();
    let time = names.iter().find(|name| is_time(name))?;
    let axis = |axis: char| {
        let mut fit = names.iter().filter(|name| is_accelerometer(name, axis));
        fit.next().copied()
    };
    let [x, y, z] = [axis('x')?, axis('y')?, axis('z')?];
    let file = match format == FileFormat::default() {
        true => String::new(),
        false => format!("[file] delimiter = \"{}\"; ", word_of(delimiter)),
    };
    Some(format!(
        "{file}[time] column = \"{time}\"; [accel] columns = [\"{x}\", \"{y}\", \"{z}\"] and unit = \"g\" or \
         another"
    ))
}

fn is_numeric(line: &str) -> bool {
    line.chars().filter(|sign| sign.is_ascii_digit()).count() * 2 > line.len()
}

fn is_time(name: &str) -> bool {
    let name = name.to_lowercase();
    name == "t" || name.starts_with("t ") || TIMES.iter().any(|word| name.contains(word))
}

/// Whether a name is one of the accelerometer of an axis: words for it, with the letter of the axis as a
/// word or at the end of one.
fn is_accelerometer(name: &str, axis: char) -> bool {
    let name = name.to_lowercase();
    let unit = name.find(['[', '(']).unwrap_or(name.len());
    let bare = name[..unit].trim();
    let mut words = bare.split(|sign: char| !sign.is_alphanumeric());
    let has_axis = words.any(|word| word == axis.to_string() || word.ends_with(axis));
    has_axis && ACCELEROMETERS.iter().any(|word| bare.starts_with(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn proposed(text: &str) -> Option<String> {
        propose_map(&SourceText::new(text, "log.csv").unwrap())
    }

    #[test]
    fn a_header_of_another_program_gives_its_map() {
        let map =
            proposed("# made by\nZeit;Beschl X [m/s²];Beschl Y [m/s²];Beschl Z [m/s²]\n1;2;3;4\n");
        assert_eq!(
            map.unwrap(),
            "[file] delimiter = \"semicolon\"; [time] column = \"Zeit\"; [accel] columns = [\"Beschl X \
             [m/s²]\", \"Beschl Y [m/s²]\", \"Beschl Z [m/s²]\"] and unit = \"g\" or another"
        );
        let map = proposed("t,ax,ay,az\n0,0,0,1\n").unwrap();
        assert!(
            map.starts_with("[time] column = \"t\"; [accel] columns = [\"ax\", \"ay\", \"az\"]")
        );
    }

    #[test]
    fn what_has_no_header_gives_none() {
        assert_eq!(proposed("1,2,3,4\n5,6,7,8\n"), None);
        assert_eq!(proposed("pressure,humidity,wind,rain\n1,2,3,4\n"), None);
    }
}
