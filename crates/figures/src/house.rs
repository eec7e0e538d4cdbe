//! The structure of the tree: effects as data, cycles, long functions, arithmetic in the command; equal
//! results before and after; cost of a build.

mod arithmetic;
mod before;
mod builds;
mod cycles;
mod literals;
mod sizes;
mod source;

use std::path::Path;

use gyrocal::EFFECTS;
use gyrocal_testkit::{WorkspaceCopy, add_own_terms, cargo, find_own_terms, workspace};

use crate::error::Error;
use crate::figure::Figure;
use sizes::Long;

/// Functions and files above the limits, and the reason of each.
const LONG: [(&str, &str, &str); 1] = [(
    "codegen/emit/src/emit/function.rs",
    "emit",
    "one function, returned by value or written to a place: two forms of the same text",
)];

/// Most of them.
const MOST_LONG: usize = 5;

/// Standard deviations within which the parameters of a term of one's own are found.
const OWN_TERM_SIGMAS: f64 = 3.0;

/// All figures of the topic; the small ones without builds. `write` renews the results that later builds
/// are compared with.
pub(crate) fn figures(small: bool, write: bool) -> Result<Vec<Figure>, Error> {
    let root = workspace();
    if write {
        before::write(&root)?;
    }
    let crates = source::crates(&root)?;
    let kinds = EFFECTS.iter().map(|effect| format!("{:?}", effect.kind));
    let words = literals::Words::new(EFFECTS.iter().map(|effect| effect.id), kinds);
    let places: Vec<String> = crates
        .iter()
        .flat_map(|of| literals::places(of, &words))
        .map(|place| {
            let file = place.file.display();
            format!("{file}:{} `{}`", place.line, place.literal)
        })
        .collect();
    let cycles: Vec<String> = crates
        .iter()
        .flat_map(cycles::at_the_top)
        .map(|cycle| format!("{} {{{}}}", cycle.within, cycle.members.join(", ")))
        .collect();
    let inside: usize = crates.iter().map(|of| cycles::inside(of).len()).sum();
    let arithmetic: Vec<String> = crates
        .iter()
        .filter(|of| of.name == "cli")
        .flat_map(arithmetic::lines)
        .collect();
    let mut figures = vec![
        none(
            "places where an effect's id or kind is compared with a string literal",
            &places,
        ),
        none("cycles between top-level modules of a crate", &cycles),
        Figure::note("cycles inside a module", inside.to_string()),
    ];
    figures.extend(long(&crates));
    figures.push(none(
        "lines of crates/cli that compute: roots, logarithms, exponentials, sums of squares, matrices",
        &arithmetic,
    ));
    figures.extend(before::figures(&root)?);
    if !small {
        figures.push(own_terms()?);
        figures.extend(builds::figures(&root)?);
    }
    Ok(figures)
}

/// A figure that counts places, all of which are listed.
fn none(name: &str, places: &[String]) -> Figure {
    let mut figure = Figure::within(name, [0.0, 0.0], places.len() as f64);
    figure.target = "0".to_owned();
    figure.measured = match places {
        [] => "0".to_owned(),
        places => format!("{}: {}", places.len(), places.join("; ")),
    };
    figure.over(1, "this tree")
}

/// Functions and files above the limits.
fn long(crates: &[source::Crate]) -> [Figure; 2] {
    let all: Vec<Long> = crates.iter().flat_map(sizes::long).collect();
    let reason = |long: &Long| {
        let file = long.file.to_string_lossy();
        let mut known = LONG.iter();
        known
            .find(|(of, function, _)| *of == file && *function == long.function)
            .map(|(.., reason)| *reason)
    };
    let described: Vec<String> = all
        .iter()
        .map(|long| {
            let reason = reason(long).unwrap_or("no reason given");
            let file = long.file.display();
            match long.function.as_str() {
                "" => format!("{file}, {} lines: {reason}", long.lines),
                function => format!("{function} in {file}, {} lines: {reason}", long.lines),
            }
        })
        .collect();
    let justified = all.iter().all(|long| reason(long).is_some());
    let strict = all.iter().any(|long| {
        ["crates/diagnosis", "crates/cli"]
            .iter()
            .any(|of| long.file.starts_with(of))
    });
    let mut first = none(
        "functions above 80 lines and files above 450, each with its reason",
        &described,
    );
    first.target = format!("<= {MOST_LONG}");
    first.holds = Some(all.len() <= MOST_LONG && justified);
    let second = Figure::truth("none of them in crates/diagnosis or crates/cli", !strict);
    [first, second.over(1, "this tree")]
}

/// Terms of one's own in a copy of the workspace.
fn own_terms() -> Result<Figure, Error> {
    let scratch = tempfile::tempdir()?;
    let copy = WorkspaceCopy::make(&scratch.path().to_string_lossy(), "own-terms");
    add_own_terms(&copy, "");
    let target = scratch.path().join("target");
    let found = find_own_terms(&copy, |root: &Path| {
        let mut command = cargo(root, &target);
        command.args(["run", "--release"]);
        command
    });
    let within = found.iter().filter(|term| term.is_within(OWN_TERM_SIGMAS));
    let within = within.count();
    let distances: Vec<String> = found
        .iter()
        .map(|term| {
            let parameters = term.parameters.iter();
            let parameters: Vec<String> = parameters
                .map(|parameter| format!("{} {:.1} σ off", parameter.name, parameter.distance()))
                .collect();
            format!("{} ({})", term.id, parameters.join(", "))
        })
        .collect();
    Ok(Figure {
        name: "own terms of each kind (constant, onset, time constant, regressor) found, all \
               parameters within 3 σ"
            .to_owned(),
        target: format!("{} of {}", found.len(), found.len()),
        measured: format!("{within} of {}: {}", found.len(), distances.join(", ")),
        runs: found.len(),
        seeds: "5 to 8".to_owned(),
        holds: Some(within == 4 && found.len() == 4),
        ..Figure::default()
    })
}
