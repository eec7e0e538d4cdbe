//! `gyrocal tumble`: multi-position test of gyros from a log with static stops in many attitudes.

mod figures;

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use comfy_table::{Cell, Table};
use gyrocal::generated::MODEL_HASH;
use gyrocal_instruments::multi_position::{
    Finding, MultiPositionReport, MultiPositionSettings, PreparedTest, SearchSettings,
    multi_position_test, prepare,
};
use gyrocal_instruments::{
    Description, InstrumentError, Log, ResultFile, StopSettings, find_stops, given_stops,
};
use gyrocal_record::Outputs;
use gyrocal_statistics::format;

use crate::Failure;
use crate::measured::{interval, unusable};
use crate::numbers::{positive, probability};
use crate::outputs::{self, manifest};
use crate::pictures;
use crate::tables::{right, table};

/// Multi-position test: fit the drift law to static stops and find missing terms.
///
/// Stops are detected in the log or given. Gyro outputs are fitted to specific force, and terms of
/// the catalogue are added while they are significant. Reports the alternatives of each term, the
/// gain of the extended law on held-out stops, and the findings in permuted stops.
#[derive(Debug, Args)]
pub(crate) struct TumbleArguments {
    /// The log (CSV) with a header row.
    log: PathBuf,
    /// Description of its columns (TOML); docs/measured-data.md has every key.
    #[arg(long, value_name = "LOG.toml")]
    log_description: PathBuf,
    /// A stop, instead of those detected; may be repeated.
    #[arg(long, value_name = "FROM_S:TO_S", value_parser = interval)]
    stop: Vec<[f64; 2]>,
    /// Shortest stop.
    #[arg(long, value_name = "S", default_value_t = StopSettings::default().shortest_s,
          value_parser = positive, conflicts_with = "stop")]
    shortest_stop_s: f64,
    /// Threshold of a static window: variance over that of the quietest windows.
    #[arg(long, value_name = "FACTOR", default_value_t = StopSettings::default().accel_factor,
          value_parser = positive, conflicts_with = "stop")]
    quiet_factor: f64,
    /// Family-wise false-alarm probability, 1e-4 or more; below 0.01 the time grows with its
    /// inverse.
    #[arg(long, value_name = "P", default_value_t = 0.01, value_parser = false_alarm)]
    false_alarm: f64,
    /// Successive stops that are held out together to measure the gain.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..))]
    left_out: u32,
    /// Seed of the permutations.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    #[arg(long, value_name = "DIR", help = pictures::HELP)]
    figures: Option<PathBuf>,
    /// Write the result for programs (JSON).
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,
}

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &TumbleArguments) -> Result<String, Failure> {
    let inputs = [&*arguments.log, &*arguments.log_description];
    outputs::check(
        &inputs,
        arguments.json.as_deref(),
        arguments.figures.as_deref(),
    )?;
    let (prepared, report) = work(arguments).map_err(|error| unusable(&arguments.log, error))?;
    tracing::info!(?report, "tested");
    let mut outputs = Outputs::new();
    let mut text = summary(arguments, &prepared, &report);
    // The folder of pictures first: the result for programs may go there too.
    if let Some(folder) = &arguments.figures {
        let pictures = figures::pictures(&arguments.log, &prepared, &report);
        text += &pictures::stage(&arguments.log, &pictures, folder, &mut outputs)?;
    }
    if let Some(path) = &arguments.json {
        let manifest = manifest(MODEL_HASH, arguments.seed, &inputs)?;
        let result = serde_json::json!({ "sensors": prepared.sensors(), "test": report });
        outputs.stage_json(path, &ResultFile::new(manifest, result))?;
    }
    outputs.commit()?;
    Ok(text)
}

fn false_alarm(text: &str) -> Result<f64, String> {
    let value = probability(text)?;
    SearchSettings::at(value, 1)
        .map(|settings| settings.false_alarm_probability)
        .map_err(|error| error.to_string())
}

fn work(
    arguments: &TumbleArguments,
) -> Result<(PreparedTest, MultiPositionReport), InstrumentError> {
    let description = Description::read(&arguments.log_description)?;
    let log = Log::read(&arguments.log, &description)?;
    let stops = match &arguments.stop[..] {
        [] => {
            let default = StopSettings::default();
            let settings = StopSettings {
                shortest_s: arguments.shortest_stop_s,
                accel_factor: arguments.quiet_factor,
                gyro_factor: default.gyro_factor * arguments.quiet_factor / default.accel_factor,
                ..default
            };
            find_stops(&log, &settings)?
        }
        given => given_stops(&log, given)?,
    };
    let prepared = prepare(&log, &description, &stops)?;
    let settings = MultiPositionSettings {
        search: SearchSettings::at(arguments.false_alarm, arguments.seed)?,
        left_out: arguments.left_out as usize,
        ..MultiPositionSettings::default()
    };
    let report = multi_position_test(&prepared.positions, &settings)?;
    Ok((prepared, report))
}

