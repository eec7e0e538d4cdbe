//! Estimates of a page as a picture: a panel for each quantity, with a dot and an interval for each model.

use crate::axes::{Axes, Labels};
use crate::axis::Axis;
use crate::canvas::{Align, Canvas, LineStyle, TextStyle};
use crate::check;
use crate::error::Error;
use crate::figure::{Legend, Sample, figure};
use crate::geometry::Rect;
use crate::layout::Layout;
use crate::picture::Picture;
use crate::span::Span;
use crate::style::{BLACK, DATA, SMALL, colour};
use crate::text;
use gyrocal_document::{EstimateRow, Estimates, ValueWithSigma};

/// Quantities side by side.
const IN_A_ROW: usize = 3;

/// Height of the row of a model, px.
const ROW_PX: f64 = 17.0;

/// Most of the width that names of models may take, px.
const NAMES_PX: f64 = 170.0;

impl Picture for Estimates {
    fn to_svg_of(&self, source: &str) -> Result<String, Error> {
        checked(self)?;
        let names = self.models.iter();
        let widths = names.map(|(name, _)| text::width_px(name, SMALL, false));
        let names_px = widths.fold(20.0, f64::max).min(NAMES_PX);
        let panel_px = ROW_PX * self.models.len() as f64 + 10.0;
        let layout = Layout {
            left_px: 34.0,
            ..Layout::new(IN_A_ROW, self.rows.len(), panel_px)
        };
        let remarks = match &*self.note_head {
            "" => String::new(),
            head => format!("At the right above each panel: {head}."),
        };
        Ok(figure(
            &self.title,
            &[&remarks, source],
            &legend(self),
            layout.height(),
            |canvas, mut body| {
                body.left += names_px;
                draw(self, canvas, layout, body, names_px);
            },
        ))
    }
}

fn checked(estimates: &Estimates) -> Result<(), Error> {
    check::non_empty("the list of models", &estimates.models)?;
    check::non_empty("the list of quantities", &estimates.rows)?;
    for row in &estimates.rows {
        let of = |part: fn(&ValueWithSigma) -> f64| -> Vec<f64> {
            row.values.iter().map(part).collect()
        };
        let what = || format!("the list of estimates of {}", row.name);
        let models = ("the models", estimates.models.len());
        check::column(what, &of(|one| one.value), models)?;
        check::not_infinite(what, &of(|one| one.sigma))?;
    }
    Ok(())
}

fn legend(estimates: &Estimates) -> Vec<Legend> {
    let models = estimates.models.iter();
    let dots = models.map(|(name, tint)| Legend::new(Sample::Dot(colour(*tint)), name));
    let bar = Sample::Line(LineStyle::solid(BLACK, DATA));
    dots.chain([Legend::new(bar, "±2σ (95%)")]).collect()
}

fn draw(estimates: &Estimates, canvas: &mut Canvas, layout: Layout, body: Rect, names_px: f64) {
    let heights = Span::new(-0.8, estimates.models.len() as f64 - 0.2);
    for (index, row) in estimates.rows.iter().enumerate() {
        let frame = layout.frame(body, index);
        let span = Span::of(row.values.iter().flat_map(ends));
        let has_data = span.is_some();
        let span = span.unwrap_or(Span { lo: 0.0, hi: 1.0 }).padded(0.08);
        let ticks = (frame.width() / 50.0) as usize;
        let axes = Axes {
            frame,
            x: Axis::linear(span, "", &row.unit, ticks),
            y: Axis::bare(heights),
        };
        if layout.is_first_in_row(index) {
            draw_names(estimates, canvas, &axes, names_px);
        }
        let labels = Labels {
            name: &row.name,
            note: &row.note,
            ordinate_title: false,
        };
        axes.draw(canvas, labels, has_data, |axes, canvas| {
            draw_row(estimates, canvas, axes, row);
        });
    }
}

/// The names of the models left of a panel.
fn draw_names(estimates: &Estimates, canvas: &mut Canvas, axes: &Axes, names_px: f64) {
    for (place, (name, _)) in estimates.models.iter().enumerate() {
        let (_, y) = axes.point(0.0, height_of(estimates, place));
        let name = text::fit(name, SMALL, false, names_px);
        let style = TextStyle::new(SMALL, Align::End);
        canvas.text(&name, (axes.frame.left - 8.0, y), style);
    }
}

fn draw_row(estimates: &Estimates, canvas: &mut Canvas, axes: &Axes, row: &EstimateRow) {
    for (place, (one, (_, tint))) in row.values.iter().zip(&estimates.models).enumerate() {
        let y = height_of(estimates, place);
        let [lower, upper] = ends(one);
        if lower < upper {
            let bar = [axes.point(lower, y), axes.point(upper, y)];
            canvas.line(&bar, LineStyle::solid(colour(*tint), DATA));
        }
        if !one.value.is_nan() {
            canvas.disc(axes.point(one.value, y), 3.0, colour(*tint));
        }
    }
}

/// Ordinate of a model, the first on top.
fn height_of(estimates: &Estimates, place: usize) -> f64 {
    estimates.models.len() as f64 - 1.0 - place as f64
}

/// Both ends of an interval of two standard deviations each way; without a sigma the value itself.
pub(crate) fn ends(one: &ValueWithSigma) -> [f64; 2] {
    let half = match one.sigma.is_nan() {
        true => 0.0,
        false => 2.0 * one.sigma,
    };
    [one.value - half, one.value + half]
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyrocal_document::Tint;

    #[test]
    fn estimates_are_compared() {
        let row = EstimateRow {
            note: "+3.1".to_owned(),
            ..EstimateRow::new("gyro_x.bias", "deg/h", [[0.5, 0.1]])
        };
        let models = [("nominal model", Tint::Nominal)];
        let mut estimates = Estimates {
            note_head: "change".to_owned(),
            ..Estimates::new("Coefficients", &models, [row])
        };
        let svg = estimates.to_svg().unwrap();
        for words in ["gyro_x.bias", "nominal model", "+3.1", "panel: change."] {
            assert!(svg.contains(words), "{words}");
        }
        estimates.rows[0].values.clear();
        assert!(estimates.to_svg().is_err());
    }
}
