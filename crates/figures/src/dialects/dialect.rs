//! A record of a platform as some program or laboratory would have written it.

use std::fmt::Write as _;

use gyrocal_record::Record;
use jiff::Timestamp;
use jiff::tz::Offset;
use serde::Deserialize;

/// Encodings of a text.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
pub(super) enum Encoding {
    Utf8,
    Utf8Mark,
    Utf16Mark,
    Utf16Big,
    Utf16,
    Latin1,
}

/// Forms of the times.
#[derive(Clone, Debug, Deserialize, PartialEq)]
pub(super) enum Times {
    /// Number of seconds in a unit from an origin \[s since 1970\], `NaN` of an elapsed time, with decimals.
    Number(f64, f64, usize),
    /// Fields that are dates and times by `strftime`, with the offset of the clock \[h\].
    Fields(Vec<String>, i8),
    /// Week and seconds of GPS.
    Gps,
}

/// Titles of the fields of the time, of accelerometers and of the temperature.
pub(super) type Titles = (Vec<String>, [String; 3], String);

/// Separators, encoding, names, units and form of a file.
#[derive(Clone, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Dialect {
    pub(super) name: String,
    pub(super) separator: String,
    pub(super) decimal_comma: bool,
    pub(super) quoted: bool,
    pub(super) encoding: Encoding,
    pub(super) line_end: String,
    pub(super) times: Times,
    pub(super) header: bool,
    /// Titles of the fields of the time, three accelerometers and the temperature.
    pub(super) titles: Titles,
    /// Units in a line below the header: time, accelerometers, temperature.
    pub(super) units: Option<[String; 3]>,
    /// Units of 1 g, and the value at zero.
    pub(super) scale: f64,
    pub(super) zero: f64,
    pub(super) decimals: usize,
    /// Lines in front of the header.
    pub(super) preamble: String,
    /// Sign in front of the header and of a line in the middle.
    pub(super) comment: String,
    /// Temperature: factor and offset of °C.
    pub(super) temperature: Option<[f64; 2]>,
    /// Word for a missing value of each fiftieth row.
    pub(super) missing: Option<String>,
    /// Text behind the last field of a row: a separator, an empty field.
    pub(super) behind: String,
    pub(super) repeats_header: bool,
}

impl Default for Dialect {
    /// A plain file: commas, points, seconds, g.
    fn default() -> Self {
        let text = str::to_owned;
        Self {
            name: text("plain"),
            separator: text(","),
            decimal_comma: false,
            quoted: false,
            encoding: Encoding::Utf8,
            line_end: text("\n"),
            times: Times::Number(1.0, f64::NAN, 1),
            header: true,
            titles: (vec![text("t")], ["ax", "ay", "az"].map(text), text("temp")),
            units: None,
            scale: 1.0,
            zero: 0.0,
            decimals: 8,
            preamble: String::new(),
            comment: String::new(),
            temperature: None,
            missing: None,
            behind: String::new(),
            repeats_header: false,
        }
    }
}

/// Origin of the GPS weeks \[s since 1970\], and what GPS is ahead of UTC \[s\].
const GPS_S: f64 = 315_964_800.0;
const GPS_AHEAD_S: f64 = 18.0;
const WEEK_S: f64 = 604_800.0;

impl Dialect {
    /// The bytes of a record whose first row is at a time \[s since 1970\].
    pub(super) fn bytes(&self, record: &Record, first_s: f64) -> Vec<u8> {
        self.encoded(&self.text(record, first_s))
    }

