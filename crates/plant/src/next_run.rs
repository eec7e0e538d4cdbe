//! What a run that has not been made would tell: standard deviations after it, and whether what may be the cause
//! is told apart.
//!
//! The run is simulated by the model with all findings. Information of its rows on parameters and effects is
//! added to that of the records (Lindley, Ann. Math. Stat. 27, 986, 1956; Box and Hill, Technometrics 9, 57,
//! 1967).

use std::sync::{Arc, OnceLock};

use crate::linearised::reduce;
use gyrocal_answer::{AlternativeKind, Coefficients, Finding, NextRun, NextSigma, ToldApart};
use gyrocal_hypothesis::{CONFIDENCE_SET_DEVIANCE, FittedModel as _};
use gyrocal_inference::{Column, stop};
use gyrocal_scalar::effect::Effect;
use gyrocal_statistics::normal_probability;
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::diagnosed::Diagnosed;
use crate::dynamics::Dynamics;
use crate::error::PlantError;
use crate::first_values::KNEES;
use crate::fitted::FittedPlant;
use crate::later_starts::eliminated;
use crate::lines::{Course, initial, parameters_of};
use crate::prediction::least_prior;
use crate::problem::Problem;
use crate::record::{NamedRecord, PlantRecord};
use crate::solve::{Solution, Solver};
use gyrocal_words::plant::mean_ratio;

/// Information on parameters of the model, by their index in the table of the plant, from the records and from a run.
struct Informed<'a> {
    fitted: &'a FittedPlant,
    /// Parameters of the model: nominal ones, then those of effects.
    unknowns: Vec<usize>,
    /// Now, and after the run; then the same with the knees of rivals elsewhere.
    all: Vec<[DMatrix<f64>; 2]>,
}

impl Diagnosed {
    /// Adds forecasts of runs that could be made next to the answer. A run has the inputs of its record and begins
    /// with the initial states of the first one; its outputs are not used. Effects that begin at one time belong to
    /// their record and are not in it.
    ///
    /// # Errors
    /// [`PlantError::Input`] of a run in which the model leaves the numbers, [`PlantError::Singular`].
    pub fn forecast(&mut self, runs: Vec<NamedRecord>) -> Result<(), PlantError> {
        let forecasts = runs.into_iter().map(|run| self.next_run(run));
        let mut forecasts: Vec<NextRun> = stop::finished(forecasts.collect::<Result<_, _>>())?;
        forecasts.sort_by(|a, b| {
            let told = least_probability(b).total_cmp(&least_probability(a));
            told.then(mean_ratio(a).total_cmp(&mean_ratio(b)))
        });
        self.answer.next_runs = forecasts;
        Ok(())
    }

    fn next_run(&self, run: NamedRecord) -> Result<NextRun, PlantError> {
        let NamedRecord { name, record: run } = run;
        let fitted = &self.searched.fitted;
        let (rows, duration_s) = (run.len(), run.duration_s());
        let informed =
            Informed::new(fitted, &self.answer.findings, run).map_err(|error| match error {
                PlantError::NotFinite { row } => PlantError::Input {
                    origin: name.clone(),
                    problem: format!("the model gives no finite numbers from row {row} on"),
                    advice: "give inputs that the plant bears".to_owned(),
                },
                other => other,
            })?;
        Ok(NextRun {
            name,
            rows,
            duration_s,
            sigmas: informed.sigmas(self)?,
            told_apart: informed.told_apart(&self.answer.findings),
        })
    }
}

/// The smallest probability with which an alternative leaves its set; one without alternatives.
fn least_probability(run: &NextRun) -> f64 {
    let all = run.told_apart.iter().map(|one| one.probability);
    all.fold(1.0, f64::min)
}

/// The other effects of the set of a finding.
fn rivals(finding: &Finding) -> impl Iterator<Item = &str> {
    let all = finding.of_kind(AlternativeKind::NotExcluded);
    all.map(|other| &*other.effect)
}

