//! The tests beside the search: magnitude, filter, whiteness, Allan deviation, noise audit.

use gyrocal_record::AXES;
use gyrocal_statistics::format::p_bound;

use crate::format::{counted, duration, short, tested, with_sigma};
use gyrocal_answer::{
    AllanCourse, Answer, FindingKind, ResidualTest, ResidualVerdict, UnmodelledPattern,
    UnmodelledTerm, Verdict,
};

/// Sigmas of the mean magnitude below which an error would not be detected.
const DETECTABLE_SIGMAS: f64 = 4.0;

/// Magnitude test of specific force.
pub(super) fn magnitude(result: &Answer) -> String {
    let Some(test) = &result.norm else {
        return "Specific-force magnitude test: not made, too few rows have all three axes."
            .to_owned();
    };
    let p = p_bound(test.p_value);
    if test.accelerometers {
        return format!(
            "Specific-force magnitude test: not gravity, {} ({p}). An accelerometer, or gravity, is \
             other than declared: no gyro and no attitude enters this test.",
            test.description
        );
    }
    let consistent = format!(
        "Specific-force magnitude test: consistent with gravity (mean offset {:.1e} ± {:.1e} g, {p}).",
        test.mean_g, test.mean_sigma_g
    );
    let causes = result.findings.iter().any(|f| f.kind == FindingKind::Cause);
    if causes || result.verdict == Verdict::Unexplained {
        format!(
            "{consistent} The fault is in the gyros, attitude or site, or in an accelerometer error \
             that is below {:.0e} g or leaves the magnitude unchanged.",
            DETECTABLE_SIGMAS * test.mean_sigma_g
        )
    } else {
        consistent
    }
}

/// Consistency test of another filter.
pub(super) fn filter(result: &Answer) -> Option<String> {
    let test = result.filter.as_ref()?;
    let [low, high] = test.nis_band;
    let reference = test.reference_nis_mean;
    let band = format!("99.9 % band {low:.3} to {high:.3}");
    let inconsistent = result
        .findings
        .iter()
        .any(|f| f.kind == FindingKind::Filter);
    Some(match (test.nis_mean, &test.stopped) {
        (Some(mean), _) if inconsistent => format!(
            "Consistency of the paper's filter: failed. Mean NIS {mean:.1} ({band}); the filter of \
             this program has {reference:.3}. One Euler step a sample, with Euler angles as states, \
             is too coarse for this record: its coefficients and sigmas are invalid."
        ),
        (Some(mean), _) => format!(
            "Consistency of the paper's filter: its integration rule is not at fault. Mean NIS \
             {mean:.3} ({band}); the filter of this program has {reference:.3}."
        ),
        (None, stopped) => format!(
            "Consistency of the paper's filter: it stopped {}. The filter of this program has mean \
             NIS {reference:.3} ({band}).",
            stopped.as_deref().unwrap_or("before it had an answer")
        ),
    })
}

/// Whiteness of the innovations.
pub(super) fn whiteness(result: &Answer) -> String {
    let test = &result.remainder;
    let p = tested(test.p_value);
    match test.verdict {
        ResidualVerdict::Unexplained => format!(
            "Whiteness: failed ({p}). Unexplained: {}. No effect of the catalogue does this; \
             docs/adding-a-term.md adds one.",
            test.description
        ),
        ResidualVerdict::NotTested => format!(
            "Whiteness: not tested for {}. Too few rows without a gap have all three axes.",
            test.description
        ),
        ResidualVerdict::White => {
            let causes = result.findings.iter().any(|f| f.kind == FindingKind::Cause);
            let extended = result.coefficients.as_ref();
            let model = if extended.is_some_and(|coefficients| coefficients.extended.is_some()) {
                "extended model"
            } else if causes {
                "model with all causes"
            } else {
                "nominal model"
            };
            format!(
                "Whiteness: passed. The innovations of the {model} are white up to the Nyquist \
                 frequency ({p})."
            )
        }
    }
}

