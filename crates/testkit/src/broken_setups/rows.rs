//! Rows that are wrong.

use core::ops::Range;

use gyrocal_truth::Attitude;

use super::Broken;

impl Broken {
    fn rows(&self) -> usize {
        self.record.len()
    }

    fn axis(&mut self) -> usize {
        *self.random.one_of(&[0, 1, 2])
    }

    /// Some rows within the record, away from its ends, of a number of hours.
    fn block(&mut self, hours: [f64; 2]) -> Range<usize> {
        let hours = hours[0] + (hours[1] - hours[0]) * self.random.uniform();
        let length = (hours * 60.0) as usize;
        let first = self.place(600, self.rows() - length - 600);
        first..first + length
    }

    fn place(&mut self, from: usize, to: usize) -> usize {
        from + (self.random.uniform() * (to - from) as f64) as usize
    }

    /// The axis that reaches the largest force, and that force.
    fn widest(&self) -> (usize, f64) {
        let reach = |axis: usize| {
            let values = self.record.accel_g.iter().map(|row| row[axis].abs());
            values.fold(0.0, f64::max)
        };
        let mut axes: [_; 3] = core::array::from_fn(|axis| (axis, reach(axis)));
        axes.sort_by(|a, b| b.1.total_cmp(&a.1));
        axes[0]
    }

    /// The axis whose force varies most.
    fn liveliest(&self) -> usize {
        let range = |axis: usize| {
            let values = || self.record.accel_g.iter().map(move |row| row[axis]);
            values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
        };
        let mut axes: [_; 3] = core::array::from_fn(|axis| (axis, range(axis)));
        axes.sort_by(|a, b| b.1.total_cmp(&a.1));
        axes[0].0
    }
}

pub(super) fn exchange_two(broken: &mut Broken) {
    let at = broken.place(1, broken.rows() - 1);
    broken.record.time_s.swap(at, at - 1);
}

pub(super) fn scale_time(broken: &mut Broken, factor: f64) {
    for time_s in &mut broken.record.time_s {
        *time_s *= factor;
    }
}

pub(super) fn empty_column(broken: &mut Broken) {
    let axis = broken.axis();
    for row in &mut broken.record.accel_g {
        row[axis] = f64::NAN;
    }
}

/// A code in 2 to 10 % of the rows.
pub(super) fn code(broken: &mut Broken, code: f64, all: bool) {
    let share = 0.02 + 0.08 * broken.random.uniform();
    let axis = broken.liveliest();
    for at in 0..broken.rows() {
        if broken.random.uniform() > share {
            continue;
        }
        if all {
            broken.record.accel_g[at] = [code; 3];
        } else {
            broken.record.accel_g[at][axis] = code;
        }
    }
}

pub(super) fn zero_block(broken: &mut Broken) {
    for at in broken.block([0.5, 6.0]) {
        broken.record.accel_g[at] = [0.0; 3];
    }
}

pub(super) fn scale(broken: &mut Broken, factors: [f64; 3]) {
    for row in &mut broken.record.accel_g {
        *row = core::array::from_fn(|axis| factors[axis] * row[axis]);
    }
}

pub(super) fn remove_gravity(broken: &mut Broken) {
    for row in &mut broken.record.accel_g {
        *row = core::array::from_fn(|_| 1e-5 * broken.random.normal());
    }
}

pub(super) fn stick_for_hours(broken: &mut Broken) {
    let axis = broken.liveliest();
    let block = broken.block([2.0, 8.0]);
    let value = broken.record.accel_g[block.start][axis];
    for at in block {
        broken.record.accel_g[at][axis] = value;
    }
}

pub(super) fn stick_to_the_end(broken: &mut Broken) {
    let axis = broken.liveliest();
    let from = broken.place(broken.rows() / 3, 2 * broken.rows() / 3);
    let value = broken.record.accel_g[from][axis];
    for at in from..broken.rows() {
        broken.record.accel_g[at][axis] = value;
    }
}

