//! What a file has beside the libraries: its head, the types that it recommends, and its tests.

use std::fmt::Write as _;

use gyrocal_record::Gyros;

use crate::number::Number;
use crate::reference::{ANGLES_RAD, Expected, INTERVAL_S, LATITUDE_DEG, SIGMA_RAD, Start, TURN};

/// True if the libraries of this program fuse multiplication and addition, which the file does not.
const FUSED: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));

/// An extended model.
pub(crate) struct Names<'a> {
    /// Its module.
    pub(crate) module: &'a str,
    /// Its type.
    pub(crate) model: &'a str,
    /// What its gyros are fixed to.
    pub(crate) gyros: Gyros,
}

/// Comment and attributes at the beginning.
pub(crate) fn head(number: Number, gyros: Gyros, effects: &[String], hash: &str) -> String {
    let of = match gyros {
        Gyros::Platform => "of a platform",
        Gyros::Strapdown => "of a strapdown unit",
    };
    let number = number.name();
    let what = match effects {
        [] => "the nine drift coefficients".to_owned(),
        effects => format!("the nine drift coefficients and {}", effects.join(", ")),
    };
    format!(
        "\
//! A streaming filter for the drift of three gyros {of}, in one file, `{number}`:
//! {what}.
//!
//! Written by `gyrocal emit`, gyrocal {}; do not edit. Model {hash}.
//!
//! It needs `core` only. As a library: `rustc --edition 2024 --crate-type lib FILE`, or as `src/lib.rs` of a
//! package of edition 2024. Its tests: `rustc --edition 2024 -O --test FILE`, and run the program.
//!
//! [`EmittedFilter`] is the type to use. The modules `gyrocal`, `estimation` and `scalar` are the sources of
//! the libraries, without what no filter uses. MIT OR Apache-2.0.

#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]
#![allow(
    dead_code,
    unexpected_cfgs,
    unused_imports,
    clippy::all,
    reason = \"the libraries have more than one program uses, and lints of their own\"
)]
",
        env!("CARGO_PKG_VERSION")
    )
}

/// Types of a nominal filter.
pub(crate) fn nominal(number: Number) -> String {
    let number = number.name();
    format!(
        "\
pub use gyrocal::{{
    ControllerError, ControllerFilter, Discretisation, Drift, EstimationError, FilterSettings,
    InitialAttitude, Innovation, Limits, PlatformFilter, Site,
}};

/// The number type.
pub type Number = {number};

/// The filter: `EmittedFilter::unset()` in a `static`, then `start`, `update` with the first sample, and
/// `step` with each later one.
pub type EmittedFilter = ControllerFilter<Number>;
"
    )
}

/// Types of an extended filter.
pub(crate) fn extended(number: Number, names: &Names<'_>) -> String {
    let (number, Names { module, model, .. }) = (number.name(), names);
    let take = match names.gyros {
        Gyros::Platform => "`take`",
        Gyros::Strapdown => "`take_turning`",
    };
    format!(
        "\
pub use gyrocal::{{
    Discretisation, Drift, EstimationError, ExtensionFilter, FilterSettings, InitialAttitude, Innovation,
    Regressors, Site,
}};
pub use {module}::{{{model}, {model}Inputs, START}};

/// The number type.
pub type Number = {number};

/// The filter: [`emitted_filter`], then {take} with each sample.
pub type EmittedFilter =
    ExtensionFilter<Number, {model}, {model}Inputs<Number>, {{ {model}::STATES }}>;

/// A filter whose parameters of effects start at the values of the model file.
///
/// # Errors
/// [`EstimationError`] if the settings are refused.
pub fn emitted_filter(
    settings: &FilterSettings<Number>,
    attitude: &InitialAttitude<Number>,
) -> Result<EmittedFilter, EstimationError> {{
    let start = START.iter().map(|start| [start.value, start.sigma]);
    EmittedFilter::new({model}, start, settings, attitude)
}}
"
    )
}

