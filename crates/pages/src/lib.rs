//! Content of the HTML pages of gyrocal's answers: the page of `gyrocal report` and of `--report`.
//!
//! Each function makes a [`Part`] of one answer: the summary for the first screen, sections with
//! charts and tables, and the origin. [`page`] puts parts together, `gyrocal_report::to_html` makes a file of
//! them. Sentences are those of the libraries ([`gyrocal_words`] and others); this crate
//! chooses and arranges.
//!
//! | part | of |
//! |---|---|
//! | [`of_diagnosis`] | a diagnosis with its fits: with charts over time |
//! | [`of_result`] | a written result of a diagnosis: what it tells without the record |
//! | [`of_calibration`] | a calibration |
//! | [`of_plan`] | a planned next run |
//! | [`of_plant`] | a diagnosis of any plant |
//! | [`of_fleet`] | what a fleet shows |
//! | [`of_tumble`] | a multi-position test |
//! | [`of_budget`], [`of_spread`] | sections of an uncertainty budget, of the scatter over runs |
//! | [`of_monte_carlo`] | a calibration over many simulated records |
//! | [`of_rates`] | gyro outputs in the rate domain |
//! | [`of_characterise`] | operating characteristics |
//! | [`of_allan`] | Allan deviations of a log |
//!
//! [`pictures`] are the charts of a part, for files of their own; [`read`] gives the rest of it, for a terminal.
//!
//! # What it does not do
//!
//! It reads and writes no files, fits nothing, and knows nothing of HTML.

mod allan;
mod bad_samples;
mod calibration;
mod characterise;
mod diagnosis;
mod error;
mod fleet;
mod monte_carlo;
mod origin;
mod panels;
mod pictures;
mod plan;
mod plant;
mod ranked;
mod rates;
mod read;
mod signs;
mod tumble;
mod uncertainty;
mod unlisted;
mod words;

use gyrocal_answer::{Answer, Subject};

pub use allan::of_allan;
pub use calibration::{CalibratedRecord, of_calibration};
pub use characterise::of_characterise;
pub use diagnosis::of_diagnosis;
pub use error::PageError;
pub use fleet::of_fleet;
pub use gyrocal_document::{Page, Part};
pub use monte_carlo::of_monte_carlo;
pub use pictures::pictures;
pub use plan::of_plan;
pub use plant::{of_comparison, of_fit, of_plant};
pub use rates::of_rates;
pub use read::{read, read_sections};
pub use tumble::{TumbleAnswer, of_tumble};
pub use uncertainty::{of_budget, of_spread, uncertainty_screen};

/// The page of a written answer: all but the charts over time, for which the record is needed.
#[must_use]
pub fn of_result(answer: &Answer) -> Part {
    match answer.subject {
        Subject::Plant(_) => plant::of_answer(answer),
        Subject::Platform | Subject::Strapdown => diagnosis::of_platform(answer),
    }
}

/// A page of one answer or several.
#[must_use]
pub fn page(parts: Vec<Part>) -> Page {
    let title = match &*parts {
        [one] => format!("{}: {}", one.name, one.first.verdict),
        several => format!("{} records", several.len()),
    };
    Page { title, parts }
}
