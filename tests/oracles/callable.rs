//! Functions of flat vectors, for every scalar type that a test asks for.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use gyrocal_oracle::dual::{self, Dual};
use gyrocal_oracle::points::State;
use gyrocal_oracle::rounding::{ROUNDOFF_F64, RunningError};
use gyrocal_scalar::Lanes;

use crate::programs;

/// Variables that dual numbers carry; longer groups are differentiated in parts.
pub(crate) const VARIABLES: usize = 9;

/// A function of flat vectors.
pub(crate) type Flat<T> = fn(&[T]) -> Vec<T>;

/// A function from the scalars of some groups to its structural nonzeros, both flat.
#[derive(Clone, Copy)]
pub(crate) struct Callable {
    pub(crate) name: &'static str,
    /// Names of the groups that it takes.
    pub(crate) groups: &'static [&'static str],
    pub(crate) double: Flat<f64>,
    pub(crate) single: Flat<f32>,
    /// For functions that a filter runs; the step that only tests run would take most of a
    /// minute to compile.
    pub(crate) lanes: Option<Flat<Lanes<f64, 4>>>,
    /// For functions that a test differentiates.
    pub(crate) dual: Option<Flat<Dual<VARIABLES>>>,
    pub(crate) bounded: Flat<RunningError>,
}

/// A [`Callable`] from a function that is generic over its scalar.
macro_rules! callable {
    ($name:expr, $groups:expr, $function:path, lanes: $lanes:expr, dual: $dual:expr) => {
        $crate::callable::Callable {
            name: $name,
            groups: $groups,
            double: $function,
            single: $function,
            lanes: $lanes,
            dual: $dual,
            bounded: $function,
        }
    };
}
pub(crate) use callable;

impl Callable {
    /// Its inputs at a state.
    pub(crate) fn inputs(&self, state: &State) -> Vec<f64> {
        let groups = self.groups.iter();
        groups.flat_map(|name| group(state, name)).collect()
    }

    /// Places of a group in its inputs; of the first, where it takes the group twice.
    pub(crate) fn places(&self, name: &str, state: &State) -> Vec<usize> {
        let before = self.groups.iter().take_while(|&&other| other != name);
        let start: usize = before.map(|other| group(state, other).len()).sum();
        (start..start + group(state, name).len()).collect()
    }

    /// Bound on the rounding error of each of its results in `f64`.
    pub(crate) fn rounding(&self, inputs: &[f64]) -> Vec<f64> {
        let inputs: Vec<RunningError> = inputs
            .iter()
            .map(|&value| RunningError::exact(value))
            .collect();
        (self.bounded)(&inputs)
            .iter()
            .map(|result| ROUNDOFF_F64 * result.bound())
            .collect()
    }
}

/// Jacobian of a function by dual numbers, row by row, with a column for each place.
pub(crate) fn dual_jacobian(
    function: Flat<Dual<VARIABLES>>,
    inputs: &[f64],
    places: &[usize],
) -> Vec<f64> {
    let parts: Vec<(usize, Vec<f64>)> = places
        .chunks(VARIABLES)
        .map(|places| {
            let part = dual::jacobian::<VARIABLES>(function, inputs, places);
            (places.len(), part)
        })
        .collect();
    let rows = parts
        .first()
        .map_or(0, |(columns, part)| part.len() / columns);
    (0..rows)
        .flat_map(|row| {
            let parts = parts.iter();
            parts.flat_map(move |(columns, part)| part[row * columns..][..*columns].to_vec())
        })
        .collect()
}

/// A group of a state, or `origin`: angles where a chart that moves with the platform has it.
/// Parameters and shapes of extended models are as long as the model has them.
fn group(state: &State, name: &str) -> Vec<f64> {
    if name == "origin" {
        return vec![0.0; 3];
    }
    if let Some(group) = state.group(name) {
        return group.to_vec();
    }
    let elements = &own_groups()[name];
    if name.ends_with("::parameters") {
        state.parameters(elements.len())
    } else {
        state.shapes(elements)
    }
}

/// Names of the elements of groups that each program has of its own.
fn own_groups() -> &'static BTreeMap<String, Vec<String>> {
    static GROUPS: OnceLock<BTreeMap<String, Vec<String>>> = OnceLock::new();
    GROUPS.get_or_init(|| {
        let functions = programs().into_iter().flat_map(|program| program.functions);
        functions
            .flat_map(|function| function.inputs)
            .filter(|group| group.name.contains("::"))
            .map(|group| (group.name, group.elements))
            .collect()
    })
}

/// The next group of flat inputs.
pub(crate) fn take<'a, T, const N: usize>(rest: &mut &'a [T]) -> &'a [T; N] {
    let (group, others) = rest
        .split_first_chunk()
        .expect("as many scalars as the groups have");
    *rest = others;
    group
}
