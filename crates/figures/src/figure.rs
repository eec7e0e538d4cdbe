//! Figures of the documentation with their targets, and their table.

use comfy_table::{ContentArrangement, Table, presets};

/// One figure: target and measurement.
#[derive(Clone, Debug)]
pub(crate) struct Figure {
    /// Name of the figure.
    pub(crate) name: String,
    /// Target, in words.
    pub(crate) target: String,
    /// Measured value, in words.
    pub(crate) measured: String,
    /// Number of runs that it is measured over.
    pub(crate) runs: usize,
    /// Seeds, or another identification of the runs.
    pub(crate) seeds: String,
    /// `true` if the target is met; `None` without a target.
    pub(crate) holds: Option<bool>,
}

impl Figure {
    /// A figure that must lie in a closed interval.
    pub(crate) fn within(name: &str, bounds: [f64; 2], measured: f64) -> Self {
        Self {
            name: name.to_owned(),
            target: match bounds {
                [low, high] if low == f64::NEG_INFINITY => format!("<= {high}"),
                [low, high] if high == f64::INFINITY => format!(">= {low}"),
                [low, high] => format!("{low} to {high}"),
            },
            measured: format!("{measured:.3}"),
            runs: 1,
            seeds: String::new(),
            holds: Some(bounds[0] <= measured && measured <= bounds[1]),
        }
    }

    /// A cost with an upper limit. NaN stands for a failed measurement, which does not hold.
    pub(crate) fn at_most(name: &str, limit: f64, measured: f64, unit: &str) -> Self {
        Self {
            target: format!("<= {limit} {unit}"),
            measured: format!("{measured:.2} {unit}"),
            ..Self::within(name, [0.0, limit], measured)
        }
    }

    /// A statement that must be true.
    pub(crate) fn truth(name: &str, measured: bool) -> Self {
        Self {
            name: name.to_owned(),
            target: "yes".to_owned(),
            measured: if measured { "yes" } else { "no" }.to_owned(),
            runs: 1,
            seeds: String::new(),
            holds: Some(measured),
        }
    }

    /// A figure without a target.
    pub(crate) fn note(name: &str, measured: String) -> Self {
        Self {
            name: name.to_owned(),
            target: String::new(),
            measured,
            runs: 1,
            seeds: String::new(),
            holds: None,
        }
    }

    pub(crate) fn over(self, runs: usize, seeds: impl Into<String>) -> Self {
        Self {
            runs,
            seeds: seeds.into(),
            ..self
        }
    }
}

/// The figures as a table.
pub(crate) fn table(figures: &[Figure]) -> Table {
    let mut table = Table::new();
    table
        .load_style(presets::ASCII_MARKDOWN)
        .set_content_arrangement(ContentArrangement::Disabled)
        .set_header(["figure", "target", "measured", "runs", "seeds", "holds"]);
    for figure in figures {
        table.add_row([
            figure.name.clone(),
            figure.target.clone(),
            figure.measured.clone(),
            figure.runs.to_string(),
            figure.seeds.clone(),
            match figure.holds {
                Some(true) => "yes".to_owned(),
                Some(false) => "NO".to_owned(),
                None => String::new(),
            },
        ]);
    }
    table
}
