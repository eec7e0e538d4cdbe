//! A plant that is ready to be fitted.

use std::path::Path;
use std::sync::Arc;

use gyrocal_codegen::Program;
use gyrocal_hypothesis::Plant;
use gyrocal_record::digest_of_text;
use gyrocal_scalar::{Model, NamedInputs};

use crate::catalogue::Catalogue;
use crate::columns::read_text;
use crate::description::Description;
use crate::error::PlantError;
use crate::functions::Functions;
use crate::generated::Generated;
use crate::interpreted::Interpreted;

/// Functions, description and catalogue of a plant.
#[derive(Clone)]
pub struct LoadedPlant {
    pub(crate) functions: Arc<dyn Functions>,
    pub(crate) description: Arc<Description>,
    pub(crate) catalogue: Arc<Catalogue>,
    hash: Arc<str>,
}

impl core::fmt::Debug for LoadedPlant {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("LoadedPlant")
            .field("name", &self.description.name)
            .finish_non_exhaustive()
    }
}

impl LoadedPlant {
    /// Reads a program file; its functions are interpreted. The tables of a catalogue stay in memory until
    /// the program ends: read a plant once.
    ///
    /// # Errors
    /// [`PlantError::Unreadable`], [`PlantError::Program`], [`PlantError::NoPlant`].
    pub fn read(path: &Path) -> Result<Self, PlantError> {
        let text = read_text(path)?;
        Self::parse(&text, &path.display().to_string())
    }

    /// The same from the text of a file of the name `origin`.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(text: &str, origin: &str) -> Result<Self, PlantError> {
        let program = Program::from_json(text, origin)?;
        let functions = Interpreted::new(&program)?;
        let description = Description::of(&program)?;
        let catalogue = Catalogue::new(&description, functions.sizes().parameters);
        Ok(Self {
            functions: Arc::new(functions),
            description: Arc::new(description),
            catalogue: Arc::new(catalogue),
            hash: digest_of_text(text).into(),
        })
    }

    /// The same plant with other functions, such as generated ones.
    ///
    /// # Errors
    /// [`PlantError::NoPlant`] if their sizes differ from those of the program.
    pub fn with_functions(&self, functions: Arc<dyn Functions>) -> Result<Self, PlantError> {
        if functions.sizes() != self.functions.sizes() {
            return Err(PlantError::NoPlant {
                origin: self.description.name.clone(),
                problem: format!(
                    "other functions have sizes {:?}, expected {:?}",
                    functions.sizes(),
                    self.functions.sizes()
                ),
            });
        }
        Ok(Self {
            functions,
            ..self.clone()
        })
    }

    /// The same plant with a generated model for its functions.
    ///
    /// # Errors
    /// [`PlantError::NoPlant`] if its sizes differ from those of the program.
    pub fn with_model<D, const M: usize, const Y: usize>(
        &self,
        model: D,
    ) -> Result<Self, PlantError>
    where
        D: Model<f64, M, Y> + Send + Sync + 'static,
        D::Inputs: NamedInputs<f64>,
    {
        let noises = self.functions.sizes().noises;
        self.with_functions(Arc::new(Generated::new(model, noises)))
    }

    /// SHA-256 of the text of the program, in hexadecimal.
    #[must_use]
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// States, parameters, inputs and outputs.
    #[must_use]
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Tables for score tests.
    #[must_use]
    pub fn tables(&self) -> &'static Plant {
        self.catalogue.plant
    }

    /// Rates and outputs.
    #[must_use]
    pub fn functions(&self) -> &dyn Functions {
        &*self.functions
    }
}
