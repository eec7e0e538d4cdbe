//! The sheet that pictures are drawn on: lines, areas and text in pixels, as SVG by plotters.

use plotters::backend::SVGBackend;
use plotters::prelude::{DrawingBackend, FontStyle, FontTransform, IntoFont, RGBColor};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, ShapeStyle, TextStyle};

use crate::error::Error;
use crate::style::{BLACK, WHITE};
use crate::text;

/// Plotters draws on whole numbers: so many of them make a pixel.
const FINE: f64 = 8.0;
/// Plotters divides sizes of fonts by this.
const PLOTTERS_FONT_SCALE: f64 = 1.24;

/// A place on the sheet, px from the left and from the top.
pub(crate) type Place = (f64, f64);

/// How a line looks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stroke {
    pub colour: RGBColor,
    pub width_px: f64,
    pub opacity: f64,
    pub dashed: bool,
}

impl Stroke {
    pub(crate) fn solid(colour: RGBColor, width_px: f64) -> Self {
        Self {
            colour,
            width_px,
            opacity: 1.0,
            dashed: false,
        }
    }

    pub(crate) fn dashed(colour: RGBColor, width_px: f64) -> Self {
        Self {
            dashed: true,
            ..Self::solid(colour, width_px)
        }
    }
}

/// How a text looks. It stands with the middle of its height on the given place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lettering {
    pub colour: RGBColor,
    pub size_px: f64,
    pub bold: bool,
    pub align: Align,
    /// Read from bottom to top.
    pub upright: bool,
}

/// Which part of a text stands on the given place.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Align {
    Start,
    Middle,
    End,
}

impl Lettering {
    pub(crate) fn new(size_px: f64, align: Align) -> Self {
        Self {
            colour: BLACK,
            size_px,
            bold: false,
            align,
            upright: false,
        }
    }

    pub(crate) fn colour(self, colour: RGBColor) -> Self {
        Self { colour, ..self }
    }

    pub(crate) fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    pub(crate) fn upright(self) -> Self {
        Self {
            upright: true,
            ..self
        }
    }
}

/// Draws on a white sheet of a size in px and returns the SVG. The title is for readers that do
/// not see.
pub(crate) fn draw(
    title: &str,
    width_px: f64,
    height_px: f64,
    content: impl FnOnce(&mut Canvas<'_>) -> Result<(), Error>,
) -> Result<String, Error> {
    let mut svg = String::new();
    let size = (fine(width_px) as u32, fine(height_px) as u32);
    let mut canvas = Canvas {
        backend: SVGBackend::with_string(&mut svg, size),
    };
    canvas.rect((0.0, 0.0), (width_px, height_px), WHITE, 1.0)?;
    content(&mut canvas)?;
    canvas.backend.present().map_err(refused)?;
    drop(canvas);
    Ok(with_size_and_title(&svg, width_px, height_px, title))
}

/// Plotters gives the size of the sheet in its own fine units and no title.
fn with_size_and_title(svg: &str, width_px: f64, height_px: f64, title: &str) -> String {
    let rest = svg.split_once('>').map_or("", |(_, rest)| rest);
    let title = text::printable(title)
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;");
    format!(
        "<svg width=\"{width_px}\" height=\"{height_px}\" viewBox=\"0 0 {} {}\" \
         xmlns=\"http://www.w3.org/2000/svg\" role=\"img\">\n<title>{title}</title>{rest}",
        fine(width_px),
        fine(height_px),
    )
}

/// A white sheet.
pub(crate) struct Canvas<'a> {
    backend: SVGBackend<'a>,
}

