//! From columns of numbers to lines on the sheet: gaps, decimation, clipping.

use crate::axis::Axis;
use crate::canvas::Place;

/// A rectangle on the sheet, px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Frame {
    pub(crate) fn width(self) -> f64 {
        self.right - self.left
    }

    pub(crate) fn height(self) -> f64 {
        self.bottom - self.top
    }
}

/// Intervals longer than so many times the usual one are gaps.
const GAP_FACTOR: f64 = 4.0;

/// The longest interval, in units of the abscissa, that a line may bridge.
pub(crate) fn longest_bridge(abscissa: &[f64]) -> f64 {
    let mut intervals: Vec<f64> = abscissa.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if intervals.is_empty() {
        return f64::INFINITY;
    }
    let middle = intervals.len() / 2;
    let (_, median, _) = intervals.select_nth_unstable_by(middle, f64::total_cmp);
    GAP_FACTOR * *median
}

/// The lines that join values, broken at missing values and at gaps, no more than four points for
/// each column of pixels, cut at the upper and lower edge of the frame.
pub(crate) fn lines(
    frame: Frame,
    (x_axis, y_axis): (&Axis, &Axis),
    abscissa: &[f64],
    values: &[f64],
    bridge: f64,
) -> Vec<Vec<Place>> {
    let mut lines = Vec::new();
    let mut line = Thinned::default();
    let mut last = f64::NAN;
    for (&x, &value) in abscissa.iter().zip(values) {
        let place = place(frame, (x_axis, y_axis), (x, value));
        let missing = !(place.0.is_finite() && place.1.is_finite());
        if missing || x - last > bridge {
            clip(frame, &std::mem::take(&mut line).finish(), &mut lines);
        }
        if !missing {
            line.push(place);
            last = x;
        }
    }
    clip(frame, &line.finish(), &mut lines);
    lines
}

/// The outline of the area between two columns, in as many pieces as there are stretches without
/// missing values or gaps, clamped to the frame.
pub(crate) fn areas(
    frame: Frame,
    axes: (&Axis, &Axis),
    abscissa: &[f64],
    lower: &[f64],
    upper: &[f64],
    bridge: f64,
) -> Vec<Vec<Place>> {
    let mut areas = Vec::new();
    let mut columns: Vec<[f64; 3]> = Vec::new();
    let mut last = f64::NAN;
    let mut close = |columns: &mut Vec<[f64; 3]>| {
        if columns.len() > 1 {
            let bottom = columns.iter().map(|column| (column[0], column[1]));
            let top = columns.iter().rev().map(|column| (column[0], column[2]));
            areas.push(bottom.chain(top).collect());
        }
        columns.clear();
    };
    for ((&x, &lower), &upper) in abscissa.iter().zip(lower).zip(upper) {
        let (px, bottom) = place(frame, axes, (x, lower));
        let (_, top) = place(frame, axes, (x, upper));
        let missing = !(px.is_finite() && bottom.is_finite() && top.is_finite());
        if missing || x - last > bridge {
            close(&mut columns);
        }
        if missing {
            continue;
        }
        last = x;
        let clamp = |y: f64| y.clamp(frame.top, frame.bottom);
        let (bottom, top) = (clamp(bottom), clamp(top));
        match columns.last_mut() {
            Some(column) if px - column[0] < 1.0 => {
                column[1] = column[1].max(bottom);
                column[2] = column[2].min(top);
            }
            _ => columns.push([px, bottom, top]),
        }
    }
    close(&mut columns);
    areas
}

/// Where a pair of values stands on the sheet, maybe outside of the frame.
pub(crate) fn place(frame: Frame, axes: (&Axis, &Axis), (x, y): (f64, f64)) -> Place {
    (
        frame.left + axes.0.at(x) * frame.width(),
        frame.bottom - axes.1.at(y) * frame.height(),
    )
}

/// A line of at most four points for each column of pixels: first, highest, lowest, last, in
/// their order, which draws the same pixels as all of them.
#[derive(Default)]
struct Thinned {
    line: Vec<Place>,
    column: Option<Column>,
}

struct Column {
    number: i64,
    first: (usize, Place),
    highest: (usize, Place),
    lowest: (usize, Place),
    last: (usize, Place),
}

impl Thinned {
    fn push(&mut self, place: Place) {
        let number = place.0.floor() as i64;
        match &mut self.column {
            Some(column) if column.number == number => {
                let next = (column.last.0 + 1, place);
                if place.1 < column.highest.1.1 {
                    column.highest = next;
                }
                if place.1 > column.lowest.1.1 {
                    column.lowest = next;
                }
                column.last = next;
            }
            _ => {
                self.close();
                let only = (0, place);
                self.column = Some(Column {
                    number,
                    first: only,
                    highest: only,
                    lowest: only,
                    last: only,
                });
            }
        }
    }

