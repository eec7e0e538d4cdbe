//! What can be drawn of a chart, and on which scale.

use gyrocal_document::{Chart, Panel};

use crate::check;
use crate::error::Error;
use crate::number::{count, readable_unit, short};
use crate::scale;

/// Checks that columns have equal lengths and can be drawn.
pub(crate) fn check(chart: &Chart) -> Result<(), Error> {
    check::non_empty("the list of panels", &chart.panels)?;
    for panel in &chart.panels {
        let of = |what: &str, label: &str| format!("{what} {label} of panel {}", panel.name);
        check::non_decreasing(&of("abscissas", ""), &panel.abscissa)?;
        let rows = ("the abscissas", panel.abscissa.len());
        for line in &panel.lines {
            check::column(|| of("line", &line.label), &line.values, rows)?;
        }
        for band in &panel.bands {
            check::column(|| of("lower edge", &band.label), &band.lower, rows)?;
            check::column(|| of("upper edge", &band.label), &band.upper, rows)?;
        }
        for level in &panel.levels {
            check::finite(&of("level", &level.label), &[level.value])?;
        }
        for mark in &panel.marks {
            check::finite(&of("mark", &mark.label), &[mark.value])?;
        }
    }
    Ok(())
}

/// Half of the scale of each panel that leaves extremes out; `None` of one where all have a place.
pub(crate) fn halves(chart: &Chart) -> Vec<Option<f64>> {
    let of = |panels: &[Panel]| {
        let lines = panels.iter().flat_map(|panel| &panel.lines);
        let expected = panels.iter().map(Panel::largest_expected);
        let least = 1.25 * expected.fold(0.0, f64::max);
        scale::without_extremes(lines.map(|line| &*line.values), least)
    };
    match (chart.cut_extremes, chart.same_scale) {
        (false, _) => vec![None; chart.panels.len()],
        (true, true) => vec![of(&chart.panels); chart.panels.len()],
        (true, false) => {
            let panels = chart.panels.iter().map(core::slice::from_ref);
            panels.map(of).collect()
        }
    }
}

/// The note of a panel, with what has no place on its scale.
pub(crate) fn note(chart: &Chart, panel: &Panel, half: Option<f64>) -> String {
    let half = half.unwrap_or(f64::INFINITY);
    let values = panel.lines.iter().flat_map(|line| &line.values);
    let beyond = values.map(|value| value.abs()).filter(|size| *size > half);
    let (number, largest) = beyond.fold((0, 0.0_f64), |(number, largest), size| {
        (number + 1, largest.max(size))
    });
    if number == 0 {
        return panel.note.clone();
    }
    let (factor, unit) = readable_unit(chart.unit_of(panel), largest);
    let words = format!(
        "{} beyond the scale, to {} {unit}",
        count(number),
        short(factor * largest, 2)
    );
    match &*panel.note {
        "" => words,
        note => format!("{note}; {words}"),
    }
}
