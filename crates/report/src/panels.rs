//! Charts of a page as pictures.

use crate::axes::{Axes, Labels};
use crate::axis::Axis;
use crate::canvas::{Align, Canvas, LineStyle, TextStyle};
use crate::error::Error;
use crate::figure::{Legend, Sample, figure};
use crate::geometry::Rect;
use crate::layout::Layout;
use crate::page::chart::{check, halves, note};
use crate::picture::Picture;
use crate::polyline::longest_interval;
use crate::span::Span;
use crate::style::{BAND_OPACITY, BROAD, DATA, LEGEND_LINE, LEVEL, MARK, SMALL, THIN, colour};
use crate::text;
use gyrocal_document::{Chart, Line, LineKind, Panel, Tint};

/// Least height of a panel, px.
const LEAST_PX: f64 = 150.0;

/// Room of a tick along the abscissa and the ordinate, px: an axis has as many as fit.
const TICK_PX: f64 = 50.0;
const ROW_PX: f64 = 32.0;

/// Most of a bar's width, px.
const BAR_PX: f64 = 8.0;

impl Picture for Chart {
    fn to_svg_of(&self, source: &str) -> Result<String, Error> {
        check(self)?;
        let panel_px = f64::from(self.height_px).clamp(LEAST_PX, 2.0 * LEAST_PX);
        let layout = Layout::new(self.columns, self.panels.len(), panel_px);
        Ok(figure(
            &self.title,
            &[&self.caption, source],
            &legend(self),
            layout.height(),
            |canvas, body| draw(self, canvas, layout, body),
        ))
    }
}

/// One entry for each name in any panel.
fn legend(chart: &Chart) -> Vec<Legend> {
    let bands = chart.panels.iter().flat_map(|panel| &panel.bands);
    let bands = bands.map(|band| {
        let area = Sample::Area(colour(band.tint), BAND_OPACITY);
        (&band.label, area)
    });
    let lines = chart.panels.iter().flat_map(|panel| &panel.lines);
    let lines = lines.map(|line| (&line.label, sample_of(line)));
    let levels = chart.panels.iter().flat_map(|panel| &panel.levels);
    let dashed = || Sample::Line(LineStyle::dashed(LEVEL, THIN));
    let levels = levels.map(|level| (&level.label, dashed()));
    let mut shown: Vec<&String> = Vec::new();
    let mut legend = Vec::new();
    for (label, sample) in bands.chain(lines).chain(levels) {
        if !label.is_empty() && !shown.contains(&label) {
            shown.push(label);
            legend.push(Legend::new(sample, label));
        }
    }
    legend
}

fn draw(chart: &Chart, canvas: &mut Canvas, layout: Layout, body: Rect) {
    let cut = halves(chart);
    let spans = chart.panels.iter().zip(&cut);
    let ordinates: Vec<Option<Span>> = spans
        .map(|(panel, half)| match half {
            Some(half) => Some(Span::symmetric(*half)),
            None => ordinates(panel, chart.logarithmic),
        })
        .collect();
    let whole = |spans: &[Option<Span>]| spans.iter().copied().flatten().reduce(Span::with);
    let of_all = whole(&ordinates);
    let abscissas = chart.panels.iter().map(|panel| {
        let values = panel.abscissa.iter().copied();
        Span::of(values.filter(|value| !chart.logarithmic_abscissa || *value > 0.0))
    });
    let abscissas: Vec<Option<Span>> = abscissas.collect();
    let linked = whole(&abscissas).filter(|_| !chart.unlinked);
    for (index, panel) in chart.panels.iter().enumerate() {
        let frame = layout.frame(body, index);
        let along = linked.or(abscissas[index]);
        let up = if chart.same_scale {
            of_all
        } else {
            ordinates[index]
        };
        let axes = Axes {
            frame,
            x: axis(
                along,
                chart.abscissa_of(panel),
                chart.logarithmic_abscissa,
                (frame.width() / TICK_PX) as usize,
            ),
            y: axis(
                up.map(|span| match chart.logarithmic {
                    true => span,
                    false => span.padded(0.05),
                }),
                (&chart.quantity, chart.unit_of(panel)),
                chart.logarithmic,
                (frame.height() / ROW_PX) as usize,
            ),
        };
        let labels = Labels {
            name: &panel.name,
            note: &note(chart, panel, cut[index]),
            ordinate_title: layout.is_first_in_row(index) || panel.unit.is_some(),
        };
        let has_data = along.is_some() && up.is_some() && has_data(panel);
        axes.draw(canvas, labels, has_data, |axes, canvas| {
            draw_panel(panel, canvas, axes);
        });
    }
}