/// Allan deviation of the innovations.
pub(super) fn allan(result: &Answer) -> String {
    let Some(test) = &result.allan else {
        return "Allan deviation: not computed, no stretch of rows without a gap and with all axes \
                is long enough."
            .to_owned();
    };
    let p = p_bound(test.p_value);
    let course = match test.course {
        AllanCourse::White => {
            let longest = test.points.last().map_or(0.0, |point| point.tau_s);
            return format!(
                "Allan deviation of the innovations follows white noise of the estimated level up \
                 to {} ({p}).",
                duration(longest)
            );
        }
        AllanCourse::LargerWhite => "follows white noise above the estimated level",
        AllanCourse::Flicker => "stops falling (flicker, or a slow process)",
        AllanCourse::Slow => "rises (a random walk, or a slow process)",
    };
    // The largest excess over white noise.
    let largest = test
        .points
        .iter()
        .flat_map(|point| {
            (0..3).map(move |axis| (point.deviation[axis] / point.white, point, axis))
        })
        .max_by(|a, b| a.0.total_cmp(&b.0));
    let Some((factor, point, axis)) = largest else {
        return format!("Allan deviation of the innovations {course} ({p}).");
    };
    format!(
        "Allan deviation of the innovations {course}: at {} it is {} times that of white noise in \
         channel {} ({p}). This is reported and makes no finding.",
        duration(point.tau_s),
        short((100.0 * factor).round() / 100.0),
        AXES[axis]
    )
}

/// Noise audit of the accelerometers.
pub(super) fn noise_audit(result: &Answer) -> Option<String> {
    let audit = result.noise_audit.as_ref()?;
    let mut parts = vec![match audit.correlation {
        Some(found) => format!(
            "lag-1 correlation {}",
            with_sigma(found.estimate, found.sigma)
        ),
        None => "the record is too short for a spectrum of the noise".to_owned(),
    }];
    parts.push(match audit.outliers {
        0 => "no outliers".to_owned(),
        count => format!("{}, left out", counted(count, "outlier")),
    });
    let gaps = &result.record.gaps;
    if gaps.count > 0 {
        parts.push(format!(
            "{} with {} s missing, the longest interval {} s",
            counted(gaps.count, "gap"),
            short(gaps.missing_s),
            short(gaps.longest_s)
        ));
    }
    if gaps.missing_values > 0.0 {
        parts.push(format!(
            "{} % of the values missing",
            short(100.0 * gaps.missing_values)
        ));
    }
    Some(format!(
        "Noise audit of the accelerometers: {}.",
        parts.join("; ")
    ))
}

/// The structure that a residual test found, or the tests that it could not make; empty if the
/// innovations are white.
#[must_use]
pub fn residual_description(test: &ResidualTest) -> String {
    match test.verdict {
        ResidualVerdict::White => String::new(),
        ResidualVerdict::NotTested => {
            let missing = [
                (test.line.is_none(), "spectral lines"),
                (
                    test.correlation.is_none(),
                    "correlation of neighbouring rows",
                ),
            ];
            let missing = missing.iter().filter(|(missing, _)| *missing);
            let missing: Vec<&str> = missing.map(|(_, test)| *test).collect();
            missing.join(" and ")
        }
        ResidualVerdict::Unexplained => {
            let line = test.line.as_ref().filter(|line| line.significant);
            let line = line.map(|line| {
                format!(
                    "a spectral line in the innovations of channel {} with a period of {:.2} h and \
                     an amplitude of {:.2} sigma",
                    line.channel, line.period_h, line.amplitude
                )
            });
            let correlation = test.correlation.filter(|found| found.significant);
            let correlation = correlation.map(|found| {
                format!(
                    "innovations of neighbouring rows are correlated (Ljung-Box {:.0} for {} degrees \
                     of freedom)",
                    found.ljung_box, found.degrees_of_freedom
                )
            });
            let terms = test.unmodelled.iter().map(unmodelled);
            let all: Vec<String> = line.into_iter().chain(correlation).chain(terms).collect();
            all.join("; ")
        }
    }
}

/// A term that the catalogue does not hold.
fn unmodelled(term: &UnmodelledTerm) -> String {
    let channel = match term.channel.split_once('_') {
        Some(("gyro", axis)) => format!("drift of gyro {axis}"),
        Some(("accel", axis)) => format!("reading of accelerometer {axis}"),
        _ => term.channel.clone(),
    };
    let (size, unit) = (term.size, &term.unit);
    match (term.pattern, term.period_h, &term.depends_on) {
        (UnmodelledPattern::Line, Some(period_h), _) => format!(
            "a line in the {channel} with a period of {period_h:.2} h and an amplitude of {size:.2e} \
             {unit}"
        ),
        (UnmodelledPattern::Curve, _, Some(axis)) => format!(
            "the {channel} depends on specific force along {axis} as no polynomial of the catalogue \
             does, {size:.2e} {unit} rms"
        ),
        _ => format!("a term in the {channel} of {size:.2e} {unit}"),
    }
}
