//! Tests of the library in one program: to compile and link one for each file would take most of their time.
#![cfg(test)]

mod averaging;
mod budget;
mod open_loop_band;
mod prediction;
mod rate_noise;
mod records;
mod runs;
mod several_records;
mod smoother;
