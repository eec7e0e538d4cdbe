//! Tests of the library in one program: to compile and link one for each file would take most of their time.
#![cfg(test)]

mod allan;
mod common;
mod dialect_set;
mod dialects;
mod few_positions;
mod gyro_axes;
mod laser;
mod logs;
mod matlab;
mod multi_position;
mod rates;
mod sensors;
mod spoiled;
mod stamps;
mod strapdown;
mod turn_ons;
mod typed_files;
