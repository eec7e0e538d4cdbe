//! Panels with lines, as data.

use serde::Serialize;

/// Panels with one abscissa, which zoom together.
///
/// Not-a-number is a missing value and leaves a gap, as does an interval of more than four times the
/// median one. A panel of more than 6000 rows is decimated to the extremes of each of 1500 stretches;
/// gaps shorter than an eighth of a stretch are then not shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// Main statement.
    pub title: String,
    /// What is shown, and how to read it.
    pub caption: String,
    /// Quantity of the abscissa.
    pub abscissa: String,
    /// Its unit.
    pub abscissa_unit: String,
    /// Whether the abscissa is logarithmic.
    pub logarithmic_abscissa: bool,
    /// Quantity of the ordinate; empty if each panel is of its own.
    pub quantity: String,
    /// Unit of all values; of the panel where a panel has one.
    pub unit: String,
    /// Whether the ordinate is logarithmic.
    pub logarithmic: bool,
    /// Whether all panels have one scale.
    pub same_scale: bool,
    /// Whether a few extremes of lines about zero that would flatten all else leave the scale; the note of a
    /// panel then tells how many.
    pub cut_extremes: bool,
    /// Whether the panels have abscissas of different meaning and do not zoom together.
    pub unlinked: bool,
    /// Panels in a row.
    pub columns: usize,
    /// Height of a panel, px.
    pub height_px: u32,
    /// The panels.
    pub panels: Vec<Panel>,
}

/// One set of axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Panel {
    /// Its name: `x`.
    pub name: String,
    /// Statistics beside the name; may be empty.
    pub note: String,
    /// Unit of its values, if it is not that of the chart.
    pub unit: Option<String>,
    /// Quantity and unit of its abscissas, if they are not those of the chart.
    pub own_abscissa: Option<(String, String)>,
    /// The abscissas; they never decrease.
    pub abscissa: Vec<f64>,
    /// Bands between two lines, drawn first.
    pub bands: Vec<Band>,
    /// Lines, drawn in their order.
    pub lines: Vec<Line>,
    /// Horizontal lines.
    pub levels: Vec<Level>,
    /// Vertical lines.
    pub marks: Vec<Mark>,
    /// Whether the abscissas are evenly spaced points of which none is missing, such as lags: a wide
    /// interval is then no gap.
    pub no_gaps: bool,
    /// Abscissa from which on the values set the scale; earlier ones may leave the panel.
    pub scale_from: Option<f64>,
}

/// A line.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Name in the legend.
    pub label: String,
    /// Its colour.
    pub tint: Tint,
    /// Its form.
    pub kind: LineKind,
    /// Its values.
    pub values: Series,
}

/// Values, one for each abscissa.
pub type Series = Vec<f64>;

/// Form of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LineKind {
    /// Drawn through.
    Solid,
    /// Dashed.
    Dashed,
    /// Points without a line.
    Points,
    /// Bars from zero.
    Bars,
}

/// The band between two lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// Name in the legend.
    pub label: String,
    /// Its colour.
    pub tint: Tint,
    /// Its lower edge.
    pub lower: Series,
    /// Its upper edge.
    pub upper: Series,
}

/// A horizontal line.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Name in the legend.
    pub label: String,
    /// The ordinate.
    pub value: f64,
}

/// A vertical line.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Its name, written beside it.
    pub label: String,
    /// The abscissa.
    pub value: f64,
}

/// Colour of a series by its meaning, the same in every chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tint {
    /// What was measured.
    Measured,
    /// The nominal model.
    Nominal,
    /// The extended model.
    Extended,
    /// What is expected: bounds, noise.
    Expected,
    /// Alternatives of a reported effect.
    Alternative,
    /// All else.
    Other,
}

impl Line {
    /// A line with a name.
    #[must_use]
    pub fn new(label: &str, tint: Tint, kind: LineKind, values: Series) -> Self {
        Self {
            label: label.to_owned(),
            tint,
            kind,
            values,
        }
    }
}

impl Band {
    /// A band with a name between two edges.
    #[must_use]
    pub fn new(label: &str, tint: Tint, [lower, upper]: [Series; 2]) -> Self {
        Self {
            label: label.to_owned(),
            tint,
            lower,
            upper,
        }
    }
}

impl Level {
    /// A line at zero, without a name.
    #[must_use]
    pub fn zero() -> Self {
        let label = String::new();
        Self { label, value: 0.0 }
    }
}

impl Chart {
    /// Unit of the values of a panel.
    #[must_use]
    pub fn unit_of<'a>(&'a self, panel: &'a Panel) -> &'a str {
        panel.unit.as_deref().unwrap_or(&self.unit)
    }

    /// Quantity and unit of the abscissas of a panel.
    #[must_use]
    pub fn abscissa_of<'a>(&'a self, panel: &'a Panel) -> (&'a str, &'a str) {
        let own = panel.own_abscissa.as_ref();
        let (quantity, unit) = own.map_or((&self.abscissa, &self.abscissa_unit), |(q, u)| (q, u));
        (quantity, unit)
    }
}

impl Panel {
    /// All columns over the abscissa.
    pub fn columns(&self) -> impl Iterator<Item = &[f64]> {
        let bands = self
            .bands
            .iter()
            .flat_map(|band| [&*band.lower, &*band.upper]);
        bands.chain(self.lines.iter().map(|line| &*line.values))
    }

    /// The largest magnitude, nan aside.
    #[must_use]
    pub fn largest(&self) -> f64 {
        let lines = self.lines.iter().flat_map(|line| &line.values);
        let largest = lines.map(|value| value.abs()).fold(0.0, f64::max);
        largest.max(self.largest_expected())
    }

    /// The largest magnitude of bands and levels, nan aside.
    #[must_use]
    pub fn largest_expected(&self) -> f64 {
        let bands = self.bands.iter();
        let edges = bands.flat_map(|band| band.lower.iter().chain(&band.upper));
        let levels = self.levels.iter().map(|level| &level.value);
        let all = edges.chain(levels);
        all.map(|value| value.abs()).fold(0.0, f64::max)
    }
}
