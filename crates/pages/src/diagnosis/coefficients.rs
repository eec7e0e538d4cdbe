//! The drift coefficients: nominal and extended, against record length, and against the site.

use gyrocal::generated::platform::DRIFT;
use gyrocal_answer::{Answer, CoefficientEstimate, CoefficientShift};
use gyrocal_calibration::{Estimates as Fitted, FittedPlatform, SiteBias, SiteQuantity};
use gyrocal_document::{
    Cell, Chart, Column, EstimateRow, Estimates, Item, Panel, Section, Table, TimeAxis, Tint,
};
use gyrocal_record::Record;

use super::accepted;
use crate::error::PageError;
use crate::panels::{EXTENDED, NOMINAL, line, two_sigmas};
use crate::words::{listed, section as titled};

/// A change of a coefficient from which on it is marked, in claimed sigmas.
const NOTABLE: f64 = 2.0;

/// Points of a curve, evenly over the record.
const POINTS: usize = 240;
/// Part of the record after which estimates set the scale of a panel.
const SETTLED: f64 = 0.3;

pub(super) fn section(result: &Answer, convergence: Option<Chart>) -> Option<Section> {
    let all = result.coefficients.as_ref()?;
    let models = [Some(&all.nominal), all.extended.as_ref()];
    let models: Vec<_> = models.into_iter().flatten().collect();
    let labels = [(NOMINAL, Tint::Nominal), (EXTENDED, Tint::Extended)];
    let shifts = result.gain.as_ref().filter(|_| models.len() > 1);
    let rows = all.nominal.iter().enumerate().map(|(place, one)| {
        let note = shifts.map(|gain| change(&gain.coefficient_shift, &one.name));
        let of = |model: &&Vec<CoefficientEstimate>| {
            let one = model.get(place);
            one.map_or([f64::NAN; 2], |one| [one.estimate, one.sigma])
        };
        let (note, strong) = note.map_or_else(Default::default, |note| (note.text, note.strong));
        let row = EstimateRow::new(&one.name, &one.unit, models.iter().map(of));
        EstimateRow {
            note,
            strong,
            ..row
        }
    });
    let effects = accepted(result);
    let title = match listed(&effects) {
        none if none.is_empty() => "Drift coefficients of the nominal model".to_owned(),
        effects => format!("Drift coefficients without and with {effects} in the model"),
    };
    let mut items = vec![Item::Estimates(Estimates {
        note_head: shifts.map_or_else(String::new, |_| "change, σ of the nominal fit".to_owned()),
        ..Estimates::new(&title, &labels[..models.len()], rows)
    })];
    items.extend(convergence.map(Item::Chart));
    items.extend(gyrocal_words::over_sets(all).map(Item::from));
    let lead = "The nine drift coefficients with their standard deviations.";
    Some(titled("coefficients", "Coefficients", lead, items))
}

/// Estimates against record length; `None` of a record without a second row.
pub(crate) fn convergence(
    record: &Record,
    (nominal, extended): (&FittedPlatform<'_>, Option<&FittedPlatform<'_>>),
) -> Result<Option<Chart>, PageError> {
    let all = record.len();
    let rows = (1..=POINTS).map(|point| point * all.saturating_sub(1) / POINTS);
    let mut rows: Vec<usize> = rows.collect();
    rows.dedup();
    if rows.len() < 2 {
        return Ok(None);
    }
    let time = TimeAxis::of(&record.time_s);
    let times: Vec<f64> = rows.iter().map(|row| time.values[*row]).collect();
    let of = |fit: &FittedPlatform<'_>| fit.convergence(&rows);
    let nominal = of(nominal)?;
    let extended = extended.map(of).transpose()?;
    let settled = times.last().map(|last| SETTLED * last);
    let panels = DRIFT.iter().enumerate().map(|(index, element)| {
        let mut panel = Panel {
            name: element.id.to_owned(),
            unit: Some(element.unit.to_owned()),
            abscissa: times.clone(),
            no_gaps: true,
            scale_from: settled,
            ..Panel::default()
        };
        add(&mut panel, (NOMINAL, Tint::Nominal), &nominal, index);
        if let Some(extended) = &extended {
            add(&mut panel, (EXTENDED, Tint::Extended), extended, index);
        }
        panel
    });
    Ok(Some(Chart {
        title: "Convergence of each coefficient".to_owned(),
        caption:
            "Estimate from the record up to each time, with a band of two standard deviations. \
                  Early values may leave the panels."
                .to_owned(),
        abscissa: "length of the record".to_owned(),
        abscissa_unit: time.unit.to_owned(),
        panels: panels.collect(),
        columns: 3,
        height_px: 170,
        ..Chart::default()
    }))
}