/// An effect whose columns another record has too.
fn lasting(fitted: &FittedPlant, effect: &str) -> Option<&'static Effect> {
    let row = fitted.plant().effect(effect)?;
    (row.has_term() && row.shape().is_none()).then_some(row)
}

impl<'a> Informed<'a> {
    fn new(
        fitted: &'a FittedPlant,
        findings: &[Finding],
        run: PlantRecord,
    ) -> Result<Self, PlantError> {
        let description = &fitted.loaded().description;
        let states = description.states.len();
        let mut unknowns: Vec<usize> = (states..fitted.problem.nominal()).collect();
        let own = fitted.extension().parameters.iter();
        unknowns.extend(own.map(|(parameter, _)| *parameter));
        let rivals = findings.iter().flat_map(rivals);
        let rivals: Vec<&Effect> = rivals.filter_map(|rival| lasting(fitted, rival)).collect();
        unknowns.extend(rivals.iter().flat_map(|row| row.model_parameters()));
        let has_knee = rivals.iter().any(|row| row.has_knee());
        let mut seen = Vec::with_capacity(unknowns.len());
        unknowns.retain(|parameter| {
            let new = !seen.contains(parameter);
            seen.push(*parameter);
            new
        });
        let sigmas = &fitted.problem.prior_sigma[..states];
        let pairs = description.states.iter().zip(sigmas);
        let sigmas: Vec<f64> = pairs
            .map(|(state, sigma)| least_prior(state, *sigma))
            .collect();
        // What belongs to the record comes last, to be eliminated: its initial states, and its own columns.
        let table = fitted.plant().parameters.len();
        let own = &fitted.extension().columns;
        let parameters = unknowns.iter().copied().chain(0..states);
        let places = parameters.chain(table..table + own.columns().len());
        let columns: Vec<usize> = core::iter::once(0)
            .chain(places.map(|place| place + 1))
            .collect();
        // A rival of no size has no derivative by its knee, and is as near as the nearest of a grid.
        let knees = if has_knee { &KNEES[..] } else { &KNEES[..1] };
        let run = with_no_outputs(run);
        let all = knees.iter().map(|share| {
            let gram = fitted.signatures_gram_at(*share)?;
            let gram = gram.select_rows(&columns).select_columns(&columns);
            let mut now = without_last(gram, &[&sigmas, own.sigmas()].concat())?;
            for (place, parameter) in unknowns.iter().enumerate() {
                let problem = &fitted.problem;
                let nominal = problem.prior_sigma.get(*parameter).copied();
                if let Some(sigma) = nominal.or_else(|| problem.sigma_of_knee(*parameter)) {
                    now[(place, place)] += sigma.powi(-2);
                }
            }
            let run = without_last(fitted.gram_of(&run, &unknowns, *share)?, &sigmas)?;
            Ok([now.clone(), now + run])
        });
        Ok(Self {
            all: all.collect::<Result<_, PlantError>>()?,
            fitted,
            unknowns,
        })
    }

    fn places(&self, row: &Effect) -> Option<Vec<usize>> {
        let place = |parameter| self.unknowns.iter().position(|own| *own == parameter);
        row.model_parameters().map(place).collect()
    }

    /// Places of what is in the fitted model.
    fn fitted_places(&self) -> Vec<usize> {
        let count = self.fitted.loaded().description.parameters.len();
        (0..count + self.fitted.extension().parameters.len()).collect()
    }

