//! Kinds of gross errors.

/// Kind of a gross error of the set-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum SetupKind {
    /// Times do not rise, or are in another unit.
    Clock,
    /// An accelerometer has no values.
    Missing,
    /// Missing values are written as numbers.
    MissingCoded,
    /// Temperature is in another unit, or none.
    Temperature,
    /// Specific force is in another unit.
    Unit,
    /// An accelerometer repeats one value.
    Stuck,
    /// An accelerometer does not go beyond a value.
    Clipped,
    /// Rows repeat the row before.
    Repeated,
    /// Rows repeat an earlier block of rows.
    Duplicated,
    /// An accelerometer has another gain.
    Scale,
    /// The attitude jumps.
    Jump,
    /// Gravity does not move against the platform.
    Still,
    /// Gravity turns the wrong way: sign of the latitude, or mirrored axes.
    Handedness,
    /// Axes are exchanged or have other signs.
    Axes,
    /// The initial angles are of another convention.
    Angles,
    /// The latitude is wrong.
    Latitude,
    /// The initial attitude is wrong.
    Attitude,
    /// Specific force at rest is not what the bench description says.
    Gravity,
}

impl SetupKind {
    /// All kinds, in the order in which they are looked for.
    pub const ALL: [Self; 18] = [
        Self::Clock,
        Self::Missing,
        Self::MissingCoded,
        Self::Temperature,
        Self::Unit,
        Self::Stuck,
        Self::Clipped,
        Self::Repeated,
        Self::Duplicated,
        Self::Scale,
        Self::Jump,
        Self::Still,
        Self::Handedness,
        Self::Axes,
        Self::Angles,
        Self::Latitude,
        Self::Attitude,
        Self::Gravity,
    ];

    /// Whether it leaves the magnitudes of specific force as they are.
    #[must_use]
    pub fn is_of_directions(self) -> bool {
        matches!(
            self,
            Self::Handedness | Self::Axes | Self::Angles | Self::Latitude | Self::Attitude
        )
    }

    /// Whether the samples that it concerns are lost: no other bench file or unit brings them back.
    #[must_use]
    pub fn loses_samples(self) -> bool {
        matches!(
            self,
            Self::Stuck | Self::Clipped | Self::Repeated | Self::Duplicated
        )
    }

    /// Its name in results.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Clock => "clock",
            Self::Missing => "missing",
            Self::MissingCoded => "missing-coded",
            Self::Temperature => "temperature",
            Self::Unit => "unit",
            Self::Stuck => "stuck",
            Self::Clipped => "clipped",
            Self::Repeated => "repeated",
            Self::Duplicated => "duplicated",
            Self::Scale => "scale",
            Self::Jump => "jump",
            Self::Still => "still",
            Self::Handedness => "handedness",
            Self::Axes => "axes",
            Self::Angles => "angles",
            Self::Latitude => "latitude",
            Self::Attitude => "attitude",
            Self::Gravity => "gravity",
        }
    }
}

impl core::fmt::Display for SetupKind {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.as_str())
    }
}
