//! Pictures of an answer: the charts of its page.

use gyrocal_report::Picture;
use gyrocal_report::page::{Item, Part};

/// The charts, bars and estimates of a page as pictures, each with the name of its section, and with a number
/// where a section has several.
#[must_use]
pub fn pictures(part: Part) -> Vec<(String, Box<dyn Picture>)> {
    let mut pictures: Vec<(String, Box<dyn Picture>)> = Vec::new();
    for section in part.sections {
        let drawn = section.items.into_iter().filter_map(|item| {
            let named = |title: &mut String| {
                if title.is_empty() {
                    title.clone_from(&section.title);
                }
            };
            Some(match item {
                Item::Chart(mut chart) => {
                    named(&mut chart.title);
                    Box::new(chart) as Box<dyn Picture>
                }
                Item::Bars(mut bars) => {
                    named(&mut bars.title);
                    Box::new(bars)
                }
                Item::Estimates(mut estimates) => {
                    named(&mut estimates.title);
                    Box::new(estimates)
                }
                _ => return None,
            })
        });
        for (place, picture) in drawn.enumerate() {
            let name = match place {
                0 => section.id.clone(),
                _ => format!("{}-{}", section.id, place + 1),
            };
            pictures.push((name, picture));
        }
    }
    pictures
}
