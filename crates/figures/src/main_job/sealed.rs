//! Clean records of another simulator, shipped with the tests.

use std::path::Path;

use gyrocal_calibration::{Options, calibrate};
use gyrocal_record::{Bench, Record};

use super::Error;
use crate::figure::Figure;

/// Mean NIS of a clean record of thousands of rows: 3, with a sigma of about 0.04.
const NIS_MEAN: [f64; 2] = [2.9, 3.1];

pub(crate) fn figures() -> Result<Vec<Figure>, Error> {
    ["S01", "S11"].into_iter().map(figure).collect()
}

fn figure(case: &str) -> Result<Figure, Error> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/cases");
    let record = Record::read(&directory.join(format!("{case}.csv")))?;
    let bench = Bench::read(&directory.join(format!("{case}.toml")))?;
    let calibration = calibrate(&record, &bench, &Options::default(), |_| ())?;
    Ok(Figure::within(
        &format!("{case}: mean NIS"),
        NIS_MEAN,
        calibration.fit.nis_mean(),
    )
    .over(1, "sealed record"))
}
