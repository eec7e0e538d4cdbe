//! Turns CasADi programs into no_std Rust
