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
    pub(crate) fn within(name: &str, [low, high]: [f64; 2], measured: f64) -> Self {
        let target = match (low.is_finite(), high.is_finite()) {
            (false, _) => format!("<= {high}"),
            (_, false) => format!(">= {low}"),
            _ => format!("{low} to {high}"),
        };
        let holds = low <= measured && measured <= high;
        Self::told(name, &target, format!("{measured:.3}"), holds)
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
        let is_whole = measured.fract() == 0.0 || measured.abs() >= 1e3;
        let decimals = if is_whole { 0 } else { 2 };
        let told = format!("{measured:.decimals$} {unit}");
        let target = format!("<= {limit} {unit}");
        let told = told.trim_end().to_owned();
        Self::told(name, target.trim_end(), told, measured <= limit)
    }

    /// A statement that must be true.
    pub(crate) fn truth(name: &str, measured: bool) -> Self {
        let word = if measured { "yes" } else { "no" };
        Self::told(name, "yes", word.to_owned(), measured)
    }

    /// A statement that must be true, with target and measurement in words.
    pub(crate) fn told(name: &str, target: &str, measured: String, holds: bool) -> Self {
        Self {
            target: target.to_owned(),
            holds: Some(holds),
            ..Self::note(name, measured)
        }
    }

    /// An upper limit that is told by its order of magnitude, as the measurement is.
    pub(crate) fn at_most_small(name: &str, limit: f64, measured: f64) -> Self {
        let target = format!("<= {limit:e}");
        Self::told(name, &target, format!("{measured:.1e}"), measured <= limit)
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
        self.judged(!small)
    }

    /// The same, judged or only shown.
    pub(crate) fn judged(self, is_judged: bool) -> Self {
        let holds = self.holds.filter(|_| is_judged);
        Self { holds, ..self }
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
    let header = "figure target measured runs seeds commit holds".split(' ');
    let reasons = with_reasons.then_some("reason of the target");
    table
        .load_style(presets::ASCII_MARKDOWN)
        .set_content_arrangement(ContentArrangement::Disabled)
        .set_header(header.chain(reasons));
    for figure in figures {
        let holds = match figure.holds {
            Some(true) => "yes",
            Some(false) => "NO",
            None if figure.too_few => "too few records to tell",
            None => "",
        };
        let runs = figure.runs.to_string();
        let row = [&figure.name, &figure.target, &figure.measured, &runs];
        let row = row.into_iter().chain([&figure.seeds, &commit]);
        let row = row.map(String::as_str).chain([holds]);
        table.add_row(row.chain(with_reasons.then_some(figure.reason.as_str())));
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
