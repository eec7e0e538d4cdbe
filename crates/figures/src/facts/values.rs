//! Values in a line: numbers with their units, ids, commands.

use crate::values::{length_of_number, parsed};

/// Units beside those that have `/` or `^`.
const UNITS: &str = "% deg g µg mg ng rad arcsec arcmin s min h d day days Hz K C m kg N V A W rows nats sigma ppm counts";

/// Endings of the names of files, which are no ids.
const FILES: [&str; 7] = ["csv", "gz", "html", "json", "png", "py", "toml"];

/// Of half a unit of the last digit, for the rounding of two conversions.
const ROUNDING: f64 = 1e-9;

/// A number as it is printed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Number {
    value: f64,
    /// Power of ten of its last digit; `None` of an integer.
    last: Option<i32>,
    /// Digits and exponent.
    pub(super) digits: String,
    /// The unit behind it; may be empty.
    pub(super) unit: String,
}

impl Number {
    fn new(digits: &str, unit: &str) -> Option<Self> {
        let digits = digits.trim_start_matches('+');
        let (value, last) = parsed(digits)?;
        Some(Self {
            value,
            last,
            digits: digits.to_owned(),
            unit: unit.to_owned(),
        })
    }

    /// The least and the largest number that is written so. `0` is nothing at all.
    pub(super) fn span(&self) -> [f64; 2] {
        let half = match self.digits.as_str() {
            "0" => 0.0,
            // Without its ends, so that two numbers of the same digits are equal or differ.
            _ => 0.5 * 10f64.powi(self.last.unwrap_or(0)) * (1.0 - ROUNDING),
        };
        [self.value - half, self.value + half]
    }

    /// Whether another one says at least what this one says: rounded to the digits of this one it is this one.
    pub(super) fn is_told_by(&self, other: &Self) -> bool {
        let as_fine = |last: i32| other.last.is_some_and(|other| other <= last);
        self.value == other.value
            || self
                .last
                .is_some_and(|last| as_fine(last) && (self.value - other.value).abs() <= half(last))
    }
}

/// Half a unit of a digit.
fn half(digit: i32) -> f64 {
    0.5 * 10f64.powi(digit) * (1.0 + ROUNDING)
}

/// A text with one way to write a number: `3.1·10⁻⁶`, `(1.3 ± 0.1)e-3` and `−2σ` become `3.1e-6`, `1.3e-3 ± 0.1e-3`
/// and `-2 sigma`.
pub(super) fn plain(text: &str) -> String {
    const RAISED: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";
    let text = text.replace('−', "-").replace('\u{a0}', "");
    let text = text.replace("·10⁻", "e-").replace("·10", "e");
    let digit = |letter| {
        let digit = RAISED.chars().position(|one| one == letter)?;
        char::from_digit(digit as u32, 10)
    };
    let letters = text.chars().map(|letter| digit(letter).unwrap_or(letter));
    let mut plain = letters.collect::<String>().replace('σ', " sigma");
    while let Some(end) = plain.find(")e") {
        let Some(start) = plain[..end].rfind('(') else {
            break;
        };
        let tail = &plain[end + 1..];
        let length = tail.find(|c: char| !"e+-".contains(c) && !c.is_ascii_digit());
        let exponent = tail[..length.unwrap_or(tail.len())].to_owned();
        if exponent.len() < 2 {
            break;
        }
        let inner = plain[start + 1..end].replace(" ± ", &format!("{exponent} ± "));
        let rest = plain[end + 1 + exponent.len()..].to_owned();
        plain = format!("{}{inner}{exponent}{rest}", &plain[..start]);
    }
    plain
}

