//! Types that describe the effects of a catalogue and the channels that they enter.
//!
//! A derivation declares every effect once; the emitter writes the declarations as static tables of
//! these types. They hold all that a search, a forecast or an extended model needs to know of an
//! effect, so that no code depends on the spelling of an id.

/// One effect: a named term or property of a model, absent where all its parameters are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effect {
    /// Public id, such as `gyro_x.g_y`.
    pub id: &'static str,
    /// Id with letters in the place of axes, such as `gyro_i.g_j`: effects that differ by their
    /// axes share it.
    pub family: &'static str,
    /// Physical name, with the letter of the literature where there is one.
    pub name: &'static str,
    /// Source of the name; may be empty.
    pub reference: &'static str,
    /// The term in the symbols of the model; empty without a term.
    pub formula: &'static str,
    /// Its dependence on time.
    pub kind: EffectKind,
    /// The part of the model that it enters.
    pub enters: Enters,
    /// Its parameters, sizes first.
    pub parameters: &'static [EffectParameter],
    /// Size that a sound instrument may have, in the unit of the first parameter.
    pub typical_size: f64,
    /// Whether the nominal model has it.
    pub is_nominal: bool,
    /// Whether a search tests it without being asked to.
    pub default_search: bool,
    /// Data that a record or its description must have.
    pub needs: &'static [Need],
    /// Exact equivalents: ids of effects that no record can distinguish from it.
    pub equivalents: &'static [&'static str],
    /// Reason of the equivalence, and an experiment that would distinguish the effects; empty
    /// without equivalents.
    pub equivalence: Equivalence,
    /// Near twins: ids of effects that a short record can hardly distinguish from it.
    pub near_twins: &'static [&'static str],
    /// Nested effects: ids of simpler effects that it tends to at an end of its shape.
    pub nested: &'static [&'static str],
    /// Its course in a later record of the same plant.
    pub continuation: Continuation,
    /// Experiments that distinguish it from its alternatives.
    pub separated_by: &'static [Experiment],
}

/// Dependence of an effect on time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EffectKind {
    /// No explicit function of time.
    Constant,
    /// Zero before an onset, one after it.
    Step,
    /// Zero before an onset, any function of time after it.
    FromOnset,
    /// A function of time with a time constant.
    Exponential,
    /// Proportional to time.
    Ramp,
    /// Periodic in time.
    Periodic,
    /// Proportional to a power of a logged quantity, or of what derives from it.
    Regressor,
    /// Integral of white noise.
    RandomWalk,
    /// Sudden change of moving states at an onset.
    StateJump,
    /// Error of moving states at the first row, outside their prior.
    InitialState,
    /// A property of the noise.
    Noise(NoiseProperty),
    /// The integration rule of a filter.
    Integration,
}

/// A property of noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoiseProperty {
    /// Standard deviation of white noise over the declared one.
    Level,
    /// Isolated samples far outside the noise.
    Outliers,
    /// Least significant bit.
    Quantisation,
    /// Correlation in time.
    Correlation,
}

/// Part of a model that an effect enters. Numbers are indices into the tables of channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Enters {
    /// Rates: rate channels of the model.
    Rates(&'static [usize]),
    /// Outputs: output channels of the model.
    Outputs(&'static [usize]),
    /// Moving states.
    States(&'static [usize]),
    /// Known inputs of the model, by the names of their groups.
    Inputs(&'static [&'static str]),
    /// Time itself: a factor on all rates.
    Time,
    /// The filter and not the model.
    Filter,
}

/// A parameter of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffectParameter {
    /// Name within the effect: `size`, `onset_s`, `sine`, ….
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Part that it plays in the model.
    pub role: Role,
    /// Unit of the model over its own unit: π/180 for degrees of a state in radians.
    pub scale: f64,
    /// Index of the function of time that it is multiplied with, among the model's weights;
    /// `None` for what is no function of time, of a regressor or of an onset.
    pub weight: Option<usize>,
}

/// Part that a parameter of an effect plays in the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Constant parameter of the model with this index: the model is linear in it, or nearly so.
    Parameter(usize),
    /// Change of the moving state with this index.
    State(usize),
    /// Time of an onset, s since the first row; its index among the model's shapes, if it is one.
    Onset(Option<usize>),
    /// Time constant, h; its index among the model's shapes.
    TimeConstant(usize),
    /// Where a term bends: a constant parameter of the model with this index, which is its difference from the value
    /// that the search takes. A term of the size zero does not tell it.
    Knee(usize),
    /// A property of the noise.
    Noise,
}

