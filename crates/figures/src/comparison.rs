//! The diagnosis and four usual methods on the same records: two tests of the innovations, and two ways
//! to select terms from a library of signatures.

mod table;

use gyrocal_evaluation::{
    BaselineMethod, CoefficientScore, OWN_METHOD, PopulationCell, RecordScore, same_or_equivalent,
};
use gyrocal_statistics::{Judgement, NORMAL_97_5, Proportion, mean, standard_error};

use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;

pub(crate) use table::side_by_side;

/// First seed, number of records, and number in the small version, of each of the two populations.
const FIRST_SEED: u64 = 960_000;
const RECORDS: u64 = 300;
const SMALL: u64 = 6;

/// The populations: without an effect, and with one effect of eight sigmas of its own bound.
const CLEAN: PopulationCell = PopulationCell::Clean;
const WITH_EFFECT: PopulationCell = PopulationCell::Single(8);

/// Columns of the comparison; a figure is `METHOD: COLUMN`.
const FALSE_ALARMS: &str = "false alarms on clean records";
const DETECTED: &str = "detected at d = 8";
const FIRST: &str = "truth is the first name";
const NAMED: &str = "truth among the names";
const NAMES: &str = "names told, mean of the detections";
const COVERAGE: &str = "95 % intervals of coefficients that hold the truth";
const FAR_OFF: &str = "a coefficient more than 4 σ wrong";
const COLUMNS: [&str; 7] = [
    FALSE_ALARMS,
    DETECTED,
    FIRST,
    NAMED,
    NAMES,
    COVERAGE,
    FAR_OFF,
];

/// Errors of a coefficient above this, in sigmas, are counted.
const FAR_SIGMAS: f64 = 4.0;

/// Points of the normal distribution at which a mean is shown to meet a limit (95 %) or to miss it
/// (99.9 %), one-sided, as [`Judgement`] has them for shares.
const MET_SIGMAS: f64 = 1.645;
const MISSED_SIGMAS: f64 = 3.090;

/// Targets of the diagnosis of this project.
const MOST_FALSE_ALARMS: f64 = 0.02;
const LEAST_DETECTED: f64 = 0.98;
const LEAST_NAMED: f64 = 0.95;
const LEAST_COVERAGE: f64 = 0.93;

/// What one method says of one record.
#[derive(Debug, Clone, Default)]
struct Answer {
    detected: bool,
    /// All names, those of the first finding first.
    names: Vec<String>,
    /// Number of findings that the names stand in.
    findings: usize,
    coefficients: Option<CoefficientScore>,
}

/// A method of the comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Method {
    Baseline(BaselineMethod),
    Own,
}

impl Method {
    const ALL: [Self; 5] = [
        Self::Baseline(BaselineMethod::Nis),
        Self::Baseline(BaselineMethod::LjungBox),
        Self::Baseline(BaselineMethod::Bic),
        Self::Baseline(BaselineMethod::Stls),
        Self::Own,
    ];

    /// Its name in the figures.
    fn name(self) -> &'static str {
        match self {
            Self::Baseline(method) => method.name(),
            Self::Own => OWN_METHOD,
        }
    }

    fn names_effects(self) -> bool {
        match self {
            Self::Baseline(method) => method.identifies_effects(),
            Self::Own => true,
        }
    }

    /// Its answer in the score of a record; `None` if it was not applied.
    fn answer(self, score: &RecordScore) -> Option<Answer> {
        match self {
            Self::Own => Some(Answer {
                detected: score.verdict != "clean",
                names: score
                    .findings
                    .iter()
                    .flat_map(|finding| {
                        let others = finding.alternatives.iter().map(|(name, _)| name);
                        core::iter::once(&finding.effect).chain(others).cloned()
                    })
                    .collect(),
                findings: score.findings.len(),
                coefficients: score.coefficients,
            }),
            Self::Baseline(method) => {
                let mut asked = score.methods.iter();
                let asked = asked.find(|asked| asked.method == method.name())?;
                Some(Answer {
                    detected: asked.result.detected,
                    names: asked.result.names.clone(),
                    findings: asked.result.names.len(),
                    coefficients: asked.coefficients,
                })
            }
        }
    }
}

/// All figures of the topic.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let (clean, failed_clean) = scores(CLEAN, small)?;
    let (with_effect, failed_with) = scores(WITH_EFFECT, small)?;
    let mut figures = Vec::new();
    for method in Method::ALL {
        figures.extend(of_method(method, &clean, &with_effect, &seeds(small)));
    }
    let failed = failed_clean + failed_with;
    figures.push(Figure::truth("every record is examined", failed == 0));
    Ok(figures)
}

fn seeds(small: bool) -> String {
    let records = if small { SMALL } else { RECORDS };
    format!("{FIRST_SEED}..{}", FIRST_SEED + records)
}

