//! Operations at their edges and random graphs, many more of them than the tests of the generator
//! have: the same test on larger data.

use std::path::Path;
use std::process::Command;

use crate::error::Error;
use crate::figure::Figure;
use crate::kernel::instructions::{output, root};

const GRAPHS: usize = 1000;
const EDGES: usize = 1_000_000;

pub(crate) fn figures() -> Result<Vec<Figure>, Error> {
    let directory = root().join("target/figures/generator");
    let python = directory.join("env/bin/python");
    if !python.is_file() {
        let reason = "CasADi cannot be had".to_owned();
        return Ok(vec![Figure::note("operations not compared", reason)]);
    }
    let data = directory.join("operations");
    let exporter = root().join("codegen/emit/exporter/run.py");
    let source = root().join("codegen/emit/tests/data/operations");
    output(
        Command::new(python)
            .args(["-I", "-B"])
            .args([&exporter, &source, &data])
            .env("GRAPHS", GRAPHS.to_string())
            .env("EDGES", EDGES.to_string()),
    )?;
    let printed = tested(&data);
    let holds = printed.is_ok();
    let reason = |name: &str, text: String, holds: bool| Figure {
        name: name.to_owned(),
        target: "all".to_owned(),
        measured: text,
        runs: 1,
        seeds: "1".to_owned(),
        holds: Some(holds),
        too_few: false,
        share: None,
    };
    let points = lines(&data.join("operations.txt"))?;
    let text = match &printed {
        Ok(_) => format!("all of {points} calls but the differences that the manual lists"),
        Err(error) => error.to_string(),
    };
    let graphs = match &printed {
        Ok(_) => format!("{GRAPHS} of {GRAPHS}"),
        Err(_) => "not all, see above".to_owned(),
    };
    Ok(vec![
        reason(
            "operations and slopes at their edges: equal to CasADi to 2 ulp",
            text,
            holds,
        ),
        reason(
            "random graphs: equal to the interpreter, and to CasADi to rounding",
            graphs,
            holds,
        ),
        Figure::note(
            "operations of SX supported, refused",
            "44, 1 (printme: output)".to_owned(),
        ),
    ])
}

fn tested(data: &Path) -> Result<String, Error> {
    output(
        Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .current_dir(root())
            .args([
                "test",
                "--release",
                "--quiet",
                "--package",
                "gyrocal-codegen",
            ])
            .args(["--test", "emit_operations"])
            .env("GYROCAL_OPERATIONS_DATA", data),
    )
}

fn lines(path: &Path) -> Result<usize, Error> {
    Ok(std::fs::read_to_string(path)?.lines().count())
}
