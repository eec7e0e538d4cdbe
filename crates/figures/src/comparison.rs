//! The diagnosis and four usual methods on the same records: two tests of the innovations, and two ways
//! to select terms from a library of signatures. What the diagnosis detects and names has its targets in the part
//! [`naming`](crate::naming), of more records.

use gyrocal_evaluation::{Answer, BaselineMethod, OWN_METHOD, RecordScore};

use crate::harness::{COVERAGE, COVERAGE_REASON, Context, Error, Figure, Row};
use crate::naming::{CLEAN, WITH_EFFECT, population};

/// Columns of the comparison; a figure is `METHOD: COLUMN`.
const COLUMNS: [&str; 7] = [
    "false alarms on clean records",
    "detected at d = 8",
    "truth is the first name",
    "truth among the names",
    "names told, mean of the detections",
    "95 % intervals of coefficients that hold the truth",
    "a coefficient more than 4 σ wrong",
];

/// Errors of a coefficient above this, in sigmas, are counted.
const FAR_SIGMAS: f64 = 4.0;

/// A method; `None` is the diagnosis.
type Method = Option<BaselineMethod>;

const METHODS: [Method; 5] = [
    Some(BaselineMethod::Nis),
    Some(BaselineMethod::LjungBox),
    Some(BaselineMethod::Bic),
    Some(BaselineMethod::Stls),
    None,
];

fn name(method: Option<BaselineMethod>, column: usize) -> String {
    let method = method.map_or(OWN_METHOD, BaselineMethod::name);
    format!("{method}: {}", COLUMNS[column])
}

/// All figures of the part.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let alarms = METHODS.map(|method| share(method, 0, |answer| answer.detected));
    let mut figures = context.measure(&population(CLEAN), &alarms)?;
    let rows: Vec<_> = METHODS.into_iter().flat_map(with_effect).collect();
    figures.extend(context.measure(&population(WITH_EFFECT), &rows)?);
    Ok(figures)
}

/// Rows of the records with an effect.
fn with_effect(method: Option<BaselineMethod>) -> Vec<Row<'static, RecordScore>> {
    let mut rows = vec![share(method, 1, |answer| answer.detected)];
    if method.is_none_or(BaselineMethod::identifies_effects) {
        rows.extend([
            share(method, 2, |answer| answer.first_cosine >= 1.0),
            share(method, 3, |answer| answer.all_named),
            mean(method, 4, |of| of.detected.then_some(of.names as f64)),
        ]);
    }
    // The nine of one record err together: their mean counts once.
    let coverage = mean(method, 5, |of| Some(of.coefficients?.covered as f64 / 9.0));
    rows.push(match method {
        None => coverage.at_least(COVERAGE[0], COVERAGE_REASON),
        Some(_) => coverage,
    });
    rows.push(share(method, 6, |answer| {
        let coefficients = answer.coefficients;
        coefficients.is_none_or(|of| of.largest_error > FAR_SIGMAS)
    }));
    rows
}

/// The answer of a method on a record that all are applied to.
fn answer(method: Method, record: &RecordScore) -> Option<Answer> {
    let is_compared = !record.methods.is_empty();
    is_compared.then(|| Answer::of(method, record)).flatten()
}

fn share(method: Method, column: usize, of: fn(&Answer) -> bool) -> Row<'static, RecordScore> {
    let of = move |record: &RecordScore| Some(of(&answer(method, record)?));
    Row::share(name(method, column), of)
}

fn mean(
    method: Method,
    column: usize,
    of: fn(&Answer) -> Option<f64>,
) -> Row<'static, RecordScore> {
    let of = move |record: &RecordScore| of(&answer(method, record)?);
    Row::mean(name(method, column), of)
}

/// The figures side by side, with the terms explained.
pub(crate) fn side_by_side(figures: &[Figure]) -> String {
    let mut text = format!(
        "All methods see the same records, the first of two cells, with the noise as declared; \
         [characteristics.md](../characteristics.md) describes the records and the methods. All \
         columns but the first refer to records with one effect of the catalogue, of 8 standard \
         deviations of its own bound. A test names nothing. `gyrocal` names sets: its first name \
         is the first member of its first set. The coefficients are the nine of the model that a \
         method ends with: the nominal model of a test, the model with the selected effects of \
         `bic` and `stls`, the members of the sets of `gyrocal` by their weights. Intervals are \
         exact 95 % ones; standard errors are over records.\n\n| method | {} |\n|---{}|",
        COLUMNS.join(" | "),
        "|---".repeat(COLUMNS.len())
    );
    for method in METHODS {
        let cell = |column: usize| {
            let name = name(method, column);
            let found = figures.iter().find(|figure| figure.name == name);
            found.map_or("–", |figure| figure.measured.as_str())
        };
        let cells: Vec<&str> = (0..COLUMNS.len()).map(cell).collect();
        let method = method.map_or(OWN_METHOD, BaselineMethod::name);
        text += &format!("\n| `{method}` | {} |", cells.join(" | "));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_method_has_its_figures_in_its_row() {
        let figures = [
            Figure::note("bic: truth among the names", "0.890".to_owned()),
            Figure::note("nis: detected at d = 8", "0.017".to_owned()),
        ];
        let table = side_by_side(&figures);
        for row in [
            "| `bic` | – | – | – | 0.890 | – | – | – |",
            "| `nis` | – | 0.017 | – | – | – | – | – |",
        ] {
            assert!(table.contains(row), "{table}");
        }
    }
}
