//! Words on wrong signs.

use gyrocal_document::{Screen, Standing};

/// The first screen of a unit that turns against the Earth.
pub(crate) fn against_the_earth() -> Screen {
    let what = "the unit turns about the vertical against the Earth, at its rate";
    let mut screen = Screen::new(Standing::Bad, "CHECK SIGNS", what);
    screen.fact(
        "check first",
        "signs and axes of gyros and of accelerometers, sign of the latitude; or the bias about the vertical is twice \
         Earth rate by chance",
    );
    screen
}
