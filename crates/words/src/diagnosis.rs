//! The answer on a platform, a strapdown unit or several records in words.

mod catalogue;
mod clean_screen;
mod findings;
mod first_screen;
mod gain;
mod limits;
mod records;
mod tables;
mod tests;
mod verdict;

use gyrocal_answer::{Answer, Verdict};

use gyrocal_document::Words;

pub use catalogue::{explained, is_correlation, tested, typical_size};
pub use findings::{likelihood, parameter_values};
pub use first_screen::{first_screen, may_also_be};
pub use limits::{
    SET_UPS_WITHOUT_ANGLES, groups, near_twins, not_tested, time_is_temperature,
    why_not_distinguished, would_distinguish,
};
pub use records::files;
pub use tables::{over_sets, ranking, residuals, shifts};
pub use tests::residual_description;
pub use verdict::{not_settled, setup};

/// The whole answer in reading order: what is told of it, then its tables.
#[must_use]
pub fn diagnosis(result: &Answer) -> Vec<Words> {
    let mut blocks = told(result);
    if result.verdict != Verdict::Setup {
        blocks.extend(tables::all(result));
    }
    blocks
}

/// The answer in reading order without the tables of its numbers: record, verdict, magnitude test, findings,
/// limits, gain, residual test.
#[must_use]
pub fn told(result: &Answer) -> Vec<Words> {
    let mut blocks = vec![
        Words::Paragraph(verdict::record(result)),
        Words::Paragraph(verdict::verdict(result)),
    ];
    blocks.extend(verdict::setup(&result.setup));
    if result.verdict == Verdict::Setup {
        return blocks;
    }
    blocks.extend(verdict::unfinished(result).map(Words::Paragraph));
    blocks.push(Words::Paragraph(tests::magnitude(result)));
    blocks.extend(findings::entries(result));
    blocks.extend(records::table(result).map(Words::Table));
    blocks.extend(tests::filter(result).map(Words::Paragraph));
    blocks.extend(limits::indistinguishable(result));
    blocks.extend(gain::paragraphs(result).map(Words::Paragraph));
    blocks.push(Words::Paragraph(tests::whiteness(result)));
    blocks.push(Words::Paragraph(tests::allan(result)));
    blocks.extend(tables::findings(result).map(Words::Table));
    blocks.extend(tests::noise_audit(result).map(Words::Paragraph));
    blocks.extend(limits::untested(result));
    blocks
}
