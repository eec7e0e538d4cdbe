//! What a calibration tells beyond its coefficients: records, site, turn-ons.

use gyrocal_calibration::{BIASES, ConsiderSensitivity, NoiseDifference, NoiseRatio, SiteQuantity};
use gyrocal_document::{Column, Item, Section, Table};
use gyrocal_record::{
    AXES, CalibrationMethod, CalibrationReport, FittedEffects, NoiseRatioReport, NoiseReport,
    RunReport, SiteReport,
};
use gyrocal_statistics::format;
use gyrocal_words::is_correlation;

use crate::diagnosis::section;

/// Which coefficients the records determine, in a sentence.
pub(super) fn determined(report: &CalibrationReport) -> String {
    let names = |determined: bool| -> Vec<&str> {
        let those = report.coefficients.iter();
        let those = those.filter(|one| one.determined == determined);
        those.map(|one| &*one.name).collect()
    };
    let does = match report.runs.len() {
        0 | 1 => "The record determines",
        _ => "The records determine",
    };
    match (&*names(true), &*names(false)) {
        (_, []) => format!("{does} all nine coefficients."),
        ([], _) => format!(
            "{does} none of the coefficients: estimates and sigmas are mostly those of the prior."
        ),
        (yes, no) => format!(
            "{does} {}. Not determined: {}.",
            yes.join(", "),
            no.join(", ")
        ),
    }
}

/// What given effects gain, and their parameters.
pub(super) fn with_effects(with: &FittedEffects) -> [Item; 2] {
    let names: Vec<&str> = with.effects.iter().map(|one| &*one.effect).collect();
    let rows = with.effects.iter().flat_map(|effect| {
        effect.parameters.iter().map(|one| {
            let estimate = match one.sigma {
                Some(sigma) => format::estimate(one.estimate, sigma).join(" ± "),
                None => format::significant(one.estimate, 4),
            };
            let pieces = one.interval.iter().flatten();
            let pieces =
                pieces.map(|ends| ends.map(|end| format::significant(end, 4)).join(" to "));
            let interval = pieces.collect::<Vec<_>>().join(" or ");
            let (effect, unit) = (effect.effect.clone(), one.unit.clone());
            [effect, one.name.clone(), estimate, interval, unit]
        })
    });
    let columns = Column::heads("effect | parameter | > estimate | > 95 % interval | unit");
    [
        Item::text(format!(
            "Coefficients with {} in the model, which gains {:.1} nats of log-likelihood.",
            names.join(", "),
            with.gained_nats
        )),
        Table::new("Parameters of these effects", columns, rows).into(),
    ]
}

/// Attitude and noise of each record; `None` without one.
pub(super) fn records(report: &CalibrationReport) -> Option<Section> {
    let angles = |deg: [f64; 3]| deg.map(|angle| format!("{angle:.4}")).join(", ") + " deg";
    let rows = report.runs.iter().map(|run| {
        [
            run.record.clone(),
            run.rows.to_string(),
            angles(run.initial_angles_deg),
            angles(run.final_angles_deg),
        ]
    });
    let columns = Column::heads("record | > rows | > first row | > last row");
    let title = "Attitude against east, north, up: angles about x, y, z";
    let mut items = vec![Item::from(Table::new(title, columns, rows))];
    items.extend(report.runs.iter().filter_map(azimuth).map(Item::text));
    let noises = report.runs.iter().filter_map(|run| Some((run, run.noise?)));
    let noises: Vec<_> = noises.collect();
    let rows = noises.iter().map(|(run, noise)| {
        let gyros = match is_correlated(report, run) {
            true => String::new(),
            false => ratios(&noise.gyro),
        };
        [run.record.clone(), ratios(&noise.accel), gyros]
    });
    let columns = Column::heads("record | > accelerometers | > gyros");
    if !noises.is_empty() {
        let title = "Estimated over declared noise with its 95 % interval: x, y, z";
        items.push(Table::new(title, columns, rows).into());
    }
    items.extend(noises.iter().map(|(run, noise)| {
        Item::text(match is_correlated(report, run) {
            true => format!(
                "{}: No ratio for the gyros: the noise of the accelerometers is correlated, and its slow part would \
                 be taken for theirs.",
                run.record
            ),
            false => format!("{}: {}", run.record, differences(noise)),
        })
    }));
    let bounded = report.runs.iter().filter(|run| run.bounded_values > 0);
    items.extend(bounded.map(|run| {
        Item::text(format!(
            "{}: robust estimation reduced the weight of {} values beyond the bound of --robust.",
            run.record, run.bounded_values
        ))
    }));
    let lead = "Attitude and noise of each record; noise is estimated by maximum likelihood.";
    (!report.runs.is_empty()).then(|| section("records", "Records", lead, items))
}