/// Tests of a nominal filter after their tables.
const NOMINAL_TESTS: &str = "
    fn started() -> EmittedFilter {
        let mut filter = EmittedFilter::unset();
        filter.start(&settings(), &attitude(), Limits::default()).unwrap();
        filter
    }

    /// Takes the sample of a row.
    fn take(filter: &mut EmittedFilter, row: usize) {
        match row {
            0 => filter.update(&SAMPLES[row]).unwrap(),
            _ => filter.step(INTERVAL_S, &SAMPLES[row]).unwrap(),
        };
    }

    #[test]
    fn estimates_and_sigmas_are_those_of_the_libraries() {
        let mut filter = started();
        let mut compared = 0;
        for row in 0..SAMPLES.len() {
            take(&mut filter, row);
            for (_, estimates, sigmas) in EXPECTED.iter().filter(|(at, _, _)| *at == row) {
                let (found, deviations) = (filter.filter().drift(), filter.filter().drift_sigma());
                compare(row, &found.to_array(), &deviations.to_array(), estimates, sigmas);
                compared += 1;
            }
        }
        assert_eq!(compared, EXPECTED.len());
    }

    #[test]
    fn a_saved_state_continues_bit_by_bit() {
        let mut filter = started();
        (0..20).for_each(|row| take(&mut filter, row));
        let mut saved = [0; EmittedFilter::SAVED_BYTES];
        filter.save(&mut saved).unwrap();
        let mut other = started();
        other.restore(&saved).unwrap();
        for row in 20..40 {
            take(&mut filter, row);
            take(&mut other, row);
        }
        assert_eq!(filter.filter().drift(), other.filter().drift());
        saved[30] ^= 1;
        assert_eq!(other.restore(&saved), Err(ControllerError::SavedChecksum));
    }

    #[test]
    fn input_without_meaning_is_refused() {
        let mut filter = started();
        take(&mut filter, 0);
        let nan = [Number::NAN, 0.0, 1.0];
        let refused = filter.step(INTERVAL_S, &nan);
        assert_eq!(refused, Err(ControllerError::SampleNotFinite { axis: 0 }));
        let refused = filter.step(0.0, &SAMPLES[1]);
        assert_eq!(refused, Err(ControllerError::IntervalNotPositive));
        let [x, y, z] = SAMPLES[1];
        let refused = filter.step(INTERVAL_S, &[x + 0.1, y, z]);
        assert_eq!(refused, Err(ControllerError::SampleSurprising));
    }
}
";

/// Tests of a nominal filter.
pub(crate) fn nominal_vectors(
    number: Number,
    samples: &[[f64; 3]],
    expected: &[Expected],
) -> String {
    let tolerance = match (FUSED, number) {
        (false, _) => (
            0.0,
            "The numbers are those of the libraries, to the last bit.",
        ),
        (true, Number::F64) => (
            1e-6,
            "The libraries that gave the numbers fuse multiplication and addition: other last bits, in sigma.",
        ),
        (true, Number::F32) => (
            0.1,
            "The libraries that gave the numbers fuse multiplication and addition: other last bits, in sigma.",
        ),
    };
    let mut text = tables(number, samples, expected, tolerance);
    text.push_str(NOMINAL_TESTS);
    text
}

/// Tests of an extended filter.
pub(crate) fn extended_vectors(
    number: Number,
    names: &Names<'_>,
    starts: &[Start],
    samples: &[[f64; 3]],
    expected: &[Expected],
) -> String {
    let Names { module, model, .. } = names;
    let tolerance = match number {
        Number::F64 => (
            1e-5,
            "The numbers come from the model of all effects, all others of which are pinned: rounding of the \
             covariance, in sigma.",
        ),
        Number::F32 => (
            0.1,
            "The numbers come from a filter in double precision: rounding in single precision, in sigma.",
        ),
    };
    let mut text = tables(number, samples, expected, tolerance);
    let rows = starts.iter().map(|start| {
        let (value, sigma) = (start.value, start.sigma);
        format!("        ({:?}, [{value:?}, {sigma:?}]),\n", start.id)
    });
    let rows: String = rows.collect();
    let (axes, take) = match names.gyros {
        Gyros::Platform => (String::new(), "take(interval_s, sample)"),
        Gyros::Strapdown => (
            axes(),
            "take_turning(interval_s, [&axes(row as Number - 0.5), &axes(row as Number)], sample)",
        ),
    };
    let _ = write!(
        text,
        "{axes}
    /// Ids of the parameters of the effects in the order of [`EXPECTED`], with start value and sigma.
    const STARTS: [(&str, [f64; 2]); {}] = [
{rows}    ];

    #[test]
    fn estimates_and_sigmas_are_those_of_the_libraries() {{
        let effects = &{module}::PARAMETERS[9..];
        let start = effects.iter().map(|parameter| {{
            let mut starts = STARTS.iter();
            starts.find(|(id, _)| *id == parameter.id).unwrap().1
        }});
        let mut filter = EmittedFilter::new({model}, start, &settings(), &attitude()).unwrap();
        let place = |id| 12 + effects.iter().position(|parameter| parameter.id == id).unwrap();
        let places: Vec<usize> = (3..12).chain(STARTS.map(|(id, _)| place(id))).collect();
        let mut compared = 0;
        for (row, sample) in SAMPLES.iter().enumerate() {{
            let interval_s = if row == 0 {{ 0.0 }} else {{ INTERVAL_S }};
            filter.{take}.unwrap();
            for (_, estimates, sigmas) in EXPECTED.iter().filter(|(at, _, _)| *at == row) {{
                let kernel = filter.filter();
                let found: Vec<Number> = places.iter().map(|at| kernel.state()[*at]).collect();
                let deviations: Vec<Number> = places.iter().map(|at| kernel.sigma(*at)).collect();
                compare(row, &found, &deviations, estimates, sigmas);
                compared += 1;
            }}
        }}
        assert_eq!(compared, EXPECTED.len());
    }}

    #[test]
    fn the_start_values_of_the_model_file_are_taken() {{
        assert_eq!(START.len() + 12, {model}::STATES);
        assert!(emitted_filter(&settings(), &attitude()).is_ok());
    }}
}}
",
        starts.len()
    );
    text
}

