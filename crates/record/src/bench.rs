//! The bench description.

use std::fmt::Write as _;
use std::path::Path;

use crate::error::{Error, InputErrorKind};
use crate::output::write_whole;
use crate::tables::{Bound, Document, Table};

/// What is known of the bench before the record is looked at.
#[derive(Debug, Clone, PartialEq)]
pub struct Bench {
    /// Astronomic latitude, north positive.
    pub latitude_deg: f64,
    /// Local gravity and the accelerometers' unit, when they differ.
    pub gravity: Option<Gravity>,
    /// Platform against local east, north, up at the first row: angles about x, then y, then z.
    pub initial_angles_deg: [f64; 3],
    /// Standard deviation of each of these angles.
    pub initial_angles_sigma_deg: [f64; 3],
    /// Standard deviation of one sample of an accelerometer.
    pub accel_noise_g: f64,
    /// Standard deviation of the white gyro noise as held over one minute.
    pub gyro_noise_deg_per_h: f64,
    /// Standard deviations of the coefficients about zero, before the record.
    pub prior: Prior,
}

/// Local gravity, and the gravity that the accelerometers call 1 g.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gravity {
    /// Gravity at the bench.
    pub local_m_per_s2: f64,
    /// The acceleration that the record's unit stands for.
    pub unit_m_per_s2: f64,
}

/// Standard deviations of the drift coefficients about zero, of gyros x, y, z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// Of the constant drifts.
    pub bias_sigma_deg_per_h: [f64; 3],
    /// Of the drifts proportional to specific force.
    pub g_sigma_deg_per_h_per_g: [f64; 3],
    /// Of the drifts proportional to its square.
    pub gg_sigma_deg_per_h_per_g2: [f64; 3],
}

impl Default for Prior {
    fn default() -> Self {
        Self {
            bias_sigma_deg_per_h: [1.0; 3],
            g_sigma_deg_per_h_per_g: [1.0; 3],
            gg_sigma_deg_per_h_per_g2: [1.0; 3],
        }
    }
}

impl Bench {
    /// Reads a bench file.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`], or [`Error::Input`] for whatever is wrong in it.
    pub fn read(path: &Path) -> Result<Self, Error> {
        Self::from_document(&Document::read(path)?)
    }

    /// Parses the text of a bench file; errors call it `name`.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] for whatever is wrong in it.
    pub fn parse(text: &str, name: &str) -> Result<Self, Error> {
        Self::from_document(&Document::new(text, name)?)
    }

    /// Writes a bench file whole or not at all.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidValue`] if [`Bench::read`] would refuse it, [`Error::Unwritable`].
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        write_whole(path, self.to_toml(path)?.as_bytes())
    }

    /// The text of the bench file; errors call it `path`.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidValue`] if [`Bench::parse`] would refuse it.
    pub fn to_toml(&self, path: &Path) -> Result<String, Error> {
        let text = self.format();
        match Self::parse(&text, "") {
            Ok(_) => Ok(text),
            Err(Error::Input(error)) => Err(Error::InvalidValue {
                path: path.to_owned(),
                found: error.found,
                expected: error.expected,
            }),
            Err(other) => Err(other),
        }
    }

    /// Specific force at rest in the record's unit: local gravity over the unit, 1 unless
    /// [`gravity`](Self::gravity) says otherwise.
    #[must_use]
    pub fn specific_force_at_rest(&self) -> f64 {
        self.gravity.map_or(1.0, Gravity::ratio)
    }

    fn from_document(document: &Document) -> Result<Self, Error> {
        document.interpret(&["site", "platform", "noise", "prior"], |root| {
            let site = root.table(
                "site",
                &["latitude_deg", Gravity::KEYS[0], Gravity::KEYS[1]],
            )?;
            let platform = root.table(
                "platform",
                &["initial_angles_deg", "initial_angles_sigma_deg"],
            )?;
            let noise = root.table("noise", &["accel_g", "gyro_deg_per_h"])?;
            Ok(Self {
                latitude_deg: site.number("latitude_deg", Bound::Within(-90.0, 90.0))?,
                gravity: Gravity::from_site(&site)?,
                initial_angles_deg: platform.three_numbers("initial_angles_deg", ANGLE_DEG)?,
                initial_angles_sigma_deg: platform
                    .three_numbers("initial_angles_sigma_deg", Bound::Positive)?,
                accel_noise_g: noise.number("accel_g", Bound::Positive)?,
                gyro_noise_deg_per_h: noise.number("gyro_deg_per_h", Bound::Positive)?,
                prior: Prior::from_root(root)?,
            })
        })
    }

    fn format(&self) -> String {
        let mut text = format!("[site]\nlatitude_deg = {:?}\n", self.latitude_deg);
        if let Some(gravity) = self.gravity {
            text.push_str(&gravity.to_toml());
        }
        let _ = write!(
            text,
            "\n[platform]\n\
             # platform against local east, north, up at the first row\n\
             initial_angles_deg = {:?}\n\
             initial_angles_sigma_deg = {:?}\n\
             \n[noise]\n\
             # one sigma of one sample\n\
             accel_g = {:?}\n\
             # one sigma of the white gyro noise as held over one minute\n\
             gyro_deg_per_h = {:?}\n",
            self.initial_angles_deg,
            self.initial_angles_sigma_deg,
            self.accel_noise_g,
            self.gyro_noise_deg_per_h,
        );
        if self.prior != Prior::default() {
            text.push_str(&self.prior.to_toml());
        }
        text
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

/// Angles beyond a turn are a mistake in the unit.
const ANGLE_DEG: Bound = Bound::Within(-360.0, 360.0);

const PRIOR_KEYS: [&str; 3] = [
    "bias_sigma_deg_per_h",
    "g_sigma_deg_per_h_per_g",
    "gg_sigma_deg_per_h_per_g2",
];

impl Prior {
    /// Takes the table `[prior]` of a file; what is absent has its default.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] for whatever is wrong in it.
    pub fn from_root(root: &Table<'_>) -> Result<Self, Error> {
        let mut prior = Self::default();
        if let Some(table) = root.optional_table("prior", &PRIOR_KEYS)? {
            let values = [
                &mut prior.bias_sigma_deg_per_h,
                &mut prior.g_sigma_deg_per_h_per_g,
                &mut prior.gg_sigma_deg_per_h_per_g2,
            ];
            for (key, value) in PRIOR_KEYS.iter().zip(values) {
                if let Some(sigma) = table.optional_one_or_three(key, Bound::Positive)? {
                    *value = sigma;
                }
            }
        }
        Ok(prior)
    }

    /// The table `[prior]` with all its keys.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let values = [
            self.bias_sigma_deg_per_h,
            self.g_sigma_deg_per_h_per_g,
            self.gg_sigma_deg_per_h_per_g2,
        ];
        let mut text = "\n[prior]\n".to_owned();
        for (key, value) in PRIOR_KEYS.iter().zip(values) {
            let _ = writeln!(text, "{key} = {value:?}");
        }
        text
    }
}
