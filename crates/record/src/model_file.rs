//! Model files: effects of the catalogue in an extended model.

use std::fmt::Write as _;
use std::path::Path;

use crate::bound::Bound;
use crate::document::Document;
use crate::error::{Error, InputErrorKind};
use crate::module_name::module_name;
use crate::output::write_whole;
use crate::report::SCHEMA_VERSION;
use crate::suggest::{any_of, nearest_names};
use crate::table::Table;

/// Content of a model file: the effects of a model in addition to the nine drift coefficients, and
/// their estimates.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModelFile {
    /// What the gyros are fixed to.
    pub gyros: Gyros,
    /// Ids of the effects, each once.
    pub effects: Vec<String>,
    /// Ids of shapes (onsets, time constants) with the values that are built into the model.
    /// Others stay inputs of the model.
    pub shapes: Vec<(String, f64)>,
    /// Initial values of filters. Other parameters start at zero with a wide prior.
    pub estimates: Vec<ParameterEstimate>,
}

/// What the gyros and accelerometers of a model are fixed to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Gyros {
    /// The platform that the gyros stabilise: instruments lie along its axes.
    #[default]
    Platform,
    /// A body: the platform is computed from the outputs of the gyros, and coefficients and effects are
    /// errors of the instruments in their own axes.
    Strapdown,
}

impl Gyros {
    const ALL: [Self; 2] = [Self::Platform, Self::Strapdown];

    /// The word for it in a model file.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Platform => "platform",
            Self::Strapdown => "strapdown",
        }
    }
}

/// An estimated parameter of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterEstimate {
    /// Public id of the parameter, such as `gyro_y.g_z`.
    pub parameter: String,
    /// The estimate, in the unit of the parameter.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: f64,
}

/// An effect that a model file may name: the relevant fields of its row in the table of effects.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KnownEffect<'a> {
    /// Public id.
    pub id: &'a str,
    /// Whether a model file may name it.
    pub standing: Standing,
    /// Ids of its parameters.
    pub states: Vec<&'a str>,
    /// Ids of its shapes.
    pub shapes: Vec<&'a str>,
}

/// Standing of an effect in the symbolic model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// A term that a model file may name.
    Term,
    /// A coefficient that every model has.
    Nominal,
    /// A property of the noise.
    Noise,
    /// A change of the attitude.
    State,
    /// A property of the filter.
    Filter,
}

impl KnownEffect<'_> {
    /// Reason why a model file cannot name the effect, as a clause; `None` if it can.
    #[must_use]
    pub fn objection(&self) -> Option<&'static str> {
        match self.standing {
            Standing::Term => None,
            Standing::Nominal => Some("is one of the nine coefficients that every model has"),
            Standing::Noise => Some(
                "is noise and not a term: filters take white noise from `[noise]` of the bench file, \
                 and model no other",
            ),
            Standing::State => Some(
                "concerns the attitude and is not a term: every filter estimates the attitude, so \
                 start the record after it or widen the prior of the angles",
            ),
            Standing::Filter => Some("concerns the filter and is not a term of the model"),
        }
    }
}

const KEYS: [&str; 5] = ["schema_version", "gyros", "effects", "shapes", "estimates"];

