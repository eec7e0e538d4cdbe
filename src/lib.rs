//! gyrocal
