//! The bench description.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use crate::bound::Bound;
use crate::document::Document;
use crate::error::{Error, InputErrorKind};
use crate::gimbals::GimbalLimits;
use crate::output::write_whole;
use crate::site::{Gravity, Site, SiteUncertainty};
use crate::table::Table;
use crate::white_noise::WhiteNoise;

/// Description of the bench: site, initial attitude, noise, and prior of the coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct Bench {
    /// What identifies unit and run, by its key: serial number, operator, date and whatever else the file tells.
    /// Nothing is computed from it.
    pub identification: BTreeMap<String, String>,
    /// Astronomic latitude, north positive.
    pub latitude_deg: f64,
    /// Local gravity and the accelerometers' unit, when they differ.
    pub gravity: Option<Gravity>,
    /// Standard deviations of latitude, Earth rate and gravity.
    pub uncertainty: SiteUncertainty,
    /// Earth's magnetic field along local east, north, up, if it is known.
    pub magnetic_field_gauss: Option<[f64; 3]>,
    /// Platform against local east, north, up at the first row: angles about x, then y, then z.
    /// `None` if they are unknown and to be estimated from the record.
    pub initial_angles_deg: Option<[f64; 3]>,
    /// Standard deviation of each of these angles; without meaning if they are not known.
    pub initial_angles_sigma_deg: [f64; 3],
    /// Limits of the platform angles.
    pub gimbal_limits: GimbalLimits,
    /// Standard deviation of one sample of an accelerometer.
    pub accel_noise_g: f64,
    /// Standard deviation of the white gyro noise as held over one minute.
    pub gyro_noise_deg_per_h: f64,
    /// Standard deviations of the coefficients about zero, before the record.
    pub prior: Prior,
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
    /// Of the constant drift in one turn-on about its mean over turn-ons, to which
    /// `bias_sigma_deg_per_h` applies; 0 if it is the same in every turn-on.
    pub turn_on_sigma_deg_per_h: [f64; 3],
}

impl Default for Prior {
    fn default() -> Self {
        Self {
            bias_sigma_deg_per_h: [1.0; 3],
            g_sigma_deg_per_h_per_g: [1.0; 3],
            gg_sigma_deg_per_h_per_g2: [1.0; 3],
            turn_on_sigma_deg_per_h: [0.0; 3],
        }
    }
}

impl Bench {
    /// Reads a bench file.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`], or [`Error::Input`] for a fault in it.
    pub fn read(path: &Path) -> Result<Self, Error> {
        Self::from_document(&Document::read(path)?)
    }

    /// Parses the text of a bench file; errors call it `name`.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] for a fault in it.
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
        Self::parse(&text, "").map_err(|error| error.of_written(path))?;
        Ok(text)
    }

    /// Specific force at rest in the record's unit: local gravity over the unit, 1 unless
    /// [`gravity`](Self::gravity) says otherwise.
    #[must_use]
    pub fn specific_force_at_rest(&self) -> f64 {
        self.gravity.map_or(1.0, Gravity::ratio)
    }

    fn from_document(document: &Document) -> Result<Self, Error> {
        document.interpret(&KNOWN, |root| {
            let keys = [&Site::KEYS[..], &SiteUncertainty::KEYS].concat();
            let site_table = root.table(Site::TABLE, &keys)?;
            let platform = root.optional_table("platform", &PLATFORM_KEYS)?;
            let noise = WhiteNoise::from_root(root)?;
            let site = Site::from_table(&site_table)?;
            let initial_angles = platform.as_ref().map(initial_angles).transpose()?;
            let (initial_angles_deg, initial_angles_sigma_deg) =
                initial_angles.unwrap_or((None, UNKNOWN_ANGLES_SIGMA_DEG));
            Ok(Self {
                identification: root.facts(IDENTIFICATION)?,
                latitude_deg: site.latitude_deg,
                gravity: site.gravity,
                uncertainty: SiteUncertainty::from_site(&site_table)?,
                magnetic_field_gauss: site.magnetic_field_gauss,
                initial_angles_deg,
                initial_angles_sigma_deg,
                gimbal_limits: GimbalLimits::from_root(root)?,
                accel_noise_g: noise.accel_g,
                gyro_noise_deg_per_h: noise.gyro_deg_per_h,
                prior: Prior::from_root(root)?,
            })
        })
    }

    fn format(&self) -> String {
        let mut text = format!(
            "[{}]\nlatitude_deg = {:?}\n",
            Site::TABLE,
            self.latitude_deg
        );
        if let Some(gravity) = self.gravity {
            text.push_str(&gravity.to_toml());
        }
        text.push_str(&self.uncertainty.to_toml());
        if let Some(field_gauss) = self.magnetic_field_gauss {
            let _ = writeln!(text, "{} = {field_gauss:?}", Site::MAGNETIC_FIELD_KEY);
        }
        text.push_str("\n[platform]\n");
        if let Some(angles_deg) = self.initial_angles_deg {
            let _ = write!(
                text,
                "# platform against local east, north, up at the first row\n\
                 initial_angles_deg = {angles_deg:?}\n\
                 initial_angles_sigma_deg = {:?}\n",
                self.initial_angles_sigma_deg,
            );
        }
        let _ = write!(
            text,
            "\n[noise]\n\
             # one sigma of one sample\n\
             accel_g = {:?}\n\
             # one sigma of the white gyro noise as held over one minute\n\
             gyro_deg_per_h = {:?}\n",
            self.accel_noise_g, self.gyro_noise_deg_per_h,
        );
        if self.prior != Prior::default() {
            text.push_str(&self.prior.to_toml());
        }
        text.push_str(&self.gimbal_limits.to_toml());
        if !self.identification.is_empty() {
            let _ = writeln!(text, "\n[{IDENTIFICATION}]");
            text.push_str(&toml::to_string(&self.identification).unwrap_or_default());
        }
        text
    }
}

