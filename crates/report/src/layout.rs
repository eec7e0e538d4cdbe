//! Panels in columns and rows.

use crate::geometry::Rect;
use crate::style::{ABOVE, BELOW, LEFT};

/// The arrangement of the panels of a figure.
#[derive(Clone, Copy)]
pub(crate) struct Layout {
    pub columns: usize,
    pub panels: usize,
    /// Height of one panel, px.
    pub panel_px: f64,
    /// Each panel has an abscissa of its own; otherwise only the lowest ones are labelled.
    pub own_abscissa: bool,
    /// Room left of each panel, px.
    pub left_px: f64,
}

impl Layout {
    pub(crate) fn new(columns: usize, panels: usize, panel_px: f64) -> Self {
        Self {
            columns: columns.max(1),
            panels,
            panel_px,
            own_abscissa: false,
            left_px: LEFT,
        }
    }

    /// Each panel has an abscissa of its own.
    pub(crate) fn with_own_abscissae(self) -> Self {
        Self {
            own_abscissa: true,
            ..self
        }
    }

    /// With other room left of each panel, px.
    pub(crate) fn with_left(self, left_px: f64) -> Self {
        Self { left_px, ..self }
    }

    /// Height of all panels, px.
    pub(crate) fn height(self) -> f64 {
        let rows = self.panels.div_ceil(self.columns) as f64;
        rows * self.pitch() + if self.own_abscissa { 0.0 } else { BELOW }
    }

    /// The frame of a panel in the body of the figure.
    pub(crate) fn frame(self, body: Rect, index: usize) -> Rect {
        let (column, row) = (index % self.columns, index / self.columns);
        let wide = body.width() / self.columns as f64;
        let left = body.left + column as f64 * wide + self.left_px;
        let top = body.top + row as f64 * self.pitch() + ABOVE;
        Rect {
            left,
            top,
            // Room for half of the last label of the abscissa.
            right: body.left + (column + 1) as f64 * wide - 10.0,
            bottom: top + self.panel_px,
        }
    }

    /// Whether the abscissa of a panel is labelled.
    pub(crate) fn shows_abscissa(self, index: usize) -> bool {
        self.own_abscissa || index + self.columns >= self.panels
    }

    /// Whether a panel is the first of its row.
    pub(crate) fn is_first_in_row(self, index: usize) -> bool {
        index.is_multiple_of(self.columns)
    }

    fn pitch(self) -> f64 {
        ABOVE + self.panel_px + if self.own_abscissa { BELOW + 4.0 } else { 6.0 }
    }
}
