//! One panel: a frame with two axes, and what is drawn in it.

use plotters::style::RGBColor;

use crate::axis::Axis;
use crate::canvas::{Align, Canvas, Lettering, Place, Stroke};
use crate::error::Error;
use crate::style::{BODY, FAINT, GREY, HAIR, INK, SMALL};
use crate::text;
use crate::trace::{self, Frame};

/// A panel with its axes.
pub(crate) struct Panel {
    pub frame: Frame,
    pub x: Axis,
    pub y: Axis,
}

/// What stands round a panel.
#[derive(Clone, Copy)]
pub(crate) struct Surround<'a> {
    /// Bold, over the panel at its left.
    pub name: &'a str,
    /// Over the panel at its right: statistics.
    pub note: &'a str,
    /// Labels and title of the abscissa.
    pub abscissa: bool,
    /// Title of the ordinate.
    pub ordinate_title: bool,
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

const TICK: f64 = 4.0;
const MINOR_TICK: f64 = 2.5;
/// A label of the abscissa that reaches further out of the panel would meet that of its neighbour.
const OVERHANG: f64 = 20.0;

impl Panel {
    /// Grid lines, axes, ticks, labels and titles.
    pub(crate) fn surround(
        &self,
        canvas: &mut Canvas<'_>,
        surround: Surround<'_>,
    ) -> Result<(), Error> {
        self.ordinate(canvas, surround.ordinate_title)?;
        self.abscissa(canvas, surround.abscissa)?;
        let frame = self.frame;
        let axis = Stroke::solid(GREY, HAIR);
        canvas.line(
            &[
                (frame.left, frame.top),
                (frame.left, frame.bottom),
                (frame.right, frame.bottom),
            ],
            axis,
        )?;
        let y = frame.top - 9.0;
        let name = text::fit(surround.name, BODY, true, frame.width());
        let lettering = Lettering::new(BODY, Align::Start).bold();
        canvas.text(&name, (frame.left, y), lettering)?;
        let room = frame.width() - text::width_px(&name, BODY, true) - 12.0;
        let note = whole_parts(surround.note, room);
        let lettering = Lettering::new(SMALL, Align::End).colour(INK);
        canvas.text(note, (frame.right, y), lettering)
    }

    /// A line through values, with gaps left open.
    pub(crate) fn line(
        &self,
        canvas: &mut Canvas<'_>,
        abscissa: &[f64],
        values: &[f64],
        stroke: Stroke,
    ) -> Result<(), Error> {
        let bridge = trace::longest_bridge(abscissa);
        self.line_bridging(canvas, abscissa, values, stroke, bridge)
    }

    /// A line through values that bridges intervals up to a length.
    pub(crate) fn line_bridging(
        &self,
        canvas: &mut Canvas<'_>,
        abscissa: &[f64],
        values: &[f64],
        stroke: Stroke,
        bridge: f64,
    ) -> Result<(), Error> {
        let axes = (&self.x, &self.y);
        for line in trace::lines(self.frame, axes, abscissa, values, bridge) {
            canvas.line(&line, stroke)?;
        }
        Ok(())
    }

    /// The area between two columns.
    pub(crate) fn area(
        &self,
        canvas: &mut Canvas<'_>,
        abscissa: &[f64],
        (lower, upper): (&[f64], &[f64]),
        colour: RGBColor,
        opacity: f64,
    ) -> Result<(), Error> {
        let bridge = trace::longest_bridge(abscissa);
        let axes = (&self.x, &self.y);
        for area in trace::areas(self.frame, axes, abscissa, lower, upper, bridge) {
            canvas.fill(&area, colour, opacity)?;
        }
        Ok(())
    }

    /// The area between two levels, over the whole width.
    pub(crate) fn stripe(
        &self,
        canvas: &mut Canvas<'_>,
        lower: f64,
        upper: f64,
        colour: RGBColor,
        opacity: f64,
    ) -> Result<(), Error> {
        let edge = |value| {
            let y = self.height_of(value);
            y.clamp(self.frame.top, self.frame.bottom)
        };
        let (bottom, top) = (edge(lower), edge(upper));
        if bottom == top {
            return Ok(());
        }
        let corner = (self.frame.left, top);
        canvas.rect(corner, (self.frame.right, bottom), colour, opacity)
    }

