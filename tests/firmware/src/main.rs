//! Replays the record and prints what it found, line by line: the same program on the target,
//! where it also counts instructions and measures the stack, and on the host.
//!
//! Words of the command line: `rk4` (default) or `euler`, `short` for one day of three.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
mod host;
#[cfg(target_os = "none")]
mod target;

#[cfg(not(target_os = "none"))]
fn main() {
    host::run();
}
