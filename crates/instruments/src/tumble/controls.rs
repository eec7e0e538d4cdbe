//! Data in which nothing, or something else, must be found.

use rand_chacha::ChaCha12Rng;
use rand_chacha::rand_core::SeedableRng;
use serde::Serialize;

use super::Positions;
use super::basis::Term;
use super::search::{SearchSettings, Step, search, shuffle};

/// What was found where nothing, or something else, should be.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Controls {
    /// How often the specific forces were dealt to other stops.
    pub shuffles: usize,
    /// In how many of these something was found.
    pub shuffles_with_findings: usize,
    /// Findings with the instrument's axes renamed x to y, y to z, z to x: the findings under
    /// their new names, if the search depends on no name.
    pub renamed: Vec<String>,
    /// Whether they are exactly the findings under their new names.
    pub renamed_as_expected: bool,
    /// Findings with the axes of the accelerometers alone renamed so.
    pub forces_renamed: Vec<String>,
    /// Those among them that are no finding, and no along-axis term, under its new name.
    pub forces_renamed_unexpected: Vec<String>,
}

/// Searches shuffled and renamed stops.
#[must_use]
pub fn controls(
    positions: &Positions,
    found: &[Step],
    shuffles: usize,
    settings: &SearchSettings,
) -> Controls {
    let all: Vec<usize> = (0..positions.time_s.len()).collect();
    let mut generator = ChaCha12Rng::seed_from_u64(settings.seed);
    generator.set_stream(1);
    let mut order = all.clone();
    let mut with_findings = 0;
    for _ in 0..shuffles {
        shuffle(&mut order, &mut generator);
        let shuffled = Positions {
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
    Controls {
        shuffles,
        shuffles_with_findings: with_findings,
        renamed_as_expected: renamed == expected,
        renamed,
        forces_renamed: sorted(swapped.iter().map(name)),
        forces_renamed_unexpected: sorted(unexpected.map(name)),
    }
}

/// The name of a finding after x became y, y became z and z became x.
fn new_name(step: &Step) -> String {
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
    term.id(gyro)
}

/// Whether a term, of forces whose axes were renamed, stands for one that was there before.
fn is_there(step: &Step, found: &[Step]) -> bool {
    let Term::Cross(new) = step.term else {
        return false;
    };
    let before = (new + 2) % 3;
    let same = |other: &Step| other.gyro == step.gyro && other.term == Term::Cross(before);
    before == step.gyro || found.iter().any(same)
}

fn name(step: &Step) -> String {
    step.term.id(step.gyro)
}

fn sorted(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}
