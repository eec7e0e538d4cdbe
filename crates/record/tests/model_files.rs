//! Model files: round trips, and each way in which one can be wrong.

#![cfg(test)]

use std::path::Path;

use gyrocal_record::{
    Error, Gyros, KnownEffect, ModelFile, ParameterEstimate, Standing, module_name,
};

fn effect(
    id: &'static str,
    standing: Standing,
    states: &[&'static str],
    shapes: &[&'static str],
) -> KnownEffect<'static> {
    KnownEffect {
        id,
        standing,
        states: states.to_vec(),
        shapes: shapes.to_vec(),
    }
}

fn known() -> [KnownEffect<'static>; 7] {
    [
        effect("gyro_x.bias", Standing::Nominal, &["gyro_x.bias"], &[]),
        effect("gyro_y.g_z", Standing::Term, &["gyro_y.g_z"], &[]),
        effect("gyro_y.g_yz", Standing::Term, &["gyro_y.g_yz"], &[]),
        effect(
            "gyro_x.warmup",
            Standing::Term,
            &["gyro_x.warmup"],
            &["gyro_x.warmup.time_constant_h"],
        ),
        effect(
            "gyro_x.diurnal",
            Standing::Term,
            &["gyro_x.diurnal.sine", "gyro_x.diurnal.cosine"],
            &[],
        ),
        effect("accel_x.noise", Standing::Noise, &[], &[]),
        effect("platform.knock", Standing::State, &[], &[]),
    ]
}

const GOOD: &str = "\
schema_version = 1
effects = [\"gyro_y.g_z\", \"gyro_x.warmup\"]
[shapes]
\"gyro_x.warmup.time_constant_h\" = 3.5
[estimates]
\"gyro_y.g_z\" = { value = 0.05, sigma = 1e-4 }
";

#[test]
fn what_is_written_is_what_is_read() {
    let model = ModelFile::parse(GOOD, "m.toml", &known()).unwrap();
    assert_eq!(model.effects, ["gyro_y.g_z", "gyro_x.warmup"]);
    assert_eq!(
        model.shapes,
        [("gyro_x.warmup.time_constant_h".to_owned(), 3.5)]
    );
    let estimate = ParameterEstimate {
        parameter: "gyro_y.g_z".to_owned(),
        value: 0.05,
        sigma: 1e-4,
    };
    assert_eq!(model.estimates, [estimate]);
    let text = model.to_toml(Path::new("m.toml"), &known()).unwrap();
    assert_eq!(ModelFile::parse(&text, "m.toml", &known()).unwrap(), model);

    for gyros in [Gyros::Platform, Gyros::Strapdown] {
        let bare = ModelFile {
            gyros,
            effects: vec!["gyro_x.diurnal".to_owned()],
            ..ModelFile::default()
        };
        let text = bare.to_toml(Path::new("m.toml"), &known()).unwrap();
        assert_eq!(ModelFile::parse(&text, "m.toml", &known()).unwrap(), bare);
        // What files of before say stays the default.
        let is_said = text.contains("\ngyros = \"strapdown\"\n");
        assert_eq!(is_said, gyros == Gyros::Strapdown, "{text}");
    }
}

#[test]
fn what_no_reader_would_take_is_not_written() {
    let mut model = ModelFile::parse(GOOD, "m.toml", &known()).unwrap();
    model.estimates[0].sigma = 0.0;
    let error = model.to_toml(Path::new("m.toml"), &known()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "m.toml: not written: found `0.0`, expected a finite number greater than 0"
    );
}

#[test]
fn a_file_name_that_is_no_module_name_is_refused() {
    let model = ModelFile::parse(GOOD, "m.toml", &known()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for (file, found) in [
        ("fn.model.toml", "fn"),
        ("a b;c.model.toml", "a b;c"),
        ("Extended.model.toml", "Extended"),
        (".model.toml", ""),
    ] {
        let path = folder.path().join(file);
        let error = model.write(&path, &known()).unwrap_err();
        assert!(!path.exists(), "{file}");
        assert_eq!(
            error.to_string(),
            format!(
                "{}: not written: found the module name `{found}`, expected lower-case words \
                 joined by `_` before the first dot that are no Rust keyword",
                path.display()
            )
        );
        let help = miette::Diagnostic::help(&error).unwrap().to_string();
        assert!(help.contains("`extended.model.toml`"), "{help}");
    }
    model
        .write(&folder.path().join("plant_2.model.toml"), &known())
        .unwrap();
}

/// Keywords of Rust, names that look like them, and names of other forms.
const NAMES: &str = "abstract as async auto await become box break const continue crate default do \
    dyn else enum extern false final fn for gen if impl in let loop macro macro_rules match mod move \
    mut override priv pub raw ref return safe self Self static struct super trait true try type \
    typeof union unsafe unsized use virtual where while yield _ __ a a1 a_1 1a _a a_ a__b A aB ä a-b a; \
    extended gyro_2";

#[test]
fn a_module_name_is_what_the_build_takes_for_one() {
    for name in NAMES.split_whitespace().chain([""]) {
        let accepted = module_name(Path::new(&format!("{name}.model.toml"))).is_ok();
        let by_the_build = gyrocal_codegen::program::is_snake_case(name);
        assert_eq!(accepted, by_the_build, "{name}");
    }
}

/// What is written, what in its place, the kind of the mistake, and the beginning of the message with words of
/// the advice.
const MISTAKES: &str = r#"
    gyro_y.g_z", | gyro_y.gz", | OutOfRange | 2:12: found `gyro_y.gz`, expected the id of an effect | the nearest are `gyro_y.g_z`, `gyro_y.g_yz` or `gyro_x.warmup`
    gyro_y.g_z", | accel_x.noise", | OutOfRange | 2:12: found `accel_x.noise`, expected an effect that is a term of the model | `[noise]` of the bench file
    gyro_y.g_z", | platform.knock", | OutOfRange | 2:12: found `platform.knock`, expected an effect that is a term of the model | widen the prior of the angles
    gyro_y.g_z", | gyro_x.bias", | OutOfRange | 2:12: found `gyro_x.bias`, expected an effect that is a term of the model | every model has
    gyro_y.g_z", | gyro_x.warmup", | OutOfRange | 2:29: found `gyro_x.warmup`, expected each effect once | take one of them away
    ["gyro_y.g_z", "gyro_x.warmup"] | [] | WrongType | 2:11: found `[]`, expected a list of ids |
    ["gyro_y.g_z", "gyro_x.warmup"] | [3] | WrongType | 2:12: found `3`, expected a list of ids |
    = 1\n | = 2\n | OutOfRange | 1:18: found `2`, expected 1, the version | gyrocal extend
    = 1\n | = 1\ngyros = "body"\n | OutOfRange | 2:9: found `body`, expected `platform` or `strapdown` | without the key it is the platform
    = 1\n | = 1\ngyros = true\n | WrongType | 2:9: found `true`, expected `platform` or `strapdown` |
    schema_version = 1\n |  | MissingKey | 1:1: found a file without it, expected `schema_version = ` | add the line
    3.5 | -3.5 | OutOfRange | 4:35: found `-3.5`, expected a finite number greater than 0 |
    warmup.time_constant_h" | warmup.time_constant" | UnknownKey | 4:1: found the unknown key `gyro_x.warmup.time_constant` in `[shapes]` | did you mean `gyro_x.warmup.time_constant_h`?
    "gyro_y.g_z" = { | "gyro_y.g_yz" = { | UnknownKey | 6:1: found the unknown key `gyro_y.g_yz` in `[estimates]` | did you mean `gyro_y.g_z`?
    sigma = 1e-4 | sigma = 0 | OutOfRange | 6:40: found `0`, expected a finite number greater than 0 |
    , sigma = 1e-4 |  | MissingKey | 6:1: found `[gyro_y.g_z]` without it, expected `sigma = ` | add the line
"#;

#[test]
fn each_mistake_is_shown_where_it_is() {
    for mistake in MISTAKES.trim().lines() {
        let columns: Vec<_> = mistake.split('|').map(str::trim).collect();
        let [right, wrong, kind, message, advice] = columns[..] else {
            panic!("{mistake}")
        };
        let [right, wrong] = [right, wrong].map(|text| text.replace("\\n", "\n"));
        assert_eq!(GOOD.matches(&right).count(), 1, "{right}");
        let text = GOOD.replace(&right, &wrong);
        let error = ModelFile::parse(&text, "m.toml", &known()).unwrap_err();
        let shown = error.to_string();
        assert!(shown.starts_with(&format!("m.toml:{message}")), "{shown}");
        let Error::Input(input) = error else { panic!() };
        assert_eq!(format!("{:?}", input.kind), kind, "{shown}");
        assert!(input.advice.contains(advice), "{shown}: {}", input.advice);
    }
}