/// Scores of a population, and the number of records without one.
fn scores(cell: PopulationCell, small: bool) -> Result<(Vec<RecordScore>, usize), Error> {
    let records = if small { SMALL } else { RECORDS };
    let seeds = FIRST_SEED..FIRST_SEED + records;
    let campaign = resumable::campaign("comparison", &cell.name(), seeds, small)?;
    let outcome = campaign.run(|seed| cell.evaluate(seed, &BaselineMethod::ALL), |_| ())?;
    for failure in outcome.failures() {
        let (cell, seed) = (cell.name(), failure.seed);
        eprintln!("{cell}, seed {seed}: {}", failure.message);
    }
    let failed = outcome.failures().count();
    let scores = outcome.successes().map(|(_, score)| score.clone());
    Ok((scores.collect(), failed))
}

fn of_method(
    method: Method,
    clean: &[RecordScore],
    with_effect: &[RecordScore],
    seeds: &str,
) -> Vec<Figure> {
    let name = |column: &str| format!("{}: {column}", method.name());
    let answers: Vec<(&RecordScore, Answer)> = with_effect
        .iter()
        .filter_map(|score| Some((score, method.answer(score)?)))
        .collect();
    let share = |of: &dyn Fn(&RecordScore, &Answer) -> bool| {
        Proportion::of(answers.iter().map(|(score, answer)| of(score, answer)))
    };
    let alarms = clean.iter().filter_map(|score| method.answer(score));
    let alarms = Proportion::of(alarms.map(|answer| answer.detected));
    let detected = share(&|_, answer| answer.detected);
    let far = share(&|_, answer| {
        let coefficients = answer.coefficients;
        coefficients.is_none_or(|of| of.largest_error > FAR_SIGMAS)
    });
    let (coverage, coverage_judged) = coverage(&name(COVERAGE), &answers, seeds);
    let far = Figure::note_share(&name(FAR_OFF), far, seeds);
    let mut figures = vec![
        Figure::note_share(&name(FALSE_ALARMS), alarms, seeds),
        Figure::note_share(&name(DETECTED), detected, seeds),
    ];
    let named = share(&|score, answer| holds(&answer.names, score));
    if method.names_effects() {
        let first = share(&|score, answer| holds(answer.names.get(..1).unwrap_or(&[]), score));
        figures.extend([
            Figure::note_share(&name(FIRST), first, seeds),
            Figure::note_share(&name(NAMED), named, seeds),
            names_told(&name(NAMES), &answers, seeds),
        ]);
    }
    figures.extend([coverage, far]);
    if method == Method::Own {
        let targets = [
            (
                FALSE_ALARMS,
                format!("<= {MOST_FALSE_ALARMS}"),
                alarms.at_most(MOST_FALSE_ALARMS),
            ),
            (
                DETECTED,
                format!(">= {LEAST_DETECTED}"),
                detected.at_least(LEAST_DETECTED),
            ),
            (
                NAMED,
                format!(">= {LEAST_NAMED}"),
                named.at_least(LEAST_NAMED),
            ),
            (COVERAGE, format!(">= {LEAST_COVERAGE}"), coverage_judged),
        ];
        for (column, target, judgement) in targets {
            let of = name(column);
            if let Some(figure) = figures.iter_mut().find(|figure| figure.name == of) {
                *figure = Figure {
                    target,
                    ..figure.clone().judged(judgement)
                };
            }
        }
    }
    figures
}

/// `true` if every injected effect is among names.
fn holds(names: &[String], score: &RecordScore) -> bool {
    let named = |effect: &str| names.iter().any(|name| same_or_equivalent(name, effect));
    score.hidden.iter().all(|hidden| named(&hidden.effect))
}

/// Mean number of names of the detections; findings have several in their sets.
fn names_told(name: &str, answers: &[(&RecordScore, Answer)], seeds: &str) -> Figure {
    let detected = || answers.iter().filter(|(_, answer)| answer.detected);
    let count = detected().count();
    let of = |number: &dyn Fn(&Answer) -> usize| mean(detected().map(|(_, a)| number(a) as f64));
    let (names, findings) = (of(&|a| a.names.len()), of(&|a| a.findings));
    let text = match count {
        0 => "nothing to measure on".to_owned(),
        _ if names > findings => format!("{names:.2} in {findings:.2} findings"),
        _ => format!("{names:.2}"),
    };
    Figure::note(name, text).over(count, seeds)
}

/// Coverage of the nine coefficients, pooled, with a 95 % interval over the records: the nine of one
/// record err together.
fn coverage(name: &str, answers: &[(&RecordScore, Answer)], seeds: &str) -> (Figure, Judgement) {
    let of_record = |answer: &Answer| answer.coefficients.map(|of| of.covered as f64 / 9.0);
    let shares: Vec<f64> = answers
        .iter()
        .filter_map(|(_, answer)| of_record(answer))
        .collect();
    let average = mean(shares.iter().copied());
    let error = standard_error(&shares);
    let at = |sigmas: f64| average + sigmas * error;
    let judgement = Judgement::of(
        at(-MET_SIGMAS) >= LEAST_COVERAGE,
        at(MISSED_SIGMAS) < LEAST_COVERAGE,
    );
    let text = match shares.len() {
        0 => "nothing to measure on".to_owned(),
        _ => format!(
            "{average:.3} ({:.3} to {:.3})",
            at(-NORMAL_97_5),
            at(NORMAL_97_5).min(1.0)
        ),
    };
    (
        Figure::note(name, text).over(shares.len(), seeds),
        judgement,
    )
}

#[cfg(test)]
mod tests;
