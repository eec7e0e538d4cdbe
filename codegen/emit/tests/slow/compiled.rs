//! Emitted modules, compiled without the standard library and run: CasADi's own numbers.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use gyrocal_codegen::program::{Function, Output};
use gyrocal_codegen::{Program, emit_module};
use serde::Deserialize;

use crate::common;

/// Points of the reference that are compared: each is a line of source to compile.
const POINTS: usize = 10;

/// CasADi's sines and the library's differ by an ulp, and up to some hundred operations
/// follow; errors are relative to the largest element of the column.
const TOLERANCE: f64 = 1e-13;

#[derive(Deserialize)]
struct Reference {
    inputs: Vec<BTreeMap<String, Vec<f64>>>,
    functions: BTreeMap<String, Vec<Vec<f64>>>,
}

struct Case {
    program: Program,
    reference: Reference,
}

impl Case {
    fn new(program: &str, reference: &str) -> Self {
        Self {
            program: common::program(program),
            reference: serde_json::from_str(&common::read(reference)).unwrap(),
        }
    }

    fn function(&self, index: usize) -> &Function {
        &self.program.functions[index]
    }

    /// Prints the nonzeros of every function at every point, then the model's results.
    fn calls(&self) -> String {
        let mut text = String::new();
        for point in &self.reference.inputs[..POINTS] {
            for function in &self.program.functions {
                let arguments: Vec<String> = self
                    .program
                    .inputs_of(function)
                    .map(|group| format!("&{:?}", point[&group.name]))
                    .collect();
                let module = &self.program.name;
                writeln!(
                    text,
                    "    {{ let r = emitted::{module}::{}::<f64>({}); print(&[{}]); }}",
                    function.name,
                    arguments.join(", "),
                    accessors(function).join(", ")
                )
                .unwrap();
            }
            text += &self.model_call(point);
        }
        text
    }

    fn model_call(&self, point: &BTreeMap<String, Vec<f64>>) -> String {
        let model = self.program.model.as_ref().unwrap();
        let group = |index: usize| &self.program.groups[index].name;
        let module = &self.program.name;
        let inputs: Vec<String> = model
            .inputs
            .iter()
            .map(|&index| format!("{}: {:?}", group(index), point[group(index)]))
            .collect();
        format!(
            "    model(&emitted::{module}::{name}, &{:?}, &{:?}, \
             &emitted::{module}::{name}Inputs {{ {} }});\n",
            point[group(model.moving)],
            point[group(model.parameters.unwrap())],
            inputs.join(", "),
            name = model.name,
        )
    }

    /// Checks the lines of [`Self::calls`]: functions against CasADi, the model against the
    /// functions, bit by bit.
    fn check<'a>(&self, lines: &mut impl Iterator<Item = &'a str>) {
        let mut next = || -> Vec<f64> {
            let line = lines.next().expect("a line for every call");
            line.split(' ').map(|text| text.parse().unwrap()).collect()
        };
        for point in 0..POINTS {
            let mut all_found = BTreeMap::new();
            for function in &self.program.functions {
                let found = next();
                // Where several programs share a file, functions bear the name of theirs.
                let qualified = format!("{}::{}", self.program.name, function.name);
                let functions = &self.reference.functions;
                let rows = functions.get(&qualified);
                let rows = rows.unwrap_or_else(|| &functions[&function.name]);
                compare(function, &found, &rows[point]);
                all_found.insert(function.name.clone(), found);
            }
            assert_eq!(
                next(),
                self.model_values(&all_found),
                "model of {}",
                self.program.name
            );
        }
    }

    /// Rates, their Jacobians by moving states, noise and parameters, outputs and theirs.
    fn model_values(&self, found: &BTreeMap<String, Vec<f64>>) -> Vec<f64> {
        let model = self.program.model.as_ref().unwrap();
        let moving = &self.program.groups[model.moving];
        let parameters = &self.program.groups[model.parameters.unwrap()];
        let noise = model.noise.clone().unwrap();
        let (m, p) = (moving.elements.len(), parameters.elements.len());
        let rates = |group: &str, columns| self.dense(model.rates.jacobian, group, columns, found);
        let output =
            |group: &str, columns| self.dense(model.output.jacobian, group, columns, found);
        // The width of the parameter Jacobian of the output as the models have it: none of
        // the platform's parameters and the first of the pendulum's enter.
        let output_parameters = if self.program.name == "pendulum" {
            1
        } else {
            0
        };
        [
            self.dense(model.rates.jacobian, "", 1, found),
            rates(&moving.name, m),
            rates(&noise, m),
            rates(&parameters.name, p),
            self.dense(model.output.jacobian, "", 1, found),
            output(&moving.name, m),
            output(&parameters.name, output_parameters),
        ]
        .concat()
    }

    /// The value of a function, or its Jacobian by a group, row-major in the given number of
    /// columns.
    fn dense(
        &self,
        function: usize,
        group: &str,
        columns: usize,
        found: &BTreeMap<String, Vec<f64>>,
    ) -> Vec<f64> {
        let function = self.function(function);
        let mut values = found[&function.name].iter();
        let rows = function.outputs[0].rows;
        let mut dense = vec![0.0; rows * columns];
        for (index, output) in function.outputs.iter().enumerate() {
            let is_wanted = match group {
                "" => index == 0,
                _ => output.name.ends_with(&format!("_d_{group}")),
            };
            for &(row, column) in &output.nonzeros {
                let value = values.next().unwrap();
                if is_wanted {
                    dense[row * columns + column] = *value;
                }
            }
        }
        dense
    }
}