    /// A level over the whole width, if it is within the scale.
    pub(crate) fn level(
        &self,
        canvas: &mut Canvas<'_>,
        value: f64,
        stroke: Stroke,
    ) -> Result<(), Error> {
        let y = self.height_of(value);
        if !(self.frame.top..=self.frame.bottom).contains(&y) {
            return Ok(());
        }
        canvas.line(&[(self.frame.left, y), (self.frame.right, y)], stroke)
    }

    /// An upright line over the whole height, if it is within the scale.
    pub(crate) fn upright(
        &self,
        canvas: &mut Canvas<'_>,
        value: f64,
        stroke: Stroke,
    ) -> Result<(), Error> {
        let (x, _) = self.place(value, f64::NAN);
        if !(self.frame.left..=self.frame.right).contains(&x) {
            return Ok(());
        }
        canvas.line(&[(x, self.frame.bottom), (x, self.frame.top)], stroke)
    }

    /// Says that there is nothing to draw.
    pub(crate) fn empty(&self, canvas: &mut Canvas<'_>) -> Result<(), Error> {
        let middle = (
            0.5 * (self.frame.left + self.frame.right),
            0.5 * (self.frame.top + self.frame.bottom),
        );
        canvas.text(
            "no data",
            middle,
            Lettering::new(BODY, Align::Middle).colour(GREY),
        )
    }

    /// Where a pair of values stands on the sheet.
    pub(crate) fn place(&self, x: f64, y: f64) -> Place {
        trace::place(self.frame, (&self.x, &self.y), (x, y))
    }

    fn height_of(&self, value: f64) -> f64 {
        self.place(f64::NAN, value).1
    }

    fn ordinate(&self, canvas: &mut Canvas<'_>, title: bool) -> Result<(), Error> {
        let frame = self.frame;
        for &value in &self.y.minor {
            let y = self.height_of(value);
            let from = (frame.left - MINOR_TICK, y);
            canvas.line(&[from, (frame.left, y)], Stroke::solid(GREY, 0.5))?;
        }
        let mut widest: f64 = 0.0;
        for (value, label) in &self.y.ticks {
            let y = self.height_of(*value);
            let across = [(frame.left, y), (frame.right, y)];
            canvas.line(&across, Stroke::solid(FAINT, HAIR))?;
            let tick = [(frame.left - TICK, y), (frame.left, y)];
            canvas.line(&tick, Stroke::solid(GREY, HAIR))?;
            widest = widest.max(text::width_px(label, SMALL, false));
            let lettering = Lettering::new(SMALL, Align::End).colour(INK);
            canvas.text(label, (frame.left - TICK - 3.0, y), lettering)?;
        }
        if title {
            let middle = 0.5 * (frame.top + frame.bottom);
            let place = (frame.left - TICK - widest - 13.0, middle);
            // A title may be somewhat longer than its panel is high.
            let label = text::fit(&self.y.title, SMALL, false, frame.height() + 24.0);
            let lettering = Lettering::new(SMALL, Align::Middle).colour(INK).upright();
            canvas.text(&label, place, lettering)?;
        }
        Ok(())
    }

    fn abscissa(&self, canvas: &mut Canvas<'_>, labels: bool) -> Result<(), Error> {
        let frame = self.frame;
        for &value in &self.x.minor {
            let x = self.place(value, f64::NAN).0;
            let from = (x, frame.bottom);
            canvas.line(
                &[from, (x, frame.bottom + MINOR_TICK)],
                Stroke::solid(GREY, 0.5),
            )?;
        }
        for (value, label) in &self.x.ticks {
            let x = self.place(*value, f64::NAN).0;
            let along = [(x, frame.top), (x, frame.bottom)];
            canvas.line(&along, Stroke::solid(FAINT, HAIR))?;
            let tick = [(x, frame.bottom), (x, frame.bottom + TICK)];
            canvas.line(&tick, Stroke::solid(GREY, HAIR))?;
            let half = 0.5 * text::width_px(label, SMALL, false);
            let room = (frame.left - OVERHANG)..=(frame.right + OVERHANG);
            if labels && room.contains(&(x - half)) && room.contains(&(x + half)) {
                let lettering = Lettering::new(SMALL, Align::Middle).colour(INK);
                canvas.text(label, (x, frame.bottom + 12.0), lettering)?;
            }
        }
        if labels {
            let middle = 0.5 * (frame.left + frame.right);
            let title = text::fit(&self.x.title, SMALL, false, frame.width() + 40.0);
            let lettering = Lettering::new(SMALL, Align::Middle).colour(INK);
            canvas.text(&title, (middle, frame.bottom + 28.0), lettering)?;
        }
        Ok(())
    }
}