fn summary(
    arguments: &TumbleArguments,
    prepared: &PreparedTest,
    report: &MultiPositionReport,
) -> String {
    let mut text = format!(
        "{}: {} static stops\n\n",
        arguments.log.display(),
        report.stops
    );
    sensors(&mut text, prepared);
    let _ = writeln!(text, "{}\n", laws(report).trim_fmt());
    for gyro in &report.gyros {
        let (nominal, extended) = (&gyro.nominal, &gyro.extended);
        let test = &gyro.nominal_against_catalogue;
        let _ = writeln!(
            text,
            "{}: chi-square {:.0} with the nominal law ({} degrees of freedom), {:.1} with the \
             extended law ({}; {}).\n  Scatter beyond the standard errors of the stops: {:.0} \
             deg/h, with the nominal law {:.0} deg/h.\n  All terms of the catalogue against the \
             nominal law: F({}, {}) = {:.1}, {}; against the extended law: F = {:.1}, {}.",
            gyro.gyro,
            nominal.chi_square,
            nominal.degrees_of_freedom,
            extended.chi_square,
            extended.degrees_of_freedom,
            format::p_value(extended.p_value),
            extended.excess_deg_per_h,
            nominal.excess_deg_per_h,
            test.degrees_of_freedom[0],
            test.degrees_of_freedom[1],
            test.f,
            format::p_value(test.p_value),
            gyro.extended_against_catalogue.f,
            format::p_value(gyro.extended_against_catalogue.p_value),
        );
        if !gyro.undetermined.is_empty() {
            let names = gyro.undetermined.join(", ");
            let _ = writeln!(
                text,
                "  Not identifiable from these attitudes, given the others: {names}."
            );
        }
    }
    if report.findings.is_empty() {
        let _ = writeln!(
            text,
            "\nNo significant term beyond the nominal law (false-alarm probability {}): the extended \
             law is the nominal one.",
            arguments.false_alarm
        );
    } else {
        text.push_str("\nSignificant terms beyond the nominal law, in the order of finding:\n");
    }
    for finding in &report.findings {
        describe(&mut text, finding);
    }
    held_out_gain(&mut text, arguments, report);
    not_identifiable(&mut text, prepared);
    if let Some(path) = &arguments.json {
        let _ = writeln!(text, "\n{}: the result for programs", path.display());
    }
    text
}

fn sensors(text: &mut String, prepared: &PreparedTest) {
    let sensors = prepared.sensors();
    if let Some(outputs) = sensors.accel_outputs_per_g {
        let [x, y, z] = outputs;
        let _ = writeln!(
            text,
            "Accelerometers, from the magnitude at the stops: {x:.1}, {y:.1}, {z:.1} counts per g."
        );
    }
    let _ = writeln!(
        text,
        "Magnitude of specific force: 1 g within {:.1e} g rms.",
        sensors.norm_rms_g
    );
    if let (Some(outputs), Some(angles), Some(rms), Some(turns)) = (
        sensors.gyro_outputs_per_rad_per_s,
        sensors.gyro_misalignment_rad,
        sensors.turn_rms_g,
        &prepared.turns,
    ) {
        let [x, y, z] = outputs;
        let [ax, ay, az] = angles;
        let _ = writeln!(
            text,
            "Gyros, from {} turns between stops: {x:.5}, {y:.5}, {z:.5} outputs per rad/s, input \
             axes {ax:.3}, {ay:.3}, {az:.3} rad\nfrom those of the accelerometers; gravity \
             predicted over the turns within {rms:.1e} g rms.",
            turns.turns,
        );
    }
    text.push('\n');
}

fn laws(report: &MultiPositionReport) -> Table {
    let mut table = table([
        "coefficient",
        "nominal",
        "sigma",
        "extended",
        "sigma",
        "unit",
    ]);
    for gyro in &report.gyros {
        for coefficient in &gyro.extended.coefficients {
            let mut nominal = gyro.nominal.coefficients.iter();
            let [before, before_sigma] = nominal
                .find(|other| other.name == coefficient.name)
                .map_or([const { String::new() }; 2], |other| {
                    format::estimate(other.estimate, other.sigma)
                });
            let [estimate, sigma] = format::estimate(coefficient.estimate, coefficient.sigma);
            table.add_row([
                Cell::new(&coefficient.name),
                right(before),
                right(before_sigma),
                right(estimate),
                right(sigma),
                Cell::new(&coefficient.unit),
            ]);
        }
    }
    table
}

