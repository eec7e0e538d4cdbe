//! The signature of an effect in a record, drawn.

use gyrocal::Effect;
use gyrocal::effect::{EffectKind, EffectParameter, NoiseProperty, Role};
use gyrocal_calibration::{FittedPlatform, NoiseModel, Options, Run};
use gyrocal_document::{Band, Chart, Line, LineKind, Panel, TimeAxis, Tint};
use gyrocal_record::{AXES, Record};
use gyrocal_statistics::{NORMAL_97_5, format};
use gyrocal_testkit::workspace;
use gyrocal_truth::{Hidden, InitialAttitude, Scenario, Simulation, Temperature, simulate};

use crate::harness::Error;
use crate::values::Values;

/// Interval of rows, s: enough points for a curve, and a small file.
const INTERVAL_S: f64 = 600.0;

/// Onset as a part of the record, and time constant, h.
const ONSET: f64 = 0.4;
const TIME_CONSTANT_H: f64 = 6.0;

/// Size at which an effect can be seen: its largest residual in sigmas of a sample.
const VISIBLE_SIGMAS: f64 = 3.0;

/// Largest factor on a typical size: 10 to this power.
const LARGEST_POWER: i32 = 3;

/// The Earth's field in local east, north, up at a middle latitude, gauss.
const FIELD_GAUSS: [f64; 3] = [0.0, 0.2, -0.43];

/// Properties of noise that are seen at a glance.
const NOISE_RATIO: f64 = 3.0;
const OUTLIER_SIGMAS: f64 = 20.0;
const QUANTISATION_SIGMAS: f64 = 5.0;
const CORRELATION: f64 = 0.95;

/// The record that all pictures are of, with its noise.
fn scenario() -> Result<Scenario, Error> {
    let path = workspace().join("examples/data/hidden_fault.scenario.toml");
    Ok(Scenario {
        hidden: Vec::new(),
        initial_angles_sigma_deg: [0.01; 3],
        interval_s: INTERVAL_S,
        temperature: Some(Temperature::default()),
        magnetic_field_gauss: Some(FIELD_GAUSS),
        ..Scenario::read(&path)?
    })
}

/// The words of the page on that record.
pub(super) fn describe(values: &mut Values) -> Result<(), Error> {
    let scenario = scenario()?;
    values.put("days", format::short(scenario.duration_s / 86_400.0, 3));
    values.put("latitude", format::short(scenario.latitude_deg, 3));
    let InitialAttitude::AnglesDeg(angles) = scenario.initial else {
        return Err("the scenario of the pictures has no attitude".into());
    };
    values.put("angles", angles.map(|angle| format!("{angle}°")).join(", "));
    values.put("visible", format::short(VISIBLE_SIGMAS, 2));
    Ok(())
}

/// Whether a record shows the effect; an integration rule belongs to a filter.
pub(super) fn has_picture(effect: &Effect) -> bool {
    effect.kind != EffectKind::Integration
}

/// The picture of an effect that a record can show.
pub(super) fn picture(effect: &Effect) -> Result<Option<Chart>, Error> {
    if !has_picture(effect) {
        return Ok(None);
    }
    let scenario = scenario()?;
    let mut shown = drawn(effect, &scenario, 1.0)?;
    for power in 1..=LARGEST_POWER {
        if effect.is_noise() || effect.is_nominal || is_visible(&shown, scenario.accel_noise_g) {
            break;
        }
        shown = drawn(effect, &scenario, 10_f64.powi(power))?;
    }
    Ok(Some(shown))
}

fn is_visible(shown: &Chart, sigma_g: f64) -> bool {
    let lines = shown.panels.iter().flat_map(|panel| &panel.lines);
    let mut values = lines.flat_map(|line| &line.values);
    values.any(|value| value.abs() > VISIBLE_SIGMAS * sigma_g)
}

/// The effect at `factor` times its typical size.
fn drawn(effect: &Effect, scenario: &Scenario, factor: f64) -> Result<Chart, Error> {
    let values = values(effect, scenario, factor);
    let named = values.iter().map(|(name, value, _)| (&**name, *value));
    let named: Vec<(&str, f64)> = named.collect();
    let quiet = noise_of(effect, scenario);
    let simulation = simulate(&Scenario {
        hidden: vec![Hidden::new(effect.id, &named)?],
        ..quiet.clone()
    })?;
    let shown = values.iter().filter(|(_, value, _)| *value != 0.0);
    let sizes = shown.map(|(name, value, unit)| {
        let value = format::short(*value, 3);
        let unit = if *unit == "1" { "" } else { unit };
        format!("{name} {value} {unit}").trim_end().to_owned()
    });
    let sizes: Vec<String> = sizes.collect();
    let sigma_g = scenario.accel_noise_g;
    let (residual_g, label) = if effect.is_nominal {
        let without = simulate(&quiet)?;
        let change = difference(&simulation.record.accel_g, &without.record.accel_g);
        (change, "change of the readings")
    } else {
        let left = left_by_the_fit(&simulation, scenario)?;
        (left, "left by the fit of the nominal model")
    };
    Ok(Chart {
        title: format!("{}: {}", effect.id, sizes.join(", ")),
        caption: effect.name.to_owned(),
        ..chart(&simulation.record, &residual_g, label, sigma_g)
    })
}