    /// Of parameters and of the sizes of findings.
    fn sigmas(&self, diagnosed: &Diagnosed) -> Result<Vec<NextSigma>, PlantError> {
        let places = self.fitted_places();
        let variances = |all: &DMatrix<f64>| {
            let own = all.select_rows(&places).select_columns(&places);
            let cholesky = Cholesky::new(own).ok_or(PlantError::Singular)?;
            Ok::<_, PlantError>(cholesky.inverse().diagonal())
        };
        let Some([now, after]) = self.all.first() else {
            return Ok(Vec::new());
        };
        let (now, after) = (variances(now)?, variances(after)?);
        let ratio = |place: usize| (after[place] / now[place]).sqrt();
        let forecast = |name: String, unit: &str, sigma: f64, place: usize| NextSigma {
            name,
            unit: unit.to_owned(),
            now: sigma,
            after: sigma * ratio(place),
        };
        let answer = &diagnosed.answer;
        let parameters = answer.coefficients.iter();
        let parameters = parameters.flat_map(Coefficients::best).zip(0..);
        let count = self.fitted.loaded().description.parameters.len();
        let mut all: Vec<NextSigma> = parameters
            .take(count)
            .map(|(one, place)| forecast(one.name.clone(), &one.unit, one.sigma, place))
            .collect();
        for found in &answer.findings {
            let row = lasting(self.fitted, &found.effect);
            let places = row.and_then(|row| self.places(row)).unwrap_or_default();
            for (size, place) in found.parameters.iter().zip(places) {
                if let Some(sigma) = size.sigma {
                    let name = format!("{} {}", found.effect, size.name);
                    all.push(forecast(name, &size.unit, sigma, place));
                }
            }
        }
        Ok(all)
    }

    /// Each named effect against each of its rivals.
    fn told_apart(&self, findings: &[Finding]) -> Vec<ToldApart> {
        let mut all = Vec::new();
        for found in findings {
            let named = lasting(self.fitted, &found.effect);
            let Some(named) = named.and_then(|row| self.places(row)) else {
                continue;
            };
            for rival in rivals(found) {
                let row = lasting(self.fitted, rival).and_then(|row| self.places(row));
                let distances = row.map(|rival| {
                    [0, 1].map(|time: usize| {
                        let all = self.all.iter();
                        let all = all.filter_map(|own| self.distance(&own[time], &named, &rival));
                        all.min_by(f64::total_cmp)
                    })
                });
                let Some([Some(now), Some(after)]) = distances else {
                    continue;
                };
                // The deviance between both is normal about the squared distance, with twice it as deviation.
                let beyond = (after * after - CONFIDENCE_SET_DEVIANCE) / (2.0 * after);
                all.push(ToldApart {
                    effect: found.effect.clone(),
                    alternative: rival.to_owned(),
                    now,
                    after,
                    probability: if after > 0.0 {
                        normal_probability(beyond)
                    } else {
                        0.0
                    },
                });
            }
        }
        all
    }

    /// How far the named effect at its size is from the best fit with its rival in its place, in standard deviations.
    fn distance(&self, all: &DMatrix<f64>, named: &[usize], rival: &[usize]) -> Option<f64> {
        let mut beside = self.fitted_places();
        beside.retain(|place| !named.contains(place));
        beside.extend(rival.iter().filter(|place| !named.contains(place)));
        // What the named effect adds is its size times what that multiplies, with the knee where it is.
        let problem = &self.fitted.problem;
        let is_knee = |place: usize| problem.sigma_of_knee(self.unknowns[place]).is_some();
        let named: Vec<usize> = named
            .iter()
            .copied()
            .filter(|place| !is_knee(*place))
            .collect();
        let named = &named[..];
        let inner = all.select_rows(&beside).select_columns(&beside);
        let cross = all.select_rows(&beside).select_columns(named);
        let own = all.select_rows(named).select_columns(named);
        let left = own - cross.tr_mul(&Cholesky::new(inner)?.solve(&cross));
        let value = |place: &usize| self.fitted.value_of(self.unknowns[*place]);
        let sizes = DVector::from_iterator(named.len(), named.iter().map(value));
        Some((&left * &sizes).dot(&sizes).max(0.0).sqrt())
    }
}

/// A run whose outputs say nothing.
fn with_no_outputs(mut run: PlantRecord) -> Arc<PlantRecord> {
    run.outputs.fill(0.0);
    Arc::new(run)
}

