//! Firmware of a stabilised platform that compensates the drift of its gyros on line.
//!
//! Every minute: samples in, filter, rate commands out, health told. The accelerometers are a record
//! in flash memory here, and the torquers a line of text; everything between is what a controller
//! would run. The README beside it explains the parts.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod accelerometers;
#[cfg(target_os = "none")]
mod controller;
#[cfg(target_os = "none")]
mod health;
#[cfg(target_os = "none")]
mod kept;
#[cfg(target_os = "none")]
mod task;

#[cfg(not(target_os = "none"))]
fn main() {
    println!("This is firmware: README.md says how to build and run it.");
}
