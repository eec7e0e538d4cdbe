//! The watch against a direct computation: every onset and effect propagated by itself, from its first
//! step on, without blocks.
#![cfg(test)]

use chacha20::ChaCha12Rng;
use chacha20::rand_core::{Rng, SeedableRng};
use gyrocal_watch::{
    Budget, Calendar, Course, Driven, Entry, Observed, Settings, Step, Value, Watch,
};

const BLOCK: usize = 20;
const SPAN: usize = 2;
const ONSETS: usize = 4;

/// One moving state, two parameters, two outputs; a change of a parameter, a ramp of the other, and an
/// offset of an output that grows.
type Small = Watch<f64, 1, 2, 3, 2, 3, ONSETS, 3, 6>;

struct Random(ChaCha12Rng);

impl Random {
    fn number(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
    fn array<const N: usize>(&mut self) -> [f64; N] {
        core::array::from_fn(|_| self.number())
    }
}

/// An effect from an onset, propagated by itself.
struct Direct {
    effect: usize,
    onset: usize,
    deviation: [f64; 3],
    score: f64,
    information: f64,
}

impl Direct {
    fn step(
        &mut self,
        row: usize,
        transition: &[f64; 3],
        at: &Observed<f64, 1, 2, 3>,
        nu: [f64; 2],
    ) {
        let since = (row - self.onset) as f64 / BLOCK as f64;
        let before = since - 1.0 / BLOCK as f64;
        // The effect as it enters: mean over the step, and at its end.
        let (parameter, output) = match self.effect {
            0 => ([1.0, 0.0], 0.0),
            1 => ([0.0, 0.5 * (before + since) * 0.3], 0.0),
            _ => ([0.0, 0.0], 1.0),
        };
        let [x, p, q] = self.deviation;
        let moving = transition[0] * x
            + transition[1] * (p + parameter[0])
            + transition[2] * (q + parameter[1]);
        self.deviation[0] = moving;
        let shown: [f64; 2] =
            core::array::from_fn(|k| at.output[k][0] * moving + at.whitening[k][1] * output);
        for k in 0..2 {
            self.score += shown[k] * nu[k];
            self.information += shown[k] * shown[k];
            for i in 0..3 {
                self.deviation[i] -= at.gain[k][i] * shown[k];
            }
        }
    }
}

#[test]
#[expect(clippy::too_many_lines, reason = "one simulation, watched twice")]
fn statistics_are_those_of_a_direct_computation() {
    let mut random = Random(ChaCha12Rng::seed_from_u64(20_261_122));
    let entry = |value, slope, from_onset| Entry {
        value,
        slope,
        from_onset,
    };
    let entries = [
        entry(Value::State(1), 2, false),
        entry(Value::State(2), 0, true),
        entry(Value::Driven(1), 2, false),
    ];
    let course = |start, change| Course { start, change };
    let courses = [course(1.0, 0.0), course(0.0, 0.3), course(1.0, 0.0)];
    let budget = Budget {
        alpha: 0.01,
        onsets_per_year: 100.0,
        for_ever: false,
    };
    let settings = Settings {
        block_steps: BLOCK as u32,
        span_steps: SPAN as u32,
        precision: [0.5, 0.2, 0.1],
        jump_precision: [0.3],
        budget,
        jump_budget: budget,
    };
    let mut watch = Small::unset([Driven::Slope(2), Driven::Output(1)], entries);
    assert!(watch.start(&settings, &courses));
    let calendar = Calendar::of_slots(ONSETS);
    let threshold = budget.threshold(calendar.weight(ONSETS - 1));
    let mut direct: Vec<Direct> = Vec::new();
    let mut compared = 0;
    let mut kept = Kept::new();
    for row in 1..=BLOCK * 40 {
        if (row - 1) % BLOCK == 0 {
            for effect in 0..3 {
                direct.push(Direct {
                    effect,
                    onset: row - 1,
                    deviation: [0.0; 3],
                    score: 0.0,
                    information: 0.0,
                });
            }
        }
        let mut transition: [f64; 3] = random.array();
        transition[0] = 0.8 + 0.1 * transition[0];
        let at = Observed {
            output: [[0.3 + 0.1 * random.number()], [0.2 * random.number()]],
            whitening: [[1.0, 0.0], random.array()],
            gain: [
                random.array::<3>().map(|gain| 0.1 * gain),
                random.array::<3>().map(|gain| 0.1 * gain),
            ],
        };
        // Innovations that an effect shifts, so that the evidence is large.
        let nu = random.array::<2>().map(|number| number + 0.5);
        for one in &mut direct {
            one.step(row, &transition, &at, nu);
        }
        let step = Step {
            transition: &[transition],
            observed: Some(&at),
            part: 1.0 / BLOCK as f64,
        };
        let _ = watch.step(&step, &nu);
        // All cells of the block before have been taken, and no step of this block counts yet.
        if row > BLOCK && row % BLOCK == BLOCK - 1 {
            let block = (row / BLOCK) as u32;
            compared += 1;
            let statistic = direct_statistic(&kept, calendar, block, &settings);
            let found = watch.statistics()[0] * threshold;
            // Sums in another order: some thousand roundings.
            assert!(
                (found - statistic).abs() <= 1e-9 * statistic.max(1.0),
                "{found} {statistic}"
            );
        }
        if watch.block_is_over() {
            watch.end_block(&courses);
            let numbers = |one: &Direct| (one.effect, one.onset, one.score, one.information);
            kept = direct.iter().map(numbers).collect();
        }
    }
    assert!(compared > 0);
}

/// Effect, onset, score and information at the end of a block.
type Kept = Vec<(usize, usize, f64, f64)>;

fn direct_statistic(
    kept: &Kept,
    calendar: Calendar,
    block: u32,
    settings: &Settings<f64, 3, 1>,
) -> f64 {
    let mut sum = 0.0;
    for slot in 0..ONSETS {
        let Some(onset) = calendar.latest(slot, block).filter(|onset| *onset < block) else {
            continue;
        };
        for (effect, start, score, information) in kept {
            if *start == onset as usize * BLOCK {
                let precision = settings.precision[*effect];
                let exponent = score * score / (2.0 * (precision + information));
                let value = (precision / (precision + information)).sqrt() * exponent.exp();
                if exponent > 6.0 {
                    sum += calendar.weight::<f64>(slot) / 3.0 * value;
                }
            }
        }
    }
    sum
}