/// Information of a Gram matrix on all but its last columns, which have these standard deviations before it.
fn without_last(gram: DMatrix<f64>, sigmas: &[f64]) -> Result<DMatrix<f64>, PlantError> {
    let left = eliminated(gram, &vec![0.0; sigmas.len()], sigmas)?;
    let count = left.nrows() - 1;
    Ok(left.view((1, 1), (count, count)).into_owned())
}

impl FittedPlant {
    /// Value of a parameter of the model in the fit; zero of an effect that is not in it.
    fn value_of(&self, parameter: usize) -> f64 {
        let nominal = self.problem.nominal();
        if parameter < nominal {
            return self.values()[parameter];
        }
        let mut own = self.extension().parameters.iter();
        let place = own.position(|(other, _)| *other == parameter);
        place.map_or(0.0, |place| self.values()[nominal + place])
    }

    /// Moves the knees of effects that are not in the model to so much of where the search takes them to be.
    fn move_knees(&self, course: &mut Course, share: f64) {
        let description = &self.problem.plant.description;
        let states = description.states.len();
        for knee in &description.knees {
            let mut own = self.extension().parameters.iter();
            if !own.any(|(parameter, _)| *parameter == states + knee.constant) {
                course.constant[knee.constant] = share * knee.value;
            }
        }
    }

    /// [`FittedModel::signatures_gram`] of nothing further, with the knees of effects that are not in the model moved.
    fn signatures_gram_at(&self, share: f64) -> Result<DMatrix<f64>, PlantError> {
        if share == 1.0 {
            return self.signatures_gram(&[]);
        }
        let mut moved = self.clone();
        let problem = &*self.problem;
        let solver = Solver::new(problem, self.extension(), self.noise.clone());
        let mut course = solver.course(&self.solution.at.values);
        self.move_knees(&mut course, share);
        let mut dynamics = Dynamics::new(&problem.plant, &problem.record, problem.substeps);
        let whole = dynamics.linearise(&course, self.points())?;
        moved.solution = Arc::new(Solution {
            lin: whole,
            whole: OnceLock::new(),
            ..(*self.solution).clone()
        });
        moved.signatures_gram(&[])
    }

    /// Gram matrix of a run that the model simulates: nothing, columns of parameters of the model, initial states. The
    /// knees of effects that are not in it are moved.
    fn gram_of(
        &self,
        run: &Arc<PlantRecord>,
        unknowns: &[usize],
        share: f64,
    ) -> Result<DMatrix<f64>, PlantError> {
        let plant = &self.problem.plant;
        let (states, outputs) = (plant.description.states.len(), &plant.description.outputs);
        let problem = Problem::new(plant, Arc::clone(run), self.problem.substeps);
        let mut base = Course::declared(plant);
        self.move_knees(&mut base, share);
        let mut lines = Vec::with_capacity(unknowns.len() + states);
        for parameter in unknowns {
            let line = self.in_later(*parameter, run);
            // What another record does not have is a change of nothing.
            let line = line.unwrap_or_else(|| Column::Output {
                output: 0,
                change: Arc::from([]),
            });
            base.add(&line, self.value_of(*parameter));
            lines.push(line);
        }
        lines.extend((0..states).map(initial));
        let solver = Solver {
            problem: &problem,
            lines: Vec::new(),
            sigmas: Vec::new(),
            noise: self.noise.clone(),
            parameters: parameters_of(&lines),
            base,
        };
        let mut dynamics = solver.dynamics();
        let first = problem.initial(&self.values()[..states]);
        let points = dynamics.simulate(&solver.base, &first);
        if let Some(place) = points.iter().position(|value| !value.is_finite()) {
            return Err(PlantError::NotFinite {
                row: place / states + 1,
            });
        }
        let mut lin = dynamics.linearise(&solver.base, &points)?;
        for (residual, output) in lin.rows.residuals.iter_mut().zip(outputs.iter().cycle()) {
            let simulated = -*residual;
            if output.is_beyond(simulated) {
                *residual = f64::NAN;
            }
        }
        Ok(reduce(&lin.pass(&solver.noise, &lines))?.gram)
    }
}
