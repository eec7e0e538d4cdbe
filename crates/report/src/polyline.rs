//! From columns of points to lines and bands on the canvas: gaps, decimation, clipping.

use gyrocal_statistics::median_interval_s;

use crate::geometry::{Point, Rect};

/// Intervals longer than this multiple of the usual one are gaps.
const GAP_FACTOR: f64 = 4.0;

/// The longest interval, in units of the abscissa, that is not a gap.
pub(crate) fn longest_interval(abscissa: &[f64], no_gaps: bool) -> f64 {
    match no_gaps {
        true => f64::INFINITY,
        false => GAP_FACTOR * median_interval_s(abscissa),
    }
}

/// The lines through points, broken at missing values and at gaps, no more than four points for
/// each column of pixels, clipped at the upper and lower edge of the frame.
pub(crate) fn lines(
    frame: Rect,
    abscissa: &[f64],
    points: &[Point],
    longest_interval: f64,
) -> Vec<Vec<Point>> {
    let mut lines = Vec::new();
    let mut line = Decimated::default();
    let mut last = f64::NAN;
    for (&x, &point) in abscissa.iter().zip(points) {
        let missing = !(point.0.is_finite() && point.1.is_finite());
        if missing || x - last > longest_interval {
            clip(frame, &std::mem::take(&mut line).finish(), &mut lines);
        }
        if !missing {
            line.push(point);
            last = x;
        }
    }
    clip(frame, &line.finish(), &mut lines);
    lines
}

/// The outlines of the band between two edges, one for each stretch without missing values or
/// gaps, clamped to the frame.
pub(crate) fn bands(
    frame: Rect,
    abscissa: &[f64],
    (lower, upper): (&[Point], &[Point]),
    longest_interval: f64,
) -> Vec<Vec<Point>> {
    let mut bands = Vec::new();
    // Of each column of pixels its left edge, bottom and top.
    let mut columns: Vec<[f64; 3]> = Vec::new();
    let mut last = f64::NAN;
    let mut close = |columns: &mut Vec<[f64; 3]>| {
        if columns.len() > 1 {
            let bottom = columns.iter().map(|column| (column[0], column[1]));
            let top = columns.iter().rev().map(|column| (column[0], column[2]));
            bands.push(bottom.chain(top).collect());
        }
        columns.clear();
    };
    for ((&x, &(px, bottom)), &(_, top)) in abscissa.iter().zip(lower).zip(upper) {
        let missing = !(px.is_finite() && bottom.is_finite() && top.is_finite());
        if missing || x - last > longest_interval {
            close(&mut columns);
        }
        if missing {
            continue;
        }
        last = x;
        let clamp = |y: f64| y.clamp(frame.top, frame.bottom);
        let (bottom, top) = (clamp(bottom), clamp(top));
        match &mut *columns {
            [.., column] if px - column[0] < 1.0 => {
                column[1] = column[1].max(bottom);
                column[2] = column[2].min(top);
            }
            // A level stretch needs its ends only.
            [.., before, column] if before[1..] == column[1..] && column[1..] == [bottom, top] => {
                column[0] = px;
            }
            _ => columns.push([px, bottom, top]),
        }
    }
    close(&mut columns);
    bands
}

/// A line of at most four points for each column of pixels: first, highest, lowest, last, in
/// their order, which draws the same pixels as all of them.
#[derive(Default)]
struct Decimated {
    line: Vec<Point>,
    column: Option<Column>,
}

struct Column {
    number: i64,
    /// First, highest, lowest and last point, each with its place in the column.
    kept: [(usize, Point); 4],
}

impl Decimated {
    fn push(&mut self, point: Point) {
        let number = point.0.floor() as i64;
        match &mut self.column {
            Some(column) if column.number == number => {
                let [_, highest, lowest, last] = &mut column.kept;
                let next = (last.0 + 1, point);
                if point.1 < highest.1.1 {
                    *highest = next;
                }
                if point.1 > lowest.1.1 {
                    *lowest = next;
                }
                *last = next;
            }
            _ => {
                self.close();
                let kept = [(0, point); 4];
                self.column = Some(Column { number, kept });
            }
        }
    }

    fn close(&mut self) {
        if let Some(Column { mut kept, .. }) = self.column.take() {
            kept.sort_by_key(|(order, _)| *order);
            let mut before = None;
            for (order, point) in kept {
                if before != Some(order) {
                    self.line.push(point);
                }
                before = Some(order);
            }
        }
    }

    fn finish(mut self) -> Vec<Point> {
        self.close();
        self.line
    }
}

