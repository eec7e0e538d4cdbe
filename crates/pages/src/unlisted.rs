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
        let ratio = finding.none_of_these_log_likelihood_ratio.map(|nats| {
            let ratio = match nats.exp() {
                ratio if ratio.is_finite() => format::short(ratio, 2),
                _ => format!("exp({nats:.0})"),
            };
            format!(", {ratio} times the likelihood of these")
        });
        let ratio = ratio.unwrap_or_default();
        format!("{}: probability {probability}{ratio}", finding.effect)
    });
    let title = "The cause is outside of the catalogue, in the place of";
    List::of(title, causes).map(Item::from)
}