/// Compares nonzeros relative to the largest element of their column.
fn compare(function: &Function, found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{}", function.name);
    let mut start = 0;
    for output in &function.outputs {
        let range = start..start + output.nonzeros.len();
        start = range.end;
        let (found, expected) = (&found[range.clone()], &expected[range]);
        for (index, &(row, column)) in output.nonzeros.iter().enumerate() {
            let of_column = output
                .nonzeros
                .iter()
                .zip(expected)
                .filter(|(p, _)| p.1 == column);
            let scale = of_column.fold(0.0_f64, |most, (_, value)| most.max(value.abs()));
            assert!(
                (found[index] - expected[index]).abs() <= TOLERANCE * scale,
                "{}, {} at row {row}, column {column}: found {}, CasADi has {}",
                function.name,
                output.name,
                found[index],
                expected[index]
            );
        }
    }
}

/// Expressions of the nonzeros of each output of the result `r`.
fn accessors(function: &Function) -> Vec<String> {
    let is_direct = matches!(&function.outputs[..], [output] if output.is_full());
    let of_output = |output: &Output| -> Vec<String> {
        let field = if is_direct {
            "r".to_owned()
        } else {
            format!("r.{}", output.name)
        };
        let places = output.nonzeros.iter().enumerate();
        places
            .map(
                |(nonzero, (row, column))| match (output.is_full(), output.columns) {
                    (true, 1) => format!("{field}[{row}]"),
                    (true, _) => format!("{field}[{row}][{column}]"),
                    _ => format!("{field}[{nonzero}]"),
                },
            )
            .collect()
    };
    function.outputs.iter().flat_map(of_output).collect()
}

/// The package that is compiled: the modules in a library that denies every warning and
/// has no standard library, and a program that prints.
const LIBRARY: &str = "//! Emitted modules.
#![no_std]
#![deny(warnings, missing_docs, unsafe_code, unreachable_pub)]
/// Of the pendulum.
pub mod pendulum;
/// Of the platform.
pub mod platform;
/// Of a model that stands still at its origin.
pub mod square;
";

const PRELUDE: &str = r#"use gyrocal_scalar::{Lanes, Model};
mod support;
use support::{Buffers, model, panics, print};

