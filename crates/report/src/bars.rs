//! Bars of a page as a picture.

use crate::axis::Axis;
use crate::canvas::{Align, Canvas, LineStyle, TextStyle};
use crate::check;
use crate::error::Error;
use crate::figure::{Legend, Sample, figure};
use crate::geometry::Rect;
use crate::number::short;
use crate::picture::Picture;
use crate::span::Span;
use crate::style::{BELOW, BODY, GREY, HAIR, INK, LEVEL, SMALL, THIN, WHITE, colour};
use crate::text;
use gyrocal_document::Bars;

/// Height of a bar with its gap and of the heading of a group, px.
const PITCH: f64 = 19.0;
const HEAD: f64 = 24.0;

/// Share of the width that names may take, and the notes beside the bars.
const NAMES: f64 = 0.4;
const NOTES: f64 = 0.2;

impl Picture for Bars {
    fn to_svg_of(&self, source: &str) -> Result<String, Error> {
        check::non_empty("the list of groups of bars", &self.groups)?;
        for bar in self.groups.iter().flat_map(|group| &group.bars) {
            check::not_infinite(|| format!("the length of {}", bar.label), &[bar.value])?;
        }
        let bars: usize = self.groups.iter().map(|group| group.bars.len()).sum();
        let height = PITCH * bars as f64 + HEAD * self.groups.len() as f64 + BELOW;
        let dashed = || Sample::Line(LineStyle::dashed(LEVEL, THIN));
        let threshold = self.threshold.iter();
        let legend = threshold.map(|(_, name)| Legend::new(dashed(), name));
        let legend: Vec<Legend> = legend.collect();
        Ok(figure(
            &self.title,
            &[&self.omitted, source],
            &legend,
            height,
            |canvas, body| draw(self, canvas, body),
        ))
    }
}

fn draw(bars: &Bars, canvas: &mut Canvas, body: Rect) {
    let all = || bars.groups.iter().flat_map(|group| &group.bars);
    let widths = all().map(|bar| text::width_px(&bar.label, SMALL, false));
    let names_px = (widths.fold(0.0, f64::max) + 8.0).min(NAMES * body.width());
    let frame = Rect {
        left: body.left + names_px,
        right: body.right - NOTES * body.width(),
        bottom: body.bottom - BELOW,
        ..body
    };
    let ends = all().map(|bar| bar.value);
    let threshold = bars.threshold.as_ref().map(|(value, _)| *value);
    let span = Span::of(ends.chain(threshold).chain([0.0]));
    let span = span.unwrap_or(Span { lo: 0.0, hi: 1.0 }).open();
    let axis = Axis::linear(span, &bars.quantity, "", (frame.width() / 70.0) as usize);
    let x_of = |value: f64| frame.left + axis.at(value) * frame.width();
    let upright = |x: f64| [(x, frame.top), (x, frame.bottom)];
    let style = TextStyle::new(SMALL, Align::Middle).colour(INK);
    for (value, label) in &axis.ticks {
        let x = x_of(*value);
        canvas.line(&upright(x), LineStyle::solid(GREY, 0.5 * HAIR));
        canvas.text(label, (x, frame.bottom + 12.0), style);
    }
    let title = (frame.centre().0, frame.bottom + 28.0);
    canvas.text(&axis.title, title, style);
    let mut y = frame.top;
    let mut headings = Vec::new();
    for group in &bars.groups {
        headings.push((&group.label, y + 0.5 * HEAD));
        y += HEAD;
        for bar in &group.bars {
            let middle = y + 0.5 * PITCH;
            let name = text::fit(&bar.label, SMALL, false, names_px - 8.0);
            let at = (frame.left - 6.0, middle);
            canvas.text(&name, at, TextStyle::new(SMALL, Align::End));
            let end = x_of(if bar.value.is_nan() { 0.0 } else { bar.value });
            let [corner, opposite] = [(x_of(0.0), y + 3.0), (end, y + PITCH - 3.0)];
            canvas.rect(corner, opposite, colour(bar.tint), 1.0);
            let number = match bar.value.is_nan() {
                true => "not determined".to_owned(),
                false => short(bar.value, 3),
            };
            let words = match bar.note.is_empty() {
                true => number,
                false => format!("{number}, {}", bar.note),
            };
            let words = text::fit(&words, SMALL, false, body.right - end - 8.0);
            let style = TextStyle::new(SMALL, Align::Start).colour(INK);
            canvas.text(&words, (end.max(frame.left) + 6.0, middle), style);
            y += PITCH;
        }
    }
    if let Some(value) = threshold {
        canvas.line(&upright(x_of(value)), LineStyle::dashed(LEVEL, THIN));
    }
    for (words, y) in headings {
        // A white ground keeps grid and threshold out of the letters.
        let right = body.left + text::width_px(words, BODY, true) + 4.0;
        let half = 0.5 * HEAD - 3.0;
        canvas.rect((body.left, y - half), (right, y + half), WHITE, 1.0);
        let style = TextStyle::new(BODY, Align::Start).bold();
        canvas.text(words, (body.left, y), style);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyrocal_document::{Bar, BarGroup, Tint};

    #[test]
    fn bars_have_names_numbers_and_their_threshold() {
        let bar = |label: &str, value| Bar {
            label: label.to_owned(),
            value,
            tint: Tint::Extended,
            note: String::new(),
        };
        let found = [bar("gyro_y.g_z", 12.5), bar("gyro_x.ramp", f64::NAN)];
        let groups = vec![BarGroup::new("finding 1", found)];
        let bars = Bars {
            threshold: Some((3.0, "detection threshold".to_owned())),
            omitted: "others are left out".to_owned(),
            ..Bars::new("Ranking", "statistic", groups)
        };
        let svg = bars.to_svg().unwrap();
        for words in [
            "gyro_y.g_z",
            "12.5",
            "not determined",
            "detection threshold",
            "others are left out",
            "finding 1",
        ] {
            assert!(svg.contains(words), "{words}");
        }
        assert!(!svg.contains("NaN"), "{svg}");
    }
}
