//! Nothing: what counts is the build of its dependencies.
fn main() {}
