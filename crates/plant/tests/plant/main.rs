//! Tests of the library in one program: to compile and link one for each file would take most of their time.
#![cfg(test)]

mod duffing;
mod gauge;
mod generated;
mod input_errors;
mod next_run;
mod population;
mod several;