fn main() {
    std::panic::set_hook(Box::new(|_| {}));
    use emitted::{pendulum::{Pendulum, PendulumInputs}, platform::Platform};
    let platform: &dyn Model<f64, 3, 3, Inputs = emitted::platform::PlatformInputs<f64>> = &Platform;
    assert_eq!(platform.noise_parameters(), Some([0, 3, 6]));
    // At the origin each gyro's coefficients turn its own angle only.
    for (i, j) in (0..3).flat_map(|i| (0..9).map(move |j| (i, j))) {
        assert_eq!(platform.enters_at_origin(i, j), j / 3 == i, "{i}, {j}");
    }
    // No angle changes its own rate there, nor the force along its own axis.
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        assert_eq!(platform.moves_at_origin(i, j), i != j, "{i}, {j}");
        assert_eq!(platform.shows_at_origin(i, j), i != j, "{i}, {j}");
    }
    assert_eq!((platform.parameters(), platform.output_parameters()), (9, 0));
    assert_eq!(Model::<f64, 2, 2>::noise_parameters(&Pendulum), None);
    // One source serves lanes and f32.
    let lanes = emitted::pendulum::bob_place(&[Lanes([0.0_f32, 1.0]); 2], &[Lanes([1.0, 2.0]); 2]);
    assert_eq!(lanes[0].0[1], emitted::pendulum::bob_place(&[1.0_f32; 2], &[2.0; 2])[0]);
    let inputs = PendulumInputs { field: [9.8_f64] };
    assert_eq!(
        panics(move || { Pendulum.rates(&[0.0; 2], &[1.0; 3], &inputs); }),
        "expected 2 parameters, found 3"
    );
    assert_eq!(
        panics(move || {
            Pendulum.output_jacobian(&[0.0; 2], &[1.0; 2], &inputs, &mut [[0.0; 2]; 2], &mut [0.0]);
        }),
        "expected 2 derivatives by parameters, found 1"
    );
    assert_eq!(
        panics(move || {
            Pendulum.output_jacobian_at_origin(&[1.0; 2], &inputs, &mut [[0.0; 2]; 2], &mut [0.0]);
        }),
        "expected 2 derivatives by parameters, found 1"
    );
    // From here on a panic is a fault, to be shown.
    drop(std::panic::take_hook());
    let mut buffers = Buffers::<1, 1>::zeroed(&emitted::square::Square);
    let full = buffers.call(&emitted::square::Square, Some(&[3.0]), &[], &());
    assert_eq!(full.concat(), [9.0, 6.0, 0.0, 9.0, 6.0]);
    let at_origin = buffers.call(&emitted::square::Square, None, &[], &());
    assert_eq!(at_origin.concat(), [0.0; 5]);
"#;

#[test]
fn compiled_modules_give_the_numbers_of_casadi() {
    let pendulum = Case::new(
        "tests/data/pendulum/pendulum.json",
        "tests/data/pendulum/reference.json",
    );
    let platform = Case::new(
        "../../src/generated/platform.json",
        "../../crates/oracle/reference/platform.json",
    );
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("emitted");
    write_package(&directory, &[&pendulum, &platform]);
    let output = Command::new(env!("CARGO"))
        .args(["run", "--offline", "--quiet"])
        .current_dir(&directory)
        .env("CARGO_TARGET_DIR", directory.join("target"))
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );

    let printed = String::from_utf8(output.stdout).unwrap();
    let mut lines = printed.lines();
    pendulum.check(&mut lines);
    platform.check(&mut lines);
    assert_eq!(lines.next(), None);
}

fn write_package(directory: &Path, cases: &[&Case]) {
    std::fs::create_dir_all(directory.join("src")).unwrap();
    let write = |path: &str, text: &str| std::fs::write(directory.join(path), text).unwrap();
    let scalar = std::path::absolute(common::path("../../crates/scalar")).unwrap();
    write(
        "Cargo.toml",
        &format!(
            "[package]\nname = \"emitted\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n\
             [dependencies]\ngyrocal-scalar = {{ path = {scalar:?} }}\n\n[workspace]\n"
        ),
    );
    write("src/lib.rs", LIBRARY);
    let square = common::program("tests/data/square/square.json");
    let module = emit_module(&square, &common::header()).unwrap();
    write("src/square.rs", &module);
    write(
        "src/support.rs",
        &common::read("tests/data/printer/support.rs"),
    );
    let mut main = PRELUDE.to_owned();
    for case in cases {
        let module = emit_module(&case.program, &common::header()).unwrap();
        write(&format!("src/{}.rs", case.program.name), &module);
        main += &case.calls();
    }
    write("src/main.rs", &format!("{main}}}\n"));
}
