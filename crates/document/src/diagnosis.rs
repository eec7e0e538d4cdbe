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

use crate::Block;

pub use catalogue::{explained, is_correlation, tested, typical_size};
pub use findings::{likelihood, parameter_values};
pub use first_screen::{first_screen, may_also_be};
pub use limits::{
    SET_UPS_WITHOUT_ANGLES, groups, near_twins, not_tested, time_is_temperature,
    why_not_distinguished, would_distinguish,
};
pub use records::files;
pub use tests::residual_description;
pub use verdict::{not_settled, setup};

/// The whole answer in reading order: record, verdict, magnitude test, findings, limits, gain,
/// residual test, tables.
#[must_use]
pub fn diagnosis(result: &Answer) -> Vec<Block> {
    let mut blocks = vec![
        Block::Paragraph(verdict::record(result)),
        Block::Paragraph(verdict::verdict(result)),
    ];
    blocks.extend(verdict::setup(&result.setup));
    if result.verdict == Verdict::Setup {
        return blocks;
    }
    blocks.extend(verdict::unfinished(result).map(Block::Paragraph));
    blocks.push(Block::Paragraph(tests::magnitude(result)));
    blocks.extend(findings::entries(result));
    blocks.extend(records::table(result).map(Block::Table));
    blocks.extend(tests::filter(result).map(Block::Paragraph));
    blocks.extend(limits::indistinguishable(result));
    blocks.extend(gain::paragraphs(result).map(Block::Paragraph));
    blocks.push(Block::Paragraph(tests::whiteness(result)));
    blocks.push(Block::Paragraph(tests::allan(result)));
    blocks.extend(tables::all(result));
    blocks.extend(tests::noise_audit(result).map(Block::Paragraph));
    blocks.extend(limits::untested(result));
    blocks
}
