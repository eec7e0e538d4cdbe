//! Shared parts of the tests of the emitter.
#![allow(dead_code, reason = "each test program uses a part")]

use std::path::PathBuf;

use gyrocal_codegen::{Header, Program};

/// A path inside this package.
pub(crate) fn path(relative: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(relative)
}

pub(crate) fn read(relative: &str) -> String {
    let path = path(relative);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

pub(crate) fn program(relative: &str) -> Program {
    Program::from_json(&read(relative), relative).unwrap()
}

pub(crate) fn pendulum() -> Program {
    program("tests/data/pendulum/pendulum.json")
}

pub(crate) fn header() -> Header {
    Header {
        rebuild_command: "cargo test".to_owned(),
        source: "tests/data/pendulum".to_owned(),
        fingerprint: "none".to_owned(),
    }
}

/// A program of one function `f` of `x` (elements x0, x1, ...) with one output each for
/// `outputs`; `instructions` is their JSON.
pub(crate) fn one_function(elements: usize, outputs: usize, instructions: &str) -> String {
    let list = |count: usize, item: &dyn Fn(usize) -> String| {
        (0..count).map(item).collect::<Vec<_>>().join(",")
    };
    let elements = list(elements, &|i| {
        format!(r#"{{"name":"x{i}","id":"","unit":"m","doc":"element"}}"#)
    });
    let outputs = list(outputs, &|i| {
        format!(
            r#"{{"name":"y{i}","doc":"result","unit":"m","rows":1,"columns":1,
                "row_names":[],"column_names":[],"nonzeros":[[0,0]]}}"#
        )
    });
    format!(
        r#"{{"schema_version":1,"name":"test","doc":"","casadi_version":"3.8.2",
            "groups":[{{"name":"x","doc":"inputs","elements":[{elements}]}}],
            "functions":[{{"name":"f","doc":"function","source":"","domain":"",
                "inputs":[{{"group":"x"}}],"outputs":[{outputs}],"work_size":16,
                "instructions":[{instructions}]}}],
            "model":null}}"#
    )
}

/// Numbers between -1 and 1 from a seed (xorshift64*).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11;
        bits as f64 / (1_u64 << 52) as f64 - 1.0
    }
}
