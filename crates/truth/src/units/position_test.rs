//! Logs of multi-position tests whose stops, motion and errors are known.

use core::f64::consts::TAU;
use core::ops::Range;

use gyrocal_statistics::deviates::Draw;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// Errors of a unit of three gyros and three accelerometers.
#[derive(Debug, Clone)]
pub struct UnitErrors {
    /// Bias of the gyros \[rad/s\].
    pub gyro_bias: Vector3<f64>,
    /// Rate of each gyro per g along each axis \[rad/s/g\].
    pub gyro_g: Matrix3<f64>,
    /// Rate of each gyro per squared g along its own axis \[rad/s/g²\].
    pub gyro_gg: Vector3<f64>,
    /// Bias of the accelerometers \[g\].
    pub accel_bias: Vector3<f64>,
    /// Output of the accelerometers per g along each axis: input axes times scales.
    pub accel_matrix: Matrix3<f64>,
    /// Standard deviation of a sample of a gyro \[rad/s\].
    pub gyro_noise: f64,
    /// Standard deviation of a sample of an accelerometer \[g\].
    pub accel_noise: f64,
}

/// Samples of a unit; all vectors have the same length.
#[derive(Debug, Clone, Default)]
pub struct Samples {
    /// Rates \[rad/s\].
    pub gyro: Vec<[f64; 3]>,
    /// Specific force \[g\].
    pub accel: Vec<[f64; 3]>,
    /// The true stops.
    pub stops: Vec<Range<usize>>,
}

impl UnitErrors {
    /// Outputs at a true rate and specific force.
    pub fn measure(
        &self,
        rate: Vector3<f64>,
        force: Vector3<f64>,
        draw: &mut Draw,
    ) -> [[f64; 3]; 2] {
        let squares = self.gyro_gg.component_mul(&force.component_mul(&force));
        let law = rate + self.gyro_bias + self.gyro_g * force + squares;
        let gyro = law + self.gyro_noise * vector(draw);
        let accel = self.accel_bias + self.accel_matrix * force + self.accel_noise * vector(draw);
        [gyro.into(), accel.into()]
    }
}

/// Specific force of six positions, each axis up and down, or of twelve, with the six edges between axes in
/// addition; each as well as somebody sets it, within two degrees.
pub fn positions(count: usize, draw: &mut Draw) -> Vec<Vector3<f64>> {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let faces = axes.into_iter().flat_map(|axis| [axis, -axis]);
    let edges = (0..3).flat_map(|i| {
        let [one, other] = [axes[i], axes[(i + 1) % 3]];
        [one + other, one - other]
    });
    faces
        .chain(edges)
        .take(count)
        .map(|force| (force.normalize() + 0.02 * vector(draw)).normalize())
        .collect()
}

/// A stop at a specific force, on an Earth that turns, in a random heading.
pub fn stop(
    unit: &UnitErrors,
    force: Vector3<f64>,
    samples: usize,
    earth: [f64; 2],
    draw: &mut Draw,
) -> Samples {
    let [vertical, horizontal] = earth;
    let north = vector(draw).cross(&force).normalize();
    let rate = vertical * force + horizontal * north;
    let mut log = Samples::default();
    for _ in 0..samples {
        let [gyro, accel] = unit.measure(rate, force, draw);
        log.gyro.push(gyro);
        log.accel.push(accel);
    }
    log.stops.push(0..samples);
    log
}

/// A hand-held test: stops of 3 to 8 s with the tremor and the wander of a hand, and turns of 0.5 to 3 rad
/// in 1 to 3 s between them. `tremor` is the rms rate about each axis \[rad/s\].
pub fn hand_held(
    unit: &UnitErrors,
    stops: usize,
    rate_hz: f64,
    tremor: f64,
    draw: &mut Draw,
) -> Samples {
    let mut log = Samples::default();
    let mut attitude = UnitQuaternion::from_scaled_axis(3.0 * vector(draw));
    let mut shaken = attitude;
    let mut shake = Shake::new(tremor, draw);
    for number in 0..stops {
        let rest = ((3.0 + 5.0 * draw.uniform()) * rate_hz) as usize;
        let from = log.gyro.len();
        for _ in 0..rest {
            log.add(unit, attitude, &mut shaken, &mut shake, rate_hz, draw);
        }
        log.stops.push(from..log.gyro.len());
        if number + 1 == stops {
            break;
        }
        let turn = ((1.0 + 2.0 * draw.uniform()) * rate_hz) as usize;
        let axis = vector(draw).normalize();
        let angle = 0.5 + 2.5 * draw.uniform();
        let passed = |step: usize| {
            let share = step as f64 / turn as f64;
            angle * (share - (TAU * share).sin() / TAU)
        };
        for step in 0..turn {
            attitude *= UnitQuaternion::from_scaled_axis(axis * (passed(step + 1) - passed(step)));
            log.add(unit, attitude, &mut shaken, &mut shake, rate_hz, draw);
        }
    }
    log
}

impl Samples {
    /// Adds a sample of the mean attitude with the shaking of the hand.
    fn add(
        &mut self,
        unit: &UnitErrors,
        attitude: UnitQuaternion<f64>,
        before: &mut UnitQuaternion<f64>,
        shake: &mut Shake,
        rate_hz: f64,
        draw: &mut Draw,
    ) {
        let next = attitude * UnitQuaternion::from_scaled_axis(shake.next(1.0 / rate_hz));
        let rate = (before.inverse() * next).scaled_axis() * rate_hz;
        *before = next;
        let [gyro, accel] = unit.measure(rate, next.inverse() * Vector3::z(), draw);
        self.gyro.push(gyro);
        self.accel.push(accel);
    }
}

/// Angles of a shaking hand: tremor of 8 to 12 Hz, sway of 0.5 to 2 Hz, and half of the rate in each.
struct Shake {
    time_s: f64,
    parts: Vec<(Vector3<f64>, f64, f64)>,
}

impl Shake {
    fn new(tremor: f64, draw: &mut Draw) -> Self {
        let mut parts = Vec::new();
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            for [low, high] in [[0.5, 2.0], [8.0, 12.0]] {
                let frequency = TAU * (low + (high - low) * draw.uniform());
                // Two sines, each with half of the mean square.
                let size = tremor / frequency;
                parts.push((size * axis, frequency, TAU * draw.uniform()));
            }
        }
        Self { time_s: 0.0, parts }
    }

    fn next(&mut self, step_s: f64) -> Vector3<f64> {
        self.time_s += step_s;
        self.parts
            .iter()
            .map(|(size, frequency, phase)| size * (frequency * self.time_s + phase).sin())
            .sum()
    }
}

/// Three normal deviates.
pub fn vector(draw: &mut Draw) -> Vector3<f64> {
    Vector3::new(draw.normal(), draw.normal(), draw.normal())
}
