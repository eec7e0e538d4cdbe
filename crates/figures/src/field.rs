//! Records that a user could have and the simulator does not make: how often what is right for each is told, and how
//! often a physical cause that is not there and nothing else.

use gyrocal_evaluation::{FieldOutcome, FieldPopulation, Judgement, Statistic};
use gyrocal_statistics::median;

use crate::any_plant::plants;
use crate::any_plant::simulated::Kind;
use crate::error::Error;
use crate::figure::Figure;
use crate::harness::sources::{DIAGNOSIS, of};
use crate::harness::{Context, Population, Row};

/// Records of a row.
const RECORDS: u64 = 20;

/// Rows of the small version, with one record each: quick ones.
const SMALL: [&str; 6] = [
    "site.latitude_deg x -1",
    "noise.accel_g x 2",
    "time_s +- 3600",
    "at 85 deg",
    "records of two platforms",
    "servo: as declared",
];

/// Words for the judgements, the right one first.
const JUDGEMENTS: [(Judgement, &str); 4] = [
    (Judgement::Right, "right"),
    (Judgement::NotSettled, "not settled"),
    (Judgement::Wrong, "wrong"),
    (Judgement::PhysicalAlone, "a physical cause alone"),
];

/// All figures of the part `field` of the diagnosis.
pub(crate) fn of_records(context: &Context) -> Result<Vec<Figure>, Error> {
    let keys = FieldPopulation::wrong_keys();
    let mut figures = table(context, "wrong bench keys", keys)?;
    figures.extend(table(
        context,
        "records of users",
        FieldPopulation::kinds(),
    )?);
    Ok(figures)
}

/// All figures of the part `field` of the plants.
pub(crate) fn of_plants(context: &Context) -> Result<Vec<Figure>, Error> {
    let plants = plants()?;
    let kinds = FieldPopulation::plants(&plants[Kind::Servo as usize]);
    table(context, "records of a user's plant", kinds)
}

/// A row for each population, and shares of all records. What is right is the reason of a row.
fn table(
    context: &Context,
    name: &str,
    rows: Vec<FieldPopulation<'_>>,
) -> Result<Vec<Figure>, Error> {
    let (mut figures, mut all) = (Vec::new(), Vec::new());
    let mut is_full = true;
    for FieldPopulation {
        name,
        first_seed,
        right,
        job,
    } in rows
    {
        let small = u64::from(SMALL.contains(&&*name));
        let population = Population {
            name: format!("field {name}"),
            first: first_seed,
            full: RECORDS,
            small,
            sources: of(DIAGNOSIS, &[file!(), "examples/servo"]),
            job: Box::new(move |seed| Ok(job(seed)?)),
        };
        let of_row = context.measure(&population, &[Row::words(name, counts)])?;
        figures.extend(of_row.into_iter().map(|figure| Figure {
            reason: right.clone(),
            ..figure
        }));
        let records = context.records(&population)?;
        is_full &= records.full;
        all.extend(records.records.iter().cloned());
    }
    let total = |(judgement, word): (Judgement, &str)| {
        let share = Statistic::share(&all, |one| Some(one.judgement == judgement));
        Figure::of_statistic(&format!("{name}: {word}, of all"), &share, None, is_full)
    };
    figures.extend(JUDGEMENTS.map(total));
    Ok(figures)
}

/// Numbers of records by judgement, and the median of their strengths.
fn counts(records: &[FieldOutcome]) -> String {
    let counts = JUDGEMENTS.map(|(judgement, word)| {
        let count = records.iter().filter(|one| one.judgement == judgement);
        format!("{} {word}", count.count())
    });
    let strengths: Vec<f64> = records.iter().filter_map(|one| one.strength).collect();
    let strength = match strengths.is_empty() {
        true => String::new(),
        false => format!("; {:.1} sigma", median(&strengths)),
    };
    counts.join(", ") + &strength
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_the_small_version_are_rows() {
        let plants = plants().unwrap();
        let all = [
            FieldPopulation::wrong_keys(),
            FieldPopulation::kinds(),
            FieldPopulation::plants(&plants[Kind::Servo as usize]),
        ];
        let names: Vec<String> = all.into_iter().flatten().map(|one| one.name).collect();
        for small in SMALL {
            assert!(names.iter().any(|name| name == small), "{small}");
        }
    }
}
