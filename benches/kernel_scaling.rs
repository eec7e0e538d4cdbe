//! Cost of one filter step against the number of states n: three moving, the rest constant
//! parameters in vectors of run-time length. `cargo figures kernel --part filter` holds it against n².
#![expect(clippy::unwrap_used, reason = "a bench stops at what fails")]

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use gyrocal::Integration;
use gyrocal_testkit::extended_filter::{SIZES, samples, start, step};

/// Steps from the start before a filter starts again: four hours.
const STEPS: usize = 240;

fn kernel_scaling(criterion: &mut Criterion) {
    let samples = samples(STEPS).unwrap();
    for (name, integration) in [("euler", Integration::EULER), ("rk4", Integration::RK4)] {
        let mut group = criterion.benchmark_group(format!("kernel_scaling/{name}"));
        group
            .warm_up_time(Duration::from_millis(300))
            .measurement_time(Duration::from_secs(1));
        for states in SIZES {
            let start = start(states, integration).unwrap();
            // Per "element": nanoseconds for each entry of the covariance.
            group.throughput(Throughput::Elements((states * states) as u64));
            group.bench_function(BenchmarkId::from_parameter(states), |bencher| {
                bencher.iter_custom(|iterations| {
                    let mut elapsed = Duration::ZERO;
                    let mut left = iterations as usize;
                    while left > 0 {
                        let mut filter = start.clone();
                        let count = left.min(STEPS);
                        let begin = Instant::now();
                        for sample in &samples[..count] {
                            step(&mut filter, sample).unwrap();
                        }
                        elapsed += begin.elapsed();
                        black_box(&filter);
                        left -= count;
                    }
                    elapsed
                })
            });
        }
        group.finish();
    }
}

criterion_group!(benches, kernel_scaling);
criterion_main!(benches);
