//! The uncertainty budget of a record: its computation and its words.

use std::fmt::Write as _;
use std::path::Path;

use comfy_table::Cell;
use gyrocal_calibration::{Options, Run, UncertaintyBudget, calibrate, uncertainty_budget};
use gyrocal_diagnosis::Gate;
use gyrocal_diagnosis::prose::{Screen, Standing};
use gyrocal_record::Bench;
use gyrocal_setup::PlatformKind;
use gyrocal_statistics::format;
use miette::miette;

use crate::Failure;
use crate::diagnose::NotDiagnosed;
use crate::records::Map;
use crate::tables::{right, table};

/// The budget of a record.
pub(super) fn of_record(
    path: &Path,
    bench: &Path,
    map: &Map,
) -> Result<UncertaintyBudget, Failure> {
    let bench = Bench::read(bench)?;
    let file = map.read(path)?;
    let options = Options::default();
    let gate = Gate::of_file(PlatformKind::Stabilised, &file, &bench, &options)?;
    if gate.stops() {
        return Err(Failure::Work(miette!(
            help = "gyrocal diagnose says what is wrong with it",
            "{}: the set-up is wrong, so that there is no uncertainty",
            path.display()
        )));
    }
    let record = gate.usable.as_deref().unwrap_or(file.record());
    let failed = |source: gyrocal_calibration::CalibrationError| {
        Failure::from(NotDiagnosed::new(path, &bench, source.into()))
    };
    let calibration = calibrate(record, &bench, &options, |_| ()).map_err(failed)?;
    let runs = [Run {
        record,
        bench: &bench,
    }];
    uncertainty_budget(&runs, &calibration, &options, None).map_err(failed)
}

/// The first screen of some budgets.
pub(super) fn screen(budgets: &[UncertaintyBudget]) -> Screen {
    let mut screen = Screen::new(
        Standing::Neutral,
        "UNCERTAINTY",
        "95 % intervals of the coefficients",
    );
    for budget in budgets {
        for one in &budget.coefficients {
            let largest = one
                .contributions
                .iter()
                .max_by(|a, b| a.standard.total_cmp(&b.standard));
            let source = largest.map_or("", |line| line.source.name());
            screen.fact(
                one.id,
                format!(
                    "{} ± {} {} (k = {}), most by {source}",
                    format::short(one.estimate, 6),
                    format::short(one.expanded(), 2),
                    one.unit,
                    format::short(one.coverage_factor, 3),
                ),
            );
        }
    }
    screen
}

/// All contributions.
pub(super) fn text(budgets: &[UncertaintyBudget]) -> String {
    let mut text = String::new();
    for budget in budgets {
        let _ = writeln!(
            text,
            "Uncertainty budget (GUM): {} record, {} accelerometer values, mean normalised innovation \
             squared of a value {:.3}.",
            budget.records, budget.values, budget.nis_of_value
        );
        let mut rows = table(["coefficient", "source", "type", "standard", "unit"]);
        for one in &budget.coefficients {
            for line in &one.contributions {
                let kind = if line.source.is_type_a() { "A" } else { "B" };
                let standard = format::short(line.standard, 2);
                rows.add_row([
                    Cell::new(one.meaning),
                    Cell::new(line.source.name()),
                    Cell::new(kind),
                    right(standard),
                    Cell::new(one.unit),
                ]);
            }
        }
        let _ = writeln!(text, "{rows}\n");
    }
    text
}
