//! Dialects of files by chance.

use gyrocal_statistics::deviates::Draw;

use super::dialect::{Dialect, Encoding, Times};
use super::listed::{EXCEL_S, MATLAB_S};

/// Forms of the times, each with titles that it may have.
const TIMES: [(Times, &[&[&str]]); 18] = [
    (
        Times::Number(1.0, f64::NAN, 3),
        &[&["t"], &["time"], &["Zeit [s]"], &["elapsed"], &["sec"]],
    ),
    (
        Times::Number(1e-3, f64::NAN, 0),
        &[&["t_ms"], &["time (ms)"], &["millis"]],
    ),
    (
        Times::Number(1e-6, f64::NAN, 0),
        &[&["t"], &["timestamp_us"]],
    ),
    (
        Times::Number(60.0, f64::NAN, 5),
        &[&["minutes"], &["t"], &["time [min]"]],
    ),
    (Times::Number(3600.0, f64::NAN, 7), &[&["t [h]"], &["time"]]),
    (
        Times::Number(1.0, 0.0, 2),
        &[&["unix"], &["epoch_s"], &["timestamp"]],
    ),
    (Times::Number(1e-3, 0.0, 0), &[&["epoch"], &["stamp"]]),
    (Times::Number(1e-9, 0.0, 0), &[&["time_ns"], &["stamp"]]),
    (
        Times::Number(86_400.0, EXCEL_S, 8),
        &[&["Date"], &["Datum"]],
    ),
    (
        Times::Number(86_400.0, MATLAB_S, 8),
        &[&["datenum"], &["time"]],
    ),
    (
        Times::Fields(&["%Y-%m-%dT%H:%M:%SZ"], 0),
        &[&["utc"], &["when"]],
    ),
    (
        Times::Fields(&["%Y-%m-%d %H:%M:%S.%3f"], 0),
        &[&["timestamp"], &["DateTime"]],
    ),
    (
        Times::Fields(&["%d.%m.%Y %H:%M:%S"], 0),
        &[&["Zeitstempel"], &["Date"]],
    ),
    (
        Times::Fields(&["%m/%d/%Y %I:%M:%S %p"], 0),
        &[&["Time"], &["TIMESTAMP"]],
    ),
    (
        Times::Fields(&["%Y/%m/%d", "%H:%M:%S"], 0),
        &[&["Date", "Time"], &["d", "h"]],
    ),
    (
        Times::Fields(&["%d.%m.%y", "%H:%M:%S"], 0),
        &[&["Datum", "Uhrzeit"]],
    ),
    (
        Times::Fields(&["%Y", "%-j", "%H:%M:%S"], 0),
        &[&["Year", "DOY", "Time"]],
    ),
    (
        Times::Fields(&["%d-%b-%y %H:%M:%S %z"], 1),
        &[&["time"], &["logged"]],
    ),
];

/// Titles of accelerometers.
const FORCES: [[&str; 3]; 8] = [
    ["ax", "ay", "az"],
    ["Acc X", "Acc Y", "Acc Z"],
    ["accel_x", "accel_y", "accel_z"],
    ["X", "Y", "Z"],
    ["A1", "A2", "A3"],
    ["Beschl_x", "Beschl_y", "Beschl_z"],
    ["ch1", "ch2", "ch3"],
    ["SF_X", "SF_Y", "SF_Z"],
];

/// Units of 1 g, values at zero and decimals.
const SCALES: [(f64, f64, usize); 7] = [
    (1.0, 0.0, 8),
    (1e3, 0.0, 5),
    (1e6, 0.0, 2),
    (9.806_65, 0.0, 7),
    (32.17, 0.0, 6),
    (3.2e6, 8_388_608.0, 0),
    (1.234, 0.0, 8),
];

/// A dialect by chance.
pub(super) fn drawn(draw: &mut Draw) -> Dialect {
    let (times, titles) = draw.one_of(&TIMES);
    let (scale, zero, decimals) = *draw.one_of(&SCALES);
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
    Dialect {
        name: "drawn",
        separator,
        decimal_comma,
        quoted,
        encoding: *draw.one_of(&[
            Encoding::Utf8,
            Encoding::Utf8,
            Encoding::Utf8Mark,
            Encoding::Utf16Mark,
            Encoding::Utf16,
            Encoding::Latin1,
        ]),
        line_end: draw.one_of::<&str>(&["\n", "\r\n", "\n", "\r"]),
        times: *times,
        titles: has_header.then(|| (*draw.one_of(titles), *draw.one_of(&FORCES), celsius)),
        units: units.then_some(["", "", unit]),
        scale,
        zero,
        decimals,
        preamble: draw.one_of::<&str>(&["", "", "Logger 7, operator AB\n\n", "rig 4\nstart\n"]),
        comment,
        temperature: (has_header && draw.uniform() < 0.5).then_some(temperature),
        missing: *draw.one_of(&[None, None, Some("NA"), Some("")]),
        behind: if draw.uniform() < 0.15 { separator } else { "" },
        repeats_header: has_header && comment.is_empty() && !units && draw.uniform() < 0.15,
    }
}
