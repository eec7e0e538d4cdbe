//! The tables of an answer.

use gyrocal_record::AXES;
use gyrocal_statistics::format::{self, p_cell};

use super::catalogue::is_correlation;
use super::findings::value;
use crate::format::with_sigma;
use gyrocal_answer::{
    Answer, CoefficientEstimate, Coefficients, Finding, FindingKind, Gain, NoiseLevel, Residuals,
};
use gyrocal_document::{Column, Table};

/// Rows of the ranking that are shown.
const TOP: usize = 12;

/// An interval that spans more than this factor says that the record does not determine the noise.
const UNDETERMINED: f64 = 100.0;

/// What the nominal model leaves of the record, and the noise.
pub fn residuals(result: &Answer) -> impl Iterator<Item = Table> {
    let of_nominal = result.residuals.as_ref().map(of_nominal);
    of_nominal.into_iter().chain(noise(result))
}

/// The detected effects with size, significance and gain; `None` without any.
#[must_use]
pub fn findings(result: &Answer) -> Option<Table> {
    let heads = "effect | parameter | > estimate | unit | > z | > p | > gain, nats";
    let mut rows = Vec::new();
    for finding in &result.findings {
        let mut head = [
            finding.effect.clone(),
            format!("{:.1}", finding.z),
            finding.p_value.map_or("not computed".to_owned(), p_cell),
            gain(finding),
        ];
        let parameters = finding.parameters.iter();
        let parameters = parameters.map(|one| [one.name.clone(), value(one), one.unit.clone()]);
        let mut parameters: Vec<[String; 3]> = parameters.collect();
        if parameters.is_empty() {
            parameters.push(Default::default());
        }
        for [name, value, unit] in parameters {
            let [effect, z, p, gain] = core::mem::take(&mut head);
            rows.push(vec![effect, name, value, unit, z, p, gain]);
        }
    }
    Table::of("Size and significance", heads, rows).filled()
}

/// The coefficients of the extended model with their intervals over the sets; `None` if no effect was accepted.
#[must_use]
pub fn over_sets(shown: &Coefficients) -> Option<Table> {
    let over_set = shown.over_set.as_ref()?;
    let extended = shown.extended.as_ref()?;
    let of = |one: &CoefficientEstimate| with_sigma(one.estimate, one.sigma);
    let all = shown.nominal.iter().zip(extended).zip(over_set);
    let rows = all.map(|((nominal, extended), over_set)| {
        // Digits as those of the sigma.
        let [low, high] = over_set
            .interval
            .map(|end| format::estimate(end, over_set.sigma)[0].clone());
        vec![
            nominal.name.clone(),
            of(nominal),
            of(extended),
            format!("{low} to {high}"),
            nominal.unit.clone(),
        ]
    });
    Some(Table::of(
        "Drift coefficients, noise as estimated; the 95 % interval is over all members of the confidence sets, \
                weighted by their likelihoods",
        "coefficient | > nominal model | > extended model | > 95 % interval | unit",
        rows,
    ))
}

/// Gain of a cause; effects of noise and filter have none.
fn gain(finding: &Finding) -> String {
    match (finding.gain_nats, finding.accepted) {
        (Some(nats), Some(false)) => format!("{nats:+.1}, not in the model"),
        (Some(nats), _) => format!("{nats:+.1}"),
        (None, Some(_)) => "not judged".to_owned(),
        (None, _) => String::new(),
    }
}

fn of_nominal(shown: &Residuals) -> Table {
    let mut rows: Vec<Vec<String>> = Vec::new();
    let mut row = |name: &str, cells: [String; 3]| {
        rows.push([name.to_owned()].into_iter().chain(cells).collect());
    };
    let rms = shown.free_run_rms_g.map(|rms| format!("{rms:.2e}"));
    row("open-loop simulation error, g rms", rms);
    let correlation = shown.autocorrelation.as_ref();
    if let Some(first) = correlation.and_then(|found| found.correlation.first()) {
        let first = first.map(|correlation| format!("{correlation:+.3}"));
        row("lag-1 correlation", first);
    }
    for against in &shown.against {
        let covariate = match against.abscissa.as_str() {
            "time_s" => "time",
            "temperature_c" => "temperature",
            "force_x_g" => "specific force along x",
            "force_y_g" => "specific force along y",
            "force_z_g" => "specific force along z",
            other => other,
        };
        let name = format!("regression on {covariate}, p");
        row(&name, against.p_value.map(p_cell));
    }
    Table::new("Residuals of the nominal model", by_axis(), rows)
}

