use std::path::Path;

use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use crate::error::Error;
use crate::picture::{self, Picture};
use crate::text;

/// The largest width and height, px.
const MOST_PX: u32 = 16_384;

/// Renders an SVG picture as PNG of a given width on a white ground; the height follows. Text is
/// drawn with the embedded font, whatever fonts the machine has.
///
/// # Errors
///
/// [`Error::NotSvg`] if the text cannot be read, [`Error::Size`] if the picture would have no
/// pixel or too many, [`Error::Encoding`] if encoding fails.
pub fn to_png(svg: &str, width_px: u32) -> Result<Vec<u8>, Error> {
    let mut options = Options {
        font_family: "DejaVu Sans".to_owned(),
        ..Options::default()
    };
    let fonts = options.fontdb_mut();
    fonts.load_font_data(text::REGULAR.to_vec());
    fonts.load_font_data(text::BOLD.to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    let tree = Tree::from_str(svg, &options).map_err(|reason| Error::NotSvg {
        reason: reason.to_string(),
    })?;
    let scale = f64::from(width_px) / f64::from(tree.size().width());
    let height_px = (f64::from(tree.size().height()) * scale).round() as u32;
    let size = Error::Size {
        width_px,
        height_px,
        most: MOST_PX,
    };
    if width_px > MOST_PX || height_px > MOST_PX {
        return Err(size);
    }
    let mut pixels = Pixmap::new(width_px, height_px).ok_or(size)?;
    pixels.fill(Color::WHITE);
    let to_pixels = Transform::from_scale(scale as f32, scale as f32);
    resvg::render(&tree, to_pixels, &mut pixels.as_mut());
    pixels.encode_png().map_err(|reason| Error::Encoding {
        reason: reason.to_string(),
    })
}

/// Writes a picture as PNG of a given width, whole or not at all.
///
/// # Errors
///
/// As [`Picture::to_svg`] and [`to_png`], and [`Error::Unwritable`].
pub fn write_png(picture: &dyn Picture, path: &Path, width_px: u32) -> Result<(), Error> {
    picture::write(path, &to_png(&picture.to_svg()?, width_px)?)
}
