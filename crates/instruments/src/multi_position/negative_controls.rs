//! Negative controls: searches in data without effects, or with other ones.

use chacha20::ChaCha12Rng;
use chacha20::rand_core::SeedableRng;
use serde::Serialize;

use super::positions::Positions;
use super::search::{SearchSettings, SearchStep, search, shuffle};
use super::terms::Term;

/// Findings in data without effects, or with other ones.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NegativeControls {
    /// Number of data sets with specific forces and times permuted among the stops.
    pub shuffles: usize,
    /// Number of these with a finding.
    pub shuffles_with_findings: usize,
    /// Findings after the axes of the instrument are renamed x to y, y to z, z to x; they are the
    /// original findings under their new names if the search does not depend on names.
    pub renamed: Vec<String>,
    /// `true` if `renamed` are the original findings under their new names.
    pub renamed_as_expected: bool,
    /// Findings after only the axes of the accelerometers are renamed in this way.
    pub forces_renamed: Vec<String>,
    /// Names in `forces_renamed` that are neither an original finding nor an along-axis term under
    /// its new name.
    pub forces_renamed_unexpected: Vec<String>,
}

/// Searches stops with permuted specific forces and with renamed axes.
#[must_use]
pub fn negative_controls(
    positions: &Positions,
    found: &[SearchStep],
    shuffles: usize,
    settings: &SearchSettings,
) -> NegativeControls {
    let all: Vec<usize> = (0..positions.time_s.len()).collect();
    // ChaCha12: see `gyrocal_statistics::deviates`.
    let mut generator = ChaCha12Rng::seed_from_u64(settings.seed);
    generator.set_stream(1);
    let mut order = all.clone();
    let mut with_findings = 0;
    for _ in 0..shuffles {
        shuffle(&mut order, &mut generator);
        // Times go with the forces: a ramp is a term as well.
        let shuffled = Positions {
            time_s: order.iter().map(|stop| positions.time_s[*stop]).collect(),
            force_g: order.iter().map(|stop| positions.force_g[*stop]).collect(),
            ..positions.clone()
        };
        with_findings += usize::from(!search(&shuffled, &all, settings).is_empty());
    }
    let rename = |values: &[[f64; 3]]| -> Vec<[f64; 3]> {
        values.iter().map(|[x, y, z]| [*z, *x, *y]).collect()
    };
    let forces_renamed = Positions {
        force_g: rename(&positions.force_g),
        ..positions.clone()
    };
    let renamed = Positions {
        rate_deg_per_h: rename(&positions.rate_deg_per_h),
        sigma_deg_per_h: rename(&positions.sigma_deg_per_h),
        ..forces_renamed.clone()
    };
    let expected = sorted(found.iter().map(new_name));
    let renamed = sorted(search(&renamed, &all, settings).iter().map(name));
    let swapped = search(&forces_renamed, &all, settings);
    let unexpected = swapped.iter().filter(|step| !is_there(step, found));
    NegativeControls {
        shuffles,
        shuffles_with_findings: with_findings,
        renamed_as_expected: renamed == expected,
        renamed,
        forces_renamed: sorted(swapped.iter().map(name)),
        forces_renamed_unexpected: sorted(unexpected.map(name)),
    }
}

/// Name of a finding after the axes are renamed x to y, y to z, z to x.
fn new_name(step: &SearchStep) -> String {
    let next = |axis: usize| (axis + 1) % 3;
    let gyro = next(step.gyro);
    let term = match step.term {
        Term::Cross(j) => Term::Cross(next(j)),
        // The squares along the two other axes are one term, named after the first of them.
        Term::Product(j, k) if j == k => {
            let first = usize::from(gyro == 0);
            Term::Product(first, first)
        }
        Term::Product(j, k) => {
            let (j, k) = (next(j), next(k));
            Term::Product(j.min(k), j.max(k))
        }
        other => other,
    };
    term.id(gyro).to_owned()
}

/// `true` if a term of renamed forces stands for an original finding or for an along-axis term.
fn is_there(step: &SearchStep, found: &[SearchStep]) -> bool {
    let Term::Cross(new) = step.term else {
        return false;
    };
    let before = (new + 2) % 3;
    let same = |other: &SearchStep| other.gyro == step.gyro && other.term == Term::Cross(before);
    before == step.gyro || found.iter().any(same)
}

fn name(step: &SearchStep) -> String {
    step.term.id(step.gyro).to_owned()
}

fn sorted(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}
