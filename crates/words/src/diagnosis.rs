//! Words of the answer on a platform, a strapdown unit or several records.

mod catalogue;
mod clean_screen;
mod findings;
mod first_screen;
mod limits;
mod records;
mod remainder;
mod tables;
mod verdict;

pub use catalogue::{explained, is_correlation, tested, typical_size};
pub use findings::{likelihood, parameter_values};
pub use first_screen::{first_screen, may_also_be};
pub use limits::{
    SET_UPS_WITHOUT_ANGLES, groups, near_twins, not_tested, time_is_temperature,
    why_not_distinguished, would_distinguish,
};
pub use records::{alone, files, sizes};
pub use remainder::residual_description;
pub use tables::{findings, over_sets, ranking, residuals, shifts};
pub use verdict::{not_settled, setup};
