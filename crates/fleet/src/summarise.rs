//! From the records of a fleet to what it shows.

use std::collections::{BTreeMap, BTreeSet};

use gyrocal_diagnosis::manifest;
use gyrocal_hypothesis::{ScoreTable, Stopped};

use crate::answer::{
    FleetCoefficient, FleetResult, FoundCause, Group, GroupKind, OutlierUnit, RecordProblem,
    RecurringCause, SCHEMA_VERSION, UnitLevel, WithInterval,
};
use crate::course::{Courses, Estimate, Point, courses};
use crate::error::FleetError;
use crate::groups::{Members, Tested, differing};
use crate::level::Levels;
use crate::record::{FleetRecord, YEAR_S};
use crate::recurrence::{RecurrenceOptions, UnitRecords, recurring};

/// Settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FleetOptions {
    /// False discovery rate of recurring causes.
    pub false_discovery_rate: f64,
    /// Family-wise probability that a fleet without differences shows a batch or site that differs.
    pub group_probability: f64,
    /// Family-wise probability that a coefficient of a fleet without outliers shows one.
    pub outlier_probability: f64,
    /// Seed of the draws that p-values come from.
    pub seed: u64,
}

impl Default for FleetOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl FleetOptions {
    /// The settings unless others are given.
    pub const DEFAULT: Self = Self {
        false_discovery_rate: 0.05,
        group_probability: 0.018,
        outlier_probability: 0.01,
        seed: 0,
    };

    fn check(&self) -> Result<(), FleetError> {
        let all = [
            ("the false discovery rate", self.false_discovery_rate),
            (
                "the probability of a false batch or site",
                self.group_probability,
            ),
            (
                "the probability of a false outlier",
                self.outlier_probability,
            ),
        ];
        for (what, found) in all {
            if !(found > 0.0 && found < 1.0) {
                return Err(FleetError::Probability { what, found });
            }
        }
        Ok(())
    }
}

/// What the records of a fleet show together. Their order does not matter.
///
/// # Errors
/// [`FleetError::NoRecords`] if no record can be used, [`FleetError::Probability`], and [`FleetError::Stopped`] if the
/// job was asked to end.
pub fn summarise(
    records: &[FleetRecord],
    options: &FleetOptions,
) -> Result<FleetResult, FleetError> {
    options.check()?;
    let (records, problems) = sound(records);
    if records.is_empty() {
        return Err(FleetError::NoRecords);
    }
    let mut units: BTreeMap<&str, Vec<&FleetRecord>> = BTreeMap::new();
    for record in &records {
        units.entry(&record.name.unit).or_default().push(record);
    }
    let fleet = Fleet::new(units);
    let mut coefficients = fleet.coefficients(options);
    let groups = fleet.groups();
    let mut tested: Vec<Tested<'_>> = coefficients
        .iter()
        .map(|one| Tested {
            name: one.name,
            unit: one.unit,
            levels: &one.levels,
            columns: Vec::new(),
        })
        .collect();
    let differing = differing(&mut tested, &groups, options.group_probability);
    let columns: Vec<Vec<Vec<f64>>> = tested.into_iter().map(|one| one.columns).collect();
    let answers = coefficients.iter_mut().zip(columns);
    let answers = answers.map(|(one, columns)| one.answer(&fleet.names, columns));
    Ok(FleetResult {
        schema_version: SCHEMA_VERSION,
        manifest: manifest(options.seed),
        units: fleet.names.len(),
        records: records.len(),
        not_settled: records.iter().filter(|one| !one.is_settled).count(),
        problems,
        false_discovery_rate: options.false_discovery_rate,
        group_probability: options.group_probability,
        outlier_probability: options.outlier_probability,
        coefficients: answers.collect(),
        groups: differing,
        recurring: fleet.recurring(options)?,
        found_in_units: fleet.found_in_units(),
    })
}

