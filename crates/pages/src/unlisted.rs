//! Causes that the catalogue does not hold.

use gyrocal_answer::Answer;
use gyrocal_document::{Item, List};
use gyrocal_statistics::format;

/// For each named cause the probability that the cause is another, outside of the catalogue; `None` without causes.
pub(crate) fn unlisted(answer: &Answer) -> Option<Item> {
    let causes = answer.causes().map(|finding| {
        let probability = match finding.none_of_these {
            Some(none) => format!("{} %", format::short(100.0 * none, 2)),
            None => "not estimated".to_owned(),
        };
        format!("{}: probability {probability}", finding.effect)
    });
    let title = "The cause is outside of the catalogue, in the place of";
    List::of(title, causes).map(Item::from)
}
