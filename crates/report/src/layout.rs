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
    /// Room left of each panel, px.
    pub left_px: f64,
}

impl Layout {
    pub(crate) fn new(columns: usize, panels: usize, panel_px: f64) -> Self {
        Self {
            columns: columns.max(1),
            panels,
            panel_px,
            left_px: LEFT,
        }
    }

    /// Height of all panels, px.
    pub(crate) fn height(self) -> f64 {
        let rows = self.panels.div_ceil(self.columns) as f64;
        rows * self.pitch()
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

    /// Whether a panel is the first of its row.
    pub(crate) fn is_first_in_row(self, index: usize) -> bool {
        index.is_multiple_of(self.columns)
    }

    fn pitch(self) -> f64 {
        ABOVE + self.panel_px + BELOW + 4.0
    }
}