    fn text(&self, record: &Record, first_s: f64) -> String {
        let mut text = self.preamble.replace('\n', &self.line_end);
        let header = self.header();
        text += &header;
        for row in 0..record.len() {
            if row == record.len() / 2 {
                if self.repeats_header {
                    text += &header;
                } else if !self.comment.is_empty() {
                    let _ = write!(text, "{} door opened{}", self.comment, self.line_end);
                }
            }
            let mut fields = self.time(first_s + record.time_s[row] - record.time_s[0], first_s);
            for (axis, force) in record.accel_g[row].iter().enumerate() {
                let missing = self.missing.clone().filter(|_| row % 50 == 7 + axis);
                let number = || self.number(force * self.scale + self.zero, self.decimals);
                fields.push(missing.unwrap_or_else(number));
            }
            let temperature = self.temperature.zip(record.temperature_c.as_ref());
            fields.extend(
                temperature.map(|([factor, offset], celsius)| {
                    self.number(celsius[row] * factor + offset, 2)
                }),
            );
            text += &self.line(&fields);
        }
        text
    }

    fn line(&self, fields: &[String]) -> String {
        let mark = if self.quoted { "\"" } else { "" };
        let fields = fields.iter().map(|field| format!("{mark}{field}{mark}"));
        fields.collect::<Vec<_>>().join(&self.separator) + &self.behind + &self.line_end
    }

    fn header(&self) -> String {
        if !self.header {
            return String::new();
        }
        let (times, force, temperature) = &self.titles;
        let mut titles: Vec<String> = times.iter().chain(force).cloned().collect();
        titles.extend(self.temperature.map(|_| temperature.clone()));
        let sign = match self.comment.is_empty() || self.units.is_some() {
            true => String::new(),
            false => format!("{} ", self.comment),
        };
        let mut text = sign + &self.line(&titles);
        if let Some([time, force, temperature]) = &self.units {
            let mut units = vec![time.clone(); times.len()];
            units.extend(vec![force.clone(); 3]);
            units.extend(self.temperature.map(|_| temperature.clone()));
            text += &self.line(&units);
        }
        text
    }

    fn number(&self, value: f64, decimals: usize) -> String {
        let text = format!("{value:.decimals$}");
        text.replace('.', if self.decimal_comma { "," } else { "." })
    }

    /// Fields of a time \[s since 1970\].
    fn time(&self, time_s: f64, first_s: f64) -> Vec<String> {
        match &self.times {
            Times::Number(unit_s, origin_s, decimals) => {
                let origin_s = if origin_s.is_nan() {
                    first_s
                } else {
                    *origin_s
                };
                vec![self.number((time_s - origin_s) / unit_s, *decimals)]
            }
            Times::Fields(formats, ahead_h) => {
                let stamp = Timestamp::from_nanosecond((time_s * 1e3).round() as i128 * 1_000_000);
                let zone = Offset::constant(*ahead_h).to_time_zone();
                let zoned = stamp.unwrap_or_default().to_zoned_datetime(zone);
                let write = |format: &String| zoned.strftime(format).to_string();
                formats.iter().map(write).collect()
            }
            Times::Gps => {
                let since_s = time_s - GPS_S + GPS_AHEAD_S;
                let week = (since_s / WEEK_S).floor();
                vec![
                    format!("{week:.0}"),
                    self.number(since_s - week * WEEK_S, 3),
                ]
            }
        }
    }

    fn encoded(&self, text: &str) -> Vec<u8> {
        let utf16 = |text: &str, big: bool| -> Vec<u8> {
            let bytes = |unit: u16| match big {
                true => unit.to_be_bytes(),
                false => unit.to_le_bytes(),
            };
            text.encode_utf16().flat_map(bytes).collect()
        };
        let marked = format!("\u{feff}{text}");
        match self.encoding {
            Encoding::Utf8 => text.as_bytes().to_vec(),
            Encoding::Utf8Mark => marked.into_bytes(),
            Encoding::Utf16Mark => utf16(&marked, false),
            Encoding::Utf16Big => utf16(&marked, true),
            Encoding::Utf16 => utf16(text, false),
            // The first 256 characters of Unicode are those of Latin-1.
            Encoding::Latin1 => {
                let signs = text.chars();
                signs
                    .map(|sign| u8::try_from(sign).unwrap_or(b'?'))
                    .collect()
            }
        }
    }
}
