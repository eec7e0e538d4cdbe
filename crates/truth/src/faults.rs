//! Records such as users have and [`simulate`] does not make.
//!
//! A [`Breakage`] takes a sound record with its bench description and spoils one of them. Each has the
//! names of the kinds that tell it rightly: its own, and those that no record tells from it. Noise that is not normal
//! and drifts that wander are in [`noise`], effects that no catalogue holds are [`UnlistedEffect`]s.

mod description;
pub mod noise;
pub mod rows;
mod sound;
mod unlisted;

use gyrocal_record::{Bench, Record};
use gyrocal_statistics::deviates::Draw;

use crate::error::Error;
use crate::simulation::{Simulation, simulate};
use Angles::{Either, Given, Left};
use description::change_angles;
pub use sound::{any_scenario, large_effects, varied_record, varied_scenario};
pub use unlisted::{Series, UnlistedEffect, UnlistedKind};

/// A record, its bench description, and draws of what is spoilt.
pub struct Broken {
    /// The record.
    pub record: Record,
    /// Its bench description.
    pub bench: Bench,
    /// What is drawn.
    pub random: Draw,
}

impl Broken {
    /// A record that is to be spoilt.
    #[must_use]
    pub fn of(Simulation { record, bench, .. }: Simulation, random: Draw) -> Self {
        Self {
            record,
            bench,
            random,
        }
    }
}

/// A way to spoil a record or its description.
pub struct Breakage {
    /// What is wrong, in words.
    pub name: &'static str,
    /// Names of the kinds that tell it: its own first.
    pub kinds: &'static [&'static str],
    /// Whether the bench description has the initial angles.
    pub angles: Angles,
    spoil: fn(&mut Broken),
}

/// Which bench descriptions a breakage is made with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Angles {
    /// With the initial angles.
    Given,
    /// Without them.
    Left,
    /// Every other record has them.
    Either,
}

impl Breakage {
    const fn new(
        name: &'static str,
        kinds: &'static [&'static str],
        angles: Angles,
        spoil: fn(&mut Broken),
    ) -> Self {
        Self {
            name,
            kinds,
            angles,
            spoil,
        }
    }

    /// The broken record of a seed.
    ///
    /// # Errors
    /// As [`simulate`].
    pub fn record(&self, seed: u64) -> Result<Broken, Error> {
        let mut broken = Broken::of(sound(seed)?, Draw::new(seed, 1));
        let left = match self.angles {
            Angles::Given => false,
            Angles::Left => true,
            Angles::Either => seed % 2 == 1,
        };
        self.spoil(&mut broken);
        if left {
            leave_angles_out(&mut broken.bench);
        }
        Ok(broken)
    }

    /// Spoils a record that may be broken already.
    pub fn spoil(&self, broken: &mut Broken) {
        (self.spoil)(broken);
    }
}

