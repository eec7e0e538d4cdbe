//! The canvas that pictures are drawn on: lines, areas and text in pixels, as SVG.

use crate::geometry::Point;
use crate::style::{BLACK, Colour, WHITE};
use crate::svg::Element;
use crate::text;

/// Dash and gap of a dashed line, px.
const DASHES_PX: &str = "5 3.5";

/// Distance from the middle of small letters down to the baseline, as a fraction of the font size:
/// half of an x-height of half the size.
const BASELINE: f64 = 0.25;

/// Style of a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LineStyle {
    pub colour: Colour,
    pub width_px: f64,
    pub dashed: bool,
}

impl LineStyle {
    pub(crate) fn solid(colour: Colour, width_px: f64) -> Self {
        Self {
            colour,
            width_px,
            dashed: false,
        }
    }

    pub(crate) fn dashed(colour: Colour, width_px: f64) -> Self {
        Self {
            dashed: true,
            ..Self::solid(colour, width_px)
        }
    }
}

/// Style of a text. The middle of its height is at the given point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TextStyle {
    pub colour: Colour,
    pub size_px: f64,
    pub bold: bool,
    pub align: Align,
    /// Reads from bottom to top.
    pub vertical: bool,
}

/// The part of a text that is at the given point.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Align {
    Start,
    Middle,
    End,
}

impl TextStyle {
    pub(crate) fn new(size_px: f64, align: Align) -> Self {
        Self {
            colour: BLACK,
            size_px,
            bold: false,
            align,
            vertical: false,
        }
    }

    pub(crate) fn colour(self, colour: Colour) -> Self {
        Self { colour, ..self }
    }

    pub(crate) fn bold(self) -> Self {
        Self { bold: true, ..self }
    }
}

/// A white canvas.
#[derive(Default)]
pub(crate) struct Canvas {
    elements: String,
}

impl Canvas {
    /// The canvas as an SVG document. The title is for readers that do not see.
    pub(crate) fn into_svg(self, title: &str, width_px: f64, height_px: f64) -> String {
        let title = Element::new("title").containing_text(title);
        let mut ground = Self::default();
        ground.rect((0.0, 0.0), (width_px, height_px), WHITE, 1.0);
        Element::new("svg")
            .with_px("width", width_px)
            .with_px("height", height_px)
            .with("viewBox", format!("0 0 {width_px} {height_px}"))
            .with("xmlns", "http://www.w3.org/2000/svg")
            .with("role", "img")
            .with("font-family", text::FAMILY)
            .containing(&(title + &ground.elements + &self.elements))
    }

    /// A line through points; a single point is a dot.
    pub(crate) fn line(&mut self, points: &[Point], style: LineStyle) {
        if let [only] = points {
            return self.disc(*only, style.width_px, style.colour);
        }
        let mut line = Element::new("polyline")
            .with("fill", "none")
            .with("stroke", style.colour)
            .with("stroke-width", style.width_px);
        if style.dashed {
            line = line.with("stroke-dasharray", DASHES_PX);
        }
        self.elements += &line.with_points(points).empty();
    }

    /// A filled polygon.
    pub(crate) fn polygon(&mut self, outline: &[Point], colour: Colour, opacity: f64) {
        self.elements += &filled("polygon", colour, opacity)
            .with_points(outline)
            .empty();
    }

    /// A filled rectangle between two corners.
    pub(crate) fn rect(&mut self, corner: Point, opposite: Point, colour: Colour, opacity: f64) {
        let (left, top) = (corner.0.min(opposite.0), corner.1.min(opposite.1));
        let (right, bottom) = (corner.0.max(opposite.0), corner.1.max(opposite.1));
        self.elements += &filled("rect", colour, opacity)
            .with_px("x", left)
            .with_px("y", top)
            .with_px("width", right - left)
            .with_px("height", bottom - top)
            .empty();
    }

    /// A filled disc.
    pub(crate) fn disc(&mut self, centre: Point, radius_px: f64, colour: Colour) {
        self.elements += &filled("circle", colour, 1.0)
            .with_px("cx", centre.0)
            .with_px("cy", centre.1)
            .with("r", radius_px)
            .empty();
    }

    /// A line of text.
    pub(crate) fn text(&mut self, text: &str, (x, y): Point, style: TextStyle) {
        if text.is_empty() {
            return;
        }
        let mut element = filled("text", style.colour, 1.0)
            .with_px("x", x)
            .with_px("y", y + BASELINE * style.size_px)
            .with("font-size", style.size_px);
        if style.bold {
            element = element.with("font-weight", "bold");
        }
        element = match style.align {
            Align::Start => element,
            Align::Middle => element.with("text-anchor", "middle"),
            Align::End => element.with("text-anchor", "end"),
        };
        if style.vertical {
            element = element.with("transform", format!("rotate(-90 {x:.1} {y:.1})"));
        }
        self.elements += &element.containing_text(text);
    }
}

fn filled(name: &'static str, colour: Colour, opacity: f64) -> Element {
    let element = Element::new(name).with("fill", colour);
    if opacity < 1.0 {
        element.with("fill-opacity", opacity)
    } else {
        element
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_is_given_by_any_two_opposite_corners() {
        let (mut one, mut other) = (Canvas::default(), Canvas::default());
        one.rect((1.0, 2.0), (5.0, 8.0), BLACK, 0.5);
        other.rect((5.0, 2.0), (1.0, 8.0), BLACK, 0.5);
        assert_eq!(one.elements, other.elements);
        assert_eq!(
            one.elements,
            "<rect fill=\"#111111\" fill-opacity=\"0.5\" x=\"1\" y=\"2\" width=\"4\" \
             height=\"6\"/>\n"
        );
    }
}
