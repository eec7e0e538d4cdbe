//! Signs of the sensors against the turning Earth.

use super::prepare::PreparedTest;
use super::report::CoefficientReport;
use super::terms::Term;
use crate::earth_rate::{earth_deg_per_h, is_against};

/// Whether all gyros that can tell turn about specific force as on an Earth that turns the other way. Of gyros and
/// coefficients of their laws.
pub(super) fn earth_is_reversed<'a>(
    prepared: &PreparedTest,
    laws: impl IntoIterator<Item = &'a [CoefficientReport]>,
) -> bool {
    let Some(latitude_deg) = prepared.instrument.latitude_deg else {
        return false;
    };
    let [_, vertical] = earth_deg_per_h(latitude_deg);
    let along = |(gyro, law): (usize, &'a [CoefficientReport])| {
        let name = Term::Nominal(1).id(gyro);
        law.iter().find(|one| one.name == name)
    };
    let laws = laws.into_iter().enumerate();
    // The vertical part of Earth rate is taken off these rates.
    let told = laws
        .filter_map(along)
        .filter_map(|one| is_against([one.estimate + vertical, one.sigma], vertical));
    let told: Vec<bool> = told.collect();
    !told.is_empty() && !told.contains(&false)
}