/// Adds the course of a coefficient in a model.
fn add(panel: &mut Panel, (label, tint): (&str, Tint), fitted: &[Option<Fitted>], index: usize) {
    let of = |value: fn(&Fitted) -> &[f64; 9]| -> Vec<f64> {
        let all = fitted.iter();
        all.map(|one| one.as_ref().map_or(f64::NAN, |one| value(one)[index]))
            .collect()
    };
    let (estimates, sigmas) = (of(|one| &one.coefficients), of(|one| &one.sigmas));
    let name = format!("{label}, ±2σ");
    let pairs = estimates.iter().copied().zip(sigmas);
    panel.bands.push(two_sigmas(&name, tint, pairs));
    panel.lines.push(line(label, tint, estimates));
}

/// Sensitivity of the coefficients to the site.
pub(crate) fn site(fit: &FittedPlatform<'_>) -> Result<Section, PageError> {
    let biases = fit.site_biases()?;
    let mut columns = vec![Column::words("coefficient"), Column::numbers("σ")];
    for bias in &biases {
        columns.extend([&*site_error(bias), "in σ"].map(Column::numbers));
    }
    let rows = DRIFT.iter().enumerate().map(|(index, element)| {
        let sigma = fit.covariance()[(index, index)].sqrt();
        let mut row = vec![
            Cell::from(format!("{} [{}]", element.id, element.unit)),
            Cell::from(format!("{sigma:.1e}").replace('-', "−")),
        ];
        for bias in &biases {
            let in_sigmas = bias.in_sigmas[index];
            row.push(Cell::from(
                format!("{:+.1e}", bias.biases[index]).replace('-', "−"),
            ));
            row.push(Cell {
                text: format!("{in_sigmas:+.2}").replace('-', "−"),
                strong: in_sigmas.abs() >= 1.0,
            });
        }
        row
    });
    let lead = "Sensitivity to the site: bias of each coefficient by an error of it, in its unit and in standard \
                deviations σ of the estimate. Errors that the bench file declares count in those standard deviations \
                already.";
    let items = vec![Item::from(Table {
        title: "Biases by errors of the site".to_owned(),
        columns,
        rows: rows.collect(),
    })];
    Ok(titled("site", "Site", lead, items))
}

/// Name and size of an error of the site.
fn site_error(bias: &SiteBias) -> String {
    let size = match bias.quantity {
        SiteQuantity::Latitude => format!("latitude +{:.3} arcsec", 3600.0 * bias.error),
        SiteQuantity::EarthRate => format!("Earth rate +{:.1e} of it", bias.error),
        SiteQuantity::Gravity => format!("gravity +{:.1e} of it", bias.error),
        _ => format!("+{:.1e}", bias.error),
    };
    match bias.is_declared {
        true => format!("{size} (declared σ)"),
        false => size,
    }
}

/// The change of a coefficient in claimed sigmas.
pub(super) fn change(shifts: &[CoefficientShift], name: &str) -> Cell {
    let shift = shifts.iter().find(|shift| shift.coefficient == name);
    Cell {
        text: shift.map_or_else(String::new, |shift| {
            format!("{:+.1}", shift.in_sigmas).replace('-', "−")
        }),
        strong: shift.is_some_and(|shift| shift.in_sigmas.abs() >= NOTABLE),
    }
}
