//! The sheet of a picture: what it shows in words, the key to its signs, and room for panels.

use plotters::style::RGBColor;

use crate::canvas::{self, Align, Canvas, Lettering, Place, Stroke};
use crate::error::Error;
use crate::style::{ABOVE, BELOW, BODY, INK, LEFT, MARGIN, TITLE, WIDTH};
use crate::text;
use crate::trace::Frame;

/// One entry of the key.
pub(crate) struct Key {
    sign: Sign,
    label: String,
}

enum Sign {
    Line(Stroke),
    Area(RGBColor, f64),
    Dot(RGBColor),
}

impl Key {
    pub(crate) fn line(stroke: Stroke, label: impl Into<String>) -> Self {
        Self {
            sign: Sign::Line(stroke),
            label: label.into(),
        }
    }

    pub(crate) fn area(colour: RGBColor, opacity: f64, label: impl Into<String>) -> Self {
        Self {
            sign: Sign::Area(colour, opacity),
            label: label.into(),
        }
    }

    pub(crate) fn dot(colour: RGBColor, label: impl Into<String>) -> Self {
        Self {
            sign: Sign::Dot(colour),
            label: label.into(),
        }
    }
}

const INNER: f64 = WIDTH - 2.0 * MARGIN;
const TITLE_LINE: f64 = 21.0;
const BODY_LINE: f64 = 16.0;
const KEY_LINE: f64 = 18.0;
const SIGN: f64 = 22.0;
const BETWEEN_KEYS: f64 = 20.0;

/// Draws title, subtitle and key, then the body of a given height below them.
pub(crate) fn page(
    title: &str,
    subtitle: &str,
    keys: &[Key],
    body_px: f64,
    body: impl FnOnce(&mut Canvas<'_>, Frame) -> Result<(), Error>,
) -> Result<String, Error> {
    let title_lines = text::wrap(title, TITLE, true, INNER);
    let subtitle_lines = text::wrap(subtitle, BODY, false, INNER);
    let places = key_places(keys);
    let key_rows = places.last().map_or(0.0, |place| place.1 + 1.0);
    let head = MARGIN
        + TITLE_LINE * title_lines.len() as f64
        + BODY_LINE * subtitle_lines.len() as f64
        + KEY_LINE * key_rows
        + 8.0;
    let height = head + body_px + 0.5 * MARGIN;
    canvas::draw(title, WIDTH, height.ceil(), |canvas| {
        let mut y = MARGIN;
        for line in &title_lines {
            let lettering = Lettering::new(TITLE, Align::Start).bold();
            canvas.text(line, (MARGIN, y + 0.4 * TITLE_LINE), lettering)?;
            y += TITLE_LINE;
        }
        for line in &subtitle_lines {
            let lettering = Lettering::new(BODY, Align::Start).colour(INK);
            canvas.text(line, (MARGIN, y + 0.5 * BODY_LINE), lettering)?;
            y += BODY_LINE;
        }
        for (key, (x, row)) in keys.iter().zip(&places) {
            draw_key(canvas, key, (MARGIN + x, y + (row + 0.65) * KEY_LINE))?;
        }
        let frame = Frame {
            left: MARGIN,
            top: head,
            right: WIDTH - MARGIN,
            bottom: head + body_px,
        };
        body(canvas, frame)
    })
}

/// Where entries of the key stand: px from the left, and row.
fn key_places(keys: &[Key]) -> Vec<(f64, f64)> {
    let (mut x, mut row) = (0.0, 0.0);
    keys.iter()
        .map(|key| {
            let width = SIGN + 6.0 + text::width_px(&key.label, BODY, false);
            if x > 0.0 && x + width > INNER {
                (x, row) = (0.0, row + 1.0);
            }
            let place = (x, row);
            x += width + BETWEEN_KEYS;
            place
        })
        .collect()
}

fn draw_key(canvas: &mut Canvas<'_>, key: &Key, (x, y): Place) -> Result<(), Error> {
    match key.sign {
        Sign::Line(stroke) => canvas.line(&[(x, y), (x + SIGN, y)], stroke)?,
        Sign::Area(colour, opacity) => {
            canvas.rect((x, y - 5.0), (x + SIGN, y + 5.0), colour, opacity)?;
        }
        Sign::Dot(colour) => canvas.disc((x + 0.5 * SIGN, y), 3.5, colour, 1.0)?,
    }
    let room = INNER - SIGN - 6.0;
    let label = text::fit(&key.label, BODY, false, room);
    canvas.text(
        &label,
        (x + SIGN + 6.0, y),
        Lettering::new(BODY, Align::Start),
    )
}

/// Panels in columns and rows.
#[derive(Clone, Copy)]
pub(crate) struct Grid {
    pub columns: usize,
    pub panels: usize,
    /// Height of one panel, px.
    pub panel_px: f64,
    /// Each panel has its own abscissa; otherwise only the lowest ones show theirs.
    pub own_abscissa: bool,
    /// Room left of each panel, px.
    pub left_px: f64,
}

impl Grid {
    pub(crate) fn new(columns: usize, panels: usize, panel_px: f64) -> Self {
        Self {
            columns: columns.max(1),
            panels,
            panel_px,
            own_abscissa: false,
            left_px: LEFT,
        }
    }

    pub(crate) fn height(self) -> f64 {
        let rows = self.panels.div_ceil(self.columns) as f64;
        rows * self.pitch() + if self.own_abscissa { 0.0 } else { BELOW }
    }

    /// Where a panel stands in the body.
    pub(crate) fn frame(self, body: Frame, index: usize) -> Frame {
        let (column, row) = (index % self.columns, index / self.columns);
        let wide = body.width() / self.columns as f64;
        let left = body.left + column as f64 * wide + self.left_px;
        let top = body.top + row as f64 * self.pitch() + ABOVE;
        Frame {
            left,
            top,
            // Room for half of the last label of the abscissa.
            right: body.left + (column + 1) as f64 * wide - 10.0,
            bottom: top + self.panel_px,
        }
    }

    /// Whether a panel shows the labels of its abscissa.
    pub(crate) fn shows_abscissa(self, index: usize) -> bool {
        self.own_abscissa || index + self.columns >= self.panels
    }

    fn pitch(self) -> f64 {
        ABOVE + self.panel_px + if self.own_abscissa { BELOW + 4.0 } else { 6.0 }
    }
}