/// Angles and their sigmas are given together, or the attitude is not known.
fn initial_angles(platform: &Table<'_>) -> Result<(Option<[f64; 3]>, [f64; 3]), Error> {
    let [angles, sigmas] = PLATFORM_KEYS;
    let angles_deg = platform.optional_three_numbers(angles, Bound::ANGLE_DEG)?;
    let sigma_deg = match angles_deg {
        Some(_) => platform.three_numbers(sigmas, Bound::Positive)?,
        None => platform
            .optional_three_numbers(sigmas, Bound::Positive)?
            .map_or(Ok(UNKNOWN_ANGLES_SIGMA_DEG), |_| {
                Err(platform.error_at(
                    angles,
                    InputErrorKind::MissingKey,
                    "angles and their sigmas are given together or not at all",
                    "",
                ))
            })?,
    };
    Ok((angles_deg, sigma_deg))
}

/// Tables of a bench file.
const KNOWN: [&str; 6] = [
    "site",
    "platform",
    "noise",
    "prior",
    GimbalLimits::TABLE,
    IDENTIFICATION,
];

/// The table that takes any key.
const IDENTIFICATION: &str = "identification";

/// Value of [`Bench::initial_angles_sigma_deg`] for unknown angles.
const UNKNOWN_ANGLES_SIGMA_DEG: [f64; 3] = [180.0; 3];

const PLATFORM_KEYS: [&str; 2] = ["initial_angles_deg", "initial_angles_sigma_deg"];

const PRIOR_KEYS: [&str; 4] = [
    "bias_sigma_deg_per_h",
    "g_sigma_deg_per_h_per_g",
    "gg_sigma_deg_per_h_per_g2",
    "turn_on_sigma_deg_per_h",
];

impl Prior {
    /// Takes the table `[prior]` of a file; what is absent has its default.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] for a fault in it.
    pub fn from_root(root: &Table<'_>) -> Result<Self, Error> {
        let mut prior = Self::default();
        if let Some(table) = root.optional_table("prior", &PRIOR_KEYS)? {
            let values = [
                &mut prior.bias_sigma_deg_per_h,
                &mut prior.g_sigma_deg_per_h_per_g,
                &mut prior.gg_sigma_deg_per_h_per_g2,
                &mut prior.turn_on_sigma_deg_per_h,
            ];
            for (i, (key, value)) in PRIOR_KEYS.iter().zip(values).enumerate() {
                let bound = if i == 3 {
                    Bound::NotNegative
                } else {
                    Bound::Positive
                };
                if let Some(sigma) = table.optional_one_or_three(key, bound)? {
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
            self.turn_on_sigma_deg_per_h,
        ];
        let mut text = "\n[prior]\n".to_owned();
        for (key, value) in PRIOR_KEYS.iter().zip(values) {
            let _ = writeln!(text, "{key} = {value:?}");
        }
        text
    }
}
