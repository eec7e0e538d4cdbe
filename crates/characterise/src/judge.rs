//! One record diagnosed and held against what was hidden in it.

use gyrocal::effect::Role;
use gyrocal::{EFFECTS, Effect};
use gyrocal_calibration::NoiseModel;
use gyrocal_diagnosis::cause::{Finding, FoundParameter, Ranked, SearchOptions, search};
use gyrocal_diagnosis::{DiagnoseOptions, Diagnosis, Verdict, diagnose};
use gyrocal_statistics::NORMAL_97_5;
use gyrocal_truth::{Scenario, Simulation};

use crate::bank::Bank;
use crate::case::{Case, FoundCase, HiddenCase, MethodCase, same};
use crate::error::CharacteriseError;
use crate::methods::{Method, library};
use crate::plant::{Planted, fitted, searched};
use crate::signature::{Columns, Signature};

/// Differences to the best effect that are kept of the first search.
const NEAREST_KEPT: usize = 10;

/// Half widths, in sigmas, of intervals that hold one size, two and three together with 95 %: the
/// points of the normal distribution at the roots of 0.95 (Sidak 1967; more if sizes correlate).
const HALF_WIDTHS: [f64; 3] = [NORMAL_97_5, 2.236_476_644_557_79, 2.387_737_887_070_817];

/// Diagnoses a record and compares with what is hidden in it, an effect of the catalogue or
/// several; the strengths are theirs.
pub(crate) fn judge(
    scenario: &Scenario,
    simulation: &Simulation,
    planted: &[(Planted, f64)],
    methods: &[Method],
) -> Result<Case, CharacteriseError> {
    let found = diagnose(
        &simulation.record,
        &simulation.bench,
        &DiagnoseOptions::default(),
    )?;
    let mut columns = Columns::default();
    let truths: Vec<Option<Signature>> = planted
        .iter()
        .map(|(planted, _)| columns.signature(planted.effect, &simulation.record, planted.shape))
        .collect();
    let first = found.findings.first().and_then(|finding| {
        let shape = shape_of(finding);
        columns.signature(row(finding.effect)?, &simulation.record, shape)
    });
    let entries = if methods.iter().any(|method| method.names()) {
        library(&searched(scenario), &simulation.record, &mut columns)
    } else {
        Vec::new()
    };
    let first_name = found.findings.first().map(|finding| finding.effect);
    let another = |name| planted.iter().any(|(one, _)| !same(one.effect.id, name));
    let bank = if !methods.is_empty() || first_name.is_some_and(another) {
        let declared = found.noise_model == NoiseModel::default();
        let nominal = if declared {
            found.nominal.clone()
        } else {
            fitted(simulation)?
        };
        Some(Bank::new(&nominal, &columns.further)?)
    } else {
        None
    };
    // How near a name is to a hidden effect.
    let cosine = |index: usize, name: &str, signature: Option<&Signature>| {
        let Some((planted, _)) = planted.get(index) else {
            return 0.0;
        };
        match (&truths[index], signature, &bank) {
            _ if same(name, planted.effect.id) => 1.0,
            (Some(truth), Some(signature), Some(bank)) => {
                bank.cosine(truth, &planted.sizes, signature)
            }
            _ => 0.0,
        }
    };
    let hidden = planted
        .iter()
        .enumerate()
        .map(|(index, (planted, strength))| {
            let first_cosine = found
                .findings
                .first()
                .map_or(0.0, |finding| cosine(index, finding.effect, first.as_ref()));
            hidden_case(
                &found,
                planted,
                *strength,
                first_cosine,
                scenario.duration_s,
            )
        })
        .collect();
    let methods = methods
        .iter()
        .zip(core::iter::repeat(&bank))
        .filter_map(|(method, bank)| Some((method, bank.as_ref()?)))
        .map(|(method, bank)| {
            let (called, chosen) = method.call(bank, &entries);
            let first_cosine = chosen.first().map_or(0.0, |entry| {
                let entry = &entries[*entry];
                cosine(0, entry.effect.id, Some(&entry.signature))
            });
            MethodCase {
                method: method.name().to_owned(),
                called,
                first_cosine,
            }
        })
        .collect();
    Ok(Case {
        hidden,
        oracle_set_size: oracle_set_size(simulation, &found)?,
        methods,
        ..case(&found)
    })
}

/// What was found, with nothing known of what is hidden.
pub(crate) fn case(found: &Diagnosis<'_>) -> Case {
    Case {
        hidden: Vec::new(),
        verdict: match found.verdict {
            Verdict::Clean => "clean",
            Verdict::EffectsFound => "effects-found",
            Verdict::Unexplained => "unexplained",
        }
        .to_owned(),
        findings: found.findings.iter().map(found_case).collect(),
        noise: found
            .noise_findings
            .iter()
            .map(|finding| finding.effect.to_owned())
            .collect(),
        unexplained: found
            .remainder
            .unexplained
            .then(|| found.remainder.description.clone()),
        oracle_set_size: None,
        nearest: nearest(&found.ranking),
        methods: Vec::new(),
    }
}

