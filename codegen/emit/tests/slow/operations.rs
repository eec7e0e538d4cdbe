//! Every operation at its edges, and random expression graphs: the emitted Rust, compiled, gives the
//! numbers of CasADi, those of the interpreter bit by bit, and in `f32` those of `f64` to rounding.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use gyrocal_codegen::ir::{Expressions, lower};
use gyrocal_codegen::{Options, Program, emit_module, emit_module_with};
use gyrocal_oracle::rounding::{ROUNDOFF_F32, ROUNDOFF_F64, RunningError};

use crate::{common, evaluated};

/// The data, or those of `cargo figures kernel --part generator`, which are more.
fn data(file: &str) -> String {
    let directory = std::env::var("GYROCAL_OPERATIONS_DATA");
    format!(
        "{}/{file}",
        directory.as_deref().unwrap_or("tests/data/operations")
    )
}

/// A line of the committed values: a function, its inputs, CasADi's outputs.
struct Values {
    function: String,
    inputs: Vec<f64>,
    casadi: Vec<f64>,
}

impl Values {
    fn of(program: &str) -> Vec<Self> {
        let text = common::read(&data(&format!("{program}.txt")));
        let numbers = |text: &str| text.split_whitespace().map(hexadecimal).collect();
        let line = |line: &str| {
            let (left, right) = line.split_once(" -> ").unwrap();
            let (function, inputs) = left.split_once(' ').unwrap();
            Self {
                function: function.to_owned(),
                inputs: numbers(inputs),
                casadi: numbers(right),
            }
        };
        text.lines().map(line).collect()
    }
}

/// `-0x1.8p+1`, `inf` or `nan`, as Python writes them.
fn hexadecimal(text: &str) -> f64 {
    let (sign, digits) = match text.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, text),
    };
    let Some(rest) = digits.strip_prefix("0x") else {
        return sign * digits.parse::<f64>().unwrap();
    };
    let (mantissa, exponent) = rest.split_once('p').unwrap();
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let integer = u64::from_str_radix(&format!("{whole}{fraction}"), 16).unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    // In two steps: 2^-1074 is no power that the first could make.
    let shift = exponent - 4 * fraction.len() as i32;
    sign * integer as f64 * 2.0_f64.powi(shift / 2) * 2.0_f64.powi(shift - shift / 2)
}

/// What compiled functions print: outputs in `f64`, then in `f32`, then in `f64` of the module with
/// fused multiply-adds.
struct Printed {
    double: Vec<f64>,
    single: Vec<f64>,
    fused: Vec<f64>,
}

/// The functions that the program `calls` names.
const EXTERNALS: &str = "use gyrocal_scalar::Scalar;
pub fn bump<T: Scalar>(x: T, y: T) -> T { x * (-(x * y)).exp() }
pub fn bump_by_x<T: Scalar>(x: T, y: T) -> T {
    (T::from_f64(1.0) - x * y) * (-(x * y)).exp()
}
";

