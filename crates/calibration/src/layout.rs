//! Unknowns of a joint calibration and their order: the coefficients, the errors of each site, the
//! turn-on offsets of each run.

use gyrocal::generated::surveyed::parameters_index as index;
use gyrocal_record::Bench;

use crate::coefficients::{BIASES, PARAMETERS};
use crate::problem::Unknown;
use crate::settings::drift_prior_sigma;

/// Turn-on sigma of a gyro whose turn-ons are declared equal while those of others differ.
const SAME_DEG_PER_H: f64 = 1e-9;

/// A parameter of the site that is considered and not estimated, in the order of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SiteQuantity {
    /// Local gravity in the unit of the data, relative.
    Gravity,
    /// Astronomic latitude, deg.
    Latitude,
    /// Sidereal rotation rate of the Earth, relative.
    EarthRate,
}

impl SiteQuantity {
    /// All quantities.
    pub const ALL: [Self; 3] = [Self::Gravity, Self::Latitude, Self::EarthRate];

    /// Public id of its error in the catalogue.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::Gravity => "site.gravity",
            Self::Latitude => "site.latitude",
            Self::EarthRate => "site.earth_rate",
        }
    }

    /// The standard deviation that the bench declares.
    #[must_use]
    pub fn declared_sigma(self, bench: &Bench) -> Option<f64> {
        match self {
            Self::Gravity => bench.uncertainty.gravity_relative_sigma,
            Self::Latitude => bench.uncertainty.latitude_sigma_deg,
            Self::EarthRate => bench.uncertainty.earth_rate_relative_sigma,
        }
    }

    /// Error for which biases are reported where no sigma is declared: 1″ of latitude, a part in
    /// 10⁶ of gravity (1 mGal), and of Earth rate 1e-8, its variation with the length of day.
    #[must_use]
    pub fn reference_error(self) -> f64 {
        match self {
            Self::Gravity => 1e-6,
            Self::Latitude => 1.0 / 3600.0,
            Self::EarthRate => 1e-8,
        }
    }

    /// Index among the model's parameters.
    fn parameter(self) -> usize {
        match self {
            Self::Gravity => index::SITE_GRAVITY,
            Self::Latitude => index::SITE_LATITUDE,
            Self::EarthRate => index::SITE_EARTH_RATE,
        }
    }
}

/// Unknowns of a joint calibration: the coefficients, then the errors of each site, then, if turn-ons
/// differ, the offsets of each run's constant drifts from their means.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub(crate) unknowns: Vec<Unknown>,
    /// Index of the first unknown of each run's site.
    sites: Vec<usize>,
    /// Index of the first turn-on offset of each run.
    pub(crate) turn_ons: Vec<Option<usize>>,
}

impl Layout {
    /// Unknowns of runs on these benches; the prior of the first bench holds for all.
    pub(crate) fn new(benches: &[&Bench]) -> Self {
        let turn_on = benches
            .first()
            .map_or([0.0; 3], |bench| bench.prior.turn_on_sigma_deg_per_h);
        let differ = benches.len() > 1 && turn_on.iter().any(|sigma| *sigma > 0.0);
        let mut prior = benches.first().map_or([1.0; PARAMETERS], |bench| {
            drift_prior_sigma(bench).to_array()
        });
        if let (true, Some(bench)) = (differ, benches.first()) {
            // The prior of the mean over turn-ons, not that of one turn-on.
            for (axis, bias) in BIASES.into_iter().enumerate() {
                prior[bias] = bench.prior.bias_sigma_deg_per_h[axis];
            }
        }
        let mut unknowns: Vec<Unknown> = prior.into_iter().map(Unknown::estimated).collect();
        let mut sites = Vec::with_capacity(benches.len());
        for (run, bench) in benches.iter().enumerate() {
            let same = benches[..run].iter().position(|other| {
                (other.latitude_deg, other.gravity) == (bench.latitude_deg, bench.gravity)
            });
            sites.push(match same {
                Some(other) => sites[other],
                None => {
                    let first = unknowns.len();
                    unknowns.extend(
                        SiteQuantity::ALL
                            .map(|quantity| Unknown::considered(quantity.declared_sigma(bench))),
                    );
                    first
                }
            });
        }
        let mut turn_ons = vec![None; benches.len()];
        if differ {
            for first in &mut turn_ons {
                *first = Some(unknowns.len());
                unknowns.extend(turn_on.map(|sigma| Unknown::estimated(sigma.max(SAME_DEG_PER_H))));
            }
        }
        Self {
            unknowns,
            sites,
            turn_ons,
        }
    }

    /// For each parameter of the model the unknowns whose sum it is in a run.
    pub(crate) fn parameter_unknowns(&self, run: usize) -> Vec<Vec<usize>> {
        let mut unknowns: Vec<Vec<usize>> =
            (0..PARAMETERS).map(|parameter| vec![parameter]).collect();
        unknowns.resize(gyrocal::Surveyed::PARAMETERS, Vec::new());
        for (offset, quantity) in SiteQuantity::ALL.into_iter().enumerate() {
            unknowns[quantity.parameter()].push(self.sites[run] + offset);
        }
        if let Some(first) = self.turn_ons[run] {
            for (axis, bias) in BIASES.into_iter().enumerate() {
                unknowns[bias].push(first + axis);
            }
        }
        unknowns
    }

    /// The quantity of a site that an unknown is.
    pub(crate) fn quantity(&self, unknown: usize) -> Option<SiteQuantity> {
        let mut sites = self.sites.iter();
        sites.find_map(|first| SiteQuantity::ALL.get(unknown.checked_sub(*first)?).copied())
    }

    /// The axis of the gyro whose turn-on offset an unknown is.
    pub(crate) fn turn_on_axis(&self, unknown: usize) -> Option<usize> {
        let mut turn_ons = self.turn_ons.iter().flatten();
        turn_ons.find_map(|first| {
            let axis = unknown.checked_sub(*first)?;
            (axis < BIASES.len()).then_some(axis)
        })
    }

    /// Index of a quantity of the first run's site among the unknowns.
    pub(crate) fn site_unknown(&self, quantity: SiteQuantity) -> usize {
        self.sites[0]
            + SiteQuantity::ALL
                .iter()
                .position(|q| *q == quantity)
                .unwrap_or(0)
    }
}
