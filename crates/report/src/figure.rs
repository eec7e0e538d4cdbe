//! A whole figure: title, description and legend above a body of given height.

use crate::canvas::{Align, Canvas, LineStyle, TextStyle};
use crate::geometry::{Point, Rect};
use crate::style::{BODY, Colour, INK, INNER_WIDTH, MARGIN, TITLE, WIDTH};
use crate::text;

/// Height of a line of the title, the description and the legend, px.
const TITLE_LINE: f64 = 21.0;
const BODY_LINE: f64 = 16.0;
const LEGEND_ROW: f64 = 18.0;
/// Width of the sample of a legend entry, and its distance from the label, px.
const SAMPLE: f64 = 22.0;
const AFTER_SAMPLE: f64 = 6.0;
/// Distance between entries of the legend, px.
const BETWEEN_ENTRIES: f64 = 20.0;

/// One entry of the legend.
pub(crate) struct Legend {
    sample: Sample,
    label: String,
}

/// What stands before the name of an entry.
pub(crate) enum Sample {
    Line(LineStyle),
    Area(Colour, f64),
    Dot(Colour),
}

impl Legend {
    pub(crate) fn new(sample: Sample, label: &str) -> Self {
        let label = label.to_owned();
        Self { sample, label }
    }

    /// Draws the entry with the middle of its left edge at a point.
    fn draw(&self, canvas: &mut Canvas, (x, y): Point) {
        match self.sample {
            Sample::Line(style) => canvas.line(&[(x, y), (x + SAMPLE, y)], style),
            Sample::Area(colour, opacity) => {
                canvas.rect((x, y - 5.0), (x + SAMPLE, y + 5.0), colour, opacity);
            }
            Sample::Dot(colour) => canvas.disc((x + 0.5 * SAMPLE, y), 3.5, colour),
        }
        let beside = SAMPLE + AFTER_SAMPLE;
        let label = text::fit(&self.label, BODY, false, INNER_WIDTH - beside);
        canvas.text(&label, (x + beside, y), TextStyle::new(BODY, Align::Start));
    }
}

/// Draws title, description in paragraphs and legend, then the body of a given height below them.
pub(crate) fn figure(
    title: &str,
    description: &[&str],
    legend: &[Legend],
    body_px: f64,
    body: impl FnOnce(&mut Canvas, Rect),
) -> String {
    let title_lines = text::wrap(title, TITLE, true, INNER_WIDTH);
    let paragraphs = description.iter();
    let paragraphs = paragraphs.flat_map(|words| text::wrap(words, BODY, false, INNER_WIDTH));
    let places = legend_places(legend);
    let legend_rows = places.last().map_or(0.0, |place| place.1 + 1.0);
    let mut canvas = Canvas::default();
    let mut y = MARGIN;
    for line in &title_lines {
        let style = TextStyle::new(TITLE, Align::Start).bold();
        canvas.text(line, (MARGIN, y + 0.4 * TITLE_LINE), style);
        y += TITLE_LINE;
    }
    for line in paragraphs {
        let style = TextStyle::new(BODY, Align::Start).colour(INK);
        canvas.text(&line, (MARGIN, y + 0.5 * BODY_LINE), style);
        y += BODY_LINE;
    }
    for (entry, (x, row)) in legend.iter().zip(&places) {
        entry.draw(&mut canvas, (MARGIN + x, y + (row + 0.65) * LEGEND_ROW));
    }
    let top = y + LEGEND_ROW * legend_rows + 8.0;
    let frame = Rect {
        left: MARGIN,
        top,
        right: WIDTH - MARGIN,
        bottom: top + body_px,
    };
    body(&mut canvas, frame);
    let height = frame.bottom + 0.5 * MARGIN;
    canvas.into_svg(title, WIDTH, height.ceil())
}

/// Positions of the entries of a legend: px from the left, and row.
fn legend_places(legend: &[Legend]) -> Vec<(f64, f64)> {
    let (mut x, mut row) = (0.0, 0.0);
    legend
        .iter()
        .map(|entry| {
            let width = SAMPLE + AFTER_SAMPLE + text::width_px(&entry.label, BODY, false);
            if x > 0.0 && x + width > INNER_WIDTH {
                (x, row) = (0.0, row + 1.0);
            }
            let place = (x, row);
            x += width + BETWEEN_ENTRIES;
            place
        })
        .collect()
}
