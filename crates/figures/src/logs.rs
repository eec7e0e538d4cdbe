//! Instrument tests on simulated logs whose errors are known.

mod allan;
mod between_stops;
mod courses;
mod positions;
mod rates;
mod stops;
mod unit;
mod vertical;

use gyrocal_instruments::{Description, InstrumentError};

use crate::harness::{Context, Error, Figure, INSTRUMENTS, Population, Sources, of};

/// All figures of the part.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = allan::figures(context)?;
    figures.extend(positions::figures(context)?);
    figures.extend(between_stops::figures(context)?);
    figures.extend(stops::figures(context)?);
    figures.extend(vertical::figures(context)?);
    figures.extend(rates::figures(context)?);
    figures.extend(courses::figures(context)?);
    Ok(figures)
}

/// A population of logs: its name, its first seed, and its numbers of records, full and small.
fn logs<'a, R, E: Into<Error>>(
    name: &str,
    seeds: [u64; 3],
    job: impl Fn(u64) -> Result<R, E> + Sync + 'a,
) -> Population<'a, R> {
    const SOURCES: Sources = of(INSTRUMENTS, &[file!(), "crates/figures/src/logs"]);
    let job = move |seed| job(seed).map_err(Into::into);
    Population::new(format!("logs {name}"), seeds, SOURCES, job)
}

/// The description of a log in rad/s and g, with more tables.
fn described(rate_hz: f64, latitude_deg: f64, more: &str) -> Result<Description, InstrumentError> {
    let text = format!(
        "[time]\nrate_hz = {rate_hz}\n[gyro]\ncolumns = [\"a\", \"b\", \"c\"]\nunit = \"rad/s\"\n[accel]\n\
         columns = [\"d\", \"e\", \"f\"]\nunit = \"g\"\n{more}[site]\nlatitude_deg = {latitude_deg:?}\n"
    );
    Ok(Description::parse(&text, "log.toml")?)
}

/// Why not all hidden terms are found.
const REACHED: &str = "what a test that does not know the scatter can reach";

/// Whether a term is among the names of a finding; `None` where nothing was found.
fn in_a_set(hidden: &String, found: &[Vec<String>]) -> Option<bool> {
    let in_a_set = found.iter().any(|names| names.contains(hidden));
    (!found.is_empty()).then_some(in_a_set)
}

/// Most error and sigma of an estimate over those of projection alone, and its reason.
const OVER_PROJECTION: f64 = 1.05;
const OVER_PROJECTION_REASON: &str =
    "no worse than the simpler way, but for what the noise of a log costs to estimate";
