//! Campaigns: the same results whatever the threads and however often they were stopped.

// Failing here is what tests are for.
#![cfg(test)]

use std::fs::{self, File};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::Duration;

use gyrocal_evaluation::{Campaign, EvaluationError, Fingerprint, Outcome, Progress};
use gyrocal_hypothesis::{Stop, stop};
use serde::{Deserialize, Serialize};
use tempfile::TempDir;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Drawn {
    /// With all its bits in use.
    value: f64,
    tiny: f64,
}

/// Fails for each seventh seed.
fn job(seed: u64) -> Result<Drawn, String> {
    let value = (seed as f64 + 0.1).sqrt().sin() / 3.0;
    match seed % 7 {
        6 => Err(format!("seed {seed} is \"odd\"\nin two lines")),
        _ => Ok(Drawn {
            value,
            tiny: value * 1e-310,
        }),
    }
}

fn fingerprint() -> Fingerprint {
    Fingerprint::new("test").with("options", "a\nb")
}

fn campaign(seeds: std::ops::Range<u64>) -> Campaign {
    Campaign::new(seeds, fingerprint())
}

fn fresh(seeds: std::ops::Range<u64>) -> Outcome<Drawn> {
    campaign(seeds).run(job, |_| ()).unwrap()
}

fn results_of(outcome: &Outcome<Drawn>) -> Vec<(u64, Result<Drawn, String>)> {
    let successes = outcome
        .successes()
        .map(|(seed, drawn)| (seed, Ok(drawn.clone())));
    let failures = outcome
        .failures()
        .map(|failure| (failure.seed, Err(failure.message)));
    let mut all: Vec<_> = successes.chain(failures).collect();
    all.sort_by_key(|(seed, _)| *seed);
    all
}

fn file() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("runs.jsonl");
    (folder, path)
}

/// Runs with a file and says which seeds the job was asked for, sorted.
fn asked(campaign: &Campaign) -> (Outcome<Drawn>, Vec<u64>) {
    let seeds = Mutex::new(Vec::new());
    let outcome = campaign
        .run(
            |seed| {
                seeds.lock().unwrap().push(seed);
                job(seed)
            },
            |_| (),
        )
        .unwrap();
    let mut seeds = seeds.into_inner().unwrap();
    seeds.sort_unstable();
    (outcome, seeds)
}

#[test]
fn every_seed_has_the_result_of_its_job_bit_for_bit() {
    let found = results_of(&fresh(3..40));
    assert_eq!(found.len(), 37);
    for ((seed, result), expected) in found.into_iter().zip(3..) {
        assert_eq!(seed, expected);
        assert_eq!(result, job(seed));
    }
}

#[test]
fn threads_and_file_change_nothing() {
    let expected = results_of(&fresh(0..50));
    for threads in [1, 2, 5] {
        let (_folder, path) = file();
        let campaign = campaign(0..50).threads(NonZeroUsize::new(threads).unwrap());
        let in_memory = campaign.run(job, |_| ()).unwrap();
        assert_eq!(results_of(&in_memory), expected);
        let (written, _) = asked(&campaign.clone().results(&path));
        assert_eq!(results_of(&written), expected);
        let (read, asked) = asked(&campaign.results(&path));
        assert_eq!(results_of(&read), expected);
        assert!(asked.is_empty(), "read from the file: {asked:?}");
    }
}

#[test]
fn finished_seeds_are_not_run_again_nor_are_failed_ones() {
    let (_folder, path) = file();
    let (_, first) = asked(&campaign(5..10).results(&path));
    assert_eq!(first, [5, 6, 7, 8, 9]);
    // Seed 6 failed.
    let (outcome, second) = asked(&campaign(3..12).results(&path));
    assert_eq!(second, [3, 4, 10, 11]);
    assert_eq!(outcome.resumed(), 5);
    assert_eq!(results_of(&outcome), results_of(&fresh(3..12)));
    let (outcome, third) = asked(&campaign(8..11).results(&path));
    assert!(third.is_empty());
    assert_eq!(results_of(&outcome), results_of(&fresh(8..11)));
}

/// A kill can leave the file with any beginning of what was to be written.
#[test]
fn a_file_cut_anywhere_is_mended() {
    let (_folder, path) = file();
    let one = NonZeroUsize::new(1).unwrap();
    let campaign = campaign(4..8).threads(one).results(&path);
    let expected = results_of(&asked(&campaign).0);
    let whole = fs::read(&path).unwrap();
    for length in 0..whole.len() {
        fs::write(&path, &whole[..length]).unwrap();
        let (outcome, again) = asked(&campaign);
        assert_eq!(results_of(&outcome), expected, "cut at {length}");
        let kept = whole[..length]
            .iter()
            .filter(|byte| **byte == b'\n')
            .count();
        assert_eq!(again.len(), 4 - kept.saturating_sub(1), "cut at {length}");
        assert_eq!(fs::read(&path).unwrap(), whole, "cut at {length}");
    }
}

#[test]
fn files_of_others_are_refused_and_not_touched() {
    let (_folder, path) = file();
    let refusal = |campaign: Campaign, content: &[u8]| {
        fs::write(&path, content).unwrap();
        let error = campaign.results(&path).run(job, |_| ()).unwrap_err();
        assert_eq!(fs::read(&path).unwrap(), content);
        error
    };
    for foreign in [
        &b"a text"[..],
        b"a\ntext\n",
        b"\n",
        b"{}\n",
        b"\xff\n",
        b"\0",
    ] {
        let error = refusal(campaign(0..3), foreign);
        assert!(
            matches!(error, EvaluationError::NoResults { .. }),
            "{error}"
        );
    }
    asked_into(&path);
    // A torn line is not cut off a file of another campaign either.
    let mut content = fs::read(&path).unwrap();
    content.pop();
    let other = Campaign::new(0..3, Fingerprint::new("test").with("options", "a\nc"));
    let error = refusal(other, &content);
    assert!(
        matches!(error, EvaluationError::OtherCampaign { .. }),
        "{error}"
    );
    let said = error.to_string();
    assert!(said.contains("of options `b`, expected `c`"), "{said}");
}

