//! What residuals of the nominal model show: for programs and as a table.

use comfy_table::Cell;
use gyrocal_diagnosis::{Abscissa, DiagnoseError, Diagnosis, residuals};
use gyrocal_record::{
    AgainstReport, AutocorrelationReport, LineReport, NisReport, Record, ResidualsReport,
};
use gyrocal_statistics::format;

use crate::tables::{right, table};

const AXES: [&str; 3] = ["x", "y", "z"];

pub(super) fn report(
    diagnosis: &Diagnosis<'_>,
    record: &Record,
) -> Result<ResidualsReport, DiagnoseError> {
    let (nominal, innovations) = (&diagnosis.nominal, &diagnosis.innovations);
    let shown = residuals(
        nominal,
        innovations,
        record,
        diagnosis.false_alarm_probability,
    )?;
    Ok(ResidualsReport {
        nis: shown.nis.map(|nis| NisReport {
            mean: nis.mean,
            band: nis.band,
            p_value: nis.p_value,
        }),
        autocorrelation: shown.autocorrelation.map(|found| AutocorrelationReport {
            ljung_box: found.ljung_box,
            degrees_of_freedom: found.degrees_of_freedom,
            p_value: found.p_value,
            correlation: found.correlation,
        }),
        lines: shown.lines.map(|lines| {
            lines.map(|line| LineReport {
                period_h: 1.0 / (3600.0 * line.frequency_hz),
                amplitude: line.amplitude,
                p_value: line.p_value,
            })
        }),
        free_run_rms_g: shown.free_run_rms_g,
        against: shown
            .against
            .into_iter()
            .map(|(abscissa, axes)| AgainstReport {
                abscissa: match abscissa {
                    Abscissa::Force(axis) => format!("force_{}_g", AXES[axis]),
                    Abscissa::Time => "time_s".to_owned(),
                    Abscissa::Temperature => "temperature_c".to_owned(),
                },
                p_value: axes.each_ref().map(|axis| axis.p_value),
                at: axes
                    .each_ref()
                    .map(|axis| axis.bins.iter().map(|bin| bin.at).collect()),
                mean: axes.map(|axis| axis.bins.iter().map(|bin| bin.mean).collect()),
            })
            .collect(),
    })
}

/// A column for each axis.
pub(super) fn rows(report: &ResidualsReport, duration_h: f64) -> String {
    let mut table = table(["", "x", "y", "z"]);
    let mut row = |name: String, cells: [String; 3]| {
        let cells = cells.map(right);
        table.add_row(std::iter::once(Cell::new(name)).chain(cells));
    };
    row(
        "free run, g rms".to_owned(),
        report.free_run_rms_g.map(|rms| format!("{rms:.2e}")),
    );
    if let Some(found) = &report.autocorrelation
        && let Some(first) = found.correlation.first()
    {
        row(
            "correlation from row to row".to_owned(),
            first.map(|correlation| format!("{correlation:+.3}")),
        );
    }
    if let Some(lines) = &report.lines {
        row(
            "largest line: period, p".to_owned(),
            lines.map(|line| {
                let period = if line.period_h > duration_h {
                    "longer than the record".to_owned()
                } else {
                    format!("{} h", format::short(line.period_h, 4))
                };
                format!("{period}, {}", format::p_cell(line.p_value))
            }),
        );
    }
    for against in &report.against {
        let name = match against.abscissa.as_str() {
            "time_s" => "time",
            "temperature_c" => "temperature",
            "force_x_g" => "specific force along x",
            "force_y_g" => "specific force along y",
            _ => "specific force along z",
        };
        row(
            format!("against {name}, p"),
            against.p_value.map(format::p_cell),
        );
    }
    table.trim_fmt()
}

/// The line above the table.
pub(super) fn heading(report: &ResidualsReport) -> String {
    let nis = report.nis.map_or_else(String::new, |nis| {
        let [low, high] = nis.band;
        format!(
            "; mean NIS of a value {:.3}, expected {low:.3} to {high:.3}",
            nis.mean
        )
    });
    let correlation = report
        .autocorrelation
        .as_ref()
        .map_or_else(String::new, |found| {
            format!(
                "; Ljung-Box {:.0} for {} degrees of freedom",
                found.ljung_box, found.degrees_of_freedom
            )
        });
    format!("Residuals of the nominal model{nis}{correlation}:")
}
