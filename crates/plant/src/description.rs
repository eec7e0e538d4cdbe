//! What a program file says of a plant beside its functions.

mod rows;

use core::f64::consts::TAU;

use gyrocal_codegen::Program;
use gyrocal_statistics::math::{cos, sin};

use crate::error::PlantError;
use rows::{channel, delay, effect, knee, rows};

/// A state.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Name.
    pub id: String,
    /// Unit.
    pub unit: String,
    /// Value at the first row before a record.
    pub initial: f64,
    /// Standard deviation of that; infinite if nothing is known.
    pub sigma: f64,
}

/// A nominal parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name.
    pub id: String,
    /// Unit.
    pub unit: String,
    /// Value before a record.
    pub value: f64,
    /// Standard deviation of that; infinite if nothing is known.
    pub sigma: f64,
    /// Whether it is above zero.
    pub positive: bool,
}

/// An input.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Name.
    pub id: String,
    /// Unit.
    pub unit: String,
    /// Whether it is interpolated between rows; it is held otherwise.
    pub interpolate: bool,
}

/// An output.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Name.
    pub id: String,
    /// Unit.
    pub unit: String,
    /// Declared standard deviation of its white noise.
    pub sigma: f64,
    /// Readings at or beyond these say nothing.
    pub saturates: Option<[f64; 2]>,
}

impl Output {
    /// Whether a reading says nothing.
    pub(crate) fn is_beyond(&self, value: f64) -> bool {
        let mut ends = self.saturates.iter();
        ends.any(|[low, high]| value <= *low || value >= *high)
    }

    /// A reading that says something.
    pub(crate) fn within(&self) -> f64 {
        match self.saturates {
            Some([low, high]) if low.is_finite() && high.is_finite() => 0.5 * (low + high),
            Some([low, _]) if low.is_finite() => low + 1.0,
            Some([_, high]) if high.is_finite() => high - 1.0,
            _ => 0.0,
        }
    }
}

/// A known period: sine and cosine of it over the logged time are regressors.
#[derive(Clone, Debug, PartialEq)]
pub struct Period {
    /// Name.
    pub id: String,
    /// The period, s.
    pub period_s: f64,
}

/// White noise of a rate.
#[derive(Clone, Debug, PartialEq)]
pub struct Noise {
    /// The state.
    pub state: usize,
    /// Root of its spectral density.
    pub density: f64,
}

/// A rate, an output or an input that effects enter.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// What effects enter.
    pub place: Place,
    /// Unit.
    pub unit: String,
    /// Name.
    pub name: String,
    /// The parameter that adds a constant to it.
    pub constant: usize,
}

/// How an effect depends on time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A term of the equations.
    Term,
    /// Proportional to time.
    Ramp,
    /// From an onset on.
    Step,
    /// Proportional to a logged quantity.
    Regressor(usize),
    /// The input acts late.
    Delay,
    /// The input has play.
    Play,
}

impl Kind {
    /// Whether its size is a parameter of the model itself, and so one that a script can write.
    #[must_use]
    pub fn is_of_the_model(self) -> bool {
        matches!(self, Self::Term | Self::Delay)
    }

    /// Whether it is a function of time alone.
    #[must_use]
    pub fn is_of_time(self) -> bool {
        matches!(self, Self::Ramp | Self::Step)
    }
}

/// Part of the model that an effect enters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The rate of a state.
    Rate(usize),
    /// An output.
    Output(usize),
    /// A nominal parameter, which it changes.
    Parameter(usize),
    /// An input, which acts otherwise than it is logged.
    Input(usize),
}

/// An effect of the catalogue.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectEntry {
    /// Public id.
    pub id: String,
    /// Meaning.
    pub name: String,
    /// The term that its size multiplies.
    pub formula: String,
    /// Unit of its size.
    pub unit: String,
    /// Dependence on time.
    pub kind: Kind,
    /// Part of the model.
    pub place: Place,
    /// The parameter that is its size, or that its function of time multiplies.
    pub size: usize,
    /// Ids of effects that no record tells from it.
    pub equivalents: Vec<String>,
}

/// Where an effect bends: a constant parameter of the model, estimated with the size of its effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Knee {
    /// The parameter that is the size of its effect.
    pub size: usize,
    /// The parameter that it is.
    pub constant: usize,
    /// Unit.
    pub unit: String,
    /// Where the search takes it to be.
    pub value: f64,
    /// Standard deviation of that.
    pub sigma: f64,
}

/// A dead time of an input: what rates see of it is what it was that long before. Before the first row of a record an
/// input is what it is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Delay {
    /// The input.
    pub input: usize,
    /// The parameter that is added to the input: what it was less what it is.
    pub constant: usize,
    /// The parameter that is the dead time, s.
    pub time: usize,
}

