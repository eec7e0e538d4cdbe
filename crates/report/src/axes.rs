//! One set of axes: its frame, its scales, the words around it, and data drawn in it.

use crate::axis::Axis;
use crate::canvas::{Align, Canvas, LineStyle, TextStyle};
use crate::geometry::{Point, Rect};
use crate::polyline;
use crate::style::{BAND_OPACITY, BODY, Colour, FAINT, GREY, HAIR, INK, SMALL};
use crate::text;

/// Length of a tick with a label, px.
const TICK: f64 = 4.0;
/// Length of a tick without a label, px.
const MINOR_TICK: f64 = 2.5;
/// A label of the abscissa that reaches further out of the frame would meet that of its neighbour.
const OVERHANG: f64 = 20.0;

/// A frame with its scales.
pub(crate) struct Axes {
    pub frame: Rect,
    pub x: Axis,
    pub y: Axis,
}

/// The words around a set of axes.
#[derive(Clone, Copy)]
pub(crate) struct Labels<'a> {
    /// Bold, above the frame at its left.
    pub name: &'a str,
    /// Above the frame at its right: statistics.
    pub note: &'a str,
    /// Whether the title of the ordinate is drawn.
    pub ordinate_title: bool,
}

impl Axes {
    /// Draws the axes with their labels and, in them, the content, or `no data` if there is none.
    pub(crate) fn draw(
        &self,
        canvas: &mut Canvas,
        labels: Labels<'_>,
        has_data: bool,
        content: impl FnOnce(&Self, &mut Canvas),
    ) {
        self.draw_frame(canvas, labels);
        if has_data {
            content(self, canvas);
        } else {
            let style = TextStyle::new(BODY, Align::Middle).colour(GREY);
            canvas.text("no data", self.frame.centre(), style);
        }
    }

    /// A line through values that bridges intervals up to a length.
    pub(crate) fn line(
        &self,
        canvas: &mut Canvas,
        abscissa: &[f64],
        values: &[f64],
        style: LineStyle,
        longest: f64,
    ) {
        let points = self.points(abscissa, values);
        for line in polyline::lines(self.frame, abscissa, &points, longest) {
            canvas.line(&line, style);
        }
    }

    /// The band between two columns, which bridges intervals up to a length.
    pub(crate) fn band(
        &self,
        canvas: &mut Canvas,
        abscissa: &[f64],
        (lower, upper): (&[f64], &[f64]),
        colour: Colour,
        longest: f64,
    ) {
        let edges = (
            &*self.points(abscissa, lower),
            &*self.points(abscissa, upper),
        );
        for outline in polyline::bands(self.frame, abscissa, edges, longest) {
            canvas.polygon(&outline, colour, BAND_OPACITY);
        }
    }

    /// A line at an ordinate over the whole width, if it is within the scale.
    pub(crate) fn horizontal_line(&self, canvas: &mut Canvas, value: f64, style: LineStyle) {
        let y = self.y_of(value);
        if (self.frame.top..=self.frame.bottom).contains(&y) {
            canvas.line(&[(self.frame.left, y), (self.frame.right, y)], style);
        }
    }

    /// A line at an abscissa over the whole height, if it is within the scale.
    pub(crate) fn vertical_line(&self, canvas: &mut Canvas, value: f64, style: LineStyle) {
        let x = self.x_of(value);
        if (self.frame.left..=self.frame.right).contains(&x) {
            canvas.line(&[(x, self.frame.bottom), (x, self.frame.top)], style);
        }
    }

    /// A point on the canvas, maybe outside of the frame.
    pub(crate) fn point(&self, x: f64, y: f64) -> Point {
        (self.x_of(x), self.y_of(y))
    }

    fn points(&self, abscissa: &[f64], values: &[f64]) -> Vec<Point> {
        let pairs = abscissa.iter().zip(values);
        pairs.map(|(&x, &y)| self.point(x, y)).collect()
    }

    fn x_of(&self, value: f64) -> f64 {
        self.frame.left + self.x.at(value) * self.frame.width()
    }

