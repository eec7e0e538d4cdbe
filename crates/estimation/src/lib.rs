#![no_std]
//! estimation