/// Residuals of a record, one panel for each axis, with the band of the noise of one row.
fn chart(record: &Record, residual_g: &[[f64; 3]], label: &str, sigma_g: f64) -> Chart {
    let time = TimeAxis::of(&record.time_s);
    let half = NORMAL_97_5 * sigma_g;
    let panels = AXES.into_iter().enumerate().map(|(axis, name)| Panel {
        name: name.to_owned(),
        abscissa: time.values.clone(),
        bands: vec![Band {
            label: "95 % of the noise of the accelerometers".to_owned(),
            tint: Tint::Expected,
            lower: vec![-half; residual_g.len()],
            upper: vec![half; residual_g.len()],
        }],
        lines: vec![Line {
            label: label.to_owned(),
            tint: Tint::Nominal,
            kind: LineKind::Solid,
            values: residual_g.iter().map(|row| row[axis]).collect(),
        }],
        ..Panel::default()
    });
    Chart {
        abscissa: "time from the first row".to_owned(),
        abscissa_unit: time.unit.to_owned(),
        quantity: "residual".to_owned(),
        unit: "g".to_owned(),
        same_scale: true,
        cut_extremes: true,
        columns: 1,
        height_px: 150,
        panels: panels.collect(),
        ..Chart::default()
    }
}

/// The scenario with its noise for effects of the noise of the readings, without it for all others.
fn noise_of(effect: &Effect, scenario: &Scenario) -> Scenario {
    let noise = f64::from(matches!(effect.kind, EffectKind::Noise(_)));
    Scenario {
        accel_noise_g: noise * scenario.accel_noise_g,
        gyro_noise_deg_per_h: noise * scenario.gyro_noise_deg_per_h,
        ..scenario.clone()
    }
}

/// Name, value and unit of each parameter, as the simulator names them.
fn values(effect: &Effect, scenario: &Scenario, factor: f64) -> Vec<(String, f64, &'static str)> {
    if let EffectKind::Noise(property) = effect.kind {
        return noise_values(property, scenario);
    }
    let mut sizes = 0;
    let parameters = effect.parameters.iter();
    parameters
        .map(|parameter: &EffectParameter| {
            let (name, unit) = (parameter.name.to_owned(), parameter.unit);
            match parameter.role {
                Role::Onset(_) => (name, ONSET * scenario.duration_s, unit),
                Role::TimeConstant(_) => (name, TIME_CONSTANT_H, unit),
                role => {
                    sizes += 1;
                    let size = if sizes == 1 { effect.typical_size } else { 0.0 };
                    let name = match role {
                        Role::State(_) => format!("{name}_{unit}"),
                        _ => name,
                    };
                    (name, factor * size, unit)
                }
            }
        })
        .collect()
}

fn noise_values(property: NoiseProperty, scenario: &Scenario) -> Vec<(String, f64, &'static str)> {
    let sigma = scenario.accel_noise_g;
    let values = match property {
        NoiseProperty::Level => vec![("ratio", NOISE_RATIO, "")],
        NoiseProperty::Outliers => vec![("fraction", 0.01, ""), ("size", OUTLIER_SIGMAS, "sigmas")],
        NoiseProperty::Quantisation => vec![("lsb", QUANTISATION_SIGMAS * sigma, "g")],
        NoiseProperty::Correlation => vec![("correlation", CORRELATION, "")],
    };
    let named = |(name, value, unit): (&str, f64, &'static str)| (name.to_owned(), value, unit);
    values.into_iter().map(named).collect()
}

/// Measured less simulated specific force of the nominal model at its best fit, with the noise that
/// the scenario declares.
fn left_by_the_fit(simulation: &Simulation, scenario: &Scenario) -> Result<Vec<[f64; 3]>, Error> {
    let (record, bench) = (&simulation.record, &scenario.bench());
    let run = Run { record, bench };
    let fit = FittedPlatform::nominal_once(&run, &Options::default(), &NoiseModel::default())?;
    Ok(difference(&simulation.record.accel_g, &fit.free_run_g()?))
}

fn difference(one: &[[f64; 3]], other: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let rows = one.iter().zip(other);
    rows.map(|(one, other)| core::array::from_fn(|axis| one[axis] - other[axis]))
        .collect()
}