/// Data that an effect needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// A column of the record, by its name.
    Column(&'static str),
    /// An entry of the description of the record, by its key.
    Key(&'static str),
}

/// Explanation of an equivalence of effects, in sentences.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Equivalence {
    /// The reason.
    pub reason: &'static str,
    /// An experiment that would distinguish the effects.
    pub experiment: &'static str,
}

/// Course of an effect in a later record of the same plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Continuation {
    /// It begins anew with every record, as a warm-up does.
    BeginsAnew,
    /// It goes on as its function of time or of a regressor does.
    GoesOn,
    /// It stays as it is at the end of the record.
    Stays,
    /// It belongs to its record alone.
    ThisRecord,
}

/// An experiment that separates effects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Experiment {
    /// A second run from another initial state: it changes the course of what depends on states.
    OtherInitialState,
    /// A second run from another initial state or at another time of day.
    OtherStart,
    /// An independent measurement of the initial state.
    MeasureInitialState,
    /// A run with a regressor held or stepped on purpose; its name.
    ControlRegressor(&'static str),
    /// A run with an input changed on purpose; what to do.
    ChangeInput(&'static str),
    /// An independent measurement of inputs; what to measure.
    MeasureInput(&'static str),
    /// A run that starts long after switching on.
    StartLate,
}

/// A channel of a model: one rate or one output, with its own noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Public id, such as `gyro_x`.
    pub id: &'static str,
    /// Meaning, such as `drift of gyro x`.
    pub name: &'static str,
    /// Unit, such as `deg/h`.
    pub unit: &'static str,
    /// Its axis or other label within the plant.
    pub label: &'static str,
    /// Index of the constant parameter that adds a constant to it.
    pub constant: usize,
}

impl Effect {
    /// Whether it is an error of what the record was made with and not of the instrument or plant: of the site, the
    /// inputs, the clock, the integration or the first state.
    #[must_use]
    pub const fn is_of_set_up(&self) -> bool {
        matches!(
            self.enters,
            Enters::Inputs(_) | Enters::Time | Enters::Filter
        ) || matches!(self.kind, EffectKind::InitialState)
    }

    /// Whether the symbolic model has a term for it.
    #[must_use]
    pub fn has_term(&self) -> bool {
        !self.formula.is_empty()
    }

    /// Whether a unit of it changes the residuals of a fit in a known way: terms, jumps and
    /// errors of states.
    #[must_use]
    pub fn has_signature(&self) -> bool {
        self.has_term() || matches!(self.enters, Enters::States(_))
    }

    /// Indices of its sizes among the constant parameters of the model.
    pub fn model_parameters(&self) -> impl Iterator<Item = usize> + use<> {
        self.parameters
            .iter()
            .filter_map(|parameter| match parameter.role {
                Role::Parameter(index) => Some(index),
                _ => None,
            })
    }

    /// The same of its sizes and knees: what a model estimates that has it.
    pub fn estimated_parameters(&self) -> impl Iterator<Item = usize> + use<> {
        self.parameters
            .iter()
            .filter_map(|parameter| match parameter.role {
                Role::Parameter(index) | Role::Knee(index) => Some(index),
                _ => None,
            })
    }

    /// Whether where it bends is estimated.
    #[must_use]
    pub fn has_knee(&self) -> bool {
        let mut all = self.parameters.iter();
        all.any(|own| matches!(own.role, Role::Knee(_)))
    }

    /// Its onset or time constant, if it has one.
    #[must_use]
    pub fn shape(&self) -> Option<&'static EffectParameter> {
        self.parameters
            .iter()
            .find(|parameter| parameter.role.is_shape())
    }

    /// Its parameters but onset, time constant and knee.
    pub fn sizes(&self) -> impl Iterator<Item = &'static EffectParameter> + use<> {
        self.parameters.iter().filter(|parameter| {
            !parameter.role.is_shape() && !matches!(parameter.role, Role::Knee(_))
        })
    }

    /// The rate channel that it enters, if it enters exactly one.
    #[must_use]
    pub fn rate(&self) -> Option<usize> {
        match self.enters {
            Enters::Rates(&[rate]) => Some(rate),
            _ => None,
        }
    }

    /// Whether it is a property of the noise or a random walk.
    #[must_use]
    pub fn is_noise(&self) -> bool {
        matches!(self.kind, EffectKind::Noise(_) | EffectKind::RandomWalk)
    }
}

impl Role {
    /// Whether it is an onset or a time constant.
    #[must_use]
    pub fn is_shape(self) -> bool {
        matches!(self, Self::Onset(_) | Self::TimeConstant(_))
    }

    /// Its index among the shapes of the model, if it is one of them.
    #[must_use]
    pub fn shape_index(self) -> Option<usize> {
        match self {
            Self::Onset(index) => index,
            Self::TimeConstant(index) => Some(index),
            _ => None,
        }
    }
}
