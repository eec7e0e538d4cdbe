//! Pictures of an answer: the charts of its page.

use gyrocal_document::{Item, Part};
use gyrocal_report::{Error, Picture};

/// A picture with the name of what it is of.
struct Sourced {
    picture: Box<dyn Picture>,
    source: String,
}

impl Picture for Sourced {
    fn to_svg_of(&self, source: &str) -> Result<String, Error> {
        self.picture.to_svg_of(match source {
            "" => &self.source,
            other => other,
        })
    }
}

/// The charts, bars and estimates of a page as pictures, each with the name of its section, and with a number
/// where a section has several. Below its caption each has the title of its section, and name and verdict of the part.
#[must_use]
pub fn pictures(part: Part) -> Vec<(String, Box<dyn Picture>)> {
    let mut pictures: Vec<(String, Box<dyn Picture>)> = Vec::new();
    for section in part.sections {
        let title = section.title;
        let source = format!("{title}: {}. {}.", part.name, part.first.headline());
        let drawn = section.items.into_iter();
        let drawn = drawn.filter_map(|item| picture(item, &title));
        for (place, picture) in drawn.enumerate() {
            let name = match place {
                0 => section.id.clone(),
                _ => format!("{}-{}", section.id, place + 1),
            };
            let source = source.clone();
            pictures.push((name, Box::new(Sourced { picture, source })));
        }
    }
    pictures
}

/// A piece of a section with that title as a picture; `None` of words.
fn picture(item: Item, section: &str) -> Option<Box<dyn Picture>> {
    let named = |title: &mut String| {
        if title.is_empty() {
            section.clone_into(title);
        }
    };
    Some(match item {
        Item::Chart(mut chart) => {
            named(&mut chart.title);
            Box::new(chart)
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyrocal_document::{Bar, BarGroup, Bars, Origin, Screen, Section, Standing, Tint};

    #[test]
    fn pictures_have_names_of_sections_titles_and_their_source() {
        let bars = |title: &str| {
            let bar = Bar {
                label: "gyro_y.g_z".to_owned(),
                value: 3.0,
                tint: Tint::Extended,
                note: String::new(),
            };
            let groups = vec![BarGroup::new("found", [bar])];
            Item::Bars(Bars::new(title, "statistic", groups))
        };
        let drawn = pictures(Part {
            name: "record.csv".to_owned(),
            size: String::new(),
            first: Screen::new(Standing::Bad, "FAULT", "gyro_y.g_z"),
            sections: vec![Section {
                id: "ranking".to_owned(),
                title: "Ranking of effects".to_owned(),
                lead: String::new(),
                items: vec![bars(""), Item::text("words"), bars("Second")],
            }],
            origin: Origin::default(),
        });
        let names: Vec<&str> = drawn.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["ranking", "ranking-2"]);
        for ((_, picture), title) in drawn.iter().zip(["Ranking of effects", "Second"]) {
            let svg = picture.to_svg().unwrap();
            assert!(svg.contains(&format!("<title>{title}</title>")), "{title}");
            let source = "Ranking of effects: record.csv. FAULT: gyro_y.g_z.";
            assert!(svg.contains(source), "no `{source}`");
            assert!(picture.to_svg_of("another").unwrap().contains("another"));
        }
    }
}
