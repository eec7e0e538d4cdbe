//! Functions of flat vectors, for every scalar type that a test asks for.

use gyrocal_oracle::dual::Dual;
use gyrocal_oracle::points::State;
use gyrocal_oracle::rounding::{Bounded, ROUNDOFF_F64};
use gyrocal_scalar::Lanes;

/// Variables that dual numbers carry: enough for the longest group.
pub(crate) const VARIABLES: usize = 9;

/// A function from the scalars of some groups to its structural nonzeros, both flat.
#[derive(Clone, Copy)]
pub(crate) struct Callable {
    pub(crate) name: &'static str,
    /// Names of the groups that it takes.
    pub(crate) groups: &'static [&'static str],
    pub(crate) double: fn(&[f64]) -> Vec<f64>,
    pub(crate) single: fn(&[f32]) -> Vec<f32>,
    /// For functions that a filter runs; the step that only tests run would take most of a
    /// minute to compile.
    pub(crate) lanes: Option<fn(&[Lanes<f64, 4>]) -> Vec<Lanes<f64, 4>>>,
    /// For functions that a test differentiates.
    pub(crate) dual: Option<fn(&[Dual<VARIABLES>]) -> Vec<Dual<VARIABLES>>>,
    pub(crate) bounded: fn(&[Bounded]) -> Vec<Bounded>,
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
        self.groups.iter().flat_map(|name| state.group(name).expect(name)).copied().collect()
    }

    /// Places of a group in its inputs; of the first, where it takes the group twice.
    pub(crate) fn places(&self, group: &str, state: &State) -> Vec<usize> {
        let before = self.groups.iter().take_while(|&&name| name != group);
        let start: usize = before.map(|name| state.group(name).expect(name).len()).sum();
        (start..start + state.group(group).expect(group).len()).collect()
    }

    /// Bound on the rounding error of each of its results in `f64`.
    pub(crate) fn rounding(&self, inputs: &[f64]) -> Vec<f64> {
        let inputs: Vec<Bounded> = inputs.iter().map(|&value| Bounded::exact(value)).collect();
        (self.bounded)(&inputs).iter().map(|result| ROUNDOFF_F64 * result.bound()).collect()
    }
}

/// The next group of flat inputs.
pub(crate) fn take<'a, T, const N: usize>(rest: &mut &'a [T]) -> &'a [T; N] {
    let (group, others) = rest.split_first_chunk().expect("as many scalars as the groups have");
    *rest = others;
    group
}
