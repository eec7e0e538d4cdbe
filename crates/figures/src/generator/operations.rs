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
    let of_emit = ["exporter/run.py", "tests/data/operations"];
    output(
        Command::new(python)
            .args(["-I", "-B"])
            .args(of_emit.map(|file| root().join("codegen/emit").join(file)))
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
    let listed = printed.lines();
    let listed = listed.filter_map(|line| Some(line.split_once("listed difference: ")?.1));
    let listed = listed.collect::<Vec<_>>().join("; ");
    let none = "0 beyond those listed";
    let (edges, graphs) = match &tested {
        Ok(_) => (none.to_owned(), format!("{GRAPHS} of {GRAPHS}")),
        Err(error) => (error.to_string(), "not all, see above".to_owned()),
    };
    let of_edges = "values and slopes of operations at their edges: beyond 2 ulp of CasADi";
    let of_graphs = "random graphs: equal to the interpreter, and to CasADi to rounding";
    let what = "differences from CasADi that the manual lists, worst in ulp";
    figures.extend([
        Figure::told(of_edges, none, edges, tested.is_ok()).over(points, "1"),
        Figure::note(what, listed).over(points, "1"),
        Figure::told(of_graphs, "all", graphs, tested.is_ok()).over(GRAPHS, "1"),
    ]);
    Ok(figures)
}

/// Operations that the exporter takes, and the time of an export.
fn of_the_exporter(directory: &Path, python: &Path) -> Result<[Figure; 2], Error> {
    let script = directory.join("operations.py");
    std::fs::write(&script, SCRIPT)?;
    let (exporter, large) = (
        root().join("codegen/emit/exporter"),
        directory.join("large.json"),
    );
    let mut command = Command::new(python);
    command.args([&script, &exporter, &large]);
    let printed = output(command.arg(NODES.to_string()))?;
    let of = |kind: &str| -> Vec<&str> {
        let words = printed.lines().filter_map(|line| line.split_once(' '));
        let own = words.filter(|(word, _)| *word == kind);
        own.map(|(_, rest)| rest).collect()
    };
    let (supported, refused) = (of("supported").len(), of("refused"));
    let name = "operations of SX: supported, refused with a reason";
    let measured = format!("{supported}, {} ({})", refused.len(), refused.join(", "));
    let operations = Figure::told(name, "all but I/O", measured, refused == ["OP_PRINTME"]);
    let export = of("export");
    let words = export.first().and_then(|line| line.split_once(' '));
    let (seconds, count) = words.ok_or("the exporter printed no time")?;
    let what = format!("export of {count} instructions from CasADi");
    let time = Figure::at_most(&what, MOST_EXPORT_S, seconds.parse()?, "s");
    Ok([operations, time])
}
