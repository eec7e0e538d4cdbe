//! Every picture as SVG: what it says, how large it is, what it does with bad or missing data.

#![cfg(test)]

mod samples;

use gyrocal_document::Chart;
use gyrocal_report::{Error, Picture, write_svg};
use samples::{all, residuals};

/// Pairs of coordinates of a list of points.
fn points(list: &str) -> Vec<(f64, f64)> {
    let pairs = list
        .split_whitespace()
        .map(|pair| pair.split_once(',').unwrap());
    pairs
        .map(|(x, y)| (x.parse().unwrap(), y.parse().unwrap()))
        .collect()
}

/// The values of an attribute in a document.
fn attributes<'a>(svg: &'a str, name: &str) -> Vec<&'a str> {
    let opening = format!(" {name}=\"");
    let parts = svg.split(&opening).skip(1);
    parts.map(|part| part.split('"').next().unwrap()).collect()
}

/// Width and height of the canvas.
fn canvas(svg: &str) -> (f64, f64) {
    let view_box: Vec<f64> = attributes(svg, "viewBox")[0]
        .split(' ')
        .map(|number| number.parse().unwrap())
        .collect();
    (view_box[2], view_box[3])
}

#[test]
fn each_says_its_title_its_bands_its_axes_and_its_source() {
    for (name, picture, words) in all() {
        let svg = picture.to_svg_of("record.csv: a finding").unwrap();
        for word in words.into_iter().chain(["record.csv: a finding"]) {
            assert!(svg.contains(word), "{name}: no `{word}`");
        }
        assert!(svg.contains("<title>"), "{name}");
        assert!(svg.contains("DejaVu Sans, Verdana"), "{name}");
        assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{name}");
    }
}

#[test]
fn same_data_same_bytes() {
    for ((name, first, _), (_, second, _)) in all().into_iter().zip(all()) {
        assert_eq!(first.to_svg().unwrap(), second.to_svg().unwrap(), "{name}");
    }
}

#[test]
fn everything_drawn_is_on_the_canvas() {
    for (name, picture, _) in all() {
        let svg = picture.to_svg().unwrap();
        let (width, height) = canvas(&svg);
        let drawn: Vec<_> = attributes(&svg, "points")
            .into_iter()
            .flat_map(points)
            .collect();
        assert!(drawn.len() > 10, "{name}");
        for (x, y) in drawn {
            let inside = (0.0..=width).contains(&x) && (0.0..=height).contains(&y);
            assert!(
                inside,
                "{name}: ({x}, {y}) is not within {width} by {height}"
            );
        }
    }
}

#[test]
fn data_stay_in_their_panel() {
    let mut picture = residuals(500);
    picture.panels[1].lines[0].values[250] = 1.0;
    let svg = picture.to_svg().unwrap();
    // The axes are the paths of exactly three points: top left, bottom left, bottom right.
    let lists: Vec<_> = attributes(&svg, "points").into_iter().map(points).collect();
    let axes = lists
        .iter()
        .filter(|list| list.len() == 3 && list[0].0 == list[1].0 && list[1].1 == list[2].1);
    let axes: Vec<_> = axes.collect();
    assert_eq!(axes.len(), 3);
    let curves = lists.iter().filter(|list| list.len() > 3);
    for curve in curves {
        let home = axes.iter().find(|axis| {
            // Coordinates are rounded to tenths of a pixel.
            let inside = |point: &(f64, f64)| {
                (axis[0].0 - 0.1..=axis[2].0 + 0.1).contains(&point.0)
                    && (axis[0].1 - 0.1..=axis[1].1 + 0.1).contains(&point.1)
            };
            curve.iter().all(inside)
        });
        assert!(
            home.is_some(),
            "a curve leaves its panel: {:?}",
            &curve[..2]
        );
    }
    assert!(
        svg.contains("n = 500; 1 beyond the scale, to 1.0 g"),
        "what is cut must be said"
    );
}

#[test]
fn a_million_samples_make_a_small_picture() {
    let count = 1_000_000;
    let mut picture = residuals(count);
    for panel in &mut picture.panels {
        panel.lines.push(panel.lines[0].clone());
    }
    let svg = picture.to_svg().unwrap();
    // Six curves of at most four points of eleven bytes on each of 880 columns of pixels are
    // 232 kB; the rest is text and axes.
    assert!(svg.len() < 250_000, "{} bytes", svg.len());
}

#[test]
fn missing_data_are_said_to_be_missing() {
    let mut picture = residuals(50);
    picture.panels[2].lines[0].values = vec![f64::NAN; 50];
    assert_eq!(picture.to_svg().unwrap().matches("no data").count(), 1);
    assert_eq!(residuals(0).to_svg().unwrap().matches("no data").count(), 3);
}

#[test]
fn wrong_data_are_errors_that_say_where() {
    let mut infinite = residuals(50);
    infinite.panels[1].lines[0].values[7] = f64::INFINITY;
    let message = infinite.to_svg().unwrap_err().to_string();
    assert!(
        message.contains("line innovation of panel y, value 7: found inf"),
        "{message}"
    );

    let mut short = residuals(50);
    short.panels[0].lines[0].values.pop();
    assert!(matches!(
        short.to_svg(),
        Err(Error::UnequalLengths {
            found: 49,
            expected: 50,
            ..
        })
    ));

    let mut back = residuals(50);
    back.panels[0].abscissa[20] = 0.0;
    assert!(matches!(back.to_svg(), Err(Error::Value { index: 20, .. })));

    let without_panels = Chart {
        panels: Vec::new(),
        ..residuals(50)
    };
    assert!(matches!(without_panels.to_svg(), Err(Error::Empty { .. })));
}

#[test]
fn gaps_and_missing_values_are_left_open() {
    let lines = |picture: &Chart| {
        let svg = picture.to_svg().unwrap();
        let lists = attributes(&svg, "points");
        lists
            .into_iter()
            .filter(|list| points(list).len() > 3)
            .count()
    };
    let whole = residuals(50);
    let mut missing = whole.clone();
    missing.panels[0].lines[0].values[25] = f64::NAN;
    assert_eq!(lines(&missing), lines(&whole) + 1);
    // A pause breaks the line and its band, unless the panel has no gaps.
    let mut pause = whole.clone();
    for day in &mut pause.panels[0].abscissa[25..] {
        *day += 1.0;
    }
    assert_eq!(lines(&pause), lines(&whole) + 2);
    pause.panels[0].no_gaps = true;
    assert_eq!(lines(&pause), lines(&whole));
}

#[test]
fn markup_in_words_is_text() {
    let mut picture = residuals(50);
    picture.title = "a < b & \u{1}\"c\"".to_owned();
    let svg = picture.to_svg().unwrap();
    assert!(svg.contains("a &lt; b &amp; "), "not escaped");
    assert!(!svg.contains('\u{1}'), "forbidden in XML");
}

#[test]
fn a_file_is_written_whole_or_not_at_all() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("residuals.svg");
    write_svg(&residuals(50), &path).unwrap();
    let before = std::fs::read(&path).unwrap();
    assert!(before.ends_with(b"</svg>\n"));
    let mut wrong = residuals(50);
    wrong.panels[0].lines[0].values.pop();
    assert!(write_svg(&wrong, &path).is_err());
    assert_eq!(std::fs::read(&path).unwrap(), before);
    let nowhere = directory.path().join("no/such/directory.svg");
    assert!(matches!(
        write_svg(&residuals(5), &nowhere),
        Err(Error::Unwritable { .. })
    ));
}
