//! Bench descriptions that are wrong.

use gyrocal_truth::Attitude;

use super::Broken;

pub(super) fn negate_latitude(broken: &mut Broken) {
    broken.bench.latitude_deg *= -1.0;
}

pub(super) fn latitude_in_radians(broken: &mut Broken) {
    broken.bench.latitude_deg = broken.bench.latitude_deg.to_radians();
}

fn change_angles(broken: &mut Broken, change: impl FnOnce([f64; 3]) -> [f64; 3]) {
    broken.bench.initial_angles_deg = broken.bench.initial_angles_deg.map(change);
}

pub(super) fn angles_in_radians(broken: &mut Broken) {
    change_angles(broken, |angles| angles.map(f64::to_radians));
}

pub(super) fn negate_angles(broken: &mut Broken) {
    change_angles(broken, |angles| angles.map(|angle| -angle));
}

pub(super) fn zero_angles(broken: &mut Broken) {
    change_angles(broken, |_| [0.0; 3]);
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
