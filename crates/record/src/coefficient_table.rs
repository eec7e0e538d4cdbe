//! The coefficients of a calibration as a table.

use crate::report::CalibrationReport;
use crate::result_table::ResultTable;

impl CalibrationReport {
    /// The coefficients, one a row; those with effects in the model follow, if there are any.
    #[must_use]
    pub fn coefficient_table(&self) -> ResultTable {
        let with = self.with_effects.iter().flat_map(|with| &with.coefficients);
        let all: Vec<_> = self
            .coefficients
            .iter()
            .map(|one| ("nominal", one))
            .chain(with.map(|one| ("with-effects", one)))
            .collect();
        let each = || all.iter();
        ResultTable::default()
            .texts("model", each().map(|(model, _)| Some(*model)))
            .texts("name", each().map(|(_, one)| Some(&*one.name)))
            .numbers("estimate", each().map(|(_, one)| Some(one.estimate)))
            .numbers("sigma", each().map(|(_, one)| Some(one.sigma)))
            .texts("unit", each().map(|(_, one)| Some(&*one.unit)))
    }
}
