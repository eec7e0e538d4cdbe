//! What the effects of a search are worth in parts of the record that are left out of the fit.
//!
//! A likelihood takes noise as it is believed. Where what is left is not white, it also takes what bends a model to
//! these rows. So each effect must lower the error of simulations of four contiguous parts, each left out of the fit
//! in its turn: that of one output by two per cent over all parts, and in three of the four. This only takes effects
//! away, so that the rate of false alarms of the search stands. Parts do not refute a sudden change, whose onset and
//! size both sides tell: one is named only if the next function of time gains less than a quarter of it. An effect
//! with which a simulation leaves all bounds where the inputs swing by half as much again is no cause either.

use core::ops::Range;
use std::sync::Arc;

use gyrocal_answer::{PathError, PathStep, Refusal};
use gyrocal_hypothesis::{FittedModel as _, ModelExtension, Searched};
use gyrocal_statistics::math::ln;

use crate::dynamics::Dynamics;
use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::problem::Problem;
use crate::record::PlantRecord;
use crate::simulation::{rms, squares};
use crate::solve::Solver;

/// Parts of each record. The rows before them determine its initial states in each fit.
const PARTS: usize = 4;
const BEFORE: usize = 10;

/// Share by which an effect lowers the root mean square of an output over all parts, and parts in which it is lower.
/// Beside nothing hidden an effect seldom does so by chance in three of four parts; an end that is left out alone passes
/// effects that are not there. `cargo figures plants --part simulated` counts both kinds of error.
const LEAST_FALL: f64 = 0.02;
const LEAST_PARTS: usize = 3;

/// Share of the gain of a function of time that the next one may have. Beside a true change the next has next to none;
/// where the course of time is another than any of the catalogue, it has most of it.
const NEXT_GAIN: f64 = 0.25;

/// Swing of the inputs over that of the record, and the size of a state over that in the record, that bound a model.
const SWING: f64 = 1.5;
const BOUND: f64 = 1000.0;

/// All terms outside of the catalogue, as an effect of the path.
pub(crate) const UNLISTED: &str = "unlisted terms";

/// A model on the path, fitted to all rows, and its errors.
struct Model {
    fitted: FittedPlant,
    /// Sums of squares and numbers of values, by output and part.
    left_out: Vec<[(f64, usize); PARTS]>,
    /// By output, over all rows.
    whole: Vec<(f64, usize)>,
}

/// The nominal model, then each effect of a search, in the order in which they were found, beside those before it that
/// stand. Empty of a plant that declares noise of rates: it has no simulation over whole parts. `refused_gains` are
/// gains of functions of time that left-out parts of this record refused; those of this search come to them.
///
/// # Errors
/// Those of the nominal fit in white noise.
pub(crate) fn by_parts(
    searched: &Searched<FittedPlant>,
    later: Option<&Arc<PlantRecord>>,
    refused_gains: &mut Vec<f64>,
) -> Result<Vec<PathStep>, PlantError> {
    let description = &searched.fitted.loaded().description;
    if !description.noises.is_empty() {
        return Ok(Vec::new());
    }
    let nominal = searched.nominal.in_white_noise()?;
    let mut model = Model::new(nominal)?;
    let is_bounded = model.fitted.is_bounded();
    let mut path = vec![model.step(None, None, later)];
    let mut stands = vec![false; searched.sizes().len()];
    // Functions of time that stand: place in the path, and gain of the logarithm of the likelihood.
    let mut of_time: Vec<(usize, f64)> = Vec::new();
    for place in 0..stands.len() {
        stands[place] = true;
        let effect = searched.findings[place].effect;
        let next = model.with(&searched.effects_alone(&stands));
        let refused = match &next {
            Ok(next) if !next.is_better_than(&model) => Some(Refusal::LeftOutParts),
            Ok(next) if is_bounded && !next.fitted.is_bounded() => Some(Refusal::Diverges),
            Ok(_) => None,
            Err(_) => Some(Refusal::LeftOutParts),
        };
        stands[place] = refused.is_none();
        let Ok(next) = next else {
            path.push(without_fit(effect, refused));
            continue;
        };
        let mut own = description.effects.iter();
        if own.any(|own| own.id == effect && own.kind.is_of_time()) {
            let gain = next.gain_over(&model);
            match refused {
                None => of_time.push((path.len(), gain)),
                Some(_) => refused_gains.push(gain),
            }
        }
        path.push(next.step(Some(effect), refused, later));
        if refused.is_none() {
            model = next;
        }
    }
    if !searched.unmodelled.is_empty() {
        let next = model.with(&searched.extension_with(&stands));
        let stands = next.as_ref().is_ok_and(|next| next.is_better_than(&model));
        let refused = (!stands).then_some(Refusal::LeftOutParts);
        path.push(match &next {
            Ok(next) => next.step(Some(UNLISTED), refused, later),
            Err(_) => without_fit(UNLISTED, refused),
        });
    }
    let has_rival = |(place, gain): &(usize, f64)| {
        let others = of_time.iter().filter(|(other, _)| other != place);
        let mut others = others.map(|(_, gain)| gain).chain(refused_gains.iter());
        others.any(|other| *other > NEXT_GAIN * gain)
    };
    if of_time.iter().any(has_rival) {
        for (place, _) in of_time {
            path[place].refused = Some(Refusal::FunctionsOfTime);
        }
    }
    Ok(path)
}

