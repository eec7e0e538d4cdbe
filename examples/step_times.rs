//! Times of a filter step of the structured and of the textbook filter, which `cargo figures kernel --part filter`
//! reads in builds for several processors: `cargo run --release --example step_times -- ROUNDS`.
//!
//! For each rule of integration a line with three times in nanoseconds (structured, textbook,
//! structured on the factors) and their ratios to the first.

use gyrocal_testkit::step_times::step_times;
use gyrocal_testkit::timing::{processor, target_features};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rounds = std::env::args()
        .nth(1)
        .map_or(Ok(101), |text| text.parse())?;
    println!("{}, {}", processor(), target_features());
    for times in step_times(rounds)? {
        let words: Vec<String> = times
            .ns
            .iter()
            .chain(&times.ratios)
            .map(|number| format!("{number:.3}"))
            .collect();
        println!("{} {}", times.rule, words.join(" "));
    }
    Ok(())
}