fn nearest(ranking: &[Ranked]) -> Vec<(String, f64)> {
    let Some(best) = ranking.first() else {
        return Vec::new();
    };
    let mut nearest: Vec<(String, f64)> = Vec::with_capacity(NEAREST_KEPT);
    for ranked in &ranking[1..] {
        let told = same(ranked.effect, best.effect)
            || nearest.iter().any(|(other, _)| same(ranked.effect, other));
        if !told {
            nearest.push((ranked.effect.to_owned(), best.statistic - ranked.statistic));
        }
        if nearest.len() == NEAREST_KEPT {
            break;
        }
    }
    nearest
}

fn found_case(finding: &Finding) -> FoundCase {
    let has_equivalents = row(finding.effect).is_some_and(|effect| !effect.equivalents.is_empty());
    FoundCase {
        effect: finding.effect.to_owned(),
        z: finding.z,
        parameters: finding
            .parameters
            .iter()
            .map(|parameter| (parameter.name.to_owned(), parameter.estimate))
            .collect(),
        rivals: finding
            .rivals
            .iter()
            .map(|rival| (rival.effect.to_owned(), 2.0 * rival.log_likelihood_deficit))
            .collect(),
        equivalents: finding
            .equivalents
            .iter()
            .map(|(id, _)| (*id).to_owned())
            .collect(),
        alone: has_equivalents && finding.equivalents.is_empty(),
    }
}

fn hidden_case(
    found: &Diagnosis<'_>,
    planted: &Planted,
    strength: f64,
    first_cosine: f64,
    duration_s: f64,
) -> HiddenCase {
    let id = planted.effect.id;
    // Under its own name, or as an exact equivalent of what was named.
    let parameters: Option<&[FoundParameter]> = found.findings.iter().find_map(|finding| {
        if finding.effect == id {
            return Some(finding.parameters.as_slice());
        }
        let listed = finding.equivalents.iter().find(|(other, _)| *other == id);
        listed.map(|(_, parameters)| parameters.as_slice())
    });
    let in_set = found.findings.iter().any(|finding| {
        let mut rivals = finding.rivals.iter();
        same(finding.effect, id) || rivals.any(|rival| same(rival.effect, id))
    });
    let shape = planted.effect.shape();
    let shape = shape.filter(|shape| matches!(shape.role, Role::Onset(_)));
    let onset_s = parameters.zip(shape).and_then(|(parameters, shape)| {
        let onset = parameters
            .iter()
            .find(|parameter| parameter.name == shape.name);
        onset.map(|onset| onset.estimate)
    });
    let best = found.ranking.first().map_or(0.0, |best| best.statistic);
    let own = found.ranking.iter().find(|ranked| same(ranked.effect, id));
    let names = planted
        .effect
        .parameters
        .iter()
        .map(|parameter| parameter.name.to_owned());
    HiddenCase {
        effect: id.to_owned(),
        parameters: names
            .zip(planted.sizes.iter().copied().chain(planted.shape))
            .collect(),
        strength,
        in_set,
        first_cosine,
        covered: parameters.map(|parameters| covers(parameters, &planted.sizes)),
        onset_error: onset_s
            .zip(planted.shape)
            .map(|(found_s, true_s)| (found_s - true_s).abs() / duration_s),
        deficit: own.map(|own| best - own.statistic),
    }
}

/// Whether 95 % intervals of all sizes together hold the true ones.
fn covers(parameters: &[FoundParameter], sizes: &[f64]) -> bool {
    let sigmas = HALF_WIDTHS[sizes.len().clamp(1, HALF_WIDTHS.len()) - 1];
    parameters.iter().zip(sizes).all(|(found, size)| {
        found
            .sigma
            .is_none_or(|sigma| (found.estimate - size).abs() <= sigmas * sigma)
    })
}

/// The same search with the true noise, which in the cells is the declared one.
fn oracle_set_size(
    simulation: &Simulation,
    found: &Diagnosis<'_>,
) -> Result<Option<usize>, CharacteriseError> {
    let size = |findings: &[Finding]| findings.first().map(|finding| 1 + finding.rivals.len());
    if found.noise_model == NoiseModel::default() {
        return Ok(size(&found.findings));
    }
    let options = SearchOptions {
        false_alarm_probability: found.search_false_alarm_probability,
        ..SearchOptions::default()
    };
    let nominal = fitted(simulation)?;
    let searched = search(nominal, &simulation.record, &simulation.bench, &options)?;
    Ok(size(&searched.findings))
}

fn row(id: &str) -> Option<&'static Effect> {
    EFFECTS.iter().find(|effect| effect.id == id)
}

/// Onset or time constant of a finding.
fn shape_of(finding: &Finding) -> Option<f64> {
    let shape = row(finding.effect)?.shape()?;
    let mut parameters = finding.parameters.iter();
    let found = parameters.find(|parameter| parameter.name == shape.name);
    found.map(|parameter| parameter.estimate)
}
