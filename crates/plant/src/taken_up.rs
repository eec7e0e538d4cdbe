//! Effects that nominal parameters and initial states take up: no statistic of the record sees them.

use gyrocal_hypothesis::{Selection, select};
use gyrocal_scalar::effect::EffectKind;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::lines::of_parameters;

/// Share of the information of an effect that must be left when the nominal unknowns are projected out:
/// below it, differences to them are those of the linearisation. It is the square of an angle of 1e-3.
const LEAST: f64 = 1e-6;

/// Information along a direction of the nominal unknowns, over the largest, that counts as none.
const NULL: f64 = 1e-8;

/// Least part of a combination that is named.
const NAMED: f64 = 0.05;

impl FittedPlant {
    /// The effects to search for: those that the record can show beside the nominal parameters, priors
    /// aside. Others have words that say what takes them up.
    ///
    /// # Errors
    /// [`PlantError::Singular`].
    pub fn selection(&self) -> Result<Selection, PlantError> {
        let problem = &self.problem;
        let tables = problem.plant.tables();
        let nominal = problem.nominal();
        let all: Vec<usize> = (0..tables.parameters.len()).collect();
        let lines = of_parameters(
            &problem.plant,
            (&problem.record, &problem.rows),
            &Default::default(),
            &all,
        );
        let gram = self.shared_gram(lines)?;
        let names: Vec<&str> = tables.parameters[..nominal]
            .iter()
            .map(|one| one.id)
            .collect();
        let projection = Projection::new(gram, nominal);
        Ok(select(tables, &[], |effect| {
            if effect.kind == EffectKind::Step {
                return None;
            }
            let mut parameters = effect.model_parameters();
            parameters.find_map(|parameter| projection.reason(parameter, &names))
        }))
    }
}

/// The nominal unknowns, scaled to columns of length one.
struct Projection {
    gram: DMatrix<f64>,
    nominal: usize,
    scale: DVector<f64>,
    eigen: SymmetricEigen<f64, nalgebra::Dyn>,
}

impl Projection {
    fn new(gram: DMatrix<f64>, nominal: usize) -> Self {
        let scale = DVector::from_fn(nominal, |i, _| {
            let own = gram[(i + 1, i + 1)];
            if own > 0.0 { own.sqrt().recip() } else { 0.0 }
        });
        let information = DMatrix::from_fn(nominal, nominal, |i, j| {
            gram[(i + 1, j + 1)] * scale[i] * scale[j]
        });
        Self {
            eigen: SymmetricEigen::new(information),
            gram,
            nominal,
            scale,
        }
    }

    /// Words if the unknowns take a parameter up.
    fn reason(&self, parameter: usize, names: &[&str]) -> Option<String> {
        let raw = self.gram[(parameter + 1, parameter + 1)];
        if raw <= 0.0 {
            return Some("it changes nothing in this record".to_owned());
        }
        let cross = DVector::from_fn(self.nominal, |i, _| {
            self.gram[(i + 1, parameter + 1)] * self.scale[i]
        });
        let most = self.eigen.eigenvalues.max();
        let mut left = raw;
        let mut factors = DVector::zeros(self.nominal);
        let directions = self.eigen.eigenvalues.iter();
        for (value, vector) in directions.zip(self.eigen.eigenvectors.column_iter()) {
            if *value > NULL * most {
                let along = cross.dot(&vector);
                left -= along * along / value;
                factors += vector * (along / value);
            }
        }
        if left > LEAST * raw {
            return None;
        }
        let whole = factors.amax();
        let taking: Vec<&str> = names
            .iter()
            .zip(factors.iter())
            .filter(|(_, factor)| factor.abs() > NAMED * whole)
            .map(|(name, _)| *name)
            .collect();
        Some(format!(
            "a change of {} does the same in this record",
            taking.join(", ")
        ))
    }
}
