//! Rows that are wrong.

use core::ops::Range;

use super::Broken;
use crate::attitude::{Attitude, cross, norm};

impl Broken {
    fn rows(&self) -> usize {
        self.record.len()
    }

    fn axis(&mut self) -> usize {
        *self.random.one_of(&[0, 1, 2])
    }

    fn between(&mut self, [low, high]: [f64; 2]) -> f64 {
        low + (high - low) * self.random.uniform()
    }

    pub(super) fn each(&mut self, change: impl FnMut(&mut [f64; 3])) {
        self.record.accel_g.iter_mut().for_each(change);
    }

    /// Changes all values of any axis.
    pub(super) fn each_of_one(&mut self, change: impl Fn(f64) -> f64) {
        let axis = self.axis();
        self.each(|row| row[axis] = change(row[axis]));
    }

    /// Some rows within the record, away from its ends, of a number of hours.
    fn block(&mut self, hours: [f64; 2]) -> Range<usize> {
        let length = (self.between(hours) * 60.0) as usize;
        let first = self.place(600, self.rows() - length - 600);
        first..first + length
    }

    fn place(&mut self, from: usize, to: usize) -> usize {
        from + (self.random.uniform() * (to - from) as f64) as usize
    }

    /// The axis of which this is largest, and what it is.
    fn most(&self, of: fn(f64, f64) -> f64) -> (usize, f64) {
        let size = |axis: usize| {
            let values = || self.record.accel_g.iter().map(move |row| row[axis]);
            let least = values().fold(f64::MAX, f64::min);
            of(least, values().fold(f64::MIN, f64::max))
        };
        let mut axes: [_; 3] = core::array::from_fn(|axis| (axis, size(axis)));
        axes.sort_by(|a, b| b.1.total_cmp(&a.1));
        axes[0]
    }

    /// The axis that reaches the largest force, and that force.
    fn widest(&self) -> (usize, f64) {
        self.most(|least, most| most.max(-least))
    }

    /// The axis whose force varies most.
    fn liveliest(&self) -> usize {
        self.most(|least, most| most - least).0
    }
}

pub(super) fn exchange_two(broken: &mut Broken) {
    let at = broken.place(1, broken.rows() - 1);
    broken.record.time_s.swap(at, at - 1);
}

pub(super) fn scale_time(broken: &mut Broken, factor: f64) {
    let times_s = broken.record.time_s.iter_mut();
    times_s.for_each(|time_s| *time_s *= factor);
}

/// A code in 2 to 10 % of the rows.
pub(super) fn code(broken: &mut Broken, code: f64, all: bool) {
    let share = broken.between([0.02, 0.1]);
    let axis = broken.liveliest();
    let Broken { record, random, .. } = broken;
    for row in &mut record.accel_g {
        if random.uniform() <= share {
            match all {
                true => *row = [code; 3],
                false => row[axis] = code,
            }
        }
    }
}

pub(super) fn zero_block(broken: &mut Broken) {
    let block = broken.block([0.5, 6.0]);
    broken.record.accel_g[block].fill([0.0; 3]);
}

/// Multiplies each axis by its factor.
pub fn scale(broken: &mut Broken, factors: [f64; 3]) {
    broken.each(|row| *row = core::array::from_fn(|axis| factors[axis] * row[axis]));
}

/// All axes are off by a part of this range, to either side: a site whose gravity is not the unit's, or a scale.
pub(super) fn scale_by(broken: &mut Broken, range: [f64; 2]) {
    let sign = broken.random.sign();
    let ratio = 1.0 + sign * broken.between(range);
    scale(broken, [ratio; 3]);
}

/// Noise about a constant.
fn still(broken: &mut Broken, about: [f64; 3]) {
    let Broken { record, random, .. } = broken;
    for row in &mut record.accel_g {
        *row = about.map(|value| value + 1e-5 * random.normal());
    }
}

pub(super) fn remove_gravity(broken: &mut Broken) {
    still(broken, [0.0; 3]);
}

pub(super) fn stand_still(broken: &mut Broken) {
    let up = broken.record.accel_g[0];
    still(broken, up);
}

fn stick(broken: &mut Broken, axis: usize, rows: Range<usize>) {
    let value = broken.record.accel_g[rows.start][axis];
    for row in &mut broken.record.accel_g[rows] {
        row[axis] = value;
    }
}