fn asked_into(path: &PathBuf) {
    fs::remove_file(path).unwrap();
    asked(&campaign(0..3).results(path));
}

#[test]
fn a_whole_line_that_makes_no_sense_is_shown() {
    let (_folder, path) = file();
    asked(&campaign(0..3).results(&path));
    let good = fs::read_to_string(&path).unwrap();
    let doubled = format!("{good}{}\n", good.lines().nth(1).unwrap());
    let cases = [
        (
            good.replacen("\"value\":", "\"vale\":", 1),
            2,
            "missing field",
        ),
        (format!("{good}\n"), 5, "EOF"),
        (doubled, 5, "a second result of seed"),
    ];
    for (content, expected_line, expected) in cases {
        fs::write(&path, content).unwrap();
        let error = campaign(0..3).results(&path).run(job, |_| ()).unwrap_err();
        let said = error.to_string();
        let EvaluationError::Line { line, reason, .. } = error else {
            panic!("{said}");
        };
        assert_eq!(line, expected_line, "{said}");
        assert!(reason.contains(expected), "{said}");
    }
}

#[test]
fn two_processes_on_one_file_are_refused() {
    let (_folder, path) = file();
    asked(&campaign(0..3).results(&path));
    // A lock belongs to an open file, so another one here stands for another process.
    let other = File::open(&path).unwrap();
    other.lock().unwrap();
    let run = || campaign(0..5).results(&path).run(job, |_| ());
    let error = run().unwrap_err();
    assert!(matches!(error, EvaluationError::Busy { .. }), "{error}");
    drop(other);
    assert_eq!(results_of(&run().unwrap()), results_of(&fresh(0..5)));
}

#[test]
fn a_result_that_json_has_not_is_an_error_and_not_another_result() {
    let error = Campaign::new(0..5, fingerprint())
        .run(
            |seed| Ok::<_, String>(if seed == 3 { f64::NAN } else { 1.0 }),
            |_| (),
        )
        .unwrap_err();
    assert!(
        matches!(error, EvaluationError::Unstorable { seed: 3, .. }),
        "{error}"
    );
}

#[test]
fn the_message_of_a_failure_has_its_sources() {
    #[derive(Debug, thiserror::Error)]
    #[error("outer")]
    struct Outer {
        source: std::num::ParseIntError,
    }
    let outcome = Campaign::new(0..1, fingerprint())
        .run(
            |_| "x".parse::<u64>().map_err(|source| Outer { source }),
            |_| (),
        )
        .unwrap();
    let messages: Vec<String> = outcome.failures().map(|failure| failure.message).collect();
    assert_eq!(messages, ["outer: invalid digit found in string"]);
}

#[test]
fn a_campaign_that_is_stopped_keeps_what_it_finished() {
    let (_folder, path) = file();
    let kept = campaign(0..40).results(&path);
    let stop = Stop::default();
    // One thread: the next seed begins after the progress of this one.
    let one = kept.clone().threads(NonZeroUsize::new(1).unwrap());
    let error = stop.over(|| {
        one.run(job, |state| {
            if state.done == 12 {
                stop.ask();
            }
        })
    });
    assert!(matches!(error, Err(EvaluationError::Stopped(_))));
    let (outcome, seeds) = asked(&kept);
    assert_eq!((outcome.resumed(), seeds.len()), (12, 28));
    assert_eq!(results_of(&outcome), results_of(&fresh(0..40)));
}

#[test]
fn what_a_job_says_that_was_stopped_is_no_result() {
    let (_folder, path) = file();
    let kept = campaign(0..40).results(&path);
    let stop = Stop::default();
    let error = stop.over(|| {
        kept.run(
            |seed| {
                if seed == 20 {
                    stop.ask();
                }
                // The threads of the campaign work on the job of this one.
                stop::check().map_err(|stopped| stopped.to_string())?;
                job(seed)
            },
            |_| (),
        )
    });
    assert!(matches!(error, Err(EvaluationError::Stopped(_))));
    let (outcome, seeds) = asked(&kept);
    assert!(seeds.contains(&20), "{seeds:?}");
    assert_eq!(results_of(&outcome), results_of(&fresh(0..40)));
}

#[test]
fn progress_counts_and_time_left_is_that_of_fresh_seeds() {
    let (_folder, path) = file();
    asked(&campaign(0..90).results(&path));
    let mut states: Vec<Progress> = Vec::new();
    let pause = Duration::from_millis(4);
    campaign(0..100)
        .threads(NonZeroUsize::new(1).unwrap())
        .results(&path)
        .run(
            |seed| {
                std::thread::sleep(pause);
                job(seed)
            },
            |state| states.push(state),
        )
        .unwrap();
    assert_eq!(states.len(), 11);
    let first = states[0];
    assert_eq!((first.done, first.total, first.resumed), (90, 100, 90));
    // 6, 13, ..., 83.
    assert_eq!((first.failed, first.left), (12, None));
    for (state, done) in states.iter().zip(90..) {
        assert_eq!(state.done, done);
        if let Some(left) = state.left {
            // A sleep is never shorter; had the 90 counted, it would be a tenth of this. The
            // microsecond is for rounding.
            let least = pause * (100 - done) as u32;
            assert!(left + Duration::from_micros(1) >= least, "{state:?}");
        }
    }
    let last = states[10];
    assert_eq!((last.failed, last.left), (14, Some(Duration::ZERO)));
}
