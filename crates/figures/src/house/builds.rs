//! Cost of a clean build against that of an earlier commit, and of tests and continuous integration.

use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use gyrocal_testkit::{cargo, run};
use serde::Deserialize;

use crate::error::Error;
use crate::figure::Figure;

/// The commit that a clean build is compared with.
const EARLIER: &str = "a794a41";

/// Largest ratio of the times of the two builds.
const LARGEST_RATIO: f64 = 0.65;

/// Most minutes of the test command of the README, and of all of continuous integration.
const TESTS_MIN: f64 = 12.0;
const ALL_MIN: f64 = 25.0;

/// Seconds of each section of `.ci/run`, as it wrote them.
const SECONDS: &str = "target/ci/seconds.toml";

/// Number of packages whose share of a build is printed.
const LISTED: usize = 8;

pub(crate) fn figures(root: &Path) -> Result<Vec<Figure>, Error> {
    let mut figures = ratio(root)?;
    figures.extend(sections(root)?);
    Ok(figures)
}

/// Clean release builds of the default members of both commits, one after the other.
fn ratio(root: &Path) -> Result<Vec<Figure>, Error> {
    let scratch = tempfile::tempdir()?;
    let mut times = Vec::new();
    let name = "clean release build of the default members over that of the commit ";
    for commit in [EARLIER, "HEAD"] {
        let tree = scratch.path().join(commit);
        let clone = Command::new("git")
            .args(["clone", "--quiet", "--no-checkout"])
            .args([root, &tree])
            .status()?;
        let checkout = Command::new("git")
            .arg("-C")
            .arg(&tree)
            .args(["checkout", "--quiet", commit])
            .status()?;
        if !clone.success() || !checkout.success() {
            let why = format!("not measured: the history holds no commit {commit}");
            return Ok(vec![Figure::note(&format!("{name}{EARLIER}"), why)]);
        }
        run(cargo(&tree, &tree.join("target")).args(["fetch"])).succeeded();
        let begin = Instant::now();
        run(cargo(&tree, &tree.join("target")).args(["build", "--release", "--timings"]))
            .succeeded();
        times.push(begin.elapsed());
    }
    let seconds = |time: &Duration| time.as_secs_f64();
    let ratio = seconds(&times[1]) / seconds(&times[0]);
    let mut figure = Figure::within(&format!("{name}{EARLIER}"), [0.0, LARGEST_RATIO], ratio);
    figure.target = format!("<= {LARGEST_RATIO}");
    figure.measured = format!(
        "{ratio:.2} ({:.0} s over {:.0} s)",
        seconds(&times[1]),
        seconds(&times[0])
    );
    let split = split(&scratch.path().join("HEAD/target/cargo-timings"))?;
    Ok(vec![
        figure.over(1, "this machine"),
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
    let units: Vec<Unit> = page
        .split_once("const UNIT_DATA = ")
        .and_then(|(_, rest)| rest.split_once("];"))
        .map(|(list, _)| serde_json::from_str(&format!("{list}]")))
        .transpose()?
        .unwrap_or_default();
    let mut packages: Vec<(String, f64)> = Vec::new();
    for unit in units {
        match packages.iter_mut().find(|(name, _)| *name == unit.name) {
            Some((_, total)) => *total += unit.duration,
            None => packages.push((unit.name, unit.duration)),
        }
    }
    packages.sort_by(|a, b| b.1.total_cmp(&a.1));
    let listed = packages.iter().take(LISTED);
    let listed: Vec<String> = listed.map(|(name, s)| format!("{name} {s:.0}")).collect();
    Ok(listed.join(", "))
}

/// Times of the last run of `.ci/run`.
#[derive(Deserialize)]
struct Sections {
    commit: String,
    tests: f64,
    total: f64,
}

fn sections(root: &Path) -> Result<Vec<Figure>, Error> {
    let names = ["`cargo test --workspace`", "`.ci/run`"];
    let Ok(text) = std::fs::read_to_string(root.join(SECONDS)) else {
        let why = "not measured: `.ci/run` has not been run here";
        return Ok(names
            .map(|name| Figure::note(name, why.to_owned()))
            .to_vec());
    };
    let sections: Sections = toml::from_str(&text)?;
    let seeds = format!("run of commit {}", sections.commit);
    let limits = [(sections.tests, TESTS_MIN), (sections.total, ALL_MIN)];
    Ok(names
        .into_iter()
        .zip(limits)
        .map(|(name, (seconds, limit))| {
            Figure::at_most(name, limit, seconds / 60.0, "min").over(1, seeds.as_str())
        })
        .collect())
}