    fn close(&mut self) {
        if let Some(column) = self.column.take() {
            let mut kept = [column.first, column.highest, column.lowest, column.last];
            kept.sort_by_key(|(order, _)| *order);
            let mut before = None;
            for (order, place) in kept {
                if before != Some(order) {
                    self.line.push(place);
                }
                before = Some(order);
            }
        }
    }

    fn finish(mut self) -> Vec<Place> {
        self.close();
        self.line
    }
}

/// The parts of a line between the upper and the lower edge of the frame.
fn clip(frame: Frame, line: &[Place], lines: &mut Vec<Vec<Place>>) {
    let inside = |place: &Place| (frame.top..=frame.bottom).contains(&place.1);
    if let [only] = line {
        if inside(only) {
            lines.push(vec![*only]);
        }
        return;
    }
    let mut part: Vec<Place> = Vec::new();
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

fn clip_segment(frame: Frame, from: Place, to: Place) -> Option<(Place, Place)> {
    if from.1.max(to.1) < frame.top || from.1.min(to.1) > frame.bottom {
        return None;
    }
    let slide = |place: Place, other: Place| {
        let edge = place.1.clamp(frame.top, frame.bottom);
        if edge == place.1 {
            return place;
        }
        let part = (edge - place.1) / (other.1 - place.1);
        (place.0 + part * (other.0 - place.0), edge)
    };
    Some((slide(from, to), slide(to, from)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Span;

    const FRAME: Frame = Frame {
        left: 10.0,
        top: 20.0,
        right: 110.0,
        bottom: 70.0,
    };

    fn axes(x: (f64, f64), y: (f64, f64)) -> (Axis, Axis) {
        let axis = |(lo, hi)| Axis::linear(Span { lo, hi }, "", "", 4);
        (axis(x), axis(y))
    }

    #[test]
    fn gaps_are_not_bridged() {
        let (x_axis, y_axis) = axes((0.0, 20.0), (0.0, 1.0));
        let time = [0.0, 1.0, 2.0, 3.0, 10.0, 11.0, 12.0, 13.0];
        let values = [0.5, 0.5, f64::NAN, 0.5, 0.5, 0.5, 0.5, 0.5];
        let bridge = longest_bridge(&time);
        let lines = lines(FRAME, (&x_axis, &y_axis), &time, &values, bridge);
        let ends: Vec<_> = lines
            .iter()
            .map(|line| (line[0].0, line[line.len() - 1].0))
            .collect();
        // Five pixels a unit of time: [0, 1], [3] alone, [10, 13].
        assert_eq!(ends, [(10.0, 15.0), (25.0, 25.0), (60.0, 75.0)]);
    }

    #[test]
    fn thinning_keeps_the_extremes() {
        let count = 100_000;
        let time: Vec<f64> = (0..count).map(f64::from).collect();
        let mut values: Vec<f64> = time.iter().map(|t| (0.1 * t).sin()).collect();
        values[31_415] = 7.0;
        values[27_182] = -5.0;
        let (x_axis, y_axis) = axes((0.0, f64::from(count)), (-10.0, 10.0));
        let lines = lines(FRAME, (&x_axis, &y_axis), &time, &values, 10.0);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].len() <= 4 * 101, "{}", lines[0].len());
        let span = Span::of(lines[0].iter().map(|place| place.1));
        // 50 px for 20 units, downwards.
        let expected = Span {
            lo: 45.0 - 7.0 * 2.5,
            hi: 45.0 + 5.0 * 2.5,
        };
        assert_eq!(span, Some(expected));
        assert!(lines[0].windows(2).all(|pair| pair[0].0 <= pair[1].0));
    }

    #[test]
    fn lines_end_at_the_edge() {
        let (x_axis, y_axis) = axes((0.0, 4.0), (0.0, 1.0));
        let lines = lines(
            FRAME,
            (&x_axis, &y_axis),
            &[0.0, 1.0, 2.0, 3.0, 4.0],
            &[0.5, 1.5, 0.5, -9.5, -9.5],
            9.0,
        );
        assert_eq!(lines.len(), 2);
        assert_eq!(lines[0], [(10.0, 45.0), (22.5, 20.0)]);
        assert_eq!(lines[1].first(), Some(&(47.5, 20.0)));
        for place in lines.iter().flatten() {
            assert!((FRAME.top..=FRAME.bottom).contains(&place.1), "{place:?}");
        }
    }
}
