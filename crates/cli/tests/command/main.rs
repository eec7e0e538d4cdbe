//! The command `gyrocal` as a user runs it.

#![cfg(test)]
#![expect(
    clippy::disallowed_methods,
    reason = "tests compute what the command prints"
)]

mod allan;
mod bad_input;
mod calibrate;
mod characterise;
mod columns;
mod contract;
mod diagnose;
mod documents;
mod emit;
mod extend;
mod first_screen;
mod folder;
mod help;
mod import;
mod monte_carlo;
mod plan;
mod plant;
mod plant_fit;
mod rates;
mod report;
mod simulate;
mod terminal_safety;
mod tumble;
mod watch;