fn describe(text: &mut String, finding: &Finding) {
    let [estimate, sigma] = format::estimate(finding.estimate, finding.sigma);
    let _ = writeln!(
        text,
        "  {}  {estimate} ± {sigma} {}  (F = {:.0}, family-wise {})",
        finding.effect,
        finding.unit,
        finding.f,
        format::p_value(finding.p_value)
    );
    let rivals: Vec<String> = finding
        .alternatives
        .iter()
        .map(|rival| {
            format!(
                "{} ({:.1} nats)",
                rival.effect, rival.log_likelihood_deficit
            )
        })
        .collect();
    if rivals.is_empty() {
        text.push_str("    no alternative in the catalogue");
    } else {
        let _ = write!(text, "    alternatives: {}", rivals.join(", "));
    }
    if let Some(nearest) = &finding.nearest_ruled_out {
        let _ = write!(
            text,
            "; nearest excluded term: {} ({:.1} nats)",
            nearest.effect, nearest.log_likelihood_deficit
        );
    }
    text.push('\n');
    if !finding.equivalents.is_empty() {
        let _ = writeln!(
            text,
            "    exact equivalent, with the opposite sign: {}",
            finding.equivalents.join(", ")
        );
    }
    if let Some(angle) = finding.misalignment_needed_rad {
        let _ = writeln!(
            text,
            "    as a misalignment of the accelerometers: {angle:.1} rad"
        );
    }
}

fn held_out_gain(text: &mut String, arguments: &TumbleArguments, report: &MultiPositionReport) {
    if report.cross_validation.is_none() && !report.findings.is_empty() {
        let _ = writeln!(
            text,
            "\nThe gain of the extended law on held-out stops cannot be measured: without {} successive \
             stops the others\ndo not determine it. Give a smaller --left-out.",
            arguments.left_out
        );
    }
    if let Some(gain) = &report.cross_validation {
        let list = |values: [f64; 3]| values.map(|value| format!("{value:.0}")).join(", ");
        let _ = writeln!(
            text,
            "\nOn held-out stops ({} blocks of up to {}, searched and fitted without them) the \
             extended law improves the\npredictive log score by {:.1} ± {:.1} nats. Rms errors of \
             gyros x, y, z: {} deg/h, nominal law {},\nstandard errors of the stops {}.",
            gain.blocks,
            gain.left_out,
            gain.cross_validated_log_score_nats,
            gain.standard_error_nats,
            list(gain.rms_after_deg_per_h),
            list(gain.rms_before_deg_per_h),
            list(gain.noise_deg_per_h),
        );
        let found: Vec<String> = gain
            .found_in_blocks
            .iter()
            .map(|(name, blocks)| format!("{name} {blocks}"))
            .collect();
        let _ = writeln!(
            text,
            "Blocks without which each term is found again: {}.",
            found.join(", ")
        );
    }
    let controls = &report.controls;
    let names = |names: &[String]| match names {
        [] => "none".to_owned(),
        names => names.join(", "),
    };
    let _ = writeln!(
        text,
        "\nControls: findings in {} of {} data sets with permuted stops; with all axes renamed, the \
         findings\nare {} under their new names; with only the axes of the accelerometers renamed, \
         spurious\nfindings: {}.",
        controls.shuffles_with_findings,
        controls.shuffles,
        if controls.renamed_as_expected {
            "the same"
        } else {
            "NOT the same"
        },
        names(&controls.forces_renamed_unexpected),
    );
}

fn not_identifiable(text: &mut String, prepared: &PreparedTest) {
    text.push_str(
        "\nNot distinguishable: squares along all three axes and the bias (they sum to 1 g²); other \
         effects of the\nattitude to gravity, such as convection in the unit, and sensitivity to \
         specific force.\n",
    );
    match prepared.instrument.latitude_deg {
        Some(_) => text.push_str(
            "Earth rate: the vertical part is subtracted; the horizontal part counts as scatter, since \
             the heading is unknown.\n",
        ),
        None => text.push_str(
            "Earth rate is not subtracted, since no latitude is given: each g_i contains up to 15.04 \
             deg/h/g of it, and the\nscatter up to as much.\n",
        ),
    }
}
