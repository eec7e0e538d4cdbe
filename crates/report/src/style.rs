//! Sizes and colours, the same in all pictures.

use std::fmt;

use gyrocal_document::Tint;

/// Width of a picture, px.
pub(crate) const WIDTH: f64 = 960.0;
/// Margin around a picture, px.
pub(crate) const MARGIN: f64 = 18.0;
/// Width of a picture within its margins, px.
pub(crate) const INNER_WIDTH: f64 = WIDTH - 2.0 * MARGIN;
/// Room left of a panel for tick labels and the title of the axis, px.
pub(crate) const LEFT: f64 = 62.0;
/// Room below a panel for tick labels and the title of the axis, px.
pub(crate) const BELOW: f64 = 40.0;
/// Room above a panel for its name, px.
pub(crate) const ABOVE: f64 = 20.0;

/// Font sizes, px.
pub(crate) const TITLE: f64 = 16.0;
pub(crate) const BODY: f64 = 11.0;
pub(crate) const SMALL: f64 = 10.0;

/// Line widths, px.
pub(crate) const HAIR: f64 = 0.75;
pub(crate) const THIN: f64 = 1.0;
pub(crate) const DATA: f64 = 1.375;
/// Width of the line of measured values, under those of models, px.
pub(crate) const BROAD: f64 = 3.0;
/// Width of data lines in a legend, px.
pub(crate) const LEGEND_LINE: f64 = 2.0;

/// Opacity of confidence bands.
pub(crate) const BAND_OPACITY: f64 = 0.22;

/// A colour: red, green, blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Colour(u8, u8, u8);

impl fmt::Display for Colour {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "#{:02X}{:02X}{:02X}", self.0, self.1, self.2)
    }
}

/// Colours of text, axes and grid.
pub(crate) const BLACK: Colour = Colour(0x11, 0x11, 0x11);
/// Labels of axes and other text of less weight.
pub(crate) const INK: Colour = Colour(0x55, 0x55, 0x55);
pub(crate) const GREY: Colour = Colour(0x99, 0x99, 0x99);
pub(crate) const FAINT: Colour = Colour(0xE8, 0xE8, 0xE8);
pub(crate) const WHITE: Colour = Colour(0xFF, 0xFF, 0xFF);
/// Vertical lines.
pub(crate) const MARK: Colour = Colour(0xCC, 0x79, 0xA7);
/// Horizontal lines.
pub(crate) const LEVEL: Colour = Colour(0x4A, 0x55, 0x61);

/// Colour of a series by its meaning, as on a light page: greys, and colours of Okabe and Ito, which people with
/// any common colour blindness tell apart (<https://jfly.uni-koeln.de/color/>).
pub(crate) fn colour(tint: Tint) -> Colour {
    match tint {
        Tint::Measured => Colour(0x7A, 0x87, 0x94),
        Tint::Nominal => Colour(0xD5, 0x5E, 0x00),
        Tint::Extended => Colour(0x00, 0x72, 0xB2),
        Tint::Expected => LEVEL,
        Tint::Alternative => Colour(0xE6, 0x9F, 0x00),
        Tint::Other => Colour(0x9A, 0xA5, 0xB0),
    }
}
