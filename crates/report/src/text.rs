//! Width of text in the embedded font, and text cut or broken to fit a width.

use std::sync::OnceLock;

use ttf_parser::Face;

/// The embedded font, a subset of DejaVu Sans; see `fonts/README.md`.
pub(crate) static REGULAR: &[u8] = include_bytes!("../fonts/DejaVuSans.ttf");
/// Its bold face.
pub(crate) static BOLD: &[u8] = include_bytes!("../fonts/DejaVuSans-Bold.ttf");

/// Fonts that a viewer of the SVG may use. Verdana has the widths of DejaVu Sans.
pub(crate) const FAMILY: &str = "DejaVu Sans, Verdana, Arial, Helvetica, sans-serif";

/// Width of a text at a size, px, in the embedded font.
pub(crate) fn width_px(text: &str, size_px: f64, bold: bool) -> f64 {
    static FACES: OnceLock<[Option<Face<'static>>; 2]> = OnceLock::new();
    let faces = FACES.get_or_init(|| [REGULAR, BOLD].map(|bytes| Face::parse(bytes, 0).ok()));
    let face = faces[usize::from(bold)].as_ref();
    let em = face.map_or(1.0, |face| f64::from(face.units_per_em()));
    let advance = |letter: char| {
        let face = face?;
        face.glyph_hor_advance(face.glyph_index(letter)?)
    };
    text.chars()
        // Letters that the font lacks are drawn by a font unknown here, hardly wider than an em.
        .map(|letter| advance(letter).map_or(1.0, |units| f64::from(units) / em))
        .sum::<f64>()
        * size_px
}

/// The text, or as much of its start as fits followed by an ellipsis.
pub(crate) fn fit(text: &str, size_px: f64, bold: bool, room_px: f64) -> String {
    if width_px(text, size_px, bold) <= room_px {
        return text.to_owned();
    }
    let mut kept = text.to_owned();
    while kept.pop().is_some() {
        let candidate = format!("{}…", kept.trim_end());
        if width_px(&candidate, size_px, bold) <= room_px {
            return candidate;
        }
    }
    String::new()
}

/// The text in lines that fit, broken at spaces.
pub(crate) fn wrap(text: &str, size_px: f64, bold: bool, room_px: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let joined = lines.last().map(|line| format!("{line} {word}"));
        match (joined, lines.last_mut()) {
            (Some(joined), Some(last)) if width_px(&joined, size_px, bold) <= room_px => {
                *last = joined;
            }
            _ => lines.push(fit(word, size_px, bold, room_px)),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn width_is_that_of_the_font() {
        // DejaVu Sans has 1303 of 2048 units for a digit, 1716 for the sign minus.
        let expected = (3.0 * 1303.0 + 1716.0) / 2048.0 * 10.0;
        assert!((width_px("−123", 10.0, false) - expected).abs() < 1e-9);
        assert!(width_px("−123", 10.0, true) > expected);
    }

    #[test]
    fn long_text_is_broken_or_cut() {
        let text = "the platform drifts by more than the noise of its gyros";
        let lines = wrap(text, 11.0, false, 120.0);
        assert!(lines.len() > 1);
        assert_eq!(lines.join(" "), text);
        for line in &lines {
            assert!(width_px(line, 11.0, false) <= 120.0, "{line}");
        }
        let cut = fit(text, 11.0, false, 100.0);
        assert!(
            cut.ends_with('…') && width_px(&cut, 11.0, false) <= 100.0,
            "{cut}"
        );
    }
}