/// A plant, but for its functions.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// Name.
    pub name: String,
    /// Meaning.
    pub doc: String,
    /// States.
    pub states: Vec<State>,
    /// Nominal parameters.
    pub parameters: Vec<Parameter>,
    /// Inputs.
    pub inputs: Vec<Input>,
    /// Outputs.
    pub outputs: Vec<Output>,
    /// White noises of the rates.
    pub noises: Vec<Noise>,
    /// Logged quantities.
    pub regressors: Vec<String>,
    /// Known periods of waves.
    pub periods: Vec<Period>,
    /// Channels.
    pub channels: Vec<Channel>,
    /// Catalogue.
    pub effects: Vec<EffectEntry>,
    /// Knees of effects of the catalogue.
    pub knees: Vec<Knee>,
    /// Dead times: those of the model, then those that are effects.
    pub delays: Vec<Delay>,
}

impl Description {
    /// Reads the tables of a program.
    ///
    /// # Errors
    /// [`PlantError::NoPlant`] if a table or a field is missing.
    pub fn of(program: &Program) -> Result<Self, PlantError> {
        let known = |sigma: f64| if sigma > 0.0 { sigma } else { f64::INFINITY };
        let states = rows(program, "plant_states", |row| {
            Ok(State {
                id: row.text("id")?,
                unit: row.text("unit")?,
                initial: row.number("initial")?,
                sigma: known(row.number("sigma")?),
            })
        })?;
        let parameters = rows(program, "plant_parameters", |row| {
            Ok(Parameter {
                id: row.text("id")?,
                unit: row.text("unit")?,
                value: row.number("value")?,
                sigma: known(row.number("sigma")?),
                positive: row.truth("positive")?,
            })
        })?;
        let inputs = rows(program, "plant_inputs", |row| {
            Ok(Input {
                id: row.text("id")?,
                unit: row.text("unit")?,
                interpolate: row.truth("interpolate")?,
            })
        })?;
        let outputs = rows(program, "plant_outputs", |row| {
            Ok(Output {
                id: row.text("id")?,
                unit: row.text("unit")?,
                sigma: row.number("sigma")?,
                saturates: if row.truth("saturates")? {
                    Some([row.number("low")?, row.number("high")?])
                } else {
                    None
                },
            })
        })?;
        let noises = rows(program, "plant_noises", |row| {
            Ok(Noise {
                state: row.index("state")?,
                density: row.number("density")?,
            })
        })?;
        if states.is_empty() || outputs.is_empty() {
            return Err(PlantError::NoPlant {
                origin: program.origin.clone(),
                problem: "the program has no table of states or none of outputs".to_owned(),
            });
        }
        let (model_name, doc) = program
            .model
            .as_ref()
            .map_or((&program.name, &program.doc), |model| {
                (&model.name, &model.doc)
            });
        let effects = rows(program, "plant_effects", effect)?;
        let delays = rows(program, "plant_delays", delay)?;
        refuse_earlier(program, &effects, &delays)?;
        Ok(Self {
            name: model_name.clone(),
            doc: doc.clone(),
            states,
            parameters,
            inputs,
            outputs,
            noises,
            effects,
            delays,
            regressors: rows(program, "plant_regressors", |row| row.text("id"))?,
            periods: rows(program, "plant_periods", |row| {
                Ok(Period {
                    id: row.text("id")?,
                    period_s: row.number("period_s")?,
                })
            })?,
            channels: rows(program, "plant_channels", channel)?,
            knees: rows(program, "plant_knees", knee)?,
        })
    }
}

/// Refuses a program of an earlier version, in which a delay was a function of time.
fn refuse_earlier(
    program: &Program,
    effects: &[EffectEntry],
    delays: &[Delay],
) -> Result<(), PlantError> {
    let has_time = |one: &EffectEntry| delays.iter().any(|delay| delay.time == one.size);
    let mut effects = effects.iter();
    match effects.find(|one| one.kind == Kind::Delay && !has_time(one)) {
        None => Ok(()),
        Some(late) => Err(PlantError::NoPlant {
            origin: program.origin.clone(),
            problem: format!(
                "the effect `{}` has no dead time, as an earlier version wrote it: run the script again",
                late.id
            ),
        }),
    }
}

impl Description {
    /// The knee of a term of the catalogue, if it has one.
    pub(crate) fn knee_of(&self, entry: &EffectEntry) -> Option<&Knee> {
        let is_term = entry.kind == Kind::Term;
        let mut knees = self.knees.iter();
        knees.find(|knee| is_term && knee.size == entry.size)
    }

    /// Number of logged quantities and of waves.
    pub(crate) fn regressor_count(&self) -> usize {
        self.regressors.len() + 2 * self.periods.len()
    }

    /// The waves at some times: of each period the sine, then the cosine.
    pub(crate) fn waves(&self, time_s: &[f64]) -> Vec<Vec<f64>> {
        let of = |wave: fn(f64) -> f64, period_s: f64| -> Vec<f64> {
            let phases = time_s.iter().map(|time| TAU * (time / period_s));
            phases.map(wave).collect()
        };
        let periods = self.periods.iter();
        periods
            .flat_map(|one| [of(sin, one.period_s), of(cos, one.period_s)])
            .collect()
    }
}
