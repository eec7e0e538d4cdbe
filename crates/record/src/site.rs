//! The site of a bench: latitude, gravity and magnetic field.

use std::fmt::Write as _;

use crate::bound::Bound;
use crate::error::{Error, InputErrorKind};
use crate::table::Table;

/// The entries of the table `[site]` that bench and scenario files share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// Astronomic latitude, north positive.
    pub latitude_deg: f64,
    /// Local gravity and the accelerometers' unit, when they differ.
    pub gravity: Option<Gravity>,
    /// Earth's magnetic field along local east, north, up, if it is known.
    pub magnetic_field_gauss: Option<[f64; 3]>,
}

/// Local gravity, and the gravity that the accelerometers call 1 g.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gravity {
    /// Gravity at the bench.
    pub local_m_per_s2: f64,
    /// The acceleration that the record's unit stands for.
    pub unit_m_per_s2: f64,
}

/// Standard deviations of what is known of the site; `None` where the bench does not say.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SiteUncertainty {
    /// Of the astronomic latitude.
    pub latitude_sigma_deg: Option<f64>,
    /// Of the sidereal rotation rate of the Earth, relative to it.
    pub earth_rate_relative_sigma: Option<f64>,
    /// Of local gravity in the unit of the data, relative to it.
    pub gravity_relative_sigma: Option<f64>,
}

/// The Earth's field is at most 0.67 gauss; tesla or nanotesla are a mistake in the unit.
const FIELD_GAUSS: Bound = Bound::Within(-1.0, 1.0);

impl Site {
    /// Name of the table.
    pub const TABLE: &'static str = "site";

    /// The key of the magnetic field.
    pub const MAGNETIC_FIELD_KEY: &'static str = "magnetic_field_gauss";

    /// The keys of these entries.
    pub const KEYS: [&'static str; 4] = [
        "latitude_deg",
        Gravity::KEYS[0],
        Gravity::KEYS[1],
        Self::MAGNETIC_FIELD_KEY,
    ];

    /// Takes the entries from the table `[site]` of a file.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if the latitude is absent, or a value is out of its range.
    pub fn from_table(site: &Table<'_>) -> Result<Self, Error> {
        Ok(Self {
            latitude_deg: site.number("latitude_deg", Bound::Within(-90.0, 90.0))?,
            gravity: Gravity::from_site(site)?,
            magnetic_field_gauss: site
                .optional_three_numbers(Self::MAGNETIC_FIELD_KEY, FIELD_GAUSS)?,
        })
    }
}

impl Gravity {
    /// The keys of the table `[site]` that give it: both or none.
    pub const KEYS: [&'static str; 2] = ["local_gravity_m_per_s2", "unit_gravity_m_per_s2"];

    /// Specific force at rest in the accelerometers' unit.
    #[must_use]
    pub fn ratio(self) -> f64 {
        self.local_m_per_s2 / self.unit_m_per_s2
    }

    /// Takes it from the table `[site]` of a file, where it may be absent.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if only one key is there, or a value that is no gravity of the Earth.
    pub fn from_site(site: &Table<'_>) -> Result<Option<Self>, Error> {
        // Gravity on the Earth is 9.76 to 9.84 m/s^2; anything else is a mistake in the unit.
        const RANGE: Bound = Bound::Within(9.7, 9.9);
        let [local, unit] = Self::KEYS;
        match (
            site.optional_number(local, RANGE)?,
            site.optional_number(unit, RANGE)?,
        ) {
            (None, None) => Ok(None),
            (Some(local_m_per_s2), Some(unit_m_per_s2)) => Ok(Some(Self {
                local_m_per_s2,
                unit_m_per_s2,
            })),
            (given, _) => Err(site.error_at(
                if given.is_some() { unit } else { local },
                InputErrorKind::MissingKey,
                "local and unit gravity are given together or not at all",
                "",
            )),
        }
    }

    /// The lines of the table `[site]` that give it.
    #[must_use]
    pub fn to_toml(self) -> String {
        let [local, unit] = Self::KEYS;
        format!(
            "{local} = {:?}\n{unit} = {:?}\n",
            self.local_m_per_s2, self.unit_m_per_s2
        )
    }
}

impl SiteUncertainty {
    /// The keys of the table `[site]` that give it, each of them optional.
    pub const KEYS: [&'static str; 3] = [
        "latitude_sigma_deg",
        "earth_rate_relative_sigma",
        "gravity_relative_sigma",
    ];

    /// Takes it from the table `[site]` of a file.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if a value is not positive.
    pub fn from_site(site: &Table<'_>) -> Result<Self, Error> {
        let [latitude, rate, gravity] = Self::KEYS;
        Ok(Self {
            latitude_sigma_deg: site.optional_number(latitude, Bound::Positive)?,
            earth_rate_relative_sigma: site.optional_number(rate, Bound::Positive)?,
            gravity_relative_sigma: site.optional_number(gravity, Bound::Positive)?,
        })
    }

    /// The lines of the table `[site]` that give it.
    #[must_use]
    pub fn to_toml(self) -> String {
        let values = [
            self.latitude_sigma_deg,
            self.earth_rate_relative_sigma,
            self.gravity_relative_sigma,
        ];
        let mut text = String::new();
        for (key, value) in Self::KEYS.iter().zip(values) {
            if let Some(value) = value {
                let _ = writeln!(text, "{key} = {value:?}");
            }
        }
        text
    }
}
