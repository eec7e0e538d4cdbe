//! Names of the causes whose evidence stands.

use gyrocal_hypothesis::ScoreTable;
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::math::exp;

use super::mixture::{Evidence, Pooled};
use super::null::p_value;
use super::scores::{UnitScores, of_unit};
use super::{Discovery, RecurrenceOptions, UnitRecords, given};

/// Logarithm of the ratio of evidence within which another effect is an alternative: one in twenty.
const ALTERNATIVE: f64 = 3.0;

/// Probability below which a unit is not told to have a cause.
const LIKELY: f64 = 0.5;

/// An effect with its evidence.
pub(super) struct Tested {
    pub(super) id: String,
    pub(super) evidence: Evidence,
    pub(super) p_value: f64,
}

impl Tested {
    pub(super) fn of(units: &[UnitRecords<'_>], id: &str, options: &RecurrenceOptions) -> Self {
        let scores = scores(units, id);
        let evidence = Evidence::of(&scores);
        let mut draw = Draw::new(options.seed, purpose(id));
        Self {
            p_value: p_value(&scores, evidence.ln_e, options.draws, &mut draw),
            id: id.to_owned(),
            evidence,
        }
    }
}

/// A stream of random numbers for each effect, whatever others are tested (FNV-1a, 64 bits).
fn purpose(id: &str) -> u64 {
    id.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

pub(super) fn scores(units: &[UnitRecords<'_>], id: &str) -> Vec<UnitScores> {
    let units = units.iter();
    units
        .map(|unit| of_unit(id, unit.tables.iter().copied()))
        .collect()
}

/// Naming of effects, the one with the most evidence first.
pub(super) struct Naming<'o> {
    /// Largest p-value of the first discovery.
    pub(super) first_limit: f64,
    pub(super) options: &'o RecurrenceOptions,
    pub(super) found: Vec<Discovery>,
}

impl Naming<'_> {
    /// Largest p-value of the next discovery.
    fn limit(&self) -> f64 {
        self.first_limit * (self.found.len() as f64 + 1.0)
    }

    /// Names the first of `tested`, which are in falling order of their evidence, and goes on with those that
    /// have evidence of their own with it in the model.
    pub(super) fn name(&mut self, units: &[UnitRecords<'_>], tested: Vec<Tested>) {
        let limit = self.limit();
        let Some(best) = tested.iter().find(|one| one.p_value <= limit) else {
            return;
        };
        let mut discovery = self.describe(units, best);
        // What may be named next.
        let next = limit + self.first_limit;
        let open: Vec<&str> = tested
            .iter()
            .filter(|one| one.p_value <= next && one.id != best.id)
            .map(|one| one.id.as_str())
            .collect();
        let left: Vec<Vec<ScoreTable>> = units
            .iter()
            .map(|unit| {
                let tables = unit.tables.iter();
                tables
                    .map(|table| given::given(table, &best.id, &open))
                    .collect()
            })
            .collect();
        let beside: Vec<UnitRecords<'_>> = units
            .iter()
            .zip(&left)
            .map(|(unit, tables)| UnitRecords {
                unit: unit.unit,
                tables: tables.iter().collect(),
            })
            .collect();
        let mut again: Vec<Tested> = open
            .iter()
            .map(|id| Tested::of(&beside, id, self.options))
            .filter(|one| one.p_value <= next)
            .collect();
        let has_own = |id: &str| again.iter().any(|own| own.id == id);
        let near = |one: &&Tested| best.evidence.ln_e - one.evidence.ln_e < ALTERNATIVE;
        discovery.alternatives = tested
            .iter()
            .filter(|one| one.id != best.id && !has_own(&one.id))
            .filter(|one| one.p_value <= next || near(one))
            .map(|one| one.id.clone())
            .collect();
        self.found.push(discovery);
        again.sort_by(|a, b| b.evidence.ln_e.total_cmp(&a.evidence.ln_e));
        self.name(&beside, again);
    }

    fn describe(&self, units: &[UnitRecords<'_>], tested: &Tested) -> Discovery {
        let evidence = &tested.evidence;
        let (share, strength) = evidence.share_and_strength();
        let pooled = Pooled::of(&scores(units, &tested.id)).filter(|pooled| pooled.size.len() == 1);
        let mut likely: Vec<(String, f64)> = units
            .iter()
            .enumerate()
            .map(|(index, unit)| (unit.unit.to_owned(), evidence.probability(index)))
            .filter(|(_, probability)| *probability > LIKELY)
            .collect();
        likely.sort_by(|a, b| b.1.total_cmp(&a.1));
        let tables = units.iter().flat_map(|unit| &unit.tables);
        let mut effects = tables.flat_map(|table| &table.effects);
        let unit = effects.find(|effect| effect.id == tested.id);
        Discovery {
            effect: tested.id.clone(),
            ln_e: evidence.ln_e,
            p_value: tested.p_value,
            by_e_value: exp(-evidence.ln_e) <= self.limit(),
            share,
            strength,
            is_common: evidence.is_common(),
            size: pooled.map(|pooled| (pooled.size[0], pooled.covariance[(0, 0)].sqrt())),
            unit: unit.map_or_else(String::new, |effect| effect.unit.clone()),
            units: likely,
            alternatives: Vec::new(),
        }
    }
}