/// Compiles the modules of programs of functions of one group, and evaluates them.
#[expect(clippy::too_many_lines, reason = "it writes the program that it runs")]
fn compiled(cases: &[(&Program, &[Values])]) -> Vec<Vec<Printed>> {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("operations");
    std::fs::create_dir_all(directory.join("src")).unwrap();
    let write = |path: &str, text: &str| std::fs::write(directory.join(path), text).unwrap();
    let scalar = std::path::absolute(common::path("../../crates/scalar")).unwrap();
    write(
        "Cargo.toml",
        &format!(
            "[package]\nname = \"operations\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n\
             [dependencies]\ngyrocal-scalar = {{ path = {scalar:?} }}\n\n[workspace]\n"
        ),
    );
    let mut library = format!("#![no_std]\n#![deny(warnings)]\n{EXTERNALS}");
    let mut main = "fn main() {\n    let mut text = String::new();\n    \
                    std::io::Read::read_to_string(&mut std::io::stdin(), &mut text).unwrap();\n    \
                    for line in text.lines() {\n        let mut words = line.split(' ');\n        \
                    let name = words.next().unwrap();\n        \
                    let x: Vec<f64> = words.map(|w| f64::from_bits(w.parse().unwrap())).collect();\n        \
                    match name {\n"
        .to_owned();
    let mut input = String::new();
    for (program, values) in cases {
        let name = &program.name;
        library += &format!("pub mod {name};\npub mod {name}_fused;\n");
        let mut options = Options::default();
        options.fused_multiply_add = true;
        let fused = emit_module_with(program, &common::header(), &options).unwrap();
        assert!(fused.contains(".mul_add(") || name == "operations");
        write(&format!("src/{name}_fused.rs"), &fused);
        write(
            &format!("src/{name}.rs"),
            &emit_module(program, &common::header()).unwrap(),
        );
        for function in &program.functions {
            let function = &function.name;
            let path = format!("operations::{name}::{function}");
            let fused = format!("operations::{name}_fused::{function}");
            main += &format!(
                "\"{function}\" => show(&{path}(double(&x)), &{path}(single(&x)), &{fused}(double(&x))),\n"
            );
        }
        for line in *values {
            let bits = line.inputs.iter().map(|x| x.to_bits().to_string());
            let bits: Vec<String> = bits.collect();
            input += &format!("{} {}\n", line.function, bits.join(" "));
        }
    }
    main += "_ => panic!(\"{name}\") } } }\n\
        fn double<const N: usize>(x: &[f64]) -> &[f64; N] { x.try_into().unwrap() }\n\
        fn single<const N: usize>(x: &[f64]) -> &'static [f32; N] {\n    \
        let x: Vec<f32> = x.iter().map(|&x| x as f32).collect();\n    \
        Box::leak(Box::new(x.try_into().unwrap()))\n}\n\
        fn show(double: &[f64], single: &[f32], fused: &[f64]) {\n    \
        let all = double.iter().copied().chain(single.iter().map(|&x| f64::from(x)))\n        .chain(fused.iter().copied());\n    \
        let words: Vec<String> = all.map(|x| x.to_bits().to_string()).collect();\n    \
        println!(\"{}\", words.join(\" \"));\n}\n";
    write("src/lib.rs", &library);
    write("src/main.rs", &main);
    write("input.txt", &input);
    let output = Command::new(env!("CARGO"))
        .args(["run", "--offline", "--quiet"])
        .current_dir(&directory)
        .env("CARGO_TARGET_DIR", directory.join("target"))
        .stdin(std::fs::File::open(directory.join("input.txt")).unwrap())
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let text = String::from_utf8(output.stdout).unwrap();
    let mut lines = text.lines();
    let mut next = |count: usize| {
        let words = lines.next().unwrap().split(' ');
        let mut double: Vec<f64> = words
            .map(|word| f64::from_bits(word.parse().unwrap()))
            .collect();
        let mut single = double.split_off(count);
        let fused = single.split_off(count);
        Printed {
            double,
            single,
            fused,
        }
    };
    let results = cases.iter();
    results
        .map(|(_, values)| values.iter().map(|line| next(line.casadi.len())).collect())
        .collect()
}

/// Distance in units of the last place; none between numbers that are not, all to others.
fn ulps(found: f64, expected: f64) -> u64 {
    if found.is_nan() || expected.is_nan() {
        return if found.is_nan() == expected.is_nan() {
            0
        } else {
            u64::MAX
        };
    }
    // Negative numbers in order below the positive ones.
    let place = |x: f64| {
        let bits = x.to_bits() as i64;
        if bits < 0 { i64::MIN - bits } else { bits }
    };
    place(found).abs_diff(place(expected))
}

/// Where the emitted functions differ from CasADi by more than 2 ulp, with the most, and the reason.
const DIFFERENCES: [(&str, u64, &str); 7] = [
    (
        "div_slope",
        u64::MAX,
        "the reciprocal that quotients share overflows below 5.6e-309",
    ),
    ("hypot_slope", u64::MAX, "the same"),
    (
        "tanh_slope",
        u64::MAX,
        "1 - tanh² cancels, and both tanh are good to an ulp",
    ),
    ("tan_slope", 8, "the square of a cosine good to an ulp"),
    ("pow_slope", 4, "products of powers good to an ulp"),
    (
        "erfinv_value",
        u64::MAX,
        "CasADi's is good to 1e-8 only beyond 0.7",
    ),
    (
        "erfinv_slope",
        u64::MAX,
        "the same, in the exponent of the slope",
    ),
];

#[test]
fn compiled_operations_are_those_of_casadi_and_of_the_interpreter() {
    let operations = common::program(&data("operations.json"));
    let graphs = common::program(&data("graphs.json"));
    let calls = common::program(&data("calls.json"));
    let of_calls = Values::of("calls");
    let of_operations = Values::of("operations");
    let of_graphs = Values::of("graphs");
    let found = compiled(&[
        (&operations, &of_operations),
        (&graphs, &of_graphs),
        (&calls, &of_calls),
    ]);
    check_operations(&of_operations, &found[0]);
    check_graphs(&graphs, &of_graphs, &found[1]);
    check_calls(&of_calls, &found[2]);
}