fn without_fit(effect: &str, refused: Option<Refusal>) -> PathStep {
    PathStep {
        effect: Some(effect.to_owned()),
        outputs: Vec::new(),
        refused,
    }
}

impl Model {
    fn new(fitted: FittedPlant) -> Result<Self, PlantError> {
        let record = fitted.record();
        let outputs = fitted.loaded().description.outputs.len();
        let mut left_out = vec![[(0.0, 0); PARTS]; outputs];
        for part in 0..PARTS {
            let rows = part_of(record, part);
            let others = fitted.without(&rows)?;
            let simulated = others.simulated();
            for (output, own) in left_out.iter_mut().enumerate() {
                own[part] = squares(record, &simulated, output, rows.iter().cloned().flatten());
            }
        }
        let simulated = fitted.simulated();
        let whole = (0..outputs).map(|output| squares(record, &simulated, output, 0..record.len()));
        Ok(Self {
            whole: whole.collect(),
            left_out,
            fitted,
        })
    }

    /// The same with another extension.
    fn with(&self, extension: &ModelExtension) -> Result<Self, PlantError> {
        self.fitted.refitted(extension).and_then(Self::new)
    }

    /// Whether an output is simulated better where it was left out, by enough and in most parts, and all outputs
    /// together not worse.
    fn is_better_than(&self, before: &Self) -> bool {
        let pairs = || self.left_out.iter().zip(&before.left_out);
        let improves = pairs().any(|(own, before)| {
            let parts = own.iter().zip(before);
            let better = parts.filter(|(own, before)| own.0 < before.0).count();
            rms(own) <= (1.0 - LEAST_FALL) * rms(before) && better >= LEAST_PARTS
        });
        // Outputs have different units: each counts by its ratio.
        let ratios = pairs().filter(|(_, before)| rms(*before) > 0.0);
        let together: f64 = ratios.map(|(own, before)| ln(rms(own) / rms(before))).sum();
        improves && together < 0.0
    }

    /// Gain of the logarithm of the likelihood in white noise of the size that each model leaves.
    fn gain_over(&self, before: &Self) -> f64 {
        let pairs = self.whole.iter().zip(&before.whole);
        let gains = pairs.filter(|(own, before)| own.0 > 0.0 && before.0 > 0.0);
        gains
            .map(|(own, before)| 0.5 * own.1 as f64 * ln(before.0 / own.0))
            .sum()
    }