    fn y_of(&self, value: f64) -> f64 {
        self.frame.bottom - self.y.at(value) * self.frame.height()
    }

    /// Grid, ticks, labels, titles and the two axes.
    fn draw_frame(&self, canvas: &mut Canvas, labels: Labels<'_>) {
        self.draw_ordinate(canvas, labels.ordinate_title);
        self.draw_abscissa(canvas);
        let frame = self.frame;
        let corners = [
            (frame.left, frame.top),
            (frame.left, frame.bottom),
            (frame.right, frame.bottom),
        ];
        canvas.line(&corners, LineStyle::solid(GREY, HAIR));
        let y = frame.top - 9.0;
        let name = text::fit(labels.name, BODY, true, frame.width());
        let style = TextStyle::new(BODY, Align::Start).bold();
        canvas.text(&name, (frame.left, y), style);
        let room = frame.width() - text::width_px(&name, BODY, true) - 12.0;
        let style = TextStyle::new(SMALL, Align::End).colour(INK);
        canvas.text(whole_parts(labels.note, room), (frame.right, y), style);
    }

    fn draw_ordinate(&self, canvas: &mut Canvas, title: bool) {
        let frame = self.frame;
        for &value in &self.y.minor {
            let y = self.y_of(value);
            let tick = [(frame.left - MINOR_TICK, y), (frame.left, y)];
            canvas.line(&tick, LineStyle::solid(GREY, 0.5));
        }
        let mut widest: f64 = 0.0;
        for (value, label) in &self.y.ticks {
            let y = self.y_of(*value);
            let across = [(frame.left, y), (frame.right, y)];
            canvas.line(&across, LineStyle::solid(FAINT, HAIR));
            let tick = [(frame.left - TICK, y), (frame.left, y)];
            canvas.line(&tick, LineStyle::solid(GREY, HAIR));
            widest = widest.max(text::width_px(label, SMALL, false));
            let style = TextStyle::new(SMALL, Align::End).colour(INK);
            canvas.text(label, (frame.left - TICK - 3.0, y), style);
        }
        if title {
            let point = (frame.left - TICK - widest - 13.0, frame.centre().1);
            // A title may be somewhat longer than its frame is high.
            let label = text::fit(&self.y.title, SMALL, false, frame.height() + 24.0);
            let style = TextStyle::new(SMALL, Align::Middle).colour(INK);
            let vertical = true;
            canvas.text(&label, point, TextStyle { vertical, ..style });
        }
    }

    fn draw_abscissa(&self, canvas: &mut Canvas) {
        let frame = self.frame;
        for &value in &self.x.minor {
            let x = self.x_of(value);
            let tick = [(x, frame.bottom), (x, frame.bottom + MINOR_TICK)];
            canvas.line(&tick, LineStyle::solid(GREY, 0.5));
        }
        let style = TextStyle::new(SMALL, Align::Middle).colour(INK);
        for (value, label) in &self.x.ticks {
            let x = self.x_of(*value);
            let along = [(x, frame.top), (x, frame.bottom)];
            canvas.line(&along, LineStyle::solid(FAINT, HAIR));
            let tick = [(x, frame.bottom), (x, frame.bottom + TICK)];
            canvas.line(&tick, LineStyle::solid(GREY, HAIR));
            let half = 0.5 * text::width_px(label, SMALL, false);
            let room = (frame.left - OVERHANG)..=(frame.right + OVERHANG);
            if room.contains(&(x - half)) && room.contains(&(x + half)) {
                canvas.text(label, (x, frame.bottom + 12.0), style);
            }
        }
        let title = text::fit(&self.x.title, SMALL, false, frame.width() + 40.0);
        canvas.text(&title, (frame.centre().0, frame.bottom + 28.0), style);
    }
}

/// As many of the parts of a note, which semicolons divide, as there is room for: a number that is
/// cut would be another number.
fn whole_parts(note: &str, room_px: f64) -> &str {
    let mut kept = note;
    while !kept.is_empty() && text::width_px(kept, SMALL, false) > room_px {
        kept = kept.rsplit_once("; ").map_or("", |(start, _)| start);
    }
    kept
}
