//! The figures of the comparison as a table: a row for each method, a column for each measure.

use super::{COLUMNS, Method};
use crate::figure::Figure;

/// The figures side by side, with the terms explained.
pub(crate) fn side_by_side(figures: &[Figure]) -> String {
    let mut text = format!(
        "All methods see the same records, with the noise as declared; \
         [characteristics.md](../characteristics.md) describes the records and the methods. All \
         columns but the first refer to records with one effect of the catalogue, of 8 standard \
         deviations of its own bound. A test names nothing. `gyrocal` names sets: its first name \
         is the first member of its first set. The coefficients are the nine of the model that a \
         method ends with: the nominal model of a test, the model with the selected effects of \
         `bic` and `stls`, the members of the sets of `gyrocal` by their weights. Intervals are \
         exact 95 % ones, but that of the coefficients, which is over records: the nine of one \
         record err together.\n\n| method | {} |\n|---{}|",
        COLUMNS.join(" | "),
        "|---".repeat(COLUMNS.len())
    );
    for method in Method::ALL {
        let cells = COLUMNS.map(|column| {
            let name = format!("{}: {column}", method.name());
            let found = figures.iter().find(|figure| figure.name == name);
            found.map_or("–", |figure| figure.measured.as_str())
        });
        text += &format!("\n| `{}` | {} |", method.name(), cells.join(" | "));
    }
    text
}
