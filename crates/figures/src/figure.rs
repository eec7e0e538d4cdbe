//! Figures of the documentation with their targets, and their table.

use comfy_table::{ContentArrangement, Table, presets};
use gyrocal_evaluation::{Statistic, Target};
use gyrocal_statistics::{Judgement, Proportion, standard_error};
use gyrocal_testkit::workspace;

use crate::page::commit;

/// One figure: target and measurement.
#[derive(Clone, Debug, Default)]
pub(crate) struct Figure {
    /// Name of the figure.
    pub(crate) name: String,
    /// Target, in words.
    pub(crate) target: String,
    /// Why the target is what it is; empty where the name says it.
    pub(crate) reason: String,
    /// Measured value, in words.
    pub(crate) measured: String,
    /// Number of runs that it is measured over.
    pub(crate) runs: usize,
    /// Seeds, or another identification of the runs.
    pub(crate) seeds: String,
    /// `true` if the target is met; `None` without a target or with too few runs to tell.
    pub(crate) holds: Option<bool>,
    /// `true` if the runs are too few to tell whether the target is met.
    pub(crate) too_few: bool,
    /// The share that is the first number of `measured`, in percent where the name says `% of`; `None` for
    /// other figures.
    pub(crate) share: Option<Proportion>,
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
            holds: Some(bounds[0] <= measured && measured <= bounds[1]),
            ..Self::default()
        }
    }

    /// A statistic of a population, which is as large as its target asks for (`full`), or smaller.
    pub(crate) fn of_statistic(
        name: &str,
        of: &Statistic,
        target: Option<Target>,
        full: bool,
    ) -> Self {
        let (value, runs) = (of.value(), of.runs());
        let judgement = target.map(|target| of.judged(target, full));
        Self {
            name: name.to_owned(),
            target: target.map_or_else(String::new, |target| target.to_string()),
            measured: match (of, of.interval()) {
                _ if runs == 0 => "nothing to measure on".to_owned(),
                (Statistic::Bound(share), _) => format!("{:.4}, bound {value:.4}", share.share()),
                (_, Some([low, high])) => format!("{value:.3} ({low:.3} to {high:.3})"),
                (Statistic::Mean(values), None) if values.len() > 1 => {
                    format!("{value:.3} (standard error {:.3})", standard_error(values))
                }
                _ => format!("{value:.3}"),
            },
            runs: runs as usize,
            holds: judgement.and_then(Judgement::holds),
            too_few: judgement == Some(Judgement::TooFew),
            share: of.proportion(),
            ..Self::default()
        }
    }

    /// A cost with an upper limit. NaN stands for a failed measurement, which does not hold.
    pub(crate) fn at_most(name: &str, limit: f64, measured: f64, unit: &str) -> Self {
        let decimals = if measured.fract() == 0.0 || measured.abs() >= 1e3 {
            0
        } else {
            2
        };
        let [target, measured_text] = [
            format!("<= {limit} {unit}"),
            format!("{measured:.decimals$} {unit}"),
        ];
        Self {
            target: target.trim_end().to_owned(),
            measured: measured_text.trim_end().to_owned(),
            ..Self::within(name, [f64::NEG_INFINITY, limit], measured)
        }
    }

    /// A statement that must be true.
    pub(crate) fn truth(name: &str, measured: bool) -> Self {
        Self {
            name: name.to_owned(),
            target: "yes".to_owned(),
            measured: if measured { "yes" } else { "no" }.to_owned(),
            runs: 1,
            holds: Some(measured),
            ..Self::default()
        }
    }

    /// A figure without a target.
    pub(crate) fn note(name: &str, measured: String) -> Self {
        Self {
            name: name.to_owned(),
            measured,
            runs: 1,
            ..Self::default()
        }
    }

    /// A time, or a ratio of times: on a machine that does other work as well, as that of a small version may, it says
    /// little, and is shown and not judged.
    pub(crate) fn timed(self, small: bool) -> Self {
        Self {
            holds: self.holds.filter(|_| !small),
            ..self
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

/// The figures as a table, with the commit that they are measured at, and the reasons of targets where there are any.
pub(crate) fn table_of(figures: &[Figure]) -> String {
    let commit = commit(&workspace());
    let with_reasons = figures.iter().any(|figure| !figure.reason.is_empty());
    let mut table = Table::new();
    let mut header = vec![
        "figure", "target", "measured", "runs", "seeds", "commit", "holds",
    ];
    header.extend(with_reasons.then_some("reason of the target"));
    table
        .load_style(presets::ASCII_MARKDOWN)
        .set_content_arrangement(ContentArrangement::Disabled)
        .set_header(header);
    for figure in figures {
        let holds = match figure.holds {
            Some(true) => "yes",
            Some(false) => "NO",
            None if figure.too_few => "too few records to tell",
            None => "",
        };
        let runs = figure.runs.to_string();
        let Figure {
            name,
            target,
            measured,
            seeds,
            reason,
            ..
        } = figure;
        let mut row = vec![
            name.as_str(),
            target,
            measured,
            &runs,
            seeds,
            &commit,
            holds,
        ];
        row.extend(with_reasons.then_some(reason.as_str()));
        table.add_row(row);
    }
    table.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_few_runs_are_said_to_be_too_few() {
        let of = |hits, trials| {
            let share = Statistic::Share(Proportion { hits, trials });
            let target = Some(Target::AtLeast(0.99));
            table_of(&[Figure::of_statistic("detected", &share, target, false)])
        };
        assert!(of(45, 45).contains("| too few records to tell |"));
        assert!(of(20, 45).contains("| NO "));
        assert!(of(1000, 1000).contains("| yes "));
    }
}
