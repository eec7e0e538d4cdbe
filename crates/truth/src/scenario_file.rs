//! Scenario files.
//!
//! A scenario is a bench description with quantities that a bench does not declare: the
//! coefficients of the gyros, the sampling and the seed. See
//! `examples/data/three_days.scenario.toml`.

use std::fmt::Write as _;
use std::path::Path;

use gyrocal_record::{
    Bound, Document, Error, InputErrorKind, Prior, Record, Site, SourceText, Table, WhiteNoise,
};

use crate::coefficients::Coefficients;
use crate::effect::{DRIFT, DRIFT_SPREAD};
use crate::hidden_file::{self, HIDDEN, read_hidden};
use crate::scenario::{InitialAttitude, MAX_ROWS, Scenario};
use crate::temperature::Temperature;

#[rustfmt::skip] // a table
const ROOT_KEYS: [&str; 9] = [
    "seed", "site", "platform", "gyros", "noise", "sampling", "prior", "temperature", HIDDEN,
];
const TEMPERATURE_KEYS: [&str; 3] = ["mean_c", "daily_k", "wander_k"];
const GYRO_KEYS: [&str; 3] = ["bias_deg_per_h", "g_deg_per_h_per_g", "gg_deg_per_h_per_g2"];
const PLATFORM_KEYS: [&str; 2] = ["initial_angles_deg", "initial_angles_sigma_deg"];
#[rustfmt::skip] // a table
const SAMPLING_KEYS: [&str; 5] =
    ["duration_s", "interval_s", "start_s", "gaps_s", "missing_fraction"];

impl Scenario {
    /// Reads a scenario file.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`], or [`Error::Input`] for a fault in it.
    pub fn read(path: &Path) -> Result<Self, Error> {
        Self::from_source(&SourceText::read(path)?)
    }

    /// Parses the text of a scenario file; errors call it `name`.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] for a fault in it.
    pub fn parse(text: &str, name: &str) -> Result<Self, Error> {
        Self::from_source(&SourceText::new(text, name)?)
    }

    /// The text of a scenario file that [`Scenario::parse`] reads as the same scenario.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let Self {
            seed, latitude_deg, ..
        } = self;
        let mut text = format!("seed = {seed}\n\n[site]\nlatitude_deg = {latitude_deg:?}\n");
        if let Some(gravity) = self.gravity {
            text.push_str(&gravity.to_toml());
        }
        if let Some(field_gauss) = self.magnetic_field_gauss {
            let _ = writeln!(text, "{} = {field_gauss:?}", Site::MAGNETIC_FIELD_KEY);
        }
        text.push_str("\n[platform]\ninitial_angles_deg = ");
        let _ = match self.initial {
            InitialAttitude::AnglesDeg(angles_deg) => writeln!(text, "{angles_deg:?}"),
            InitialAttitude::Random => writeln!(text, "\"random\""),
        };
        let sigma_deg = self.initial_angles_sigma_deg;
        let _ = writeln!(text, "initial_angles_sigma_deg = {sigma_deg:?}\n\n[gyros]");
        let coefficients = [
            self.coefficients.bias_deg_per_h,
            self.coefficients.g_deg_per_h_per_g,
            self.coefficients.gg_deg_per_h_per_g2,
        ];
        for (key, values) in GYRO_KEYS.iter().zip(coefficients) {
            let _ = writeln!(text, "{key} = {values:?}");
        }
        let _ = write!(
            text,
            "\n[noise]\naccel_g = {:?}\ngyro_deg_per_h = {:?}\n\
             \n[sampling]\nduration_s = {:?}\ninterval_s = {:?}\nstart_s = {:?}\n\
             gaps_s = {:?}\nmissing_fraction = {:?}\n",
            self.accel_noise_g,
            self.gyro_noise_deg_per_h,
            self.duration_s,
            self.interval_s,
            self.start_s,
            self.gaps_s,
            self.missing_fraction,
        );
        if self.prior != Prior::default() {
            text.push_str(&self.prior.to_toml());
        }
        if let Some(temperature) = self.temperature {
            let _ = writeln!(
                text,
                "\n[temperature]\nmean_c = {:?}\ndaily_k = {:?}\nwander_k = {:?}",
                temperature.mean_c, temperature.daily_k, temperature.wander_k
            );
        }
        text.extend(self.hidden.iter().map(hidden_file::to_toml));
        text
    }

    fn from_source(source: &SourceText) -> Result<Self, Error> {
        let document = Document::new(source.text(), source.name())?;
        let scenario = Self::from_document(&document)?;
        let located = read_hidden(source)?;
        let spans: Vec<_> = located.iter().map(|located| located.span.clone()).collect();
        let scenario = Self {
            hidden: located.into_iter().map(|located| located.hidden).collect(),
            ..scenario
        };
        match scenario.conflict() {
            Some(conflict) => Err(source.error(
                InputErrorKind::OutOfRange,
                spans.get(conflict.index).cloned().unwrap_or_default(),
                conflict.found,
                conflict.expected,
                "change the effect or what it needs",
            )),
            None => Ok(scenario),
        }
    }

    fn from_document(document: &Document) -> Result<Self, Error> {
        document.interpret(&ROOT_KEYS, |root| {
            let site = Site::from_table(&root.table(Site::TABLE, &Site::KEYS)?)?;
            let platform = root.table("platform", &PLATFORM_KEYS)?;
            let noise = read_noise(root)?;
            let scenario = Self {
                seed: root.whole_number("seed")?,
                latitude_deg: site.latitude_deg,
                gravity: site.gravity,
                coefficients: read_coefficients(root)?,
                initial: read_initial(&platform)?,
                // A bench file, which goes with every record, asks for positive sigmas.
                initial_angles_sigma_deg: platform
                    .three_numbers(PLATFORM_KEYS[1], Bound::Positive)?,
                accel_noise_g: noise.accel_g,
                gyro_noise_deg_per_h: noise.gyro_deg_per_h,
                prior: Prior::from_root(root)?,
                magnetic_field_gauss: site.magnetic_field_gauss,
                temperature: read_temperature(root)?,
                ..Self::default()
            };
            with_sampling(scenario, &root.table("sampling", &SAMPLING_KEYS)?)
        })
    }
}

