//! Kinds of records of a plant of its user's, the servo of the examples, by a simulator of its own.

use gyrocal_plant::{LoadedPlant, PlantRecord, SearchOptions, diagnose};
use gyrocal_statistics::deviates::Draw;

use super::FieldOutcome;
use super::judge::{Told, judge};
use super::right::{Right, Silent, UNLISTED};

/// A kind of records of the servo `examples/servo`: a voltage turns an axis, whose angle is read.
#[derive(Clone, Copy, Debug)]
pub struct PlantKind {
    /// What the records are, in words.
    pub name: &'static str,
    /// The answer that is right for them.
    pub right: &'static Right,
    axis: Servo,
}

/// What the servo and its record have that the model lacks.
#[derive(Clone, Copy, Debug)]
struct Servo {
    feedback: Feedback,
    /// Correlation of the noise of successive readings.
    correlation: f64,
    /// Noise of the rate \[rad/s/√s\].
    process: f64,
    /// Noise of the logged voltage over its root mean square.
    input: f64,
    delay_s: f64,
    /// Share of the gain that is lost by the end.
    fade: f64,
    /// Amplitude of a wave of the gain over the gain.
    wave: f64,
}

/// Where the voltage comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Feedback {
    None,
    /// The reading of the row before.
    Late,
    /// The reading of the row itself.
    Immediate,
}

const SERVO: Servo = Servo {
    feedback: Feedback::None,
    correlation: 0.0,
    process: 0.0,
    input: 0.0,
    delay_s: 0.0,
    fade: 0.0,
    wave: 0.0,
};

const NONE: Right = Right::NOTHING;
/// Noise may be told of any source.
const NOISY: Right =
    Right::told(&[&["y.noise", "drive.noise", "rate_rate.noise"]]).silent(Silent::Always);
const DELAY: Right = Right::in_set(&[&["drive.delay"]]);
const FADE: Right = Right::in_set(&[&["a.drift", "a.ramp"]]).near(&["a.step"]);
const WAVE: Right = Right::in_set(&[&[UNLISTED]]).near(&["a.step"]);

/// First seed of the kinds.
const FIRST_SEED: u64 = 500_000_000;

const ROWS: usize = 600;
const STEP_S: f64 = 0.02;
/// Gain of the motor and friction over inertia, noise of the encoder.
const GAIN: f64 = 30.0;
const FRICTION_PER_S: f64 = 4.0;
const NOISE_RAD: f64 = 0.002;
/// Rows for which a reference is held, under feedback and without.
const HELD: [usize; 2] = [40, 8];
/// Steps of the simulation in a row.
const FINE: usize = 20;

impl PlantKind {
    /// All kinds. New ones come last: places are the seeds of the records.
    #[rustfmt::skip]
    pub const ALL: &[Self] = &[
        kind("white noise", &NONE, SERVO),
        kind("noise of correlation 0.5", &NOISY, Servo { correlation: 0.5, ..SERVO }),
        kind("noise of correlation 0.9", &NOISY, Servo { correlation: 0.9, ..SERVO }),
        kind("noise of the rate", &NOISY, Servo { process: 0.005, ..SERVO }),
        kind("noise of a tenth on the logged input", &NOISY, Servo { input: 0.1, ..SERVO }),
        kind("feedback of the row before", &NONE, Servo { feedback: Feedback::Late, ..SERVO }),
        kind("feedback of the same row", &NONE, Servo { feedback: Feedback::Immediate, ..SERVO }),
        kind("a dead time of 0.15 s", &DELAY, Servo { delay_s: 0.15, ..SERVO }),
        kind("a gain that fades by a fifth", &FADE, Servo { fade: 0.2, ..SERVO }),
        kind("a gain with a wave of a tenth", &WAVE, Servo { wave: 0.1, ..SERVO }),
    ];

    /// The first seed of a kind, by its place in [`Self::ALL`].
    #[must_use]
    pub fn first_seed(place: u64) -> u64 {
        FIRST_SEED + super::APART * place
    }

    /// Makes the record of a seed, diagnoses it with the plant of `examples/servo` and judges the answer.
    #[must_use]
    pub fn run(&self, plant: &LoadedPlant, seed: u64) -> FieldOutcome {
        let record = self
            .axis
            .record(seed)
            .prepared(plant.description(), "simulated");
        let found = record.and_then(|record| {
            let found = diagnose(plant, record, None, &SearchOptions::default())?;
            Ok(found.answer)
        });
        judge(self.right, None, false, &Told::of_plant(found.as_ref()))
    }
}

const fn kind(name: &'static str, right: &'static Right, axis: Servo) -> PlantKind {
    PlantKind { name, right, axis }
}

impl Servo {
    fn record(&self, seed: u64) -> PlantRecord {
        let random = &mut Draw::new(seed, 41);
        let near = |random: &mut Draw, value: f64| value * random.log_uniform([0.8, 1.25]);
        let [gain, friction] = [GAIN, FRICTION_PER_S].map(|value| near(random, value));
        let (mut angle, mut rate) = (0.2 * random.normal(), 0.5 * random.normal());
        let [mut noise_rad, mut reference] = [NOISE_RAD * random.normal(), 0.0];
        let mut before = angle + noise_rad;
        let mut record = PlantRecord::default();
        for row in 0..ROWS {
            let fresh = (1.0 - self.correlation * self.correlation).sqrt() * random.normal();
            noise_rad = self.correlation * noise_rad + NOISE_RAD * fresh;
            let reading = angle + noise_rad;
            if row % HELD[usize::from(self.feedback == Feedback::None)] == 0 {
                reference = 2.0 * random.uniform() - 1.0;
            }
            record.time_s.push(row as f64 * STEP_S);
            record.outputs.push(reading);
            record.inputs.push(match self.feedback {
                Feedback::None => reference,
                Feedback::Late => 2.0 * (reference - before),
                Feedback::Immediate => 2.0 * (reference - reading),
            });
            before = reading;
            let part_s = STEP_S / FINE as f64;
            for part in 0..FINE {
                let rows = row as f64 + part as f64 / FINE as f64;
                let place = (rows - self.delay_s / STEP_S).max(0.0) as usize;
                let share = rows / ROWS as f64;
                let wave = self.wave * libm::sin(9.0 * core::f64::consts::TAU * share);
                let drive = gain * (1.0 - self.fade * share + wave) * record.inputs[place];
                // Exact for a drive that is held.
                let (end, decay) = (drive / friction, libm::exp(-friction * part_s));
                angle += end * part_s + (rate - end) * (1.0 - decay) / friction;
                rate = end + (rate - end) * decay;
                rate += self.process * part_s.sqrt() * random.normal();
            }
        }
        let square: f64 = record.inputs.iter().map(|drive| drive * drive).sum();
        let sigma = self.input * (square / ROWS as f64).sqrt();
        record
            .inputs
            .iter_mut()
            .for_each(|drive| *drive += sigma * random.normal());
        record
    }
}