/// Calls of functions of the surrounding Rust, with their derivatives through CasADi.
fn check_calls(values: &[Values], printed: &[Printed]) {
    for (line, printed) in values.iter().zip(printed) {
        for (found, expected) in printed.double.iter().zip(&line.casadi) {
            // A handful of operations on numbers near 1, and exponentials to 2 ulp.
            let near = (found - expected).abs() <= 1e-14 * expected.abs().max(1.0);
            assert!(
                near,
                "{}: {found:e}, CasADi has {expected:e}",
                line.function
            );
        }
    }
}

fn check_operations(values: &[Values], printed: &[Printed]) {
    let mut worst: BTreeMap<&str, (u64, String)> = BTreeMap::new();
    for (line, printed) in values.iter().zip(printed) {
        for (found, expected) in printed.double.iter().zip(&line.casadi) {
            let apart = ulps(*found, *expected);
            let is_value = line.function.ends_with("_value");
            let sign = is_value && found.is_sign_negative() != expected.is_sign_negative();
            if apart > 2 || (*expected == 0.0 && sign) {
                let text = format!("{:?}: {found:e}, CasADi has {expected:e}", line.inputs);
                let entry = worst.entry(&line.function).or_insert((0, String::new()));
                if apart > entry.0 {
                    *entry = (apart, text);
                }
            }
        }
    }
    let listed = |function: &str, apart: u64| {
        let mut all = DIFFERENCES.iter();
        all.any(|&(name, most, _)| name == function && apart <= most)
    };
    for (function, (apart, _)) in &worst {
        // `cargo figures kernel --part generator` prints these.
        match *apart {
            u64::MAX => println!("listed difference: {function} finite against not"),
            apart => println!("listed difference: {function} {apart}"),
        }
    }
    worst.retain(|function, (apart, _)| !listed(function, *apart));
    assert!(worst.is_empty(), "ulps apart: {worst:#?}");
}

fn check_graphs(program: &Program, values: &[Values], printed: &[Printed]) {
    let expressions: BTreeMap<&str, Expressions> = program
        .functions
        .iter()
        .map(|function| (function.name.as_str(), lower(function)))
        .collect();
    let (mut exact, mut single, mut all) = (0, 0, 0);
    for (line, printed) in values.iter().zip(printed) {
        let expressions = &expressions[line.function.as_str()];
        let nodes = evaluated::nodes(expressions, &line.inputs);
        let by_zero = evaluated::depends_on_zeros(expressions, &nodes);
        let by_zero = evaluated::output(expressions, &by_zero);
        let interpreted = evaluated::output(expressions, &nodes);
        let inputs: Vec<RunningError> = line
            .inputs
            .iter()
            .copied()
            .map(RunningError::exact)
            .collect();
        let bounds = evaluated::output(expressions, &evaluated::nodes(expressions, &inputs));
        let shares = evaluated::shares_denominators(expressions);
        let jumps = evaluated::jumps(expressions);
        // Without such an instruction both forms are one.
        if !cfg!(any(target_feature = "fma", target_arch = "aarch64")) {
            let pairs = printed.double.iter().zip(&printed.fused);
            assert!(
                pairs.into_iter().all(|(x, y)| ulps(*x, *y) == 0),
                "{}",
                line.function
            );
        }
        for (index, found) in printed.double.iter().enumerate() {
            all += 1;
            if by_zero[index] {
                continue;
            }
            let of = format!("{} at {:?}, {index}", line.function, line.inputs);
            let interpreted = interpreted[index];
            if !shares {
                exact += 1;
                let same = ulps(*found, interpreted) == 0 || *found == interpreted;
                assert!(same, "{of}: {found:e}, interpreted {interpreted:e}");
            }
            // Elementary functions of both are good to 2 ulp and not to the one of the bound; a
            // shared reciprocal is one more rounding; so is a product of small terms below 1e-307.
            let bound = 4.0 * bounds[index].bound();
            let near = |found: f64, expected: f64, roundoff: f64, least: f64| {
                ulps(found, expected) <= 2
                    || (found - expected).abs() <= bound * roundoff + least
                    || !bound.is_finite()
            };
            let casadi = line.casadi[index];
            assert!(
                near(*found, casadi, ROUNDOFF_F64, 1e-307),
                "{of}: {found:e}, CasADi has {casadi:e}"
            );
            let in_range = |x: &f64| *x == 0.0 || (1e-30..1e30).contains(&x.abs());
            if !jumps && nodes.iter().all(in_range) {
                single += 1;
                let found = printed.single[index];
                assert!(
                    near(found, interpreted, ROUNDOFF_F32, 1e-30),
                    "{of}: in single precision {found:e}, in double {interpreted:e}"
                );
            }
        }
    }
    // Few graphs divide by zeros or twice by the same; half of them jump somewhere.
    assert!(exact * 4 > all * 3, "{exact} of {all} compared bit by bit");
    assert!(
        single * 20 > all,
        "{single} of {all} compared in single precision"
    );
}
