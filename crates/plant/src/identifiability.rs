//! Directions of parameters and initial states that a record does not determine: gauges, which no record
//! determines, and weak excitation.
//!
//! At the fit, directions of the information without priors that are null are told apart by other records
//! of the same plant: simulated at the fitted parameters with random inputs in the range of the record's and
//! random initial states. A gauge is null in all of them together. What is null in the record only is not excited
//! there.

use std::sync::Arc;

use crate::linearised::reduce;
use gyrocal_answer::{NullDirection, NullPart};
use gyrocal_hypothesis::ModelExtension;
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::math::exp;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::loaded::LoadedPlant;
use crate::problem::Problem;
use crate::record::PlantRecord;
use crate::solve::Solver;

/// Share of the information of the best direction, columns of length one, below which one is null.
const NULL: f64 = 1e-9;

/// Random records at the fitted parameters.
const RECORDS: u64 = 4;

/// Rows of a random record.
const ROWS: usize = 400;

/// Rows over which a random input is held.
const HELD_ROWS: usize = 7;

/// Standard deviation of the logarithm of a random initial state over a state of the record.
const SPREAD: f64 = 0.2;

/// Least part of a direction that is named.
const NAMED: f64 = 0.02;

/// A null direction with the indices of the nominal parameters in it, the largest part first.
type Indexed = (NullDirection, Vec<usize>);

/// A nominal model whose record determines it.
pub(crate) struct Determined {
    /// The fit.
    pub(crate) nominal: FittedPlant,
    /// The parameters that are held.
    pub(crate) held: Vec<usize>,
    /// The directions that they are held for, and those that priors determine.
    pub(crate) directions: Vec<NullDirection>,
}

impl FittedPlant {
    /// The nominal model, fitted with one parameter of each direction held that the record does not determine; `start`
    /// as in [`Self::nominal_from`].
    ///
    /// # Errors
    /// As [`Self::nominal`].
    pub(crate) fn determined(
        plant: &LoadedPlant,
        record: PlantRecord,
        start: Option<&[f64]>,
    ) -> Result<Determined, PlantError> {
        let first = Self::nominal_from(plant, record, &[], start)?;
        let (held, directions) = first.to_hold()?;
        let nominal = if held.is_empty() {
            first
        } else {
            Self::nominal_from(plant, first.record().clone(), &held, start)?
        };
        Ok(Determined {
            nominal,
            held,
            directions,
        })
    }

    /// Directions of initial states and parameters that the record does not determine, priors aside.
    ///
    /// # Errors
    /// [`PlantError::Singular`], [`PlantError::NotFinite`].
    pub fn null_directions(&self) -> Result<Vec<NullDirection>, PlantError> {
        let all = self.indexed_directions()?.into_iter();
        Ok(all.map(|(direction, _)| direction).collect())
    }

    fn indexed_directions(&self) -> Result<Vec<Indexed>, PlantError> {
        let mut lines = self.lines();
        lines.truncate(self.problem.nominal());
        lines.extend(self.problem.later_starts());
        let gram = self.gram(&lines)?;
        let information = gram.view((1, 1), (lines.len(), lines.len())).into_owned();
        let scales = scales(&information);
        let null = null_space(&scaled(&information, &scales));
        if null.is_empty() {
            return Ok(Vec::new());
        }
        let others = self.random_information(&scales)?;
        Ok(null
            .iter()
            .map(|direction| self.direction(direction, &scales, &others))
            .collect())
    }