/// All breakages.
#[rustfmt::skip] // a table
pub const BREAKAGES: &[Breakage] = &[
    // the clock
    Breakage::new("two rows exchanged", &["clock"], Either, rows::exchange_two),
    Breakage::new("times in milliseconds", &["clock"], Either, |b| rows::scale_time(b, 1e3)),
    Breakage::new("times in minutes", &["clock"], Either, |b| rows::scale_time(b, 1.0 / 60.0)),
    Breakage::new("times in hours", &["clock"], Either, |b| rows::scale_time(b, 1.0 / 3600.0)),
    // missing values
    Breakage::new("an empty column", &["missing"], Either, |b| b.each_of_one(|_| f64::NAN)),
    Breakage::new("0 in one column", &["missing-coded"], Either, |b| rows::code(b, 0.0, false)),
    Breakage::new("-999 in all columns", &["missing-coded"], Either, |b| rows::code(b, -999.0, true)),
    Breakage::new("a block of 0 in all columns", &["missing-coded"], Either, rows::zero_block),
    // the unit
    Breakage::new("m/s^2", &["unit"], Either, |b| rows::scale(b, [9.81; 3])),
    Breakage::new("mg", &["unit"], Either, |b| rows::scale(b, [1e3; 3])),
    Breakage::new("gravity removed", &["unit"], Either, rows::remove_gravity),
    // values that repeat
    Breakage::new("stuck for hours", &["stuck", "missing-coded"], Either, rows::stick_for_hours),
    Breakage::new("stuck from the middle on", &["stuck", "missing-coded"], Either, rows::stick_to_the_end),
    Breakage::new("clipped", &["clipped"], Either, |b| rows::clip(b, 0.0)),
    Breakage::new("clipped before the noise", &["clipped"], Either, |b| rows::clip(b, 1e-5)),
    Breakage::new("the logger hangs", &["repeated"], Either, rows::hang),
    Breakage::new("each row twice", &["repeated"], Either, rows::hold),
    Breakage::new("a block over later rows", &["duplicated"], Either, |b| rows::copy(b, 0.0)),
    Breakage::new("a block with new noise", &["duplicated"], Either, |b| rows::copy(b, 1e-5)),
    Breakage::new("a block inserted, times renumbered", &["duplicated"], Either, rows::insert_copy),
    // gains
    Breakage::new("the gain of one axis", &["scale"], Either, rows::gain),
    Breakage::new("one axis in m/s^2", &["scale"], Either, rows::one_axis_in_other_unit),
    // leaps
    Breakage::new("a jump of the attitude", &["jump"], Either, rows::jump),
    Breakage::new("rows lost without a trace", &["jump"], Either, rows::lose),
    Breakage::new("a jump of the clock", &["jump", "clock"], Either, |b| rows::jump_clock(b, [1800.0, 14_400.0])),
    Breakage::new("a platform at rest on the Earth", &["still"], Either, rows::stand_still),
    // axes and latitude without angles
    Breakage::new("latitude negated, no angles", &["handedness"], Left, |b| b.bench.latitude_deg *= -1.0),
    Breakage::new("two axes exchanged, no angles", &["handedness"], Left, |b| rows::exchange_axes(b, 0)),
    Breakage::new("one axis negated, no angles", &["handedness"], Left, |b| b.each_of_one(|value| -value)),
    Breakage::new("all axes negated, no angles", &["handedness"], Left, |b| rows::scale(b, [-1.0; 3])),
    Breakage::new("latitude in radians, no angles", &["latitude"], Left, |b| b.bench.latitude_deg = b.bench.latitude_deg.to_radians()),
    // axes, latitude and attitude with angles
    Breakage::new("latitude negated", &["latitude"], Given, |b| b.bench.latitude_deg *= -1.0),
    Breakage::new("latitude in radians", &["latitude"], Given, |b| b.bench.latitude_deg = b.bench.latitude_deg.to_radians()),
    Breakage::new("two axes exchanged", &["axes"], Given, |b| rows::exchange_axes(b, 0)),
    Breakage::new("one axis negated", &["axes"], Given, |b| b.each_of_one(|value| -value)),
    Breakage::new("all axes negated", &["axes"], Given, |b| rows::scale(b, [-1.0; 3])),
    Breakage::new("all axes exchanged", &["axes"], Given, |b| b.each(|row| row.rotate_left(1))),
    Breakage::new("angles in radians", &["angles"], Given, |b| change_angles(b, |angles| angles.map(f64::to_radians))),
    Breakage::new("angles negated", &["angles"], Given, |b| change_angles(b, |angles| angles.map(|angle| -angle))),
    Breakage::new("angles against north, east, down", &["angles"], Given, description::angles_against_ned),
    Breakage::new("angles left at zero", &["attitude"], Given, |b| change_angles(b, |_| [0.0; 3])),
    Breakage::new("the azimuth of another day", &["attitude", "angles"], Given, description::turn_azimuth),
    // gravity
    Breakage::new("standard g at another site", &["gravity"], Either, |b| rows::scale_by(b, [3e-4, 2.5e-3])),
    Breakage::new("a common scale", &["gravity", "scale"], Either, |b| rows::scale_by(b, [0.01, 0.06])),
];

/// A sound record: any attitude, latitudes of 15 to 75 degrees north or south, two to four days
/// each minute.
///
/// # Errors
/// As [`simulate`].
pub fn sound(seed: u64) -> Result<Simulation, Error> {
    simulate(&any_scenario(seed, 0, [15.0, 75.0]))
}

/// The bench description without initial angles.
pub fn leave_angles_out(bench: &mut Bench) {
    bench.initial_angles_deg = None;
    bench.initial_angles_sigma_deg = [180.0; 3];
}
