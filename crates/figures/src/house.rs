//! The structure of the tree, cost of a build.

mod builds;
mod structure;

use std::path::Path;

use gyrocal_testkit::{WorkspaceCopy, add_own_terms, cargo, find_own_terms, workspace};

use crate::error::Error;
use crate::figure::Figure;

/// Standard deviations within which the parameters of a term of one's own are found.
const OWN_TERM_SIGMAS: f64 = 3.0;

/// All figures of the topic; the small ones without builds.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let root = workspace();
    let mut figures = structure::figures(&root)?.to_vec();
    if !small {
        figures.push(own_terms()?);
        figures.extend(builds::figures(&root)?);
    }
    Ok(figures)
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
