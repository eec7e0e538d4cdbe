//! The catalogue of a plant as tables of `gyrocal-hypothesis`.
//!
//! Parameters of these tables are, in this order: initial values of the states; nominal parameters; sizes
//! of terms; sizes of functions of time, which multiply another parameter. Values of initial states and
//! nominal parameters are differences from the declared ones, so that priors have mean zero.
//!
//! The search takes tables of the whole run of a program: a plant is loaded once and stays.

use gyrocal_hypothesis::{Plant, WeightInputs};
use gyrocal_scalar::Element;
use gyrocal_scalar::effect::{
    Channel, Continuation, Effect, EffectKind, EffectParameter, Enters, Equivalence, Role,
};

use crate::description::{Description, EffectEntry, Kind, Place};

/// A function of time times a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Modulated {
    /// The parameter of the model.
    pub(crate) of: usize,
    /// Output whose rows it changes, if it is none of a step.
    pub(crate) output: Option<usize>,
    /// Its course.
    pub(crate) course: Modulation,
}

/// A course over a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Modulation {
    /// A weight of the tables.
    Weight(usize),
    /// Play of an input.
    Play(usize),
}

/// Tables, and what the sizes of functions of time multiply.
#[derive(Clone, Debug)]
pub(crate) struct Catalogue {
    pub(crate) plant: &'static Plant,
    pub(crate) modulated: Vec<Modulated>,
    /// Names of states, then inputs.
    pub(crate) covariates: Vec<&'static str>,
}

/// Name of a knee among the parameters of an effect.
pub(crate) const KNEE: &str = "knee";

/// Weight of time in hours; regressors and steps follow it.
const RAMP: usize = 0;

/// Time in hours, each regressor, the share of an interval after each onset.
fn weights(inputs: &WeightInputs<'_>, weights: &mut [f64]) {
    weights[RAMP] = inputs.time_s / 3600.0;
    let rest = &mut weights[RAMP + 1..];
    let after = |onset: &f64| ((inputs.time_s - onset) / inputs.interval_s + 0.5).clamp(0.0, 1.0);
    let regressors = rest.len().saturating_sub(inputs.shapes.len());
    for (index, weight) in rest.iter_mut().enumerate() {
        *weight = match index.checked_sub(regressors) {
            None => inputs.regressors.get(index).copied().unwrap_or(0.0),
            Some(shape) => inputs.shapes.get(shape).map_or(0.0, after),
        };
    }
}

/// A text of the whole run of a program.
fn kept(text: &str) -> &'static str {
    Box::leak(text.to_owned().into_boxed_str())
}

fn kept_all<T>(all: Vec<T>) -> &'static [T] {
    Box::leak(all.into_boxed_slice())
}

fn element(id: &str, unit: &str, doc: &str) -> Element {
    let id = kept(id);
    Element {
        name: id,
        id,
        unit: kept(unit),
        doc: kept(doc),
    }
}

/// Tables in the making.
struct Builder<'d> {
    description: &'d Description,
    /// Parameters of the model.
    sizes: usize,
    states: usize,
    rates: Vec<Channel>,
    rate_states: Vec<usize>,
    /// The nominal parameter or the input that each channel beyond those of rates is.
    changed: Vec<Place>,
    modulated: Vec<Modulated>,
    shapes: Vec<Element>,
    elements: Vec<Element>,
}

impl Catalogue {
    /// The tables of a plant whose model has `sizes` parameters.
    pub(crate) fn new(description: &Description, sizes: usize) -> Self {
        let states = description.states.len();
        let mut builder = Builder {
            description,
            sizes,
            states,
            rates: Vec::new(),
            rate_states: Vec::new(),
            changed: Vec::new(),
            modulated: Vec::new(),
            shapes: Vec::new(),
            elements: Vec::new(),
        };
        builder.parameters();
        builder.channels();
        let effects = description.effects.iter();
        let effects: Vec<Effect> = effects.map(|entry| builder.effect(entry)).collect();
        let outputs = description.channels.iter();
        let outputs = outputs.filter(|one| matches!(one.place, Place::Output(_)));
        let outputs = outputs.map(|one| Channel {
            id: kept(&one.name),
            name: kept(&one.name),
            unit: kept(&one.unit),
            label: "",
            constant: states + one.constant,
        });
        let plant = Plant {
            effects: kept_all(effects),
            parameters: kept_all(builder.elements),
            nominal_parameters: states + description.parameters.len(),
            rates: kept_all(builder.rates),
            rate_states: kept_all(builder.rate_states),
            outputs: kept_all(outputs.collect()),
            moving_states: states,
            weight_count: 1 + description.regressor_count() + builder.shapes.len(),
            shapes: kept_all(builder.shapes),
            weights,
            natural_periods_s: &[],
        };
        Self {
            plant: Box::leak(Box::new(plant)),
            modulated: builder.modulated,
            covariates: states_and_inputs(description).map(kept).collect(),
        }
    }
}

fn states_and_inputs(description: &Description) -> impl Iterator<Item = &str> {
    let states = description.states.iter().map(|state| state.id.as_str());
    let inputs = description.inputs.iter().map(|input| input.id.as_str());
    states.chain(inputs)
}

impl<'d> Builder<'d> {
    fn parameters(&mut self) {
        for state in &self.description.states {
            let id = format!("initial {}", state.id);
            self.elements.push(element(&id, &state.unit, &id));
        }
        for parameter in &self.description.parameters {
            let (id, unit) = (&parameter.id, &parameter.unit);
            self.elements.push(element(id, unit, id));
        }
        for size in self.description.parameters.len()..self.sizes {
            let id = format!("size {size}");
            self.elements.push(element(&id, "1", &id));
        }
    }

