//! Forty dialects of files as loggers, spreadsheets and laboratories write them.

use super::dialect::{Dialect, Encoding, PLAIN, Times};

/// Origins of days \[s since 1970\]: of spreadsheets, of MATLAB, of the Julian date, of 1 January 2026.
pub(super) const EXCEL_S: f64 = -25_569.0 * 86_400.0;
pub(super) const MATLAB_S: f64 = -719_529.0 * 86_400.0;
pub(super) const JULIAN_S: f64 = -2_440_587.5 * 86_400.0;
pub(super) const YEAR_S: f64 = 1_767_139_200.0;

const G: f64 = 9.81241;

const PREAMBLE: &str = "Messung;Plattform 3\nDatum;28.03.2026\n\n";
const LABVIEW: &str = "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nX_Columns\tOne\n***End_of_Header***\t\n\t\n\
    Channels\t3\t\t\t\nSamples\t1\t1\t1\t\n***End_of_Header***\t\t\t\t\n";

pub(super) const LISTED: [Dialect; 40] = [
    Dialect {
        name: "a record",
        titles: Some((
            &["time_s"],
            ["accel_x_g", "accel_y_g", "accel_z_g"],
            "temperature_c",
        )),
        ..PLAIN
    },
    Dialect {
        name: "a record with a byte-order mark",
        titles: Some((
            &["time_s"],
            ["accel_x_g", "accel_y_g", "accel_z_g"],
            "temperature_c",
        )),
        encoding: Encoding::Utf8Mark,
        temperature: Some([1.0, 0.0]),
        ..PLAIN
    },
    Dialect {
        name: "German laboratory, Latin-1",
        separator: ";",
        decimal_comma: true,
        encoding: Encoding::Latin1,
        line_end: "\r\n",
        titles: Some((
            &["Zeit [s]"],
            ["Beschl. X [m/s²]", "Beschl. Y [m/s²]", "Beschl. Z [m/s²]"],
            "Temp. [°C]",
        )),
        scale: G,
        preamble: PREAMBLE,
        temperature: Some([1.0, 0.0]),
        ..PLAIN
    },
    Dialect {
        name: "tabs, mg, a line of units, comments",
        separator: "\t",
        titles: Some((&["Elapsed"], ["A1", "A2", "A3"], "RTD")),
        units: Some(["s", "mg", "degC"]),
        scale: 1e3,
        decimals: 6,
        comment: "#",
        preamble: "# rig 4\n# operator: AB\n",
        temperature: Some([1.0, 0.0]),
        ..PLAIN
    },
    Dialect {
        name: "counts of 24 bits, blanks, no header",
        separator: " ",
        times: Times::Number(1e-3, f64::NAN, 0),
        titles: None,
        scale: 3.2e6,
        zero: 8_388_608.0,
        decimals: 0,
        ..PLAIN
    },
    Dialect {
        name: "RFC 3339 with an offset",
        times: Times::Fields(&["%Y-%m-%dT%H:%M:%S.%3f%:z"], 1),
        titles: Some((&["timestamp"], ["ax", "ay", "az"], "temp")),
        temperature: Some([1.0, 0.0]),
        ..PLAIN
    },
    Dialect {
        name: "GPS week and seconds",
        times: Times::Gps,
        titles: Some((
            &["gps_week", "gps_tow"],
            ["acc_x", "acc_y", "acc_z"],
            "temp",
        )),
        ..PLAIN
    },
    Dialect {
        name: "days of a spreadsheet, decimal commas",
        separator: ";",
        decimal_comma: true,
        times: Times::Number(86_400.0, EXCEL_S, 8),
        titles: Some((&["Date"], ["X", "Y", "Z"], "T")),
        ..PLAIN
    },
    Dialect {
        name: "year, day of year, time",
        times: Times::Fields(&["%Y", "%-j", "%H:%M:%S"], 0),
        titles: Some((&["YEAR", "DOY", "HMS"], ["AX", "AY", "AZ"], "T")),
        ..PLAIN
    },
    Dialect {
        name: "days of the year with a fraction",
        times: Times::Number(86_400.0, YEAR_S, 9),
        titles: Some((&["doy"], ["AX", "AY", "AZ"], "T")),
        ..PLAIN
    },
    Dialect {
        name: "words for missing values",
        missing: Some("OVR"),
        temperature: Some([1.0, 0.0]),
        titles: Some((&["t"], ["ax", "ay", "az"], "T")),
        ..PLAIN
    },
    Dialect {
        name: "words of a spreadsheet for missing values",
        separator: ";",
        missing: Some("#N/A"),
        ..PLAIN
    },
    Dialect {
        name: "the header again in the middle",
        repeats_header: true,
        ..PLAIN
    },
    Dialect {
        name: "Fahrenheit",
        titles: Some((
            &["time_s"],
            ["accel_x_g", "accel_y_g", "accel_z_g"],
            "temp_F",
        )),
        temperature: Some([1.8, 32.0]),
        ..PLAIN
    },
    Dialect {
        name: "kelvin",
        titles: Some((
            &["sec"],
            ["force_x", "force_y", "force_z"],
            "temperature [K]",
        )),
        temperature: Some([1.0, 273.15]),
        ..PLAIN
    },
    Dialect {
        name: "quotation marks, mark of UTF-8, CR LF",
        quoted: true,
        encoding: Encoding::Utf8Mark,
        line_end: "\r\n",
        titles: Some((
            &["time_s"],
            ["accel_x_g", "accel_y_g", "accel_z_g"],
            "temperature_c",
        )),
        ..PLAIN
    },
    Dialect {
        name: "UTF-16 with a mark",
        encoding: Encoding::Utf16Mark,
        line_end: "\r\n",
        titles: Some((
            &["time_s"],
            ["accel_x_g", "accel_y_g", "accel_z_g"],
            "temperature_c",
        )),
        ..PLAIN
    },
    Dialect {
        name: "UTF-16, big end first, tabs",
        separator: "\t",
        encoding: Encoding::Utf16Big,
        ..PLAIN
    },
    Dialect {
        name: "UTF-16 without a mark",
        separator: ";",
        encoding: Encoding::Utf16,
        ..PLAIN
    },
    Dialect {
        name: "lines that end with CR",
        line_end: "\r",
        ..PLAIN
    },
    Dialect {
        name: "German date and time in one column",
        separator: ";",
        decimal_comma: true,
        times: Times::Fields(&["%d.%m.%Y %H:%M:%S"], 0),
        titles: Some((&["Timestamp"], ["ax", "ay", "az"], "T")),
        ..PLAIN
    },
    Dialect {
        name: "German date and time in two columns",
        separator: ";",
        decimal_comma: true,
        times: Times::Fields(&["%d.%m.%Y", "%H:%M:%S"], 0),
        titles: Some((&["Datum", "Uhrzeit"], ["ax", "ay", "az"], "T")),
        ..PLAIN
    },
    Dialect {
        name: "American date, twelve hours",
        times: Times::Fields(&["%m/%d/%Y %I:%M:%S %p"], 0),
        titles: Some((&["Time"], ["ax", "ay", "az"], "T")),
        ..PLAIN
    },
    Dialect {
        name: "British date",
        times: Times::Fields(&["%d/%m/%Y %H:%M:%S"], 0),
        titles: Some((&["Date"], ["ax", "ay", "az"], "T")),
        ..PLAIN
    },
    Dialect {
        name: "milliseconds since 1970",
        times: Times::Number(1e-3, 0.0, 0),
        titles: Some((&["unix_ms"], ["ax", "ay", "az"], "T")),
        ..PLAIN
    },
    Dialect {
        name: "nanoseconds since 1970",
        times: Times::Number(1e-9, 0.0, 0),
        titles: Some((&["stamp"], ["ax", "ay", "az"], "T")),
        ..PLAIN
    },
    Dialect {
        name: "seconds since 1970",
        times: Times::Number(1.0, 0.0, 3),
        titles: Some((&["epoch"], ["ax", "ay", "az"], "T")),
        ..PLAIN
    },
    Dialect {
        name: "LabVIEW",
        separator: "\t",
        preamble: LABVIEW,
        titles: Some((&["X_Value"], ["Acc_0", "Acc_1", "Acc_2"], "")),
        behind: "\t",
        ..PLAIN
    },
    Dialect {
        name: "date and time of ISO in two columns",
        times: Times::Fields(&["%Y-%m-%d", "%H:%M:%S.%6f"], 0),
        titles: Some((&["date", "time"], ["ax", "ay", "az"], "T")),
        ..PLAIN
    },
    Dialect {
        name: "a blank for the T",
        times: Times::Fields(&["%Y-%m-%d %H:%M:%S"], 0),
        titles: Some((&["stamp"], ["ax", "ay", "az"], "T")),
        ..PLAIN
    },
    Dialect {
        name: "days of MATLAB",
        separator: " ",
        times: Times::Number(86_400.0, MATLAB_S, 8),
        titles: None,
        ..PLAIN
    },
    Dialect {
        name: "Julian date",
        separator: "|",
        times: Times::Number(86_400.0, JULIAN_S, 8),
        titles: Some((&["JD"], ["fx", "fy", "fz"], "T")),
        ..PLAIN
    },
    Dialect {
        name: "bars, ft/s²",
        separator: "|",
        scale: G / 0.3048,
        ..PLAIN
    },
    Dialect {
        name: "Gal",
        scale: 981.241,
        decimals: 5,
        titles: Some((&["t [s]"], ["a_x [Gal]", "a_y [Gal]", "a_z [Gal]"], "")),
        ..PLAIN
    },
    Dialect {
        name: "volts",
        scale: 2.47,
        titles: Some((&["time"], ["CH1", "CH2", "CH3"], "CH4 Temp")),
        temperature: Some([1.0, 0.0]),
        ..PLAIN
    },
    Dialect {
        name: "header in a comment, blanks",
        separator: " ",
        comment: "#",
        titles: Some((&["t_min"], ["x", "y", "z"], "")),
        times: Times::Number(60.0, f64::NAN, 6),
        ..PLAIN
    },
    Dialect {
        name: "hours without a word for it",
        times: Times::Number(3600.0, f64::NAN, 7),
        titles: Some((&["elapsed"], ["s1", "s2", "s3"], "")),
        scale: 1e6,
        decimals: 2,
        ..PLAIN
    },
    Dialect {
        name: "a separator behind each row",
        separator: ";",
        behind: ";",
        titles: Some((&["t"], ["ax", "ay", "az"], "T")),
        ..PLAIN
    },
    Dialect {
        name: "name of the month, an offset",
        times: Times::Fields(&["%d-%b-%Y %H:%M:%S %z"], 2),
        titles: Some((&["Time"], ["SFx", "SFy", "SFz"], "T")),
        separator: ";",
        ..PLAIN
    },
    Dialect {
        name: "decimal commas in quotation marks",
        quoted: true,
        decimal_comma: true,
        times: Times::Number(1e-6, f64::NAN, 0),
        titles: Some((
            &["time [µs]"],
            ["Acc X (mg)", "Acc Y (mg)", "Acc Z (mg)"],
            "",
        )),
        scale: 1e3,
        ..PLAIN
    },
];