impl Canvas<'_> {
    /// A line through places; a single place is a dot.
    pub(crate) fn line(&mut self, places: &[Place], stroke: Stroke) -> Result<(), Error> {
        if let [only] = places {
            return self.disc(*only, stroke.width_px, stroke.colour, stroke.opacity);
        }
        if stroke.dashed {
            for dash in dashes(places) {
                self.path(&dash, stroke)?;
            }
            return Ok(());
        }
        self.path(places, stroke)
    }

    /// A filled polygon.
    pub(crate) fn fill(
        &mut self,
        outline: &[Place],
        colour: RGBColor,
        opacity: f64,
    ) -> Result<(), Error> {
        let style = filled(colour, opacity);
        self.backend
            .fill_polygon(outline.iter().map(|&place| coordinate(place)), &style)
            .map_err(refused)
    }

    /// A filled rectangle between two corners.
    pub(crate) fn rect(
        &mut self,
        corner: Place,
        opposite: Place,
        colour: RGBColor,
        opacity: f64,
    ) -> Result<(), Error> {
        let from = (corner.0.min(opposite.0), corner.1.min(opposite.1));
        let to = (corner.0.max(opposite.0), corner.1.max(opposite.1));
        self.backend
            .draw_rect(
                coordinate(from),
                coordinate(to),
                &filled(colour, opacity),
                true,
            )
            .map_err(refused)
    }

    /// A filled disc.
    pub(crate) fn disc(
        &mut self,
        centre: Place,
        radius_px: f64,
        colour: RGBColor,
        opacity: f64,
    ) -> Result<(), Error> {
        self.backend
            .draw_circle(
                coordinate(centre),
                fine(radius_px) as u32,
                &filled(colour, opacity),
                true,
            )
            .map_err(refused)
    }

    /// A line of text.
    pub(crate) fn text(
        &mut self,
        text: &str,
        place: Place,
        lettering: Lettering,
    ) -> Result<(), Error> {
        let weight = if lettering.bold {
            FontStyle::Bold
        } else {
            FontStyle::Normal
        };
        let horizontal = match lettering.align {
            Align::Start => HPos::Left,
            Align::Middle => HPos::Center,
            Align::End => HPos::Right,
        };
        let turn = if lettering.upright {
            FontTransform::Rotate270
        } else {
            FontTransform::None
        };
        let size = lettering.size_px * FINE * PLOTTERS_FONT_SCALE;
        let style = TextStyle::from((text::FAMILY, size, weight).into_font())
            .color(&lettering.colour)
            .pos(Pos::new(horizontal, VPos::Center))
            .transform(turn);
        self.backend
            .draw_text(&text::printable(text), &style, coordinate(place))
            .map_err(refused)
    }

    fn path(&mut self, places: &[Place], stroke: Stroke) -> Result<(), Error> {
        let style = ShapeStyle {
            color: stroke.colour.mix(stroke.opacity),
            filled: false,
            stroke_width: fine(stroke.width_px) as u32,
        };
        self.backend
            .draw_path(places.iter().map(|&place| coordinate(place)), &style)
            .map_err(refused)
    }
}

fn fine(px: f64) -> i32 {
    (px * FINE).round() as i32
}

fn coordinate((x, y): Place) -> (i32, i32) {
    (fine(x), fine(y))
}

fn filled(colour: RGBColor, opacity: f64) -> ShapeStyle {
    ShapeStyle {
        color: colour.mix(opacity),
        filled: true,
        stroke_width: 0,
    }
}

fn refused(reason: impl std::fmt::Display) -> Error {
    Error::Drawing {
        reason: reason.to_string(),
    }
}

/// The line cut into dashes: SVG of plotters has none of its own.
fn dashes(places: &[Place]) -> Vec<Vec<Place>> {
    const DASH_PX: f64 = 5.0;
    const GAP_PX: f64 = 3.5;
    let mut dashes = Vec::new();
    let (mut on, mut left_px) = (true, DASH_PX);
    let mut dash: Vec<Place> = places.first().copied().into_iter().collect();
    for pair in places.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        loop {
            let length = (to.0 - from.0).hypot(to.1 - from.1);
            if length <= left_px {
                left_px -= length;
                if on {
                    dash.push(to);
                }
                break;
            }
            let part = left_px / length;
            from = (
                from.0 + part * (to.0 - from.0),
                from.1 + part * (to.1 - from.1),
            );
            if on {
                dash.push(from);
                dashes.push(std::mem::take(&mut dash));
            } else {
                dash = vec![from];
            }
            on = !on;
            left_px = if on { DASH_PX } else { GAP_PX };
        }
    }
    if on && dash.len() > 1 {
        dashes.push(dash);
    }
    dashes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_cover_their_share_of_the_line() {
        let dashes = dashes(&[(0.0, 0.0), (50.0, 0.0), (50.0, 35.0)]);
        // 85 px are ten periods of 8.5 px.
        assert_eq!(dashes.len(), 10);
        let drawn: f64 = dashes
            .iter()
            .flat_map(|dash| dash.windows(2))
            .map(|pair| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1))
            .sum();
        assert!((drawn - 50.0).abs() < 1e-9, "{drawn}");
    }
}