/// Whether the noise of the accelerometers of a record is correlated.
fn is_correlated(report: &CalibrationReport, run: &RunReport) -> bool {
    let mut own = report
        .effects
        .iter()
        .filter(|test| test.record == run.record);
    own.any(|test| test.noise.iter().any(|id| is_correlation(id)))
}

/// The search of the azimuth of a record that declares none.
fn azimuth(run: &RunReport) -> Option<String> {
    let search = run.azimuth.as_ref()?;
    let found = format!(
        "{}: the initial attitude is not declared. Levelled by the first samples, azimuth from a search over {} starts",
        run.record, search.starts
    );
    let Some(other) = search.other else {
        return Some(format!("{found}; no other azimuth fits."));
    };
    let (at, lacks) = (other.relative_deg, other.log_likelihood_deficit);
    Some(match search.ambiguous {
        true => format!(
            "{found}. The azimuth is ambiguous: another one at {at:+.1} deg from it has a log-likelihood lower by \
             only {lacks:.1}, with other coefficients. Give initial_angles_deg, or record for longer."
        ),
        false => format!(
            "{found}; the next best, at {at:+.1} deg from it, has a log-likelihood lower by {lacks:.0}."
        ),
    })
}

fn ratio(of: &NoiseRatioReport) -> NoiseRatio {
    NoiseRatio {
        ratio: of.ratio,
        interval: of.interval,
    }
}

fn ratios(of: &[NoiseRatioReport; 3]) -> String {
    let each = AXES.into_iter().zip(of).map(|(axis, one)| {
        let (ratio, [low, high]) = (one.ratio, one.interval);
        match self::ratio(one).is_observable() {
            true => format!("{axis} {ratio:.3} ({low:.3} to {high:.3})"),
            false => format!("{axis} not observable"),
        }
    });
    each.collect::<Vec<_>>().join(", ")
}

/// The noises whose interval excludes the declared one.
fn differences(noise: &NoiseReport) -> String {
    let kinds = [("accel", &noise.accel), ("gyro", &noise.gyro)];
    let different = kinds.into_iter().flat_map(|(kind, found)| {
        AXES.into_iter().zip(found).filter_map(move |(axis, one)| {
            let difference = match ratio(one).difference()? {
                NoiseDifference::Larger => "larger",
                NoiseDifference::Smaller => "smaller",
            };
            Some(format!("{kind}_{axis} ({difference})"))
        })
    });
    match &*different.collect::<Vec<_>>() {
        [] => "all noise levels agree with the declared ones.".to_owned(),
        names => format!(
            "noise levels other than declared: {}. By chance one of six intervals excludes 1 in every fourth record.",
            names.join(", ")
        ),
    }
}

/// Offsets of turn-ons, and what further records add; `None` of one record.
pub(super) fn turn_ons(report: &CalibrationReport) -> Option<Section> {
    let mut items = Vec::new();
    let rows = report.runs.iter().filter_map(|run| {
        let offsets = run.turn_on?;
        let offsets = offsets.map(|one| format::estimate(one.estimate, one.sigma).join(" ± "));
        Some([vec![run.record.clone()], offsets.into()].concat())
    });
    let columns = Column::heads("record | > gyro_x.bias | > gyro_y.bias | > gyro_z.bias");
    let title = "Offsets of the turn-ons from the mean constant drifts, deg/h";
    let offsets = Table::new(title, columns, rows);
    // Constant drifts of one record are not their means over turn-ons.
    let differ = !offsets.rows.is_empty();
    items.extend(differ.then(|| Item::from(offsets)));
    if let Some(alone) = &report.first_record_sigmas {
        let rows = report.coefficients.iter().zip(alone).enumerate();
        let rows = rows.filter(|(place, _)| !(differ && BIASES.contains(place)));
        let rows = rows.map(|(_, (one, alone))| {
            let [_, first] = format::estimate(0.0, *alone);
            let [_, all] = format::estimate(0.0, one.sigma);
            let ratio = format!("{:.2}", one.sigma / alone);
            [one.name.clone(), first, all, ratio, one.unit.clone()]
        });
        let columns = "coefficient | > first record alone | > all together | > ratio | unit";
        let title = "Sigmas from the first record alone and from all records";
        items.push(Table::new(title, Column::heads(columns), rows).into());
    }
    let lead = "What differs between the records, and what they give together.";
    (!items.is_empty()).then(|| section("turn-ons", "Several records", lead, items))
}