impl ModelFile {
    /// Reads a model file.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`], or [`Error::Input`] for a fault in it, also for effects
    /// that are not `known` or are no terms.
    pub fn read(path: &Path, known: &[KnownEffect<'_>]) -> Result<Self, Error> {
        Self::from_document(&Document::read(path)?, known)
    }

    /// Parses the text of a model file; errors call it `name`.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] for a fault in it.
    pub fn parse(text: &str, name: &str, known: &[KnownEffect<'_>]) -> Result<Self, Error> {
        Self::from_document(&Document::new(text, name)?, known)
    }

    /// Writes a model file whole or not at all.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidValue`] if [`ModelFile::read`] would refuse it, [`Error::ModuleName`],
    /// [`Error::Unwritable`].
    pub fn write(&self, path: &Path, known: &[KnownEffect<'_>]) -> Result<(), Error> {
        write_whole(path, self.to_toml(path, known)?.as_bytes())
    }

    /// The text of the model file; errors call it `path`.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidValue`] if [`ModelFile::parse`] would refuse it; [`Error::ModuleName`] if no
    /// build could derive a module from a file of this name.
    pub fn to_toml(&self, path: &Path, known: &[KnownEffect<'_>]) -> Result<String, Error> {
        module_name(path)?;
        let text = self.format();
        Self::parse(&text, "", known).map_err(|error| error.of_written(path))?;
        Ok(text)
    }

    fn from_document(document: &Document, known: &[KnownEffect<'_>]) -> Result<Self, Error> {
        document.interpret(&KEYS, |root| {
            check_version(root)?;
            let gyros = read_gyros(root)?;
            let listed = effects(root, known)?;
            let shapes: Vec<&str> = listed
                .iter()
                .flat_map(|effect| &effect.shapes)
                .copied()
                .collect();
            let states: Vec<&str> = listed
                .iter()
                .flat_map(|effect| &effect.states)
                .copied()
                .collect();
            Ok(Self {
                gyros,
                effects: listed.iter().map(|effect| effect.id.to_owned()).collect(),
                shapes: read_shapes(root, &shapes)?,
                estimates: read_estimates(root, &states)?,
            })
        })
    }

    fn format(&self) -> String {
        let mut text = format!(
            "# Effects of an extended model, after the nine drift coefficients; docs/extending.md.\n\
             schema_version = {SCHEMA_VERSION}\n"
        );
        if self.gyros != Gyros::default() {
            let _ = writeln!(
                text,
                "# fixed to a body: coefficients and effects are those of its axes\ngyros = {:?}",
                self.gyros.word()
            );
        }
        let _ = writeln!(text, "effects = {:?}", self.effects);
        if !self.shapes.is_empty() {
            text.push_str(
                "\n# constants of the model; shapes that are not listed are inputs\n[shapes]\n",
            );
            for (id, value) in &self.shapes {
                let _ = writeln!(text, "{id:?} = {value:?}");
            }
        }
        if !self.estimates.is_empty() {
            text.push_str("\n# initial values of filters\n[estimates]\n");
            for estimate in &self.estimates {
                let _ = writeln!(
                    text,
                    "{:?} = {{ value = {:?}, sigma = {:?} }}",
                    estimate.parameter, estimate.value, estimate.sigma
                );
            }
        }
        text
    }
}

fn check_version(root: &Table<'_>) -> Result<(), Error> {
    if root.whole_number("schema_version")? == u64::from(SCHEMA_VERSION) {
        return Ok(());
    }
    Err(root.error_at(
        "schema_version",
        InputErrorKind::OutOfRange,
        &format!("{SCHEMA_VERSION}, the version that this program knows"),
        "write the file again with `gyrocal extend` of this version",
    ))
}

fn read_gyros(root: &Table<'_>) -> Result<Gyros, Error> {
    let words = Gyros::ALL.map(Gyros::word);
    let expected = any_of(&words);
    let Some(text) = root.optional_text("gyros", &expected)? else {
        return Ok(Gyros::default());
    };
    let found = Gyros::ALL
        .into_iter()
        .find(|gyros| gyros.word() == text.text);
    found.ok_or_else(|| {
        text.error(
            InputErrorKind::OutOfRange,
            &expected,
            "what the gyros are fixed to; without the key it is the platform",
        )
    })
}

fn effects<'k, 'a>(
    root: &Table<'_>,
    known: &'k [KnownEffect<'a>],
) -> Result<Vec<&'k KnownEffect<'a>>, Error> {
    const EXPECTED: &str = "a list of ids of effects, such as `[\"gyro_y.g_z\"]`";
    let mut listed: Vec<&KnownEffect<'_>> = Vec::new();
    for text in root.texts("effects", EXPECTED)? {
        let Some(effect) = known.iter().find(|effect| effect.id == text.text) else {
            let terms = known.iter().filter(|effect| effect.objection().is_none());
            let terms: Vec<&str> = terms.map(|effect| effect.id).collect();
            return Err(text.error(
                InputErrorKind::OutOfRange,
                "the id of an effect",
                format!(
                    "the nearest are {}",
                    any_of(&nearest_names(text.text, &terms, 3))
                ),
            ));
        };
        if let Some(objection) = effect.objection() {
            return Err(text.error(
                InputErrorKind::OutOfRange,
                "an effect that is a term of the model",
                format!("`{}` {objection}", effect.id),
            ));
        }
        if listed.iter().any(|other| other.id == effect.id) {
            return Err(text.error(
                InputErrorKind::OutOfRange,
                "each effect once",
                "take one of them away",
            ));
        }
        listed.push(effect);
    }
    Ok(listed)
}

fn read_shapes(root: &Table<'_>, known: &[&str]) -> Result<Vec<(String, f64)>, Error> {
    let Some(table) = root.optional_table("shapes", known)? else {
        return Ok(Vec::new());
    };
    let mut shapes = Vec::new();
    for &id in known {
        let bound = match id.ends_with("time_constant_h") {
            true => Bound::Positive,
            false => Bound::Finite,
        };
        if let Some(value) = table.optional_number(id, bound)? {
            shapes.push((id.to_owned(), value));
        }
    }
    Ok(shapes)
}

fn read_estimates(root: &Table<'_>, known: &[&str]) -> Result<Vec<ParameterEstimate>, Error> {
    let Some(table) = root.optional_table("estimates", known)? else {
        return Ok(Vec::new());
    };
    let mut estimates = Vec::new();
    for &id in known {
        if let Some(estimate) = table.optional_table(id, &["value", "sigma"])? {
            estimates.push(ParameterEstimate {
                parameter: id.to_owned(),
                value: estimate.number("value", Bound::Finite)?,
                sigma: estimate.number("sigma", Bound::Positive)?,
            });
        }
    }
    Ok(estimates)
}
