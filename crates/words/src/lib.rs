//! What people read of an answer, as plain data: sentences, tables and first screens.
//!
//! Everything here is made from results alone, so that a terminal, a page and a program in another
//! language say the same words. [`plant`] gives all of an answer on any plant in reading order, [`calibration()`]
//! that of a calibration; of an answer on a platform `gyrocal-pages` arranges the pieces. [`first_screen`] gives what
//! a person reads first. The engines take from here the reasons that an answer carries in words.
//!
//! # What it does not do
//!
//! It estimates and judges nothing, and knows neither terminals nor pages.

mod calibration;
mod diagnosis;
mod files;
mod format;
mod means;
pub mod plant;

pub use calibration::{calibration, calibration_screen, calibration_verdict};
pub use diagnosis::{
    SET_UPS_WITHOUT_ANGLES, alone, explained, files, findings, first_screen, groups,
    is_correlation, likelihood, may_also_be, near_twins, not_settled, not_tested, over_sets,
    parameter_values, ranking, residual_description, residuals, setup, shifts, sizes, tested,
    time_is_temperature, typical_size, why_not_distinguished, would_distinguish,
};
pub use files::{command_files, few, input_files, joined};
pub use format::{behind, capitalised, counted, hours, size, time};