/// Sensitivity to errors of the site.
pub(super) fn site(report: &CalibrationReport) -> Section {
    let mut all: Vec<ConsiderSensitivity> = report.site.iter().filter_map(sensitivity).collect();
    // What a bench description can declare comes first.
    all.sort_by_key(|one| one.quantity != SiteQuantity::Latitude);
    let mut items = Vec::new();
    if report.method != CalibrationMethod::Batch {
        items.push(Item::text(
            "The streaming filter takes latitude, Earth rate and gravity as exact; latitude must be the astronomic \
             one. The batch estimator reports the sensitivity to their errors.",
        ));
    }
    let latitude = all
        .iter()
        .find(|one| one.quantity == SiteQuantity::Latitude);
    items.extend(latitude.map(|one| {
        Item::text(format!(
            "{} {}",
            assumed(report, one),
            of_records(report, one)
        ))
    }));
    if !all.is_empty() {
        let mut columns = vec![Column::words("coefficient")];
        for one in &all {
            columns.extend([
                Column::numbers(&site_error(one)),
                Column::numbers("in sigmas"),
            ]);
        }
        let rows = report.coefficients.iter().enumerate().map(|(place, own)| {
            let biases = all.iter().flat_map(|one| {
                let bias = one.biases()[place];
                [format!("{bias:+.1e}"), format!("{:+.2}", bias / own.sigma)]
            });
            let mut row = vec![format!("{} [{}]", own.name, own.unit)];
            row.extend(biases);
            row
        });
        items.push(Table::new("Biases by errors of the site", columns, rows).into());
    }
    section(
        "site",
        "Site",
        "Sensitivity to errors of the site of the first record, which the residuals do not show: bias of each \
         coefficient by an error, in its unit and in standard deviations of the estimate.",
        items,
    )
}

fn sensitivity(of: &SiteReport) -> Option<ConsiderSensitivity> {
    Some(ConsiderSensitivity {
        quantity: match &*of.quantity {
            "latitude" => SiteQuantity::Latitude,
            "earth_rate" => SiteQuantity::EarthRate,
            "gravity" => SiteQuantity::Gravity,
            _ => return None,
        },
        declared_sigma: of.declared_sigma,
        from_record_sigma: of.from_record_sigma.unwrap_or(f64::INFINITY),
        bias_per_unit: of.bias_per_unit.as_slice().try_into().ok()?,
    })
}

/// Name and size of an error of the site.
fn site_error(of: &ConsiderSensitivity) -> String {
    let error = of.assumed_error();
    let size = match of.quantity {
        SiteQuantity::Latitude => format!("latitude +{:.3} arcsec", 3600.0 * error),
        SiteQuantity::EarthRate => format!("Earth rate +{error:.1e}"),
        SiteQuantity::Gravity => format!("gravity +{error:.1e}"),
        _ => format!("+{error:.1e}"),
    };
    match of.declared_sigma {
        Some(_) => format!("{size} (1 sigma)"),
        None => size,
    }
}

fn assumed(report: &CalibrationReport, latitude: &ConsiderSensitivity) -> String {
    if let Some(sigma) = latitude.declared_sigma {
        return format!(
            "Latitude is known to {:.3} arcsec (latitude_sigma_deg); the sigmas include its uncertainty.",
            3600.0 * sigma
        );
    }
    let biases = latitude.biases().into_iter().zip(&report.coefficients);
    let largest = biases.max_by(|(a, of_a), (b, of_b)| {
        let [a, b] = [(a / of_a.sigma).abs(), (b / of_b.sigma).abs()];
        a.total_cmp(&b)
    });
    let largest = largest.map_or_else(String::new, |(bias, one)| {
        let (bias, in_sigmas) = (bias.abs(), (bias / one.sigma).abs());
        format!(
            " and {} by {bias:.1e} {} ({in_sigmas:.2} sigma)",
            one.name, one.unit
        )
    });
    format!(
        "Latitude is taken as exact, because the bench file gives no latitude_sigma_deg, and must be the astronomic \
         one: an error of 1 arcsec shifts the mean of the three D_I by {:.1e} deg/h/g{largest}, which no sigma \
         includes.",
        latitude.mean_g_bias_deg_per_h_per_g(),
    )
}

fn of_records(report: &CalibrationReport, latitude: &ConsiderSensitivity) -> String {
    let [alone, determine] = match report.runs.len() {
        0 | 1 => ["The record alone", "determines"],
        _ => ["The records alone", "determine"],
    };
    let sigma = latitude.from_record_sigma;
    if !sigma.is_finite() {
        return format!("{alone} cannot determine latitude.");
    }
    let better = match latitude.declared_sigma {
        Some(declared) if sigma < declared => ", better than declared",
        _ => "",
    };
    format!(
        "{alone} {determine} latitude to {:.1} arcsec (1 sigma){better}.",
        3600.0 * sigma
    )
}