    fn channels(&mut self) {
        for one in &self.description.channels {
            let Place::Rate(state) = one.place else {
                continue;
            };
            self.rates.push(Channel {
                id: kept(&one.name),
                name: kept(&one.name),
                unit: kept(&one.unit),
                label: "",
                constant: self.states + one.constant,
            });
            self.rate_states.push(state);
        }
    }

    /// The channel of a rate, or that of a parameter or an input, which is made.
    fn rate_channel(&mut self, place: Place) -> Option<usize> {
        match place {
            Place::Rate(state) => self.rate_states.iter().position(|one| *one == state),
            Place::Output(_) => None,
            Place::Parameter(_) | Place::Input(_) => {
                let first = self.rates.len() - self.changed.len();
                let known = self.changed.iter().position(|one| *one == place);
                if let Some(known) = known {
                    return Some(first + known);
                }
                let (id, unit, constant) = self.changed_channel(place)?;
                self.changed.push(place);
                self.rates.push(Channel {
                    id: kept(id),
                    name: kept(id),
                    unit: kept(unit),
                    label: "",
                    constant: self.states + constant,
                });
                let state = self.rate_states.first().copied().unwrap_or(0);
                self.rate_states.push(state);
                Some(self.rates.len() - 1)
            }
        }
    }

    /// Id and unit of a parameter or an input, and the parameter of the model that changes it.
    fn changed_channel(&self, place: Place) -> Option<(&'d str, &'d str, usize)> {
        let description = self.description;
        match place {
            Place::Parameter(index) => {
                let own = &description.parameters[index];
                Some((&own.id, &own.unit, index))
            }
            Place::Input(_) => {
                let mut channels = description.channels.iter();
                let own = channels.find(|one| one.place == place)?;
                Some((&own.name, &own.unit, own.constant))
            }
            Place::Rate(_) | Place::Output(_) => None,
        }
    }

    fn effect(&mut self, entry: &EffectEntry) -> Effect {
        let (place, unit) = (entry.place, kept(&entry.unit));
        let channel = self.rate_channel(place);
        let enters = match (place, channel) {
            (Place::Output(output), _) => Enters::Outputs(kept_all(vec![output])),
            (_, Some(channel)) => Enters::Rates(kept_all(vec![channel])),
            _ => Enters::Rates(&[]),
        };
        let size = |role, weight| EffectParameter {
            name: "size",
            unit,
            role,
            scale: 1.0,
            weight,
        };
        let (kind, parameters) = match entry.kind {
            Kind::Term | Kind::Delay => {
                let own = Role::Parameter(self.states + entry.size);
                let knee = self.description.knee_of(entry).map(|knee| EffectParameter {
                    name: KNEE,
                    unit: kept(&knee.unit),
                    role: Role::Knee(self.states + knee.constant),
                    scale: 1.0,
                    weight: None,
                });
                let all = core::iter::once(size(own, None)).chain(knee);
                (EffectKind::Constant, all.collect())
            }
            Kind::Ramp => {
                let own = self.modulated(entry, Modulation::Weight(RAMP));
                (EffectKind::Ramp, vec![size(own, Some(RAMP))])
            }
            Kind::Regressor(index) => {
                let weight = RAMP + 1 + index;
                let own = self.modulated(entry, Modulation::Weight(weight));
                (EffectKind::Regressor, vec![size(own, Some(weight))])
            }
            Kind::Play => {
                let input = match place {
                    Place::Input(input) => input,
                    _ => 0,
                };
                let own = self.modulated(entry, Modulation::Play(input));
                (EffectKind::Constant, vec![size(own, None)])
            }
            Kind::Step => {
                let shape = self.shapes.len();
                let weight = RAMP + 1 + self.description.regressor_count() + shape;
                let own = self.modulated(entry, Modulation::Weight(weight));
                self.shapes.push(element("onset_s", "s", "onset"));
                (
                    EffectKind::Step,
                    vec![size(own, Some(weight)), onset(shape)],
                )
            }
        };
        let id = kept(&entry.id);
        let equivalents = entry.equivalents.iter().map(|other| kept(other));
        Effect {
            id,
            family: id,
            name: kept(&entry.name),
            reference: "",
            formula: kept(&entry.formula),
            kind,
            enters,
            parameters: kept_all(parameters),
            typical_size: 1.0,
            is_nominal: false,
            default_search: true,
            needs: &[],
            equivalents: kept_all(equivalents.collect()),
            equivalence: Equivalence {
                reason: "with a change of the nominal parameters both are the same expression",
                experiment: "none: no record of this plant distinguishes them",
            },
            near_twins: &[],
            nested: &[],
            continuation: Continuation::Stays,
            separated_by: &[],
        }
    }

    /// A new size that multiplies a function of time.
    fn modulated(&mut self, entry: &EffectEntry, course: Modulation) -> Role {
        let output = match entry.place {
            Place::Output(output) => Some(output),
            _ => None,
        };
        self.modulated.push(Modulated {
            of: entry.size,
            output,
            course,
        });
        self.elements
            .push(element(&entry.id, &entry.unit, &entry.name));
        Role::Parameter(self.elements.len() - 1)
    }
}

/// The onset of a step, one of the shapes.
fn onset(shape: usize) -> EffectParameter {
    EffectParameter {
        name: "onset_s",
        unit: "s",
        role: Role::Onset(Some(shape)),
        scale: 1.0,
        weight: None,
    }
}