    /// Information on the parameters, scaled, of random records, their initial states free.
    fn random_information(&self, scales: &DVector<f64>) -> Result<DMatrix<f64>, PlantError> {
        let problem = &self.problem;
        let (n, nominal) = (problem.plant.description.states.len(), problem.nominal());
        let mut sum = DMatrix::zeros(nominal - n, nominal - n);
        for seed in 0..RECORDS {
            let mut draw = Draw::new(seed, 1);
            let Some(information) = self.random_record(&mut draw)? else {
                continue;
            };
            let own = scaled(&information, scales);
            // Schur complement: initial states are unknowns of that record alone.
            let states = own.view((0, 0), (n, n)).into_owned();
            let cross = own.view((0, n), (n, nominal - n)).into_owned();
            let eigen = SymmetricEigen::new(states);
            let most = eigen.eigenvalues.max().max(f64::MIN_POSITIVE);
            let mut left = own.view((n, n), (nominal - n, nominal - n)).into_owned();
            for (value, vector) in eigen
                .eigenvalues
                .iter()
                .zip(eigen.eigenvectors.column_iter())
            {
                if *value > NULL * most {
                    let along = cross.tr_mul(&vector);
                    left.ger(-value.recip(), &along, &along, 1.0);
                }
            }
            sum += left;
        }
        Ok(sum)
    }

    /// Information of a simulated record with random inputs and initial states at the fitted parameters;
    /// `None` where it leaves the numbers.
    fn random_record(&self, draw: &mut Draw) -> Result<Option<DMatrix<f64>>, PlantError> {
        let here = &self.problem;
        let description = &here.plant.description;
        let (n, u, y) = (
            description.states.len(),
            description.inputs.len(),
            description.outputs.len(),
        );
        let first = self.record().records().next().map_or(0, |rows| rows.end);
        let rows = first.min(ROWS);
        let range = |place: usize| {
            let own = self.record().inputs.iter().skip(place).step_by(u);
            let ends = [f64::INFINITY, f64::NEG_INFINITY];
            let [low, high] = own.fold(ends, |[low, high], value| {
                [low.min(*value), high.max(*value)]
            });
            // One that never moves here may move elsewhere.
            if high > low {
                [low, high]
            } else {
                [low - 1.0, low + 1.0]
            }
        };
        let mut inputs = vec![0.0; rows * u];
        for index in 0..u {
            let [low, high] = range(index);
            let mut held = 0.0;
            for row in 0..rows {
                if row % HELD_ROWS == 0 {
                    held = low + (high - low) * draw.uniform();
                }
                inputs[row * u + index] = held;
            }
        }
        let record = PlantRecord {
            time_s: self.record().time_s[..rows].to_vec(),
            inputs,
            outputs: vec![0.0; rows * y],
            regressor_means: Vec::new(),
            starts: Vec::new(),
            regressors: self
                .record()
                .regressors
                .iter()
                .map(|one| one[..rows].to_vec())
                .collect(),
        };
        let problem = Problem::new(&here.plant, Arc::new(record), here.substeps);
        let noise = self.noise.clone();
        let solver = Solver::new(&problem, &ModelExtension::default(), noise);
        let mut values = self.solution.at.values[..problem.nominal()].to_vec();
        for (index, state) in description.states.iter().enumerate() {
            let somewhere = self.points()[(draw.uniform() * rows as f64) as usize * n + index];
            values[index] = somewhere * exp(SPREAD * draw.normal()) - state.initial;
        }
        let course = solver.course(&values);
        let mut dynamics = solver.dynamics();
        let points = dynamics.simulate(&course, &problem.initial(&values));
        if !points.iter().all(|value| value.is_finite()) {
            return Ok(None);
        }
        let lin = dynamics.linearise(&course, &points)?;
        let reduced = reduce(&lin.pass(&solver.noise, &solver.lines)).ok();
        let count = solver.lines.len();
        Ok(reduced.map(|reduced| reduced.gram.view((1, 1), (count, count)).into_owned()))
    }