/// The first effects of the search by their statistics; `None` without a search.
#[must_use]
pub fn ranking(result: &Answer) -> Option<Table> {
    let all = result.ranking.len();
    let threshold = result.threshold.map_or_else(String::new, |threshold| {
        format!("; detection threshold {threshold:.1}")
    });
    let title = format!(
        "Top {} of {all} hypotheses, score statistic (chi-square, penalised for the search over onset or time \
         constant){threshold}",
        all.min(TOP)
    );
    let rows = result.ranking.iter().take(TOP).map(|ranked| {
        let statistic = format!("{:.1}", ranked.statistic);
        let role = role(result, &ranked.effect);
        [ranked.effect.clone(), statistic, role]
    });
    Table::of(&title, "effect | > statistic | ", rows).filled()
}

/// Role of a ranked effect in the answer.
fn role(result: &Answer, effect: &str) -> String {
    for finding in &result.findings {
        if finding.effect == effect {
            return "detected".to_owned();
        }
        let mut others = finding.alternatives.iter();
        if others.any(|other| other.effect == effect) {
            return format!("alternative to {}", finding.effect);
        }
    }
    String::new()
}

/// Changes of the coefficients by the effects in the model.
#[must_use]
pub fn shifts(gain: &Gain) -> Table {
    let rows = gain.coefficient_shift.iter().map(|shift| {
        [
            shift.coefficient.clone(),
            format!("{:+.2e}", shift.shift),
            format!("{:+.1}", shift.in_sigmas),
            shift.unit.clone(),
        ]
    });
    let effects = gain.effects.join(", ");
    let title = format!("Coefficient changes with {effects} in the model");
    Table::of(&title, "coefficient | > change | > in sigmas | unit", rows)
}

fn noise(result: &Answer) -> Option<Table> {
    let extended = result.coefficients.as_ref();
    let model = match extended.is_some_and(|coefficients| coefficients.extended.is_some()) {
        true => "extended model",
        false => "nominal model",
    };
    // Channels of a sensor are in the order of the axes.
    let row = |name: &str, sensor: &str| -> Vec<String> {
        let all = result.noise.iter();
        let own = all.filter(|level| level.channel.starts_with(sensor));
        [name.to_owned()]
            .into_iter()
            .chain(own.map(interval))
            .collect()
    };
    // The likelihood of white noise takes the slow part of correlated noise for that of the gyros.
    let mut of_noise = result.of_kind(FindingKind::Noise);
    let is_correlated = of_noise.any(|finding| is_correlation(&finding.effect));
    let gyros = (!is_correlated).then(|| row("gyros", "gyro_"));
    let of_gyros = match is_correlated {
        true => "; no row for the gyros, as the noise of the accelerometers is correlated",
        false => "",
    };
    let title = format!("Estimated / declared noise (95 % CI), {model}{of_gyros}");
    let accelerometers = [row("accelerometers", "accel_")].into_iter();
    let table = Table::new(&title, by_axis(), accelerometers.chain(gyros));
    (!result.noise.is_empty()).then_some(table)
}

fn interval(found: &NoiseLevel) -> String {
    let [low, high] = found.interval;
    if high <= UNDETERMINED * found.ratio {
        format!("{:.3} ({low:.3} to {high:.3})", found.ratio)
    } else {
        "not determined".to_owned()
    }
}

/// A column for names, then one for each axis.
fn by_axis() -> Vec<Column> {
    let axes = AXES.iter().map(|axis| Column::numbers(axis));
    core::iter::once(Column::words("")).chain(axes).collect()
}
