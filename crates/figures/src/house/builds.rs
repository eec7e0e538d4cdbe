//! Cost of a clean build against that of an earlier commit, and of tests and continuous integration.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use gyrocal_testkit::{cargo, run};
use serde::Deserialize;

use crate::harness::{Error, Figure};

/// The commit that a clean build is compared with.
const EARLIER: &str = "57c517e1";

/// Largest ratio of the times of the two builds.
const LARGEST_RATIO: f64 = 0.85;

/// Largest time of the gate over that of the same commit, both in units of the fixed build; most minutes of slow
/// sections; most compilations of the tree.
const GATE: f64 = 0.5;
const SLOW_MIN: f64 = 35.0;
const COMPILATIONS: f64 = 5.0;

/// Seconds of each section of `.ci/run`, as it wrote them.
const SECONDS: &str = "target/ci/seconds.toml";

/// Number of packages whose share of a build is printed.
const LISTED: usize = 8;

pub(super) fn figures(root: &Path) -> Result<Vec<Figure>, Error> {
    Ok([ratio(root)?, sections(root)?].concat())
}

/// Clean release builds of the default members of both commits, one after the other.
fn ratio(root: &Path) -> Result<Vec<Figure>, Error> {
    let name =
        format!("clean release build of the default members over that of the commit {EARLIER}");
    let scratch = tempfile::tempdir()?;
    let mut times = Vec::new();
    for commit in [EARLIER, "HEAD"] {
        let tree = scratch.path().join(commit);
        let (mut clone, mut checkout) = (Command::new("git"), Command::new("git"));
        clone.args(["clone", "--quiet", "--no-checkout"]);
        checkout.arg("-C").arg(&tree).args(["checkout", "--quiet"]);
        let cloned = clone.args([root, &tree]).status()?.success();
        if !cloned || !checkout.arg(commit).status()?.success() {
            let why = format!("not measured: the history holds no commit {commit}");
            return Ok(vec![Figure::note(&name, why)]);
        }
        let cargo = || cargo(&tree, &tree.join("target"));
        run(cargo().arg("fetch")).succeeded();
        let begin = Instant::now();
        run(cargo().args(["build", "--release", "--timings"])).succeeded();
        times.push(begin.elapsed().as_secs_f64());
    }
    let ratio = times[1] / times[0];
    let mut figure = Figure::at_most(&name, LARGEST_RATIO, ratio, "");
    figure.measured = format!("{ratio:.2} ({:.0} s over {:.0} s)", times[1], times[0]);
    let split = split(&scratch.path().join("HEAD/target/cargo-timings"))?;
    let command = scratch.path().join("HEAD/target/release/gyrocal");
    let size = std::fs::metadata(command)?.len() as f64 / 1e6;
    Ok(vec![
        figure.over(1, "this machine"),
        Figure::note("its command", format!("{size:.1} MB")),
        Figure::note("its slowest packages, s of one processor", split),
    ])
}

/// One unit of a build, as cargo's page of timings lists them.
#[derive(Deserialize)]
struct Unit {
    name: String,
    duration: f64,
}

/// The packages that take longest to build, from cargo's page of timings.
fn split(folder: &Path) -> Result<String, Error> {
    let page = std::fs::read_to_string(folder.join("cargo-timing.html"))?;
    let list = page.split_once("const UNIT_DATA = ");
    let list = list.and_then(|(_, rest)| rest.split_once("];"));
    let list = list.map_or_else(|| "[]".to_owned(), |(list, _)| format!("{list}]"));
    let units: Vec<Unit> = serde_json::from_str(&list)?;
    let mut packages = BTreeMap::new();
    for unit in units {
        *packages.entry(unit.name).or_insert(0.0) += unit.duration;
    }
    let mut packages: Vec<(String, f64)> = packages.into_iter().collect();
    packages.sort_by(|a, b| b.1.total_cmp(&a.1));
    let listed = packages.iter().take(LISTED);
    let listed = listed.map(|(name, s)| format!("{name} {s:.0}"));
    Ok(listed.collect::<Vec<_>>().join(", "))
}

/// The last run of `.ci/run`.
#[derive(Deserialize)]
struct Run {
    commit: String,
    /// The fixed build, the gate, and slow sections, s.
    unit_s: f64,
    gate_s: f64,
    slow_s: f64,
    /// The gate of the earlier commit in units of the fixed build.
    earlier_units: f64,
    /// Which slow sections were run: `--stale` or `--all`.
    slow: String,
    /// Compilations of the tree, of the gate and with slow sections.
    compiled_gate: f64,
    compiled_all: f64,
}

fn sections(root: &Path) -> Result<Vec<Figure>, Error> {
    let gate = format!(
        "`.ci/run` without slow sections over that of {EARLIER}, in units of the fixed build"
    );
    let Ok(text) = std::fs::read_to_string(root.join(SECONDS)) else {
        let why = "not measured: `.ci/run` has not been run here";
        return Ok(vec![Figure::note(&gate, why.to_owned())]);
    };
    let run: Run = toml::from_str(&text)?;
    let seeds = format!("run of commit {}", run.commit);
    let units = run.gate_s / run.unit_s;
    let mut gate = Figure::at_most(&gate, GATE, units / run.earlier_units, "");
    gate.measured += &format!(" ({units:.1} units of {} s)", run.unit_s);
    let slow = format!("slow sections together ({})", run.slow);
    let slow = Figure::at_most(&slow, SLOW_MIN, run.slow_s / 60.0, "min");
    let compiled = "compilations of the tree by the gate";
    let mut compiled = Figure::at_most(compiled, COMPILATIONS, run.compiled_gate, "");
    let [by_gate, all] = [run.compiled_gate, run.compiled_all];
    compiled.measured = format!("{by_gate}, with slow sections {all}");
    let all = [gate, slow, compiled];
    Ok(all.map(|figure| figure.over(1, seeds.as_str())).into())
}