fn read_noise(root: &Table<'_>) -> Result<WhiteNoise, Error> {
    let noise = WhiteNoise::from_root(root)?;
    // The same in a bench file is no work.
    let table = root.table(WhiteNoise::TABLE, &WhiteNoise::KEYS)?;
    table.number(WhiteNoise::KEYS[1], DRIFT_SPREAD)?;
    Ok(noise)
}

fn read_coefficients(root: &Table<'_>) -> Result<Coefficients, Error> {
    let gyros = root.table("gyros", &GYRO_KEYS)?;
    Ok(Coefficients {
        bias_deg_per_h: gyros.three_numbers(GYRO_KEYS[0], DRIFT)?,
        g_deg_per_h_per_g: gyros.three_numbers(GYRO_KEYS[1], DRIFT)?,
        gg_deg_per_h_per_g2: gyros.three_numbers(GYRO_KEYS[2], DRIFT)?,
    })
}

fn read_initial(platform: &Table<'_>) -> Result<InitialAttitude, Error> {
    if platform.is_word(PLATFORM_KEYS[0], "random") {
        return Ok(InitialAttitude::Random);
    }
    let angles_deg = platform.three_numbers(PLATFORM_KEYS[0], Bound::ANGLE_DEG)?;
    Ok(InitialAttitude::AnglesDeg(angles_deg))
}

fn read_temperature(root: &Table<'_>) -> Result<Option<Temperature>, Error> {
    let Some(table) = root.optional_table("temperature", &TEMPERATURE_KEYS)? else {
        return Ok(None);
    };
    let usual = Temperature::default();
    let number = |which: usize, bound, usual| {
        let number = table.optional_number(TEMPERATURE_KEYS[which], bound);
        number.map(|number| number.unwrap_or(usual))
    };
    Ok(Some(Temperature {
        mean_c: number(0, Bound::Within(-100.0, 100.0), usual.mean_c)?,
        daily_k: number(1, Bound::Finite, usual.daily_k)?,
        wander_k: number(2, Bound::NotNegative, usual.wander_k)?,
    }))
}

fn with_sampling(scenario: Scenario, sampling: &Table<'_>) -> Result<Scenario, Error> {
    let out_of_range = |key: &str, expected: &str, advice: &str| {
        Err(sampling.error_at(key, InputErrorKind::OutOfRange, expected, advice))
    };
    let duration_s = sampling.number("duration_s", Bound::Positive)?;
    let interval_s = sampling.number("interval_s", Bound::Positive)?;
    if duration_s / interval_s > MAX_ROWS {
        let expected = format!("at most {MAX_ROWS:?} intervals");
        return out_of_range("duration_s", &expected, "is everything in seconds?");
    }
    if duration_s > Record::LONGEST_S {
        let expected = "at most 3.16e9 s, a hundred years";
        return out_of_range("duration_s", expected, "is everything in seconds?");
    }
    let gaps_s = sampling.optional_intervals("gaps_s", Bound::NotNegative)?;
    if gaps_s.iter().any(|gap| gap[0] <= 0.0) {
        let advice = "the first row is needed: the initial attitude belongs to it";
        return out_of_range("gaps_s", "gaps that begin after 0 s", advice);
    }
    let start_s = sampling.optional_number("start_s", Bound::Finite)?;
    let missing = sampling.optional_number("missing_fraction", Bound::Within(0.0, 1.0))?;
    Ok(Scenario {
        duration_s,
        interval_s,
        gaps_s,
        start_s: start_s.unwrap_or(0.0),
        missing_fraction: missing.unwrap_or(0.0),
        ..scenario
    })
}