pub(super) fn stick_for_hours(broken: &mut Broken) {
    let axis = broken.liveliest();
    let block = broken.block([2.0, 8.0]);
    stick(broken, axis, block);
}

pub(super) fn stick_to_the_end(broken: &mut Broken) {
    let axis = broken.liveliest();
    let from = broken.place(broken.rows() / 3, 2 * broken.rows() / 3);
    stick(broken, axis, from..broken.rows());
}

/// The axis that reaches the largest force ends at 0.7 to 0.95 of it, with noise after the limit.
pub fn clip(broken: &mut Broken, noise_g: f64) {
    let (axis, reach) = broken.widest();
    let limit = reach * broken.between([0.7, 0.95]);
    let Broken { record, random, .. } = broken;
    for value in record.accel_g.iter_mut().map(|row| &mut row[axis]) {
        if value.abs() > limit {
            *value = limit.copysign(*value) + noise_g * random.normal();
        }
    }
}

pub(super) fn hang(broken: &mut Broken) {
    let block = broken.block([0.5, 4.0]);
    let row = broken.record.accel_g[block.start];
    broken.record.accel_g[block].fill(row);
}

pub(super) fn hold(broken: &mut Broken) {
    for at in (1..broken.rows()).step_by(2) {
        broken.record.accel_g[at] = broken.record.accel_g[at - 1];
    }
}

/// An earlier block in place of later rows.
pub(super) fn copy(broken: &mut Broken, noise_g: f64) {
    let block = broken.block([0.5, 4.0]);
    let lag = broken.place(block.len().min(200), 590);
    for at in block {
        let earlier = broken.record.accel_g[at - lag];
        let noisy = earlier.map(|value| value + noise_g * broken.random.normal());
        broken.record.accel_g[at] = if noise_g > 0.0 { noisy } else { earlier };
    }
}

/// The last rows before a place once more, and all later rows later.
pub(super) fn insert_copy(broken: &mut Broken) {
    let block = broken.block([0.5, 2.0]);
    let copied = broken.record.accel_g[block.clone()].to_vec();
    let rows = broken.rows();
    broken.record.accel_g.splice(block.end..block.end, copied);
    broken.record.accel_g.truncate(rows);
}

/// A gain that is 2 to 15 % off.
pub(super) fn gain(broken: &mut Broken) {
    let axis = broken.liveliest();
    let sign = broken.random.sign();
    let gain = 1.0 + sign * broken.between([0.02, 0.15]);
    broken.each(|row| row[axis] *= gain);
}

pub(super) fn one_axis_in_other_unit(broken: &mut Broken) {
    let axis = broken.liveliest();
    broken.each(|row| row[axis] *= 9.806_65);
}

/// A turn by 5 to 60 degrees about an axis across the vertical.
pub(super) fn jump(broken: &mut Broken) {
    let from = broken.place(600, broken.rows() - 600);
    let angle_rad = broken.between([5.0, 60.0]).to_radians();
    let up = broken.record.accel_g[from];
    let any: [f64; 3] = core::array::from_fn(|_| broken.random.normal());
    let across = cross(any, up);
    let size = norm(across);
    let turn = Attitude::turned_by(across.map(|x| x * angle_rad / size));
    for row in &mut broken.record.accel_g[from..] {
        *row = turn.resolve(*row);
    }
}

/// Half an hour to four hours.
pub(super) fn lose(broken: &mut Broken) {
    let block = broken.block([0.5, 4.0]);
    broken.record.accel_g.drain(block);
    let rows = broken.record.accel_g.len();
    broken.record.time_s.truncate(rows);
}

/// From some row on all times are later by a time of this range, s.
pub fn jump_clock(broken: &mut Broken, range_s: [f64; 2]) {
    let from = broken.place(600, broken.rows() - 600);
    let by_s = broken.between(range_s);
    for time_s in &mut broken.record.time_s[from..] {
        *time_s += by_s;
    }
}

/// Two columns are exchanged from a row on.
pub fn exchange_axes(broken: &mut Broken, from: usize) {
    let [one, other] = *broken.random.one_of(&[[0, 1], [1, 2], [0, 2]]);
    for row in &mut broken.record.accel_g[from..] {
        row.swap(one, other);
    }
}