/// The parts of a line between the upper and the lower edge of the frame.
fn clip(frame: Rect, line: &[Point], lines: &mut Vec<Vec<Point>>) {
    let inside = |point: &Point| (frame.top..=frame.bottom).contains(&point.1);
    if let [only] = line {
        if inside(only) {
            lines.push(vec![*only]);
        }
        return;
    }
    let mut part: Vec<Point> = Vec::new();
    for pair in line.windows(2) {
        let Some((from, to)) = clip_segment(frame, pair[0], pair[1]) else {
            continue;
        };
        if part.last() != Some(&from) {
            if part.len() > 1 {
                lines.push(std::mem::take(&mut part));
            }
            part = vec![from];
        }
        part.push(to);
    }
    if part.len() > 1 {
        lines.push(part);
    }
}

fn clip_segment(frame: Rect, from: Point, to: Point) -> Option<(Point, Point)> {
    if from.1.max(to.1) < frame.top || from.1.min(to.1) > frame.bottom {
        return None;
    }
    let slide = |point: Point, other: Point| {
        let edge = point.1.clamp(frame.top, frame.bottom);
        if edge == point.1 {
            return point;
        }
        let part = (edge - point.1) / (other.1 - point.1);
        (point.0 + part * (other.0 - point.0), edge)
    };
    Some((slide(from, to), slide(to, from)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::span::Span;

    const FRAME: Rect = Rect {
        left: 10.0,
        top: 20.0,
        right: 110.0,
        bottom: 70.0,
    };

    /// Points of values on linear scales over the frame.
    fn points(x: Span, y: Span, abscissa: &[f64], values: &[f64]) -> Vec<Point> {
        let pairs = abscissa.iter().zip(values);
        let part = |span: Span, value: f64| (value - span.lo) / span.length();
        pairs
            .map(|(&abscissa, &value)| {
                (
                    FRAME.left + part(x, abscissa) * FRAME.width(),
                    FRAME.bottom - part(y, value) * FRAME.height(),
                )
            })
            .collect()
    }

    #[test]
    fn gaps_are_not_bridged() {
        let time = [0.0, 1.0, 2.0, 3.0, 10.0, 11.0, 12.0, 13.0];
        let values = [0.5, 0.5, f64::NAN, 0.5, 0.5, 0.5, 0.5, 0.5];
        let points = points(Span::new(0.0, 20.0), Span::new(0.0, 1.0), &time, &values);
        let lines = lines(FRAME, &time, &points, longest_interval(&time, false));
        let ends: Vec<_> = lines
            .iter()
            .map(|line| (line[0].0, line[line.len() - 1].0))
            .collect();
        // Five pixels a unit of time: [0, 1], [3] alone, [10, 13].
        assert_eq!(ends, [(10.0, 15.0), (25.0, 25.0), (60.0, 75.0)]);
    }

    #[test]
    fn decimation_keeps_the_extremes() {
        let count = 100_000;
        let time: Vec<f64> = (0..count).map(f64::from).collect();
        let mut values: Vec<f64> = time.iter().map(|t| (0.1 * t).sin()).collect();
        values[31_415] = 7.0;
        values[27_182] = -5.0;
        let (x, y) = (Span::new(0.0, f64::from(count)), Span::new(-10.0, 10.0));
        let lines = lines(FRAME, &time, &points(x, y, &time, &values), 10.0);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].len() <= 4 * 101, "{}", lines[0].len());
        let drawn = Span::of(lines[0].iter().map(|point| point.1));
        // 50 px for 20 units, downwards.
        let expected = Span::new(45.0 - 7.0 * 2.5, 45.0 + 5.0 * 2.5);
        assert_eq!(drawn, Some(expected));
        assert!(lines[0].windows(2).all(|pair| pair[0].0 <= pair[1].0));
    }

    #[test]
    fn a_level_band_has_four_corners() {
        let time: Vec<f64> = (0..100).map(f64::from).collect();
        let (x, y) = (Span::new(0.0, 99.0), Span::new(0.0, 1.0));
        let edge = |value: f64| points(x, y, &time, &[value; 100]);
        let bands = bands(FRAME, &time, (&edge(0.2), &edge(0.8)), 9.0);
        assert_eq!(
            bands,
            [[(10.0, 60.0), (110.0, 60.0), (110.0, 30.0), (10.0, 30.0)]]
        );
    }

    #[test]
    fn lines_end_at_the_edge() {
        let time = [0.0, 1.0, 2.0, 3.0, 4.0];
        let values = [0.5, 1.5, 0.5, -9.5, -9.5];
        let points = points(Span::new(0.0, 4.0), Span::new(0.0, 1.0), &time, &values);
        let lines = lines(FRAME, &time, &points, 9.0);
        assert_eq!(lines.len(), 2);
        assert_eq!(lines[0], [(10.0, 45.0), (22.5, 20.0)]);
        assert_eq!(lines[1].first(), Some(&(47.5, 20.0)));
        for point in lines.iter().flatten() {
            assert!((FRAME.top..=FRAME.bottom).contains(&point.1), "{point:?}");
        }
    }
}
