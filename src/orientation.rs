use gyrocal_scalar::Real;

use crate::rotation::{dot, rotate};

/// Orientation of a chart: unit vectors North and Up along its axes.
///
/// In single precision a turn would round each component by 3e-8, a tenth of the noise of the drift
/// over a minute: coefficients would be off by two tenths of their sigmas after three days. There
/// the parts that rounding leaves are carried along, and a turn is applied as the small change that
/// it makes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Orientation<T> {
    pub(crate) north: [T; 3],
    pub(crate) up: [T; 3],
    /// What rounding left of North and Up; zero in double precision.
    low: [[T; 3]; 2],
    turns: u32,
}

/// Numbers of an orientation that the next turns depend on.
pub(crate) type Numbers<T> = [[T; 3]; 4];

impl<T: Real> Orientation<T> {
    pub(crate) const fn new(north: [T; 3], up: [T; 3]) -> Self {
        Self {
            north,
            up,
            low: [[T::ZERO; 3]; 2],
            turns: 0,
        }
    }

    /// Other vectors at the same count of turns.
    pub(crate) fn set(&mut self, [north, up]: &[[T; 3]; 2]) {
        let turns = self.turns;
        *self = Self::new(*north, *up);
        self.turns = turns;
    }

    pub(crate) fn saved(&self) -> (Numbers<T>, u32) {
        let [north_low, up_low] = self.low;
        ([self.north, self.up, north_low, up_low], self.turns)
    }

    pub(crate) fn restore(&mut self, [north, up, north_low, up_low]: Numbers<T>, turns: u32) {
        *self = Self {
            north,
            up,
            low: [north_low, up_low],
            turns,
        };
    }

    /// Rotates the axes: `matrix` takes old components to new ones.
    #[inline(always)]
    pub(crate) fn turn(&mut self, matrix: &[[T; 3]; 3]) {
        if T::is_coarse() {
            self.turn_by_changes(matrix);
        } else {
            self.north = rotate(matrix, &self.north);
            self.up = rotate(matrix, &self.up);
        }
        self.turns = self.turns.wrapping_add(1);
        // Rounding adds at most some units of the last place a turn; in f32 that would matter
        // after a few thousand.
        if self.turns & 63 == 0 {
            if T::is_coarse() {
                self.orthonormalise_by_changes();
            } else {
                self.orthonormalise();
            }
        }
    }

    #[inline(never)]
    fn turn_by_changes(&mut self, matrix: &[[T; 3]; 3]) {
        let one = T::from_f64(1.0);
        // The matrix less the unit matrix. On the diagonal it comes from the unit length of the row,
        // because the matrix itself has it rounded to the last place of one.
        let mut change = *matrix;
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let across = matrix[i][j] * matrix[i][j] + matrix[i][k] * matrix[i][k];
            change[i][i] = if matrix[i][i] > T::from_f64(0.5) {
                -across / (one + matrix[i][i])
            } else {
                matrix[i][i] - one
            };
        }
        let [north_low, up_low] = &mut self.low;
        let (north, up) = (rotate(&change, &self.north), rotate(&change, &self.up));
        add(&mut self.north, north_low, &north);
        add(&mut self.up, up_low, &up);
    }

    #[cold]
    #[inline(never)]
    fn orthonormalise_by_changes(&mut self) {
        let (one, half) = (T::from_f64(1.0), T::from_f64(0.5));
        let [north_low, up_low] = &mut self.low;
        // To first order: what is left to correct is a few units of the last place.
        let scale = half * (one - dot(&self.up, &self.up));
        let change = self.up.map(|up| up * scale);
        add(&mut self.up, up_low, &change);
        let along = dot(&self.up, &self.north);
        let scale = half * (one - dot(&self.north, &self.north));
        let mut change = self.north.map(|north| north * scale);
        for (change, up) in change.iter_mut().zip(self.up) {
            *change = *change - along * up;
        }
        add(&mut self.north, north_low, &change);
    }

    #[cold]
    #[inline(never)]
    fn orthonormalise(&mut self) {
        let one = T::from_f64(1.0);
        let scale = one / dot(&self.up, &self.up).sqrt();
        self.up = self.up.map(|component| component * scale);
        let along = dot(&self.up, &self.north);
        for i in 0..3 {
            self.north[i] = self.north[i] - along * self.up[i];
        }
        let scale = one / dot(&self.north, &self.north).sqrt();
        self.north = self.north.map(|component| component * scale);
    }
}

/// Adds a change to numbers of which rounding left `low`.
#[inline(always)]
fn add<T: Real>(number: &mut [T; 3], low: &mut [T; 3], change: &[T; 3]) {
    for i in 0..3 {
        let change = low[i] + change[i];
        let sum = number[i] + change;
        low[i] = change - (sum - number[i]);
        number[i] = sum;
    }
}