/// A range of 0.7 to 0.95 of the largest force, with noise after the limit.
pub(super) fn clip(broken: &mut Broken, noise_g: f64) {
    let (axis, reach) = broken.widest();
    let limit = reach * (0.7 + 0.25 * broken.random.uniform());
    for at in 0..broken.rows() {
        let value = &mut broken.record.accel_g[at][axis];
        if value.abs() > limit {
            *value = limit.copysign(*value) + noise_g * broken.random.normal();
        }
    }
}

pub(super) fn hang(broken: &mut Broken) {
    let block = broken.block([0.5, 4.0]);
    let row = broken.record.accel_g[block.start];
    for at in block {
        broken.record.accel_g[at] = row;
    }
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
        let noisy = core::array::from_fn(|axis| earlier[axis] + noise_g * broken.random.normal());
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
    let gain = 1.0 + broken.random.sign() * (0.02 + 0.13 * broken.random.uniform());
    for row in &mut broken.record.accel_g {
        row[axis] *= gain;
    }
}

pub(super) fn one_axis_in_other_unit(broken: &mut Broken) {
    let axis = broken.liveliest();
    for row in &mut broken.record.accel_g {
        row[axis] *= 9.806_65;
    }
}

/// A turn by 5 to 60 degrees about an axis across the vertical.
pub(super) fn jump(broken: &mut Broken) {
    let from = broken.place(600, broken.rows() - 600);
    let angle_rad = (5.0 + 55.0 * broken.random.uniform()).to_radians();
    let up = broken.record.accel_g[from];
    let any: [f64; 3] = core::array::from_fn(|_| broken.random.normal());
    let across = [
        any[1] * up[2] - any[2] * up[1],
        any[2] * up[0] - any[0] * up[2],
        any[0] * up[1] - any[1] * up[0],
    ];
    let size = across.iter().map(|x| x * x).sum::<f64>().sqrt();
    let turn = Attitude::turned_by(across.map(|x| x * angle_rad / size));
    for row in &mut broken.record.accel_g[from..] {
        *row = turn.resolve(*row);
    }
}

/// Half an hour to four hours.
pub(super) fn lose(broken: &mut Broken) {
    let block = broken.block([0.5, 4.0]);
    broken.record.accel_g.drain(block.clone());
    let rows = broken.record.accel_g.len();
    broken.record.time_s.truncate(rows);
}

pub(super) fn jump_clock(broken: &mut Broken) {
    let from = broken.place(600, broken.rows() - 600);
    let by_s = 1800.0 + 12_600.0 * broken.random.uniform();
    for time_s in &mut broken.record.time_s[from..] {
        *time_s += by_s;
    }
}

pub(super) fn stand_still(broken: &mut Broken) {
    let up = broken.record.accel_g[0];
    for row in &mut broken.record.accel_g {
        *row = core::array::from_fn(|axis| up[axis] + 1e-5 * broken.random.normal());
    }
}

pub(super) fn exchange_axes(broken: &mut Broken) {
    let pair = *broken.random.one_of(&[[0, 1], [1, 2], [0, 2]]);
    for row in &mut broken.record.accel_g {
        row.swap(pair[0], pair[1]);
    }
}

pub(super) fn negate_axis(broken: &mut Broken) {
    let axis = broken.axis();
    for row in &mut broken.record.accel_g {
        row[axis] *= -1.0;
    }
}

pub(super) fn turn_axes(broken: &mut Broken) {
    for row in &mut broken.record.accel_g {
        row.rotate_left(1);
    }
}

/// A record divided by standard gravity, at a site whose gravity is 0.03 to 0.25 % off.
pub(super) fn standard_gravity(broken: &mut Broken) {
    let ratio = 1.0 + broken.random.sign() * (3e-4 + 2.2e-3 * broken.random.uniform());
    scale(broken, [ratio; 3]);
}

pub(super) fn common_scale(broken: &mut Broken) {
    let ratio = 1.0 + broken.random.sign() * (0.01 + 0.05 * broken.random.uniform());
    scale(broken, [ratio; 3]);
}
