//! Kinds of gross errors.

/// The kinds with their names in results, in the order in which they are looked for.
macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident = $name:literal,)+) => {
        /// Kind of a gross error of the set-up.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum SetupKind {
            $($(#[$doc])* $kind,)+
        }

        impl SetupKind {
            /// All kinds, in the order in which they are looked for.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$kind),+];

            /// Its name in results.
            #[must_use]
            pub fn as_str(self) -> &'static str {
                match self {
                    $(Self::$kind => $name,)+
                }
            }
        }
    };
}

kinds! {
    /// Times do not rise, or are in another unit.
    Clock = "clock",
    /// An accelerometer has no values.
    Missing = "missing",
    /// Missing values are written as numbers.
    MissingCoded = "missing-coded",
    /// Temperature is in another unit, or none.
    Temperature = "temperature",
    /// Specific force is in another unit.
    Unit = "unit",
    /// An accelerometer repeats one value.
    Stuck = "stuck",
    /// An accelerometer does not go beyond a value.
    Clipped = "clipped",
    /// Rows repeat the row before.
    Repeated = "repeated",
    /// Rows repeat an earlier block of rows.
    Duplicated = "duplicated",
    /// An accelerometer has another gain.
    Scale = "scale",
    /// The attitude jumps.
    Jump = "jump",
    /// Gravity does not move against the platform.
    Still = "still",
    /// Gravity turns the wrong way: sign of the latitude, or mirrored axes.
    Handedness = "handedness",
    /// Axes are exchanged or have other signs.
    Axes = "axes",
    /// The initial angles are of another convention.
    Angles = "angles",
    /// The latitude is wrong.
    Latitude = "latitude",
    /// The initial attitude is wrong.
    Attitude = "attitude",
    /// Specific force at rest is not what the bench description says.
    Gravity = "gravity",
}

impl SetupKind {
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
}

impl core::fmt::Display for SetupKind {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.as_str())
    }
}
