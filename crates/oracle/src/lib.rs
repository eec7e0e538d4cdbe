//! Test oracles: dual numbers, finite differences, an interpreter of programs
