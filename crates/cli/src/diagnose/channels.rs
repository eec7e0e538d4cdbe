//! What is told beside the findings: the norm channel, and how noise averages out.

use gyrocal::EFFECTS;
use gyrocal::effect::EffectKind;
use gyrocal_diagnosis::MagnitudeTest;
use gyrocal_record::{
    AllanCourse, AllanPointReport, AllanReport, DiagnosisReport, DiagnosisVerdict, NormReport,
};
use gyrocal_statistics::{AllanTest, NoiseCourse, format};

/// Sigmas of the mean norm below which an error would not be seen.
const SEEN: f64 = 4.0;

const AXES: [&str; 3] = ["x", "y", "z"];

pub(super) fn norm(verdict: &MagnitudeTest) -> NormReport {
    NormReport {
        accelerometers: verdict.accelerometers,
        p_value: verdict.p_value,
        mean_g: verdict.mean_g,
        mean_sigma_g: verdict.mean_sigma_g,
        description: verdict.description.clone(),
    }
}

pub(super) fn allan(test: &AllanTest) -> AllanReport {
    let [x, y, z] = &test.points;
    AllanReport {
        course: match test.course {
            NoiseCourse::White => AllanCourse::White,
            NoiseCourse::LargerWhite => AllanCourse::LargerWhite,
            NoiseCourse::Flicker => AllanCourse::Flicker,
            // A course without a word of its own is at least not white.
            _ => AllanCourse::Slow,
        },
        p_value: test.p_value,
        rows: test.rows,
        points: x
            .iter()
            .zip(y.iter().zip(z))
            .map(|(x, (y, z))| AllanPointReport {
                tau_s: x.tau_s,
                white: (x.averaging as f64).sqrt().recip(),
                deviation: [x.deviation, y.deviation, z.deviation],
                interval: [x.interval, y.interval, z.interval],
            })
            .collect(),
    }
}

/// Which side the norm of specific force speaks for.
pub(super) fn norm_in_words(report: &DiagnosisReport) -> String {
    let Some(norm) = &report.norm else {
        return "The norm of specific force has too few complete rows to say anything.".to_owned();
    };
    let p = format::p_value(norm.p_value);
    if norm.accelerometers {
        return format!(
            "The norm of specific force says: the accelerometers' side. No gyro and no attitude \
             enters it, and {} ({p}): an accelerometer, or gravity, is other \
             than declared.",
            norm.description
        );
    }
    let within = format!(
        "it is gravity's within its noise, {:.1e} ± {:.1e} g off on average ({p})",
        norm.mean_g, norm.mean_sigma_g
    );
    let physical = report.findings.iter().any(|finding| {
        let row = EFFECTS.iter().find(|row| row.id == finding.effect);
        !row.is_some_and(|row| matches!(row.kind, EffectKind::Noise(_) | EffectKind::Integration))
    });
    if physical || report.verdict == DiagnosisVerdict::Unexplained {
        format!(
            "The norm of specific force says: not the accelerometers' side. No gyro and no attitude \
             enters it, and {within}. What is wrong is wrong with gyros, attitude or site, unless \
             it is an error of the accelerometers that leaves the norm alone or is below some \
             {:.0e} g.",
            SEEN * norm.mean_sigma_g
        )
    } else {
        format!("The norm of specific force shows no error of the accelerometers: {within}.")
    }
}

/// How what is left averages out.
pub(super) fn allan_in_words(report: &DiagnosisReport) -> String {
    let Some(allan) = &report.allan else {
        return "No stretch of rows without a gap and with all axes is long enough for an Allan \
                deviation of it."
            .to_owned();
    };
    let p = format::p_value(allan.p_value);
    let longest = allan.points.last().map_or(0.0, |point| point.tau_s);
    let course = match allan.course {
        AllanCourse::White => {
            return format!(
                "Averaged over up to {}, it falls as white noise of the believed size does \
                 (Allan deviation; {p}).",
                duration(longest)
            );
        }
        AllanCourse::LargerWhite => "falls as white noise does, but is larger than believed",
        AllanCourse::Flicker => "does not fall: flicker, or something slow",
        _ => "rises: a random walk, or something slow",
    };
    // Where the excess over white noise is largest.
    let most = allan
        .points
        .iter()
        .flat_map(|point| {
            (0..3).map(move |axis| (point.deviation[axis] / point.white, point, axis))
        })
        .max_by(|a, b| a.0.total_cmp(&b.0));
    let Some((factor, point, axis)) = most else {
        return String::new();
    };
    format!(
        "Averaged, it {course}: in channel {} its Allan deviation over {} is {} times that of \
         white noise ({p}). That is told, not counted as a finding.",
        AXES[axis],
        duration(point.tau_s),
        format::short((100.0 * factor).round() / 100.0, 4)
    )
}

fn duration(seconds: f64) -> String {
    if seconds < 3600.0 {
        format!("{} s", format::short(seconds, 4))
    } else {
        format!("{} h", format::short((seconds / 360.0).round() / 10.0, 4))
    }
}
