//! PNG from SVG: size, content, and the letters of the embedded font.

#![cfg(feature = "png")]
#![cfg(test)]

mod samples;

use gyrocal_report::{Error, to_png, write_png};
use resvg::tiny_skia::Pixmap;
use resvg::usvg::{Options, Tree};
use samples::{all, residuals};

fn dark(pixels: &Pixmap) -> usize {
    let dark = pixels.pixels().iter().filter(|pixel| pixel.red() < 128);
    dark.count()
}

#[test]
fn each_is_a_picture_of_the_asked_width() {
    for (name, picture, _) in all() {
        let svg = picture.to_svg().unwrap();
        let tree = Tree::from_str(&svg, &Options::default()).unwrap();
        let pixels = Pixmap::decode_png(&to_png(&svg, 1200).unwrap()).unwrap();
        let height = f64::from(tree.size().height()) * 1200.0 / f64::from(tree.size().width());
        assert_eq!(pixels.width(), 1200, "{name}");
        assert_eq!(f64::from(pixels.height()), height.round(), "{name}");
        let share = dark(&pixels) as f64 / f64::from(pixels.width() * pixels.height());
        // Letters, axes and data; a sheet without them has none, a broken one is all dark.
        assert!(
            (0.002..0.5).contains(&share),
            "{name}: {share} of the pixels are dark"
        );
    }
}

#[test]
fn letters_are_drawn_without_any_font_of_the_machine() {
    let letters = |text: &str, weight: &str| {
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"400\" height=\"40\"><text x=\"4\" \
             y=\"30\" font-size=\"24\" font-weight=\"{weight}\" font-family=\"No Such Font, \
             DejaVu Sans, sans-serif\">{text}</text></svg>"
        );
        dark(&Pixmap::decode_png(&to_png(&svg, 400).unwrap()).unwrap())
    };
    assert_eq!(letters("", "normal"), 0);
    // Every sign that the pictures use beyond ASCII leaves ink.
    for sign in "−·±µ°²⁻⁰¹²³⁴⁵⁶⁷⁸⁹…σΩ≤→".chars() {
        assert!(
            letters(&sign.to_string(), "normal") > 0,
            "no glyph for {sign}"
        );
    }
    assert!(letters("gyro_x.bias", "bold") > letters("gyro_x.bias", "normal"));
}

#[test]
fn what_cannot_be_drawn_is_an_error() {
    assert!(matches!(
        to_png("not a picture", 100),
        Err(Error::NotSvg { .. })
    ));
    let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"10\" height=\"100\"/>";
    assert!(matches!(to_png(svg, 0), Err(Error::Size { .. })));
    assert!(matches!(to_png(svg, 10_000), Err(Error::Size { .. })));
}

#[test]
fn files_hold_the_picture() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("residuals.png");
    write_png(&residuals(50), &path, 300).unwrap();
    let pixels = Pixmap::decode_png(&std::fs::read(&path).unwrap()).unwrap();
    assert_eq!(pixels.width(), 300);
}
