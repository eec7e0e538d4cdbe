/// A column beside those of the states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driven {
    /// A parameter rises by one over a block: the parameter's index among the states.
    Slope(usize),
    /// An output is off by one.
    Output(usize),
    /// An output comes to be off by one over a block.
    OutputSlope(usize),
}

/// The quantity that an effect changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Value {
    /// It enters as the parameter with this index among the states does.
    State(usize),
    /// It enters an output: index of its column [`Driven::Output`].
    Driven(usize),
}

/// An effect: the quantity that it changes, by a size that is the same all the time, times a course
/// that is straight within a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The quantity.
    pub value: Value,
    /// Index of the column with the slope of that quantity; beyond the columns if its course never
    /// has one.
    pub slope: usize,
    /// True if its course rises from zero at its onset by [`Course::change`] a block; the start of
    /// [`Course`] is then of no account.
    pub from_onset: bool,
}

/// Course of an effect over a block, per unit of its size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course<T> {
    /// At the beginning of the block.
    pub start: T,
    /// Change over the block.
    pub change: T,
}