    fn direction(
        &self,
        direction: &DVector<f64>,
        scales: &DVector<f64>,
        others: &DMatrix<f64>,
    ) -> Indexed {
        let description = &self.problem.plant.description;
        let n = description.states.len();
        let own = direction.rows(n, description.parameters.len()).into_owned();
        let most = SymmetricEigen::new(others.clone()).eigenvalues.max();
        // A direction of initial states alone that is null is one at every input.
        let along = (others * &own).dot(&own);
        let is_gauge = along <= NULL.sqrt() * most * own.norm_squared();
        let states = description.states.iter();
        let states = states.map(|state| (format!("the initial {}", state.id), 0.0, None));
        let parameters = description.parameters.iter().enumerate();
        let parameters = parameters.map(|(index, one)| {
            let value = one.value + self.solution.at.values[n + index];
            (one.id.clone(), value, Some(index))
        });
        let later = (1..=self.record().starts.len()).flat_map(|record| {
            let states = description.states.iter();
            states.map(move |state| {
                let name = format!("the initial {} of record {}", state.id, record + 1);
                (name, 0.0, None)
            })
        });
        let mut parts: Vec<(NullPart, Option<usize>)> = states
            .chain(parameters)
            .chain(later)
            .zip(direction.iter().zip(scales.iter()))
            .map(|((name, value, parameter), (part, scale))| {
                let change = part * scale;
                let is_share = value != 0.0;
                let part = NullPart {
                    name,
                    change: if is_share { change / value } else { change },
                    is_share,
                };
                (part, parameter)
            })
            .collect();
        let largest = |shares: bool| {
            let own = parts.iter().filter(|(part, _)| part.is_share || !shares);
            own.map(|(part, _)| part.change.abs()).fold(0.0, f64::max)
        };
        let largest = match largest(true) {
            share if share > 0.0 => share,
            _ => largest(false),
        };
        for (part, _) in &mut parts {
            part.change /= largest;
        }
        let mut index = 0;
        parts.retain(|(part, _)| {
            index += 1;
            direction[index - 1].abs() > NAMED && part.change.abs() > NAMED
        });
        parts.sort_by(|(a, _), (b, _)| b.change.abs().total_cmp(&a.change.abs()));
        let parameters = parts.iter().filter_map(|(_, parameter)| *parameter);
        let parameters = parameters.collect();
        let direction = NullDirection {
            is_gauge,
            parts: parts.into_iter().map(|(part, _)| part).collect(),
            held: None,
        };
        (direction, parameters)
    }

    /// Nominal parameters to hold, one for each null direction, with the directions.
    ///
    /// # Errors
    /// As [`Self::null_directions`].
    pub fn to_hold(&self) -> Result<(Vec<usize>, Vec<NullDirection>), PlantError> {
        let mut directions = self.indexed_directions()?;
        let mut held = Vec::new();
        let parameters = &self.problem.plant.description.parameters;
        for (direction, own) in &mut directions {
            let free = own.iter().copied();
            // What has a prior needs no holding.
            let known = free
                .clone()
                .any(|index| parameters[index].sigma.is_finite());
            let mut free = free.filter(|index| !held.contains(index));
            if let Some(index) = free.next().filter(|_| !known) {
                held.push(index);
                direction.held = Some(parameters[index].id.clone());
            }
        }
        let directions = directions.into_iter().map(|(direction, _)| direction);
        Ok((held, directions.collect()))
    }
}

/// One over the root of the diagonal; of a column that is zero, one.
fn scales(information: &DMatrix<f64>) -> DVector<f64> {
    information
        .diagonal()
        .map(|own| if own > 0.0 { own.sqrt().recip() } else { 1.0 })
}

fn scaled(information: &DMatrix<f64>, scales: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(information.nrows(), information.ncols(), |i, j| {
        information[(i, j)] * scales[i] * scales[j]
    })
}

/// Directions without information.
fn null_space(information: &DMatrix<f64>) -> Vec<DVector<f64>> {
    let eigen = SymmetricEigen::new(information.clone());
    let most = eigen.eigenvalues.max();
    let all = eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter());
    all.filter(|(value, _)| **value <= NULL * most)
        .map(|(_, vector)| vector.into_owned())
        .collect()
}
