//! The replay on the host: the lines that the target must print too.

use gyrocal::Integration;
use gyrocal_firmware_test::{
    CASES, Digest, Filter, INTERVAL_S, Record, Report, answers, attitude, settings,
};

pub(crate) fn run() {
    let words: Vec<String> = std::env::args().collect();
    let has = |word: &str| words.iter().any(|given| given == word);
    let integration = if has("euler") {
        Integration::EULER
    } else {
        Integration::RK4
    };
    let rows = if has("short") { 1440 } else { Record.len() };
    let mut filter = Filter::unset();
    for (case, answer) in CASES.iter().zip(answers(&mut filter)) {
        println!("bad_input {case} {}", u32::from(answer));
    }
    let started = filter.start(&settings(integration), &attitude());
    let mut digest = Digest::default();
    let mut nis = filter
        .update(&Record.sample(0))
        .map_or(0.0, |innovation| innovation.nis);
    for row in 1..rows {
        match filter.step(INTERVAL_S, &Record.sample(row)) {
            Ok(innovation) => nis = innovation.nis,
            Err(error) => {
                println!("error {row} {error}");
                break;
            }
        }
        digest.add_step(&filter, nis);
        if row % 720 == 0 {
            println!("digest {row} {:016x}", digest.0);
        }
    }
    if started.is_err() {
        println!("error 0 not started");
    }
    let mut saved = [0; Filter::SAVED_BYTES];
    let _ = filter.save(&mut saved);
    for (index, bits) in Report::of(&filter, nis).bits().enumerate() {
        println!("number {index} {bits:016x}");
    }
}
