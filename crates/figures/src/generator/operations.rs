//! Operations that CasADi's `SX` has, at their edges, and random graphs, many more of them than the
//! tests of the generator have: the same test on larger data.

use std::path::Path;
use std::process::Command;

use crate::harness::{Error, Figure};
use crate::kernel::instructions::{cargo, output, root};

const SCRIPT: &str = include_str!("operations.py");
const GRAPHS: usize = 1000;
const EDGES: usize = 1_000_000;
/// Nodes of the large expression: about 37 000 instructions.
const NODES: usize = 30_500;
/// Of the exporter alone; the emission has a figure of its own.
const MOST_EXPORT_S: f64 = 1.0;

pub(super) fn figures(directory: &Path, python: &Path) -> Result<Vec<Figure>, Error> {
    let mut figures = of_the_exporter(directory, python)?.to_vec();
    let data = directory.join("operations");
    let emit = root().join("codegen/emit");
    output(
        Command::new(python)
            .args(["-I", "-B"])
            .args([
                emit.join("exporter/run.py"),
                emit.join("tests/data/operations"),
            ])
            .arg(&data)
            .env("GRAPHS", GRAPHS.to_string())
            .env("EDGES", EDGES.to_string()),
    )?;
    let points = std::fs::read_to_string(data.join("operations.txt"))?;
    let points = points.lines().count();
    let test = "test --release --quiet --package gyrocal-codegen --features slow --test slow operations -- --nocapture";
    let tested = output(
        Command::new(cargo())
            .current_dir(root())
            .args(test.split(' '))
            .env("GYROCAL_OPERATIONS_DATA", &data),
    );
    let printed = tested.as_deref().unwrap_or_default();
    let listed = printed
        .lines()
        .filter_map(|line| line.split_once("listed difference: "));
    let listed: Vec<&str> = listed.map(|(_, rest)| rest).collect();
    let (edges, graphs) = match &tested {
        Ok(_) => (
            "0 beyond those listed".to_owned(),
            format!("{GRAPHS} of {GRAPHS}"),
        ),
        Err(error) => (error.to_string(), "not all, see above".to_owned()),
    };
    let figure = |name: &str, target: &str, measured: String, runs: usize| Figure {
        target: target.to_owned(),
        measured,
        ..Figure::truth(name, tested.is_ok()).over(runs, "1")
    };
    let what = "differences from CasADi that the manual lists, worst in ulp";
    figures.extend([
        figure(
            "values and slopes of operations at their edges: beyond 2 ulp of CasADi",
            "0 beyond those listed",
            edges,
            points,
        ),
        Figure::note(what, listed.join("; ")).over(points, "1"),
        figure(
            "random graphs: equal to the interpreter, and to CasADi to rounding",
            "all",
            graphs,
            GRAPHS,
        ),
    ]);
    Ok(figures)
}

/// Operations that the exporter takes, and the time of an export.
fn of_the_exporter(directory: &Path, python: &Path) -> Result<[Figure; 2], Error> {
    let script = directory.join("operations.py");
    std::fs::write(&script, SCRIPT)?;
    let printed = output(
        Command::new(python)
            .arg(&script)
            .arg(root().join("codegen/emit/exporter"))
            .arg(directory.join("large.json"))
            .arg(NODES.to_string()),
    )?;
    let of = |kind: &str| -> Vec<&str> {
        let words = printed.lines().filter_map(|line| line.split_once(' '));
        words
            .filter(|(word, _)| *word == kind)
            .map(|(_, rest)| rest)
            .collect()
    };
    let (supported, refused) = (of("supported").len(), of("refused"));
    let name = "operations of SX: supported, refused with a reason";
    let operations = Figure {
        target: "all but I/O".to_owned(),
        measured: format!("{supported}, {} ({})", refused.len(), refused.join(", ")),
        ..Figure::truth(name, refused == ["OP_PRINTME"])
    };
    let export = of("export");
    let words = export.first().and_then(|line| line.split_once(' '));
    let (seconds, count) = words.ok_or("the exporter printed no time")?;
    let what = format!("export of {count} instructions from CasADi");
    let time = Figure::at_most(&what, MOST_EXPORT_S, seconds.parse()?, "s");
    Ok([operations, time])
}
