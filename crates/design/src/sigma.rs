//! Standard deviations of coefficients and sizes.

use gyrocal::generated::platform::DRIFT;
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::COEFFICIENTS;
use crate::joint_unknowns::{JointUnknowns, with_priors};
use crate::result::Forecast;

/// Of the nine coefficients, then of the sizes of what was named, from the information on all
/// unknowns: as a joint calibration gives them, what is uncertain of the site considered. `None` if
/// it does not determine them.
pub(crate) fn sigmas(
    unknowns: &JointUnknowns,
    information: &DMatrix<f64>,
) -> Option<(Vec<Forecast>, Vec<Forecast>)> {
    let mut estimated: Vec<usize> = (0..COEFFICIENTS).collect();
    let named: Vec<_> = unknowns
        .cases
        .iter()
        .filter_map(|case| case.members.first())
        .collect();
    estimated.extend(named.iter().flat_map(|member| member.places.iter()));
    estimated.extend(&unknowns.common);
    let count = estimated.len();
    let inner = with_priors(information, &unknowns.list, &estimated);
    let cholesky = Cholesky::new(inner)?;
    let mut variance = cholesky.inverse().diagonal();
    for site in unknowns.site {
        let sigma = unknowns.list[site].sigma;
        let cross = DVector::from_fn(count, |i, _| information[(estimated[i], site)]);
        let taken = cholesky.solve(&cross) * sigma;
        variance += taken.component_mul(&taken);
    }
    let coefficients = (0..COEFFICIENTS)
        .map(|i| Forecast {
            name: DRIFT[i].id.into(),
            sigma: variance[i].sqrt(),
            unit: DRIFT[i].unit.into(),
        })
        .collect();
    let mut sizes = Vec::new();
    let mut place = COEFFICIENTS;
    for member in named {
        let row = member.candidate.row;
        for index in 0..member.places.len() {
            if !member.is_walk() {
                sizes.push(Forecast {
                    name: format!("{} {}", row.id, row.parameters[index].name).into(),
                    sigma: variance[place].sqrt() / row.parameters[index].scale,
                    unit: row.parameters[index].unit.into(),
                });
            }
            place += 1;
        }
    }
    Some((coefficients, sizes))
}