/// Records that can be used, in the order of their names, and what is wrong with the others.
fn sound(records: &[FleetRecord]) -> (Vec<&FleetRecord>, Vec<RecordProblem>) {
    let mut sorted: Vec<&FleetRecord> = records.iter().collect();
    sorted.sort_by(|a, b| {
        let name = |one: &FleetRecord| (one.name.unit.clone(), one.name.record.clone());
        name(a).cmp(&name(b))
    });
    let mut seen = BTreeSet::new();
    let mut batches: BTreeMap<&str, &Option<String>> = BTreeMap::new();
    let (mut usable, mut problems) = (Vec::new(), Vec::new());
    for record in sorted {
        let name = &record.name;
        let batch = *batches.entry(&name.unit).or_insert(&name.batch);
        let problem = if !seen.insert((&name.unit, &name.record)) {
            Some("another record has the same name: two units with one name, or a record that came twice".to_owned())
        } else if batch != &name.batch {
            Some(format!(
                "the batch is {}, that of another record of the unit {}: two units with one name?",
                name.batch.as_deref().unwrap_or("not given"),
                batch.as_deref().unwrap_or("not given"),
            ))
        } else if name.date_s.is_some_and(|date| !date.is_finite()) {
            Some("the date is no number".to_owned())
        } else {
            let odd = |one: &&crate::Coefficient| {
                !(one.estimate.is_finite() && one.sigma.is_finite() && one.sigma > 0.0)
            };
            let odd = record.coefficients.iter().find(odd);
            odd.map(|odd| format!("`{}` has no estimate with a sigma", odd.name))
        };
        match problem {
            Some(problem) => problems.push(RecordProblem {
                unit: name.unit.clone(),
                record: name.record.clone(),
                problem,
            }),
            None => usable.push(record),
        }
    }
    (usable, problems)
}

/// The records by unit.
struct Fleet<'a> {
    names: Vec<&'a str>,
    records: Vec<Vec<&'a FleetRecord>>,
    /// Mean of all dates, s.
    mean_date_s: f64,
}

/// One coefficient of all units.
struct OneCoefficient<'a> {
    name: &'a str,
    unit: &'a str,
    /// Places of the units that have it.
    places: Vec<usize>,
    courses: Courses,
    outliers: Vec<OutlierUnit>,
    /// Without outliers.
    levels: Levels,
    ageing_outliers: Vec<OutlierUnit>,
    slopes: Levels,
}

impl<'a> Fleet<'a> {
    fn new(units: BTreeMap<&'a str, Vec<&'a FleetRecord>>) -> Self {
        let (names, records): (Vec<&str>, Vec<Vec<&FleetRecord>>) = units.into_iter().unzip();
        let dates = records
            .iter()
            .flatten()
            .filter_map(|record| record.name.date_s);
        let (sum, count) = dates.fold((0.0, 0.0), |(sum, count), date| (sum + date, count + 1.0));
        Self {
            names,
            records,
            mean_date_s: if count > 0.0 { sum / count } else { 0.0 },
        }
    }

