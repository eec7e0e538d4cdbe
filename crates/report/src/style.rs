//! One look for all pictures.

use plotters::style::RGBColor;

/// Width of a picture, px.
pub(crate) const WIDTH: f64 = 960.0;
/// Margin round a picture, px.
pub(crate) const MARGIN: f64 = 18.0;
/// Room left of a panel for tick labels and the title of the axis, px.
pub(crate) const LEFT: f64 = 62.0;
/// Room under a panel for tick labels and the title of the axis, px.
pub(crate) const BELOW: f64 = 40.0;
/// Room over a panel for its name, px.
pub(crate) const ABOVE: f64 = 20.0;

/// Sizes of text, px.
pub(crate) const TITLE: f64 = 16.0;
pub(crate) const BODY: f64 = 11.0;
pub(crate) const SMALL: f64 = 10.0;

/// Widths of lines, px.
pub(crate) const HAIR: f64 = 0.75;
pub(crate) const THIN: f64 = 1.0;
pub(crate) const DATA: f64 = 1.375;

/// Colours of Okabe and Ito, which people with any common colour blindness tell apart
/// (<https://jfly.uni-koeln.de/color/>).
pub(crate) const ORANGE: RGBColor = RGBColor(0xE6, 0x9F, 0x00);
pub(crate) const SKY: RGBColor = RGBColor(0x56, 0xB4, 0xE9);
pub(crate) const GREEN: RGBColor = RGBColor(0x00, 0x9E, 0x73);
pub(crate) const BLUE: RGBColor = RGBColor(0x00, 0x72, 0xB2);
pub(crate) const VERMILION: RGBColor = RGBColor(0xD5, 0x5E, 0x00);
pub(crate) const PURPLE: RGBColor = RGBColor(0xCC, 0x79, 0xA7);
pub(crate) const BLACK: RGBColor = RGBColor(0x11, 0x11, 0x11);
/// Axes and text of less weight.
pub(crate) const INK: RGBColor = RGBColor(0x55, 0x55, 0x55);
pub(crate) const GREY: RGBColor = RGBColor(0x99, 0x99, 0x99);
pub(crate) const FAINT: RGBColor = RGBColor(0xE8, 0xE8, 0xE8);
pub(crate) const WHITE: RGBColor = RGBColor(0xFF, 0xFF, 0xFF);

/// Colours of things that are told apart by colour, in this order, again from the start when
/// there are more.
pub(crate) const SERIES: [RGBColor; 7] = [BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK];
