//! A fit in the making: a plant, a record, and the unknowns of a model.

use std::sync::Arc;

use gyrocal_hypothesis::{Column, ModelExtension, Rows};

use crate::fitted_noise::FittedNoise;
use crate::lines::{of_parameters, of_search};
use crate::loaded::LoadedPlant;
use crate::record::PlantRecord;

/// A plant and a record.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    pub(crate) plant: LoadedPlant,
    pub(crate) record: Arc<PlantRecord>,
    /// Rows in the time of the search.
    pub(crate) rows: Arc<Rows>,
    /// Runge-Kutta steps between rows.
    pub(crate) substeps: usize,
    /// Standard deviations of the nominal parameters and initial states before the record.
    pub(crate) prior_sigma: Vec<f64>,
}

impl Problem {
    pub(crate) fn new(plant: &LoadedPlant, record: Arc<PlantRecord>, substeps: usize) -> Self {
        let (scale, first) = (
            record.search_scale(),
            record.time_s.first().copied().unwrap_or(0.0),
        );
        let time_s = record.time_s.iter().map(|time| (time - first) * scale);
        let rows = Rows {
            starts: record.starts.clone(),
            time_s: time_s.collect(),
            regressors: record.regressors.clone(),
            ..Rows::default()
        };
        let description = &plant.description;
        let states = description.states.iter().map(|state| state.sigma);
        let parameters = description.parameters.iter().map(|one| one.sigma);
        Self {
            prior_sigma: states.chain(parameters).collect(),
            plant: plant.clone(),
            rows: Arc::new(rows),
            record,
            substeps,
        }
    }

    /// Number of initial states and nominal parameters.
    pub(crate) fn nominal(&self) -> usize {
        self.prior_sigma.len()
    }

    /// The unknowns of a model as columns.
    pub(crate) fn lines(&self, extension: &ModelExtension) -> Vec<Column> {
        let own = extension.parameters.iter().map(|(parameter, _)| *parameter);
        let wanted: Vec<usize> = (0..self.nominal()).chain(own).collect();
        let mut lines = of_parameters(&self.plant, (&self.record, &self.rows), extension, &wanted);
        lines.extend(self.columns(extension));
        lines.extend(self.later_starts());
        lines
    }

    /// Initial states of the records after the first: changes of the declared ones in the step to each.
    pub(crate) fn later_starts(&self) -> impl Iterator<Item = Column> + '_ {
        let states = self.plant.description.states.len();
        let starts = self.record.starts.iter();
        starts.flat_map(move |row| {
            (0..states).map(move |state| Column::StateJump {
                row: row - 1,
                state,
            })
        })
    }

    /// Number of these.
    pub(crate) fn later(&self) -> usize {
        self.record.starts.len() * self.plant.description.states.len()
    }

    /// The further columns of an extension.
    pub(crate) fn columns(&self, extension: &ModelExtension) -> Vec<Column> {
        let (states, steps) = self.shape();
        let columns = extension.columns.columns().iter();
        columns
            .map(|column| of_search(column, states, steps, &self.record.starts))
            .collect()
    }

    /// Numbers of states and of steps.
    pub(crate) fn shape(&self) -> (usize, usize) {
        (
            self.plant.description.states.len(),
            self.record.len().saturating_sub(1),
        )
    }

    /// Standard deviations of the unknowns of a model before the record: nominal ones, those of the extension,
    /// initial states of later records.
    pub(crate) fn sigmas(&self, extension: &ModelExtension) -> Vec<f64> {
        let own = extension.parameters.iter().map(|(parameter, sigma)| {
            let own = self.sigma_of_knee(*parameter);
            own.map_or(*sigma, |own| own.min(*sigma))
        });
        let columns = extension.columns.sigmas().iter().copied();
        let states = &self.prior_sigma[..self.plant.description.states.len()];
        let later = self.record.starts.iter().flat_map(|_| states).copied();
        self.prior_sigma
            .iter()
            .copied()
            .chain(own)
            .chain(columns)
            .chain(later)
            .collect()
    }

    /// Standard deviation before the record of a parameter of the table of the plant that is a knee.
    pub(crate) fn sigma_of_knee(&self, parameter: usize) -> Option<f64> {
        let description = &self.plant.description;
        let constant = parameter.checked_sub(description.states.len())?;
        let mut knees = description.knees.iter();
        let own = knees.find(|knee| knee.constant == constant);
        own.map(|knee| knee.sigma)
    }

    /// States at the first row, from the unknowns.
    pub(crate) fn initial(&self, values: &[f64]) -> Vec<f64> {
        let declared = self.plant.description.states.iter();
        let pairs = declared.zip(values);
        pairs.map(|(state, value)| state.initial + value).collect()
    }

    /// The declared noise: of the outputs, of the rates.
    pub(crate) fn declared_noise(&self) -> FittedNoise {
        let description = &self.plant.description;
        FittedNoise::of(&vec![
            1.0;
            description.outputs.len() + description.noises.len()
        ])
    }
}