/// Numbers of a text, each with its place.
pub(super) fn numbers(text: &str) -> Vec<(usize, Number)> {
    let mut found = Vec::new();
    let mut begins = true;
    let mut at = 0;
    while let Some(letter) = text[at..].chars().next() {
        let rest = &text[at..];
        let length = if begins { length_of_number(rest) } else { 0 };
        let after = &rest[length..];
        let mut next = after.chars();
        let ends = match next.next() {
            None => true,
            Some('.') => !next.next().is_some_and(char::is_alphanumeric),
            Some(letter) => letter.is_whitespace() || "),;:]%µ→".contains(letter),
        };
        if length > 0 && ends {
            let unit = unit_of(after);
            found.extend(Number::new(&rest[..length], unit).map(|one| (at, one)));
        }
        at += length.max(letter.len_utf8());
        begins = length == 0 && (letter.is_whitespace() || "([=<>≤≥≈~±,;:→".contains(letter));
    }
    found
}

/// The number that a text begins with, and what follows; `<` and `>` make it a bound.
pub(super) fn leading(text: &str) -> Option<([f64; 2], &str)> {
    let bound = text.strip_prefix(['<', '>']);
    let number = bound.map_or(text, str::trim_start);
    let length = length_of_number(number);
    let [low, high] = Number::new(&number[..length], "")?.span();
    let span = match text.chars().next() {
        Some('<') => [f64::NEG_INFINITY, high],
        Some('>') => [low, f64::INFINITY],
        _ => [low, high],
    };
    Some((span, &number[length..]))
}

fn unit_of(text: &str) -> &str {
    let text = text.strip_prefix(' ').unwrap_or(text);
    let end = text.find(|c: char| c.is_whitespace() || ",;:)]→".contains(c));
    let word = text[..end.unwrap_or(text.len())].trim_end_matches('.');
    let is_composed = word.starts_with(char::is_alphabetic) && word.contains(['/', '^']);
    match is_composed || UNITS.split(' ').any(|unit| unit == word) {
        true => word,
        false => "",
    }
}

/// Words of a text that are ids of effects or names of coefficients (`gyro_x.g_z`, `v_rate.sign(v)`), or that
/// `chosen` has, each with its place.
pub(super) fn words<'a>(text: &'a str, chosen: &[&str]) -> Vec<(usize, &'a str)> {
    let words = text.split(|c: char| c.is_whitespace() || ",;:".contains(c));
    let words = words.map(|word| {
        let mut word = word
            .trim_matches(['`', '\'', '"', '('])
            .trim_end_matches('.');
        while word.ends_with(')') && word.matches(')').count() > word.matches('(').count() {
            word = &word[..word.len() - 1];
        }
        (word.as_ptr().addr() - text.as_ptr().addr(), word)
    });
    words
        .filter(|(_, word)| is_id(word) || chosen.contains(word))
        .collect()
}

pub(super) fn is_id(word: &str) -> bool {
    let Some((of, name)) = word.split_once('.') else {
        return false;
    };
    let is_letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    of.starts_with(|c: char| c.is_ascii_alphabetic())
        && of.chars().all(is_letter)
        && name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '|')
        && name.chars().all(|c| is_letter(c) || "()|^*+-".contains(c))
        && of.len() + name.len() > 2
        && !FILES.contains(&name)
}

/// The command with arguments that a text tells to run; may be empty.
pub(super) fn command(text: &str) -> String {
    let mut words = text.split(' ').skip_while(|word| *word != "gyrocal");
    let mut command: Vec<&str> = words.next().into_iter().collect();
    let is_argument = |word: &str| word.starts_with(['-', '%', '@']);
    for word in words {
        let is_value = command
            .last()
            .is_some_and(|before| before.starts_with("--"));
        let is_name = !command.iter().any(|before| is_argument(before))
            && word.chars().all(|c| c.is_ascii_lowercase() || c == '-');
        if !(is_argument(word) || is_value || is_name) || word.ends_with('`') {
            break;
        }
        command.push(word);
    }
    match command.iter().any(|word| is_argument(word)) {
        true => command.join(" "),
        false => String::new(),
    }
}