/// A scale of a quantity with its unit; without values from 1 to 10.
fn axis(
    span: Option<Span>,
    (quantity, unit): (&str, &str),
    logarithmic: bool,
    ticks: usize,
) -> Axis {
    let span = span.unwrap_or(Span { lo: 1.0, hi: 10.0 }).open();
    match logarithmic && span.lo > 0.0 {
        true => Axis::logarithmic(span, quantity, unit, ticks),
        false => Axis::linear(span, quantity, unit, ticks),
    }
}

/// Where bars begin, px: at zero, or at the bottom of the frame where zero has no place in it.
fn foot(axes: &Axes) -> f64 {
    let (_, zero) = axes.point(f64::NAN, 0.0);
    match zero.is_finite() {
        true => zero.clamp(axes.frame.top, axes.frame.bottom),
        false => axes.frame.bottom,
    }
}

/// Measured values are under those of models, which often hide them.
fn width_px(line: &Line) -> f64 {
    match line.tint {
        Tint::Measured => BROAD,
        _ => DATA,
    }
}

fn sample_of(line: &Line) -> Sample {
    let colour = colour(line.tint);
    match line.kind {
        LineKind::Solid => Sample::Line(LineStyle::solid(colour, width_px(line).max(LEGEND_LINE))),
        LineKind::Dashed => Sample::Line(LineStyle::dashed(colour, THIN)),
        LineKind::Points => Sample::Dot(colour),
        LineKind::Bars => Sample::Area(colour, 1.0),
    }
}

/// The span of all that is drawn; `None` without a value that has a place.
fn ordinates(panel: &Panel, logarithmic: bool) -> Option<Span> {
    let from = panel.scale_from.unwrap_or(f64::NEG_INFINITY);
    let settled = panel.abscissa.partition_point(|value| *value < from);
    let columns = panel.columns();
    let values = columns.flat_map(|column| column.iter().skip(settled).copied());
    let levels = panel.levels.iter().map(|level| level.value);
    let feet = panel.lines.iter().any(|line| line.kind == LineKind::Bars);
    let feet = feet.then_some(0.0).into_iter();
    let all = values.chain(levels).chain(feet);
    Span::of(all.filter(|value| !logarithmic || *value > 0.0))
}

/// Whether any line has a value; a band alone is data where there are no lines.
fn has_data(panel: &Panel) -> bool {
    let mut values = panel.lines.iter().flat_map(|line| &line.values);
    panel.lines.is_empty() || values.any(|value| value.is_finite())
}

fn draw_panel(panel: &Panel, canvas: &mut Canvas, axes: &Axes) {
    let longest = longest_interval(&panel.abscissa, panel.no_gaps);
    for band in &panel.bands {
        let edges = (&*band.lower, &*band.upper);
        let colour = colour(band.tint);
        axes.band(canvas, &panel.abscissa, edges, colour, longest);
    }
    for line in &panel.lines {
        draw_line(panel, canvas, axes, (line, longest));
    }
    for level in &panel.levels {
        axes.horizontal_line(canvas, level.value, LineStyle::dashed(LEVEL, THIN));
    }
    for (row, mark) in panel.marks.iter().enumerate() {
        axes.vertical_line(canvas, mark.value, LineStyle::dashed(MARK, THIN));
        let (x, _) = axes.point(mark.value, 0.0);
        if (axes.frame.left..=axes.frame.right).contains(&x) {
            // Each label in a row of its own: marks may be close.
            let y = axes.frame.top + SMALL + 1.3 * SMALL * row as f64;
            let room = axes.frame.right - text::width_px(&mark.label, SMALL, false);
            let style = TextStyle::new(SMALL, Align::Start).colour(MARK);
            canvas.text(&mark.label, ((x + 3.0).min(room), y), style);
        }
    }
}