/// The function of the axes of a strapdown unit.
fn axes() -> String {
    format!(
        "
    /// Axes of the gyros in the platform, some rows after the first: of the quaternion (1, x, y, z).
    fn axes(rows: Number) -> [[Number; 3]; 3] {{
        let [x, y, z] = {TURN:?}.map(|change: Number| change * rows);
        let scale = 1.0 / (1.0 + x * x + y * y + z * z);
        [
            [1.0 + x * x - y * y - z * z, 2.0 * (x * y - z), 2.0 * (x * z + y)],
            [2.0 * (x * y + z), 1.0 - x * x + y * y - z * z, 2.0 * (y * z - x)],
            [2.0 * (x * z - y), 2.0 * (y * z + x), 1.0 - x * x - y * y + z * z],
        ]
        .map(|row| row.map(|element| scale * element))
    }}
"
    )
}

/// Samples, expected numbers and the comparison: the beginning of the module of tests.
fn tables(
    number: Number,
    samples: &[[f64; 3]],
    expected: &[Expected],
    (tolerance, reason): (f64, &str),
) -> String {
    let list = |numbers: &[f64]| {
        let numbers: Vec<String> = numbers.iter().map(|x| literal(number, *x)).collect();
        format!("[{}]", numbers.join(", "))
    };
    let mut rows = String::new();
    for sample in samples {
        let _ = writeln!(rows, "        {},", list(sample));
    }
    let mut compared = String::new();
    for one in expected {
        let (estimates, sigmas) = (list(&one.estimates), list(&one.sigmas));
        let _ = writeln!(compared, "        ({}, {estimates}, {sigmas}),", one.row);
    }
    let parameters = expected.first().map_or(0, |one| one.estimates.len());
    format!(
        "\
#[cfg(test)]
mod vectors {{
    use super::*;

    /// {reason}
    const TOLERANCE: Number = {tolerance:?};
    const INTERVAL_S: Number = {INTERVAL_S:?};
    /// Specific forces, g.
    const SAMPLES: [[Number; 3]; {}] = [
{rows}    ];
    /// Row, estimates and sigmas after it.
    const EXPECTED: [(usize, [Number; {parameters}], [Number; {parameters}]); {}] = [
{compared}    ];

    fn settings() -> FilterSettings<Number> {{
        FilterSettings::at_site(Site::at_latitude_deg({LATITUDE_DEG:?}))
    }}

    fn attitude() -> InitialAttitude<Number> {{
        InitialAttitude::Angles {{
            angles_rad: {},
            sigma_rad: [{}; 3],
        }}
    }}

    fn compare(
        row: usize,
        found: &[Number],
        deviations: &[Number],
        estimates: &[Number],
        sigmas: &[Number],
    ) {{
        assert_eq!(found.len(), estimates.len());
        for (i, (estimate, sigma)) in estimates.iter().zip(sigmas).enumerate() {{
            let apart = (found[i] - estimate).abs();
            assert!(apart <= TOLERANCE * sigma, \"row {{row}}, parameter {{i}}: {{}} {{estimate}}\", found[i]);
            let apart = (deviations[i] - sigma).abs();
            assert!(apart <= TOLERANCE * sigma, \"row {{row}}, sigma {{i}}: {{}} {{sigma}}\", deviations[i]);
        }}
    }}
",
        samples.len(),
        expected.len(),
        list(&ANGLES_RAD),
        literal(number, SIGMA_RAD),
    )
}

/// A number as it is written in Rust, with all its digits.
fn literal(number: Number, x: f64) -> String {
    match number {
        Number::F32 => format!("{:?}", x as f32),
        Number::F64 => format!("{x:?}"),
    }
}
