//! Bench descriptions that are wrong.

use super::Broken;
use crate::attitude::Attitude;

pub(super) fn change_angles(broken: &mut Broken, change: impl FnOnce([f64; 3]) -> [f64; 3]) {
    broken.bench.initial_angles_deg = broken.bench.initial_angles_deg.map(change);
}

/// An azimuth that is wrong by 60 to 300 degrees: the platform turned about the vertical before the
/// angles were measured.
pub(super) fn turn_azimuth(broken: &mut Broken) {
    let wrong_rad = (60.0 + 240.0 * broken.random.uniform()).to_radians();
    change_angles(broken, |angles| {
        let attitude = Attitude::from_angles_rad(angles.map(f64::to_radians));
        let turned = Attitude::turned_by([0.0, 0.0, wrong_rad]);
        attitude.after(turned).angles_deg()
    });
}

/// Angles against north, east, down.
pub(super) fn angles_against_ned(broken: &mut Broken) {
    // East, north, up against north, east, down: a half turn about the middle of north and east.
    let half = core::f64::consts::PI * core::f64::consts::FRAC_1_SQRT_2;
    change_angles(broken, |angles| {
        let attitude = Attitude::from_angles_rad(angles.map(f64::to_radians));
        let enu_against_ned = Attitude::turned_by([half, half, 0.0]);
        attitude.after(enu_against_ned).angles_deg()
    });
}
