//! Dialects of files by chance.

use gyrocal_statistics::deviates::Draw;
use serde::Deserialize;

use super::dialect::{Dialect, Encoding, Times};

/// What dialects by chance are drawn of, and those that are listed.
#[derive(Deserialize)]
pub(super) struct Dialects {
    /// Titles of accelerometers.
    forces: Vec<[String; 3]>,
    /// Units of 1 g, values at zero and decimals.
    scales: Vec<(f64, f64, usize)>,
    time: Vec<Time>,
    pub(super) listed: Vec<Dialect>,
}

/// A form of the times, with titles that it may have.
#[derive(Deserialize)]
struct Time {
    form: Times,
    titles: Vec<Vec<String>>,
}

/// A dialect by chance.
pub(super) fn drawn(of: &Dialects, draw: &mut Draw) -> Dialect {
    let time = draw.one_of(&of.time);
    let (scale, zero, decimals) = *draw.one_of(&of.scales);
    let separator = *draw.one_of(&[",", ";", "\t", "|", ";", ","]);
    // Decimal commas between commas stand in quotation marks.
    let decimal_comma = draw.uniform() < 0.4;
    let quoted = (decimal_comma && separator == ",") || draw.uniform() < 0.15;
    let has_header = draw.uniform() < 0.85;
    let comment = *draw.one_of(&["", "", "", "#", "%"]);
    let units = has_header && draw.uniform() < 0.2;
    let (celsius, unit, temperature) = *draw.one_of(&[
        ("temp", "degC", [1.0, 0.0]),
        ("T [degF]", "degF", [1.8, 32.0]),
        ("Temperatur", "C", [1.0, 0.0]),
        ("temp_K", "K", [1.0, 273.15]),
    ]);
    let text = str::to_owned;
    let encodings = {
        use Encoding::{Latin1, Utf8, Utf8Mark, Utf16, Utf16Mark};
        [Utf8, Utf8, Utf8Mark, Utf16Mark, Utf16, Latin1]
    };
    let mut drawn = Dialect {
        name: text("drawn"),
        separator: text(separator),
        decimal_comma,
        quoted,
        encoding: *draw.one_of(&encodings),
        line_end: text(draw.one_of::<&str>(&["\n", "\r\n", "\n", "\r"])),
        times: time.form.clone(),
        header: has_header,
        units: units.then(|| ["", "", unit].map(text)),
        scale,
        zero,
        decimals,
        comment: text(comment),
        ..Dialect::default()
    };
    if has_header {
        let titles = draw.one_of(&time.titles).clone();
        drawn.titles = (titles, draw.one_of(&of.forces).clone(), text(celsius));
    }
    let preambles = ["", "", "Logger 7, operator AB\n\n", "rig 4\nstart\n"];
    drawn.preamble = text(draw.one_of::<&str>(&preambles));
    drawn.temperature = (has_header && draw.uniform() < 0.5).then_some(temperature);
    drawn.missing = draw.one_of(&[None, None, Some("NA"), Some("")]).map(text);
    if draw.uniform() < 0.15 {
        drawn.behind = text(separator);
    }
    drawn.repeats_header = has_header && comment.is_empty() && !units && draw.uniform() < 0.15;
    drawn
}