fn draw_line(panel: &Panel, canvas: &mut Canvas, axes: &Axes, (line, longest): (&Line, f64)) {
    let colour = colour(line.tint);
    let style = match line.kind {
        LineKind::Dashed => LineStyle::dashed(colour, THIN),
        _ => LineStyle::solid(colour, width_px(line)),
    };
    let points = panel.abscissa.iter().zip(&line.values);
    let points = points.map(|(x, y)| (axes.point(*x, *y), *x));
    let inside = |(x, y): (f64, f64)| {
        (axes.frame.left..=axes.frame.right).contains(&x)
            && (axes.frame.top..=axes.frame.bottom).contains(&y)
    };
    match line.kind {
        LineKind::Points => {
            for (point, _) in points.filter(|(point, _)| inside(*point)) {
                canvas.disc(point, 2.0, colour);
            }
        }
        LineKind::Bars => {
            let apart = axes.frame.width() / panel.abscissa.len().max(1) as f64;
            let style = LineStyle::solid(colour, BAR_PX.min(0.7 * apart));
            for ((x, y), _) in points.filter(|(point, _)| inside(*point)) {
                canvas.line(&[(x, foot(axes)), (x, y)], style);
            }
        }
        _ => axes.line(canvas, &panel.abscissa, &line.values, style, longest),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyrocal_document::{Band, Level, Mark};

    fn chart(logarithmic: bool) -> Chart {
        let line = |label: &str, kind, values: [f64; 3]| {
            Line::new(label, Tint::Nominal, kind, values.to_vec())
        };
        Chart {
            title: "A statement".to_owned(),
            abscissa: "averaging time".to_owned(),
            abscissa_unit: "s".to_owned(),
            logarithmic_abscissa: logarithmic,
            quantity: "deviation".to_owned(),
            unit: "deg/h".to_owned(),
            logarithmic,
            columns: 1,
            height_px: 200,
            panels: vec![Panel {
                name: "gyro x".to_owned(),
                abscissa: vec![1.0, 10.0, 100.0],
                bands: vec![Band::new(
                    "interval",
                    Tint::Measured,
                    [vec![0.9, f64::NAN, 0.09], vec![1.1, 0.4, 0.11]],
                )],
                lines: vec![
                    line("through", LineKind::Solid, [1.0, 0.3, 0.1]),
                    line("points", LineKind::Points, [1.0, 0.3, f64::NAN]),
                    line("bars", LineKind::Bars, [1.0, 0.3, 0.1]),
                ],
                levels: vec![Level {
                    label: "bound".to_owned(),
                    value: 0.5,
                }],
                marks: vec![Mark {
                    label: "onset".to_owned(),
                    value: 10.0,
                }],
                no_gaps: true,
                ..Panel::default()
            }],
            ..Chart::default()
        }
    }

    #[test]
    fn all_that_a_chart_holds_is_in_its_picture() {
        for logarithmic in [false, true] {
            let svg = chart(logarithmic).to_svg().unwrap();
            for words in [
                "A statement",
                "averaging time [s]",
                "deviation [deg/h]",
                "gyro x",
                "interval",
                "through",
                "points",
                "bars",
                "bound",
                "onset",
            ] {
                assert!(svg.contains(words), "{words}");
            }
            assert!(!svg.contains("NaN"), "{svg}");
        }
    }

    #[test]
    fn a_panel_without_values_says_so() {
        let mut chart = chart(false);
        let panel = &mut chart.panels[0];
        panel.lines.truncate(1);
        panel.lines[0].values.fill(f64::NAN);
        panel.bands.clear();
        panel.levels.clear();
        assert!(chart.to_svg().unwrap().contains("no data"));
        chart.panels.clear();
        assert!(chart.to_svg().is_err());
    }
}
