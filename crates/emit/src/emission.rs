use gyrocal::generated::MODEL_HASH;
use gyrocal_record::{Gyros, ModelFile};

use crate::bundle::{Sources, generated, selected};
use crate::error::EmitError;
use crate::number::Number;
use crate::{reference, text};

/// The model of an extended filter.
#[derive(Clone, Copy, Debug)]
pub struct Extension<'a> {
    /// The model file.
    pub model: &'a ModelFile,
    /// Name of the module: that of the model file up to the first dot.
    pub name: &'a str,
    /// The module that a build derived from the model file.
    pub module: &'a str,
}

/// A filter that is to be written as one file.
#[derive(Clone, Copy, Debug)]
pub struct Emission<'a> {
    /// Number type of the tests, and of the type that the file recommends.
    pub number: Number,
    /// The extended model; without it the filter is the nominal one.
    pub extension: Option<Extension<'a>>,
}

impl Emission<'_> {
    /// The text of the file.
    ///
    /// # Errors
    /// [`EmitError`]: a module that is not that of the model file, or a filter that stops.
    pub fn write(&self) -> Result<String, EmitError> {
        let gyros = self
            .extension
            .map_or_else(Gyros::default, |extension| extension.model.gyros);
        let samples = reference::samples(gyros)?;
        let (model, own, vectors) = match &self.extension {
            None => {
                let expected = match self.number {
                    Number::F32 => reference::nominal::<f32>(&samples)?,
                    Number::F64 => reference::nominal::<f64>(&samples)?,
                };
                let vectors = text::nominal_vectors(self.number, &samples, &expected);
                (String::new(), text::nominal(self.number), vectors)
            }
            Some(extension) => {
                let type_name = extension.type_name()?;
                let starts = reference::starts(extension.model)?;
                let expected = reference::extended(extension.model, &starts, &samples)?;
                let module = generated(extension.name, extension.module);
                let names = text::Names {
                    module: extension.name,
                    model: &type_name,
                    gyros,
                };
                let own = text::extended(self.number, &names);
                let vectors =
                    text::extended_vectors(self.number, &names, &starts, &samples, &expected);
                (module, own, vectors)
            }
        };
        let effects = self
            .extension
            .map_or_else(Vec::new, |extension| extension.model.effects.clone());
        let parts = [
            text::head(self.number, gyros, &effects, MODEL_HASH),
            own,
            model,
            libraries()?,
            vectors,
        ];
        Ok(parts.join("\n"))
    }
}

impl Extension<'_> {
    /// Name of the model's type, which the module must have with its inputs and its start values.
    fn type_name(&self) -> Result<String, EmitError> {
        let words = self.name.split('_').map(|word| {
            let mut letters = word.chars();
            let first = letters.next().map(|letter| letter.to_ascii_uppercase());
            first.into_iter().chain(letters).collect::<String>()
        });
        let name: String = words.collect();
        let taken = ["scalar", "estimation", "gyrocal", "elementary", "vectors"];
        if taken.contains(&self.name) || name.is_empty() {
            return Err(EmitError::ModuleName {
                found: self.name.to_owned(),
                expected: "another name than those of the modules of the file",
            });
        }
        for item in [
            format!("pub struct {name};"),
            format!("pub struct {name}Inputs<T>"),
            "pub static START: ".to_owned(),
        ] {
            if !self.module.contains(&item) {
                return Err(EmitError::Module {
                    module: format!("{}.rs", self.name),
                    missing: format!("`{item}`"),
                });
            }
        }
        let found = match self.module.contains("pub platform_c_gyros: [T; 9],") {
            true => Gyros::Strapdown,
            false => Gyros::Platform,
        };
        if found != self.model.gyros {
            return Err(EmitError::Gyros {
                module: format!("{}.rs", self.name),
                found: found.word(),
                expected: self.model.gyros.word(),
            });
        }
        Ok(name)
    }
}

/// The modules of the libraries.
fn libraries() -> Result<String, EmitError> {
    let scalar = Sources {
        name: "scalar",
        files: gyrocal_scalar::source::FILES,
    };
    let estimation = Sources {
        name: "estimation",
        files: gyrocal_estimation::source::FILES,
    };
    let platform = ("generated/platform.rs", gyrocal::source::PLATFORM);
    let files: Vec<_> = gyrocal::source::FILES
        .iter()
        .copied()
        .chain([platform])
        .collect();
    let gyrocal = Sources {
        name: "gyrocal",
        files: &files,
    };
    let elementary = selected(include_str!("elementary.rs")).join("\n");
    let modules = [
        gyrocal.module()?,
        estimation.module()?,
        scalar.module()?,
        generated("elementary", &elementary),
    ];
    Ok(modules.join("\n"))
}

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    reason = "a test may stop at what must not happen"
)]
mod tests {
    use super::*;

    /// Modules of the example package with their effects.
    const EXTENDED: (&str, &str) = (
        include_str!("../../../examples/extended/src/generated/extended.rs"),
        "gyro_y.g_z",
    );
    const UNIT: (&str, &str) = (
        include_str!("../../../examples/extended/src/generated/unit.rs"),
        "gyro_y.ramp",
    );

    fn refused(gyros: Gyros, name: &str, (module, effect): (&str, &str)) -> EmitError {
        let model = ModelFile {
            gyros,
            effects: vec![effect.to_owned()],
            ..ModelFile::default()
        };
        let extension = Extension {
            model: &model,
            name,
            module,
        };
        let emission = Emission {
            number: Number::F32,
            extension: Some(extension),
        };
        emission.write().unwrap_err()
    }

    #[test]
    fn a_module_of_another_model_is_refused() {
        let error = refused(Gyros::Platform, "other", EXTENDED);
        assert!(matches!(error, EmitError::Module { .. }));
    }

    #[test]
    fn a_module_with_other_gyros_is_refused_in_words() {
        for (gyros, name, module, found, expected) in [
            (Gyros::Platform, "unit", UNIT, "strapdown", "platform"),
            (
                Gyros::Strapdown,
                "extended",
                EXTENDED,
                "platform",
                "strapdown",
            ),
        ] {
            let said = refused(gyros, name, module).to_string();
            let words = format!("{name}.rs: found gyros that are `{found}`, expected `{expected}`");
            assert!(said.starts_with(&words), "{said}");
        }
    }
}
