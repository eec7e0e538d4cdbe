//! Kinds of platforms that records are of.

/// Kind of the platform of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PlatformKind {
    /// Gyros hold it in inertial space: gravity turns against it at the rate of the Earth.
    Stabilised,
    /// It is computed from gyros that are fixed to a body: it drifts as fast as these do, and the
    /// accelerometers turn with the body.
    Computed,
}

impl PlatformKind {
    /// All kinds.
    pub const ALL: [Self; 2] = [Self::Stabilised, Self::Computed];
}
