//! Pictures of a diagnosis of a plant.

use gyrocal_answer::{Answer, Coefficients, Verdict};
use gyrocal_plant::{Diagnosed, OutputSeries, RecordSeries};
use gyrocal_report::page::Tint;
use gyrocal_report::{
    ComparedEstimate, ComparedQuantity, Comparison, Correlation, CorrelationChannel, OpenLoop,
    OpenLoopChannel, Picture, ResidualChannel, Residuals,
};

use crate::error::PageError;
use crate::panels::{EXTENDED, NOMINAL};
use crate::ranked::Ranked;
use crate::words::listed;

/// Lags of the autocorrelation.
const LAGS: usize = 40;

/// Share of white noise that stays inside the band of a correlation.
const CONFIDENCE: f64 = 0.95;

/// A picture with the name of its files.
pub type NamedPicture = (&'static str, Box<dyn Picture>);

/// Pictures of a diagnosis of a plant, with the names of their files. The clock of several records goes on
/// from one to the next.
///
/// # Errors
/// [`PageError::Plant`] if a pass over the record fails.
pub fn plant_pictures(diagnosed: &Diagnosed, name: &str) -> Result<Vec<NamedPicture>, PageError> {
    let answer = &diagnosed.answer;
    let subtitle = format!("{name}; {}", verdict(answer));
    let series = diagnosed.joined_series();
    let mut pictures: Vec<NamedPicture> = vec![
        (
            "residuals",
            Box::new(residuals(answer, &series, &subtitle, "residual")),
        ),
        ("free-run", Box::new(open_loop(&series, &subtitle))),
    ];
    if let Some(ranked) = Ranked::of(answer) {
        pictures.push(("ranking", Box::new(ranked.picture(&subtitle))));
    }
    if answer.has_findings() {
        let compared = answer.coefficients.as_ref();
        pictures.extend(
            compared.map(|all| -> NamedPicture {
                ("parameters", Box::new(parameters(all, &subtitle)))
            }),
        );
    }
    if let (Some(later), true) = (&diagnosed.later, answer.has_findings()) {
        let gain = answer.gain.as_ref();
        let gain = gain.and_then(|gain| gain.validation.as_ref());
        let nats = gain.map_or(f64::NAN, |gain| gain.log_score_nats);
        let subtitle = format!("later record, {nats:+.1} nats; {subtitle}").replace('-', "−");
        let picture = residuals(answer, later, &subtitle, "residual in the later record");
        pictures.push(("later-record", Box::new(picture)));
    }
    let correlation = correlation(diagnosed, &subtitle)?;
    pictures.extend(correlation.map(|one| ("autocorrelation", Box::new(one) as Box<dyn Picture>)));
    Ok(pictures)
}

fn verdict(answer: &Answer) -> String {
    let effects: Vec<&str> = answer.findings.iter().map(|one| &*one.effect).collect();
    let found = match &*effects {
        [] => "no effects found".to_owned(),
        found => format!("effects found: {}", found.join(", ")),
    };
    match answer.verdict {
        Verdict::Unexplained => "unexplained residual".to_owned(),
        Verdict::NotSettled => format!("not settled, {found}"),
        _ => found,
    }
}

/// The unit of outputs that share one. Others are shown over the noise of their sensors.
fn shared_unit(series: &RecordSeries) -> Option<String> {
    let mut units = series.outputs.iter().map(|one| one.unit.as_str());
    let first = units.next()?;
    units.all(|unit| unit == first).then(|| match first {
        "1" => String::new(),
        unit => unit.to_owned(),
    })
}

/// Measured less simulated with both models.
fn residuals(answer: &Answer, series: &RecordSeries, subtitle: &str, quantity: &str) -> Residuals {
    let unit = shared_unit(series);
    let channel = |one: &OutputSeries| {
        let scale = if unit.is_some() {
            1.0
        } else {
            one.sigma.recip()
        };
        let scaled = |values: Vec<f64>| values.into_iter().map(|value| scale * value).collect();
        ResidualChannel {
            name: one.output.clone(),
            before: scaled(one.nominal_residuals()),
            after: one.extended_residuals().map(scaled),
            sigma: scale * one.sigma,
        }
    };
    let effects: Vec<&str> = answer
        .findings
        .iter()
        .map(|one| one.effect.as_str())
        .collect();
    Residuals {
        title: match &*effects {
            [] => format!("Open-loop {quantity} of the nominal model"),
            found => format!(
                "Open-loop {quantity}: nominal model, and with {}",
                listed(found)
            ),
        },
        subtitle: format!("measured minus simulated; {subtitle}"),
        time_s: series.time_s.clone(),
        channels: series.outputs.iter().map(channel).collect(),
        before_label: NOMINAL.to_owned(),
        after_label: EXTENDED.to_owned(),
        quantity: "residual".to_owned(),
        unit: unit.unwrap_or_else(|| "σ".to_owned()),
    }
}

/// Outputs as measured and as simulated by the nominal model.
fn open_loop(series: &RecordSeries, subtitle: &str) -> OpenLoop {
    let unit = shared_unit(series);
    let channel = |one: &OutputSeries| {
        let scale = if unit.is_some() {
            1.0
        } else {
            one.sigma.recip()
        };
        let scaled = |values: &[f64]| values.iter().map(|value| scale * value).collect();
        OpenLoopChannel {
            name: one.output.clone(),
            measured: scaled(&one.measured),
            simulated: scaled(&one.nominal),
            sigma: scale * one.sigma,
        }
    };
    OpenLoop {
        title: "Open-loop simulation of the nominal model, and what was measured".to_owned(),
        subtitle: subtitle.to_owned(),
        time_s: series.time_s.clone(),
        channels: series.outputs.iter().map(channel).collect(),
        quantity: "output".to_owned(),
        unit: unit.unwrap_or_else(|| "σ".to_owned()),
    }
}

fn parameters(all: &Coefficients, subtitle: &str) -> Comparison {
    let models = all.nominal.iter().zip(all.best());
    let quantities = models.map(|(nominal, extended)| ComparedQuantity {
        name: nominal.name.clone(),
        unit: nominal.unit.clone(),
        reference: None,
        estimates: [nominal, extended]
            .map(|one| ComparedEstimate {
                value: one.estimate,
                sigma: one.sigma,
            })
            .to_vec(),
    });
    Comparison {
        title: "Parameters without and with what was found".to_owned(),
        subtitle: subtitle.to_owned(),
        estimators: vec!["nominal".to_owned(), "extended".to_owned()],
        tints: vec![Tint::Nominal, Tint::Extended],
        quantities: quantities.collect(),
        columns: 3,
        reference_label: String::new(),
    }
}

/// `None` of a record that is too short.
fn correlation(diagnosed: &Diagnosed, subtitle: &str) -> Result<Option<Correlation>, PageError> {
    let found = diagnosed.correlations(LAGS)?;
    let mut channels = Vec::new();
    for one in found.into_iter().filter(|one| !one.nominal.is_empty()) {
        let models = [
            (NOMINAL, Tint::Nominal, Some(one.nominal)),
            (EXTENDED, Tint::Extended, one.extended),
        ];
        for (model, tint, correlation) in models {
            channels.extend(correlation.map(|correlation| CorrelationChannel {
                name: format!("{}, {model}", one.output),
                correlation,
                band: one.band,
                samples: one.values,
                tint,
            }));
        }
    }
    let outside = |channel: &CorrelationChannel| {
        let beyond = channel.correlation.iter();
        beyond.filter(|value| value.abs() > channel.band).count()
    };
    let total: usize = channels.iter().map(|one| one.correlation.len()).sum();
    let count: usize = channels.iter().map(outside).sum();
    Ok((!channels.is_empty()).then(|| Correlation {
        title: format!(
            "{count} of {total} autocorrelations of the innovations outside the 95 % band"
        ),
        subtitle: format!("one-step innovations; {subtitle}"),
        channels,
        confidence: CONFIDENCE,
    }))
}
