//! Functions of flat vectors, for every scalar type that a test asks for.

use gyrocal_oracle::dual::Dual;
use gyrocal_oracle::points::State;
use gyrocal_oracle::rounding::{Bounded, ROUNDOFF_F64};
use gyrocal_scalar::Lanes;

/// Variables that dual numbers carry: enough for the longest group.
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
    pub(crate) bounded: Flat<Bounded>,
}

/// A [`Callable`] from a function that is generic over its scalar.
macro_rules! callable {
    ($name:expr, $groups:expr, $function:ident, lanes: $lanes:expr, dual: $dual:expr) => {
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
        let groups = self.groups.iter().flat_map(|name| group(state, name));
        groups.copied().collect()
    }

    /// Places of a group in its inputs; of the first, where it takes the group twice.
    pub(crate) fn places(&self, name: &str, state: &State) -> Vec<usize> {
        let before = self.groups.iter().take_while(|&&other| other != name);
        let start: usize = before.map(|other| group(state, other).len()).sum();
        (start..start + group(state, name).len()).collect()
    }

    /// Bound on the rounding error of each of its results in `f64`.
    pub(crate) fn rounding(&self, inputs: &[f64]) -> Vec<f64> {
        let inputs: Vec<Bounded> = inputs.iter().map(|&value| Bounded::exact(value)).collect();
        (self.bounded)(&inputs)
            .iter()
            .map(|result| ROUNDOFF_F64 * result.bound())
            .collect()
    }
}

/// A group of a state, or `origin`: angles where a chart that moves with the platform has it.
fn group<'a>(state: &'a State, name: &str) -> &'a [f64] {
    if name == "origin" {
        return &[0.0; 3];
    }
    state.group(name).expect(name)
}

/// The next group of flat inputs.
pub(crate) fn take<'a, T, const N: usize>(rest: &mut &'a [T]) -> &'a [T; N] {
    let (group, others) = rest
        .split_first_chunk()
        .expect("as many scalars as the groups have");
    *rest = others;
    group
}
