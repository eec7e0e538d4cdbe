//! Records that a user could have and the simulator does not make: how often what is right for each is told, and how
//! often a physical cause that is not there and nothing else.

use gyrocal_evaluation::{FieldOutcome, FieldPopulation, Judgement, Statistic};
use gyrocal_plant::LoadedPlant;
use gyrocal_statistics::median;
use serde::{Deserialize, Serialize};

use crate::answers::Checked;
use crate::any_plant::plants;
use crate::any_plant::simulated::Kind;
use crate::harness::{Context, DIAGNOSIS, Error, Figure, Population, Row, of};

/// Rows of the small version, with one record each: quick ones.
const SMALL: [&str; 6] = [
    "site.latitude_deg x -1",
    "noise.accel_g x 2",
    "time_s +- 3600",
    "at 85 deg",
    "records of two platforms",
    "servo: as declared",
];

/// Records of most rows, and of the small version of the row that has more: they are short.
const EACH: u64 = 20;
const SHORT: u64 = 56;

/// Answers that are asked for.
const LEAST: f64 = 5_000.0;

/// Answers that are shown with what is wrong.
const SHOWN: usize = 10;

/// Words for the judgements, the right one first.
const JUDGEMENTS: [(Judgement, &str); 4] = [
    (Judgement::Right, "right"),
    (Judgement::NotSettled, "not settled"),
    (Judgement::Wrong, "wrong"),
    (Judgement::PhysicalAlone, "a physical cause alone"),
];

/// All figures of the part `field` of the diagnosis.
pub(crate) fn of_records(context: &Context) -> Result<Vec<Figure>, Error> {
    let keys = FieldPopulation::wrong_keys()?;
    let mut figures = table(context, "wrong bench keys", keys)?;
    let kinds = FieldPopulation::kinds()?;
    figures.extend(table(context, "records of users", kinds)?);
    Ok(figures)
}

/// All figures of the part `field` of the plants.
pub(crate) fn of_plants(context: &Context) -> Result<Vec<Figure>, Error> {
    let plants = plants()?;
    let kinds = FieldPopulation::plants(&plants[Kind::Servo as usize])?;
    table(context, "records of a user's plant", kinds)
}

/// All figures of answers as files, of the same records.
///
/// # Errors
/// If a population cannot be drawn.
pub(crate) fn of_answers(context: &Context) -> Result<Vec<Figure>, Error> {
    let plants = plants()?;
    let (mut all, mut is_full) = (Vec::new(), true);
    for population in populations(&plants[Kind::Servo as usize])? {
        let records = context.records(&population)?;
        is_full &= records.full;
        let answers = records.records.iter().filter_map(|one| one.answer.clone());
        all.extend(answers.map(|answer| (population.name.clone(), answer)));
    }
    let wrong = all.iter().filter_map(|(name, one)| {
        let wrong = [&one.faults[..], &one.settled].concat();
        (!wrong.is_empty()).then(|| format!("{name}: {}", wrong.join("; ")))
    });
    wrong.take(SHOWN).for_each(|line| println!("{line}"));
    let share = Statistic::share(&all, |(_, one)| Some(one.faults.is_empty()));
    let least = [if is_full { LEAST } else { 1.0 }, f64::INFINITY];
    let number = |of: fn(&Checked) -> bool| all.iter().filter(|(_, one)| of(one)).count() as f64;
    let given = "answers written, validated, read back, and given to every command that takes one";
    let failed = number(|one| !one.faults.is_empty());
    let open = "answers whose search was cut, or whose rest is not white beside names";
    let settled = number(|one| !one.settled.is_empty());
    Ok(vec![
        Figure::within("answers of all kinds", least, all.len() as f64),
        Figure::of_statistic(given, &share, None, is_full),
        Figure::at_most("answers of which that failed", 0.0, failed, ""),
        Figure::note(open, number(|one| one.is_open).to_string()),
        Figure::at_most("of these called settled anywhere", 0.0, settled, ""),
    ])
}

/// A row for each population, and shares of all records. What is right is the reason of a row.
fn table(
    context: &Context,
    name: &str,
    rows: Vec<FieldPopulation<'_>>,
) -> Result<Vec<Figure>, Error> {
    let (mut figures, mut all) = (Vec::new(), Vec::new());
    let mut is_full = true;
    for row in rows {
        let (name, right) = (row.name.clone(), row.right.clone());
        let population = population(row);
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
        let share = Statistic::share(&all, |one| Some(one.outcome.judgement == judgement));
        Figure::of_statistic(&format!("{name}: {word}, of all"), &share, None, is_full)
    };
    figures.extend(JUDGEMENTS.map(total));
    Ok(figures)
}

/// The judged outcome of a record, and what is wrong with the answer as a file.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Fielded {
    #[serde(flatten)]
    outcome: FieldOutcome,
    /// `None` if the diagnosis failed.
    answer: Option<Checked>,
}

/// All populations: records of the platform, then of the servo.
fn populations(servo: &LoadedPlant) -> Result<Vec<Population<'_, Fielded>>, Error> {
    let rows = FieldPopulation::wrong_keys()?.into_iter();
    let rows = rows.chain(FieldPopulation::kinds()?);
    let rows = rows.chain([FieldPopulation::short()]);
    let rows = rows.chain(FieldPopulation::plants(servo)?);
    Ok(rows.map(population).collect())
}

fn population(row: FieldPopulation<'_>) -> Population<'_, Fielded> {
    const FILES: &[&str] = &[file!(), "crates/figures/src/answers.rs", "examples/servo"];
    let small = match row.records {
        EACH => u64::from(SMALL.contains(&&*row.name)),
        _ => SHORT,
    };
    let name = format!("field {}", row.name);
    let seeds = [row.first_seed, row.records, small];
    Population::new(name, seeds, of(DIAGNOSIS, FILES), move |seed| {
        let (outcome, answer) = (row.job)(seed)?;
        let answer = answer.as_ref().map(Checked::of).transpose()?;
        Ok(Fielded { outcome, answer })
    })
}

/// Numbers of records by judgement, and the median of their strengths.
fn counts(records: &[Fielded]) -> String {
    let records: Vec<&FieldOutcome> = records.iter().map(|one| &one.outcome).collect();
    let counts = JUDGEMENTS.map(|(judgement, word)| {
        let count = records.iter().filter(|one| one.judgement == judgement);
        format!("{} {word}", count.count())
    });
    let strengths: Vec<f64> = records.iter().filter_map(|one| one.strength).collect();
    match strengths.is_empty() {
        true => counts.join(", "),
        false => format!("{}; {:.1} sigma", counts.join(", "), median(&strengths)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_the_small_version_are_rows() {
        let plants = plants().unwrap();
        let all = [
            FieldPopulation::wrong_keys().unwrap(),
            FieldPopulation::kinds().unwrap(),
            FieldPopulation::plants(&plants[Kind::Servo as usize]).unwrap(),
        ];
        let names: Vec<String> = all.into_iter().flatten().map(|one| one.name).collect();
        for small in SMALL {
            assert!(names.iter().any(|name| name == small), "{small}");
        }
    }
}
