//! Measurement and simulation over time.

use gyrocal_calibration::FittedPlatform;
use gyrocal_diagnosis::OpenLoopSimulation;
use gyrocal_document::{Chart, Panel, Section, TimeAxis};
use gyrocal_record::{AXES, Bench, Record};
use gyrocal_statistics::NORMAL_97_5;
use gyrocal_words::counted;

use super::covariates;
use crate::error::PageError;
use crate::panels;
use crate::words::{listed, micro_g};

/// The fits of a record whose simulations are shown.
pub(crate) struct Simulated<'a, 'b> {
    pub(crate) record: &'a Record,
    pub(crate) bench: &'a Bench,
    pub(crate) nominal: &'a FittedPlatform<'b>,
    pub(crate) extended: Option<&'a FittedPlatform<'b>>,
    /// Effects in the extended model.
    pub(crate) effects: Vec<&'a str>,
}

/// The two sections over time: simulation against measurement, and their difference.
pub(crate) fn sections(of: &Simulated<'_, '_>) -> Result<[Section; 2], PageError> {
    let nominal = OpenLoopSimulation::new(of.nominal, of.record)?;
    let extended = of
        .extended
        .map(|fit| OpenLoopSimulation::new(fit, of.record));
    let extended = extended.transpose()?;
    let time = TimeAxis::of(&of.record.time_s);
    let best = extended.as_ref().unwrap_or(&nominal);
    let fit = of.extended.unwrap_or(of.nominal);
    let sigma_g = fit.free_run_sigma_g(&best.simulated_g)?;
    let measured = columns(&of.record.accel_g);
    let chart = simulations(&time, measured, &nominal, extended.as_ref());
    let left = residuals(of, (&time, &sigma_g), &nominal, extended.as_ref());
    let against_force = covariates::against_force(of.record, &nominal);
    let leads = [
        "The platform simulated from its first attitude on, without measurement updates, and what the \
         accelerometers measured.",
        "Measured less simulated. A right model stays within the band, which holds the noise of the \
         accelerometers and what the noise of the gyros adds with time.",
    ];
    let residuals = [left].into_iter().chain(against_force);
    Ok(panels::sections(leads, [vec![chart], residuals.collect()]))
}

fn simulations(
    time: &TimeAxis,
    measured: [Vec<f64>; 3],
    nominal: &OpenLoopSimulation,
    extended: Option<&OpenLoopSimulation>,
) -> Chart {
    let before = columns(&nominal.simulated_g);
    let after = extended.map(|run| columns(&run.simulated_g));
    let panels = measured.into_iter().enumerate().map(|(axis, measured)| {
        let after = after.as_ref().map(|after| after[axis].clone());
        let name = format!("accelerometer {}", AXES[axis]);
        panels::simulation(name, &time.values, measured, (before[axis].clone(), after))
    });
    let title = "Specific force, measured and simulated".to_owned();
    Chart {
        caption: "Over days the lines coincide at this scale.".to_owned(),
        quantity: "specific force".to_owned(),
        unit: "g".to_owned(),
        ..panels::over_time(title, time, panels.collect())
    }
}

fn residuals(
    of: &Simulated<'_, '_>,
    (time, sigma_g): (&TimeAxis, &[[f64; 3]]),
    nominal: &OpenLoopSimulation,
    extended: Option<&OpenLoopSimulation>,
) -> Chart {
    let panels = (0..3).map(|axis| {
        let before = &nominal.residuals_g[axis];
        let after = extended.map(|run| &run.residuals_g[axis]);
        let half_width: Vec<f64> = sigma_g.iter().map(|row| NORMAL_97_5 * row[axis]).collect();
        let rms = |run: &OpenLoopSimulation| micro_g(run.axis_rms_g[axis]);
        Panel {
            name: AXES[axis].to_owned(),
            note: match extended {
                Some(after) => {
                    let before = rms(nominal);
                    format!("rms {} → {}", before.trim_end_matches(" µg"), rms(after))
                }
                None => format!("rms {}", rms(nominal)),
            },
            abscissa: time.values.clone(),
            bands: vec![panels::band(
                "95 % band of a right model: accelerometers and gyros",
                &half_width,
            )],
            lines: panels::of_models(before.clone(), after.cloned()),
            ..Panel::default()
        }
    });
    let noise = micro_g(of.bench.accel_noise_g);
    let left_out = match nominal.left_out {
        0 => String::new(),
        count => format!(
            " Not counted in any rms: {} that the noise audit left out.",
            counted(count, "value")
        ),
    };
    let title = match extended {
        Some(run) => format!(
            "{} rms for the nominal model, {} with {}",
            micro_g(nominal.rms_g),
            micro_g(run.rms_g),
            listed(&of.effects)
        ),
        None => format!(
            "{} rms; accelerometer noise {noise}",
            micro_g(nominal.rms_g)
        ),
    };
    Chart {
        caption: format!(
            "The band is of the residual of each row: noise of the accelerometers ({noise} declared), \
             and attitude that the gyros' noise has turned since the first row, less what the fitted \
             coefficients absorb of it.{left_out}"
        ),
        quantity: "residual".to_owned(),
        unit: "g".to_owned(),
        same_scale: true,
        cut_extremes: true,
        ..panels::over_time(title, time, panels.collect())
    }
}

fn columns(rows: &[[f64; 3]]) -> [Vec<f64>; 3] {
    core::array::from_fn(|axis| rows.iter().map(|row| row[axis]).collect())
}
