//! Reference values of every function, computed by CasADi at fixed points in the derivation.
//!
//! The format is that of `codegen/derive/reference.py`.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;

use crate::OracleError;

/// Path of the committed values.
pub const REFERENCE_PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/reference/platform.json");

/// Values of functions at points.
#[derive(Clone, Debug, Deserialize)]
pub struct Reference {
    /// Version of CasADi that computed them.
    pub casadi_version: String,
    /// The points: scalars of every group, by the name of the group.
    pub inputs: Vec<BTreeMap<String, Vec<f64>>>,
    /// For every function its structural nonzeros at each point, in program order.
    pub functions: BTreeMap<String, Vec<Vec<f64>>>,
}

impl Reference {
    /// Reads values from the text of their file.
    ///
    /// # Errors
    /// If the text is of another form.
    pub fn from_json(text: &str) -> Result<Self, OracleError> {
        Ok(serde_json::from_str(text)?)
    }

    /// Reads values from a file.
    ///
    /// # Errors
    /// If there is no such file, or it is of another form.
    pub fn read(path: &Path) -> Result<Self, OracleError> {
        let text = std::fs::read_to_string(path).map_err(|source| OracleError::Read {
            path: path.to_owned(),
            source,
        })?;
        Self::from_json(&text)
    }

    /// The values of one function, point by point.
    ///
    /// # Errors
    /// If there are none.
    pub fn function(&self, name: &str) -> Result<&[Vec<f64>], OracleError> {
        self.functions
            .get(name)
            .map(Vec::as_slice)
            .ok_or_else(|| OracleError::Unknown {
                kind: "reference of",
                name: name.to_owned(),
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_to_the_last_bit() {
        let text = r#"{"casadi_version": "3.8.2", "inputs": [{"theta": [0.30000000000000004]}],
                       "functions": {"f": [[7.292115e-05, -0.1]]}}"#;
        let reference = Reference::from_json(text).unwrap();
        assert_eq!(reference.inputs[0]["theta"], [0.1 + 0.2]);
        assert_eq!(reference.function("f").unwrap()[0], [7.292115e-5, -0.1]);
        assert!(reference.function("g").is_err());
        let message = Reference::read(Path::new("absent.json"))
            .unwrap_err()
            .to_string();
        assert!(message.contains("absent.json"), "{message}");
    }
}
