//! The tests beside the search, in one table.

use gyrocal_answer::{AllanCourse, Answer, FilterTest, ResidualTest, ResidualVerdict, Residuals};
use gyrocal_document::Table;
use gyrocal_record::AXES;
use gyrocal_statistics::format::{self, p_cell, short};
use gyrocal_words::{counted, time};

/// Name of the test of correlation.
const LJUNG_BOX: &str = "correlation over rows (Ljung-Box)";
/// Sigmas of the mean magnitude below which an error would not be detected.
const DETECTABLE_SIGMAS: f64 = 4.0;

/// Model, name, what was found, and p; `None` of one that has none.
type Test = (&'static str, String, String, Option<f64>);

/// The tests in a table.
pub(super) fn table(result: &Answer) -> Table {
    let duration_h = result.record.duration_s / 3600.0;
    let mut all = Vec::new();
    if let Some(residuals) = &result.residuals {
        all.extend(of_nominal(residuals, duration_h));
    }
    all.extend(of_remainder(&result.remainder, duration_h));
    all.push(allan(result));
    all.extend(result.filter.as_ref().map(of_filter));
    all.extend(of_accelerometers(result));
    let rows = all.into_iter().map(|(model, name, found, p)| {
        let p = p.map_or_else(String::new, p_cell);
        [model.to_owned(), name, found, p]
    });
    let title = "Tests, and probability of as much by chance";
    Table::of(title, "model | test | found | > p", rows)
}

fn ljung_box(statistic: f64, degrees_of_freedom: usize) -> String {
    format!("{statistic:.0} for {degrees_of_freedom} degrees of freedom")
}

fn line_of(period_h: f64, amplitude: f64, duration_h: f64) -> String {
    let period = match period_h > duration_h {
        true => "period longer than the record".to_owned(),
        false => format!("period {}", time(3600.0 * period_h)),
    };
    format!("{period}, amplitude {} σ", short(amplitude, 2))
}

fn of_nominal(residuals: &Residuals, duration_h: f64) -> Vec<Test> {
    let mut tests = Vec::new();
    let mut add = |name: &str, found, p| tests.push(("nominal", name.to_owned(), found, Some(p)));
    if let Some(nis) = &residuals.nis {
        let [low, high] = nis.band;
        let found = format!(
            "{:.3} (band {low:.3} to {high:.3}), {} in {}",
            nis.mean,
            counted(nis.values, "value"),
            counted(nis.rows, "row")
        );
        add("mean normalised innovation squared", found, nis.p_value);
    }
    if let Some(all) = &residuals.autocorrelation {
        let found = ljung_box(all.ljung_box, all.degrees_of_freedom);
        add(LJUNG_BOX, found, all.p_value);
    }
    for (line, axis) in residuals.lines.iter().flatten().zip(AXES) {
        let found = line_of(line.period_h, line.amplitude, duration_h);
        let name = format!("largest spectral line, axis {axis}");
        add(&name, found, line.p_value);
    }
    tests
}

fn of_remainder(remainder: &ResidualTest, duration_h: f64) -> Vec<Test> {
    let mut tests = Vec::new();
    let mut add = |name: &str, found, p| tests.push(("with all causes", name.to_owned(), found, p));
    if let Some(line) = &remainder.line {
        let found = line_of(line.period_h, line.amplitude, duration_h);
        let found = format!("axis {}, {found}", line.channel);
        add("largest spectral line", found, Some(line.p_value));
    }
    if let Some(all) = &remainder.correlation {
        let found = ljung_box(all.ljung_box, all.degrees_of_freedom);
        add(LJUNG_BOX, found, Some(all.p_value));
    }
    for term in &remainder.unmodelled {
        let name = format!("outside of the catalogue, {}", term.channel);
        let size = format!("{} {}", format::significant(term.size, 3), term.unit);
        add(&name, size, Some(term.p_value));
    }
    let found = match remainder.verdict {
        ResidualVerdict::White => "white".to_owned(),
        ResidualVerdict::NotTested => format!("not tested for {}", remainder.description),
        ResidualVerdict::Unexplained => format!("unexplained: {}", remainder.description),
    };
    add("all residual tests together", found, remainder.p_value);
    tests
}

/// Allan deviation of the innovations, which makes no finding.
fn allan(result: &Answer) -> Test {
    let told = |found: String, p| ("reported only", "Allan deviation".to_owned(), found, p);
    let Some(test) = &result.allan else {
        let why = "not computed: no stretch of rows without a gap and with all axes is long enough";
        return told(why.to_owned(), None);
    };
    let course = match test.course {
        AllanCourse::White => {
            let longest = test.points.last().map_or(0.0, |point| point.tau_s);
            let longest = time(longest);
            let found = format!("white noise of the estimated level up to {longest}");
            return told(found, Some(test.p_value));
        }
        AllanCourse::LargerWhite => "white noise above the estimated level",
        AllanCourse::Flicker => "stops falling (flicker, or a slow process)",
        AllanCourse::Slow => "rises (a random walk, or a slow process)",
    };
    // The largest excess over white noise.
    let excess = test.points.iter().flat_map(|point| {
        let of_axis = |axis: usize| (point.deviation[axis] / point.white, point.tau_s, axis);
        (0..3).map(of_axis)
    });
    let largest = excess.max_by(|a, b| a.0.total_cmp(&b.0));
    let at = largest.map_or_else(String::new, |(factor, tau_s, axis)| {
        format!(
            "; at {} {} times that of white noise, axis {}",
            time(tau_s),
            short((100.0 * factor).round() / 100.0, 4),
            AXES[axis]
        )
    });
    told(format!("{course}{at}"), Some(test.p_value))
}

/// Consistency of another filter.
fn of_filter(test: &FilterTest) -> Test {
    let [low, high] = test.nis_band;
    let found = match (test.nis_mean, &test.stopped) {
        (Some(mean), _) => format!("{mean:.3}"),
        (None, Some(stopped)) => format!("stopped {stopped}"),
        (None, None) => "stopped before it had an answer".to_owned(),
    };
    let found = format!(
        "{found} (99.9 % band {low:.3} to {high:.3}); the filter of this program {:.3}",
        test.reference_nis_mean
    );
    let name = "mean NIS with one Euler step a sample".to_owned();
    ("filter of the paper", name, found, None)
}

/// Magnitude test and noise audit, in which no gyro and no attitude enters.
fn of_accelerometers(result: &Answer) -> Vec<Test> {
    let mut tests = Vec::new();
    let mut add = |name: &str, found, p| tests.push(("none", name.to_owned(), found, p));
    let (magnitude, p) = match &result.norm {
        None => (
            "not tested: too few rows have all three axes".to_owned(),
            None,
        ),
        Some(test) if test.accelerometers => (
            format!("not gravity: {}", test.description),
            Some(test.p_value),
        ),
        Some(test) => (
            format!(
                "gravity: mean offset {:.1e} ± {:.1e} g; an error of {:.0e} g would show",
                test.mean_g,
                test.mean_sigma_g,
                DETECTABLE_SIGMAS * test.mean_sigma_g
            ),
            Some(test.p_value),
        ),
    };
    let name = "magnitude of specific force (accelerometers alone)";
    add(name, magnitude, p);
    let Some(audit) = &result.noise_audit else {
        return tests;
    };
    let lag_1 = match audit.correlation {
        Some(found) => format::estimate(found.estimate, found.sigma).join(" ± "),
        None => "not tested: the record is too short for a spectrum of its noise".to_owned(),
    };
    add("noise, lag-1 correlation", lag_1, None);
    let outliers = match audit.outliers {
        0 => "no outliers".to_owned(),
        count => format!("{}, left out", counted(count, "outlier")),
    };
    add("noise, outliers", outliers, None);
    let gaps = &result.record.gaps;
    if gaps.count > 0 {
        let found = format!(
            "{} with {} s missing, the longest interval {} s",
            counted(gaps.count, "gap"),
            short(gaps.missing_s, 4),
            short(gaps.longest_s, 4)
        );
        add("gaps", found, None);
    }
    if gaps.missing_values > 0.0 {
        let share = short(100.0 * gaps.missing_values, 4);
        let found = format!("{share} % of the values missing");
        add("missing values", found, None);
    }
    tests
}