    fn step(
        &self,
        effect: Option<&str>,
        refused: Option<Refusal>,
        later: Option<&Arc<PlantRecord>>,
    ) -> PathStep {
        // A model that cannot be brought to the later record has no error there.
        let predicted = later.and_then(|later| {
            let simulated = self.fitted.predict(later).ok()?.simulated;
            Some((later, simulated))
        });
        let outputs = self.fitted.loaded().description.outputs.iter();
        let errors = outputs.enumerate().map(|(index, output)| {
            let later = predicted
                .as_ref()
                .map(|(later, simulated)| rms(&[squares(later, simulated, index, 0..later.len())]));
            PathError {
                output: output.id.clone(),
                unit: output.unit.clone(),
                left_out: Some(rms(&self.left_out[index])).filter(|rms| rms.is_finite()),
                later: later.filter(|rms| rms.is_finite()),
            }
        });
        PathStep {
            effect: effect.map(str::to_owned),
            outputs: errors.collect(),
            refused,
        }
    }
}

/// Rows of one part: a piece of each record.
fn part_of(record: &PlantRecord, part: usize) -> Vec<Range<usize>> {
    let pieces = record.records().map(|rows| {
        let first = rows.start + rows.len() / BEFORE;
        let end = |part: usize| first + part * (rows.end - first) / PARTS;
        end(part)..end(part + 1)
    });
    pieces.collect()
}

/// Root mean square errors of each output in the parts that were left out of the fit; `None` where a simulation leaves
/// the finite numbers. Empty of a plant that declares noise of rates.
///
/// # Errors
/// Those of a fit to the other parts.
pub(crate) fn left_out_rms(fitted: &FittedPlant) -> Result<Vec<Option<f64>>, PlantError> {
    if !fitted.loaded().description.noises.is_empty() {
        return Ok(Vec::new());
    }
    let model = Model::new(fitted.clone())?;
    let all = model.left_out.iter().map(|parts| rms(parts));
    Ok(all
        .map(|rms| Some(rms).filter(|rms| rms.is_finite()))
        .collect())
}

impl FittedPlant {
    /// The same model in white noise alone, of the size that it then leaves.
    pub(crate) fn in_white_noise(&self) -> Result<Self, PlantError> {
        let white = self.noise.loosened(Vec::new());
        let found = self.with_noise_problem(|unknown| unknown.sizes(&white, &[]))?;
        self.in_noise(found.noise)
    }

    /// The same model fitted without the readings of some rows.
    fn without(&self, rows: &[Range<usize>]) -> Result<Self, PlantError> {
        let mut record = self.record().clone();
        let outputs = self.loaded().description.outputs.len();
        for row in rows.iter().cloned().flatten() {
            record.outputs[row * outputs..][..outputs].fill(f64::NAN);
        }
        self.on_record(record)
    }

    /// Whether its states stay within bounds where the inputs swing more than in the record.
    fn is_bounded(&self) -> bool {
        let mut record = self.record().clone();
        let inputs = self.loaded().description.inputs.len();
        for input in 0..inputs {
            let own = || self.record().inputs.iter().skip(input).step_by(inputs);
            let mean = own().sum::<f64>() / record.len() as f64;
            let places = record.inputs.iter_mut().skip(input).step_by(inputs);
            for (value, own) in places.zip(own()) {
                *value = mean + SWING * (own - mean);
            }
        }
        let own = &*self.problem;
        let problem = Problem {
            record: Arc::new(record),
            ..own.clone()
        };
        let values = &self.solution.at.values;
        let course = Solver::new(own, self.extension(), self.noise.clone()).course(values);
        let mut dynamics = Dynamics::new(&problem.plant, &problem.record, problem.substeps);
        let points = dynamics.simulate(&course, &problem.initial(values));
        let states = self.loaded().description.states.len();
        (0..states).all(|state| {
            let size = |points: &[f64]| {
                let own = points.iter().skip(state).step_by(states);
                own.fold(0.0, |most: f64, value| most.max(value.abs()))
            };
            // A comparison that says no to what is no number.
            let all_finite = points.iter().all(|value| value.is_finite());
            all_finite && size(&points) <= BOUND * size(self.points()).max(f64::MIN_POSITIVE)
        })
    }
}