    fn coefficients(&self, options: &FleetOptions) -> Vec<OneCoefficient<'a>> {
        let mut known = BTreeSet::new();
        let mut all: Vec<(&str, &str)> = Vec::new();
        for one in self
            .records
            .iter()
            .flatten()
            .flat_map(|record| &record.coefficients)
        {
            if known.insert(&one.name) {
                all.push((&one.name, &one.unit));
            }
        }
        let all = all.into_iter();
        all.filter_map(|(name, unit)| self.coefficient(name, unit, options))
            .collect()
    }

    fn coefficient(
        &self,
        name: &'a str,
        unit: &'a str,
        options: &FleetOptions,
    ) -> Option<OneCoefficient<'a>> {
        let mut places = Vec::new();
        let mut points = Vec::new();
        for (place, records) in self.records.iter().enumerate() {
            let own: Vec<Point> = records
                .iter()
                .filter_map(|record| {
                    let one = record.coefficients.iter().find(|one| one.name == name)?;
                    let date = record.name.date_s;
                    Some(Point {
                        years: date.map(|date| (date - self.mean_date_s) / YEAR_S),
                        value: one.estimate,
                        variance: one.sigma * one.sigma,
                    })
                })
                .collect();
            if !own.is_empty() {
                places.push(place);
                points.push(own);
            }
        }
        let courses = courses(&points)?;
        let of = |estimates: &mut dyn Iterator<Item = Option<Estimate>>| {
            let mut all = vec![None; self.names.len()];
            for (place, estimate) in places.iter().zip(estimates) {
                all[*place] = estimate;
            }
            Levels::of(&all)
        };
        let mut levels = of(&mut courses.levels.iter().copied().map(Some));
        let mut slopes = of(&mut courses.slopes.iter().copied());
        Some(OneCoefficient {
            name,
            unit,
            outliers: levels.take_outliers(&self.names, options.outlier_probability),
            levels,
            ageing_outliers: slopes.take_outliers(&self.names, options.outlier_probability),
            slopes,
            places,
            courses,
        })
    }

    /// Batches, and sites: that of most of a unit's records.
    fn groups(&self) -> Vec<Members> {
        let mut groups: BTreeMap<Group, Vec<bool>> = BTreeMap::new();
        for (place, records) in self.records.iter().enumerate() {
            let batch = records.iter().find_map(|record| record.name.batch.clone());
            let own = [
                batch.map(|name| (GroupKind::Batch, name)),
                most_frequent_site(records).map(|name| (GroupKind::Site, name)),
            ];
            for (kind, name) in own.into_iter().flatten() {
                let members = groups
                    .entry(Group { kind, name })
                    .or_insert_with(|| vec![false; self.names.len()]);
                members[place] = true;
            }
        }
        let groups = groups.into_iter();
        groups
            .map(|(group, units)| Members { group, units })
            .collect()
    }

    fn recurring(&self, options: &FleetOptions) -> Result<Vec<RecurringCause>, Stopped> {
        let units: Vec<UnitRecords<'_>> = self
            .names
            .iter()
            .zip(&self.records)
            .map(|(unit, records)| {
                let tables = records.iter().filter_map(|record| record.scores.as_ref());
                let tables: Vec<&ScoreTable> = tables.collect();
                UnitRecords { unit, tables }
            })
            .filter(|unit| !unit.tables.is_empty())
            .collect();
        let options = RecurrenceOptions {
            false_discovery_rate: options.false_discovery_rate,
            seed: options.seed,
            ..RecurrenceOptions::default()
        };
        recurring(&units, &options)
    }

    fn found_in_units(&self) -> Vec<FoundCause> {
        let mut found: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for record in self.records.iter().flatten() {
            for cause in &record.causes {
                found.entry(cause).or_default().insert(&record.name.unit);
            }
        }
        let mut found: Vec<FoundCause> = found
            .into_iter()
            .map(|(effect, units)| FoundCause {
                effect: effect.to_owned(),
                units: units.into_iter().map(str::to_owned).collect(),
            })
            .collect();
        found.sort_by_key(|one| std::cmp::Reverse(one.units.len()));
        found
    }
}

fn most_frequent_site(records: &[&FleetRecord]) -> Option<String> {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for site in records
        .iter()
        .filter_map(|record| record.name.site.as_deref())
    {
        *counts.entry(site).or_default() += 1;
    }
    // Of equally frequent ones the first by name.
    let most = counts.into_iter().rev().max_by_key(|(_, count)| *count);
    most.map(|(site, _)| site.to_owned())
}

impl OneCoefficient<'_> {
    fn answer(&self, names: &[&str], columns: Vec<Vec<f64>>) -> FleetCoefficient {
        let level = self.levels.mean_and_spread(columns);
        let ageing = self.slopes.mean_and_spread(Vec::new());
        let repeatability = self.courses.repeatability;
        let levels = self.places.iter().enumerate().map(|(index, place)| {
            let level = self.courses.levels[index];
            let slope = self.courses.slopes[index];
            UnitLevel {
                unit: names[*place].to_owned(),
                estimate: level.value,
                sigma: level.variance.sqrt(),
                slope: slope.map(|slope| slope.value),
                slope_sigma: slope.map(|slope| slope.variance.sqrt()),
            }
        });
        FleetCoefficient {
            name: self.name.to_owned(),
            unit: self.unit.to_owned(),
            mean: level.mean,
            spread: level.spread,
            repeatability: repeatability
                .map(|(estimate, interval)| WithInterval { estimate, interval }),
            ageing: ageing.mean,
            ageing_spread: ageing.spread,
            outliers: self.outliers.clone(),
            ageing_outliers: self.ageing_outliers.clone(),
            levels: levels.collect(),
        }
    }
}
