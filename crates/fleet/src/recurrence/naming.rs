//! Names of the causes whose evidence stands.

use gyrocal_hypothesis::{ScoreTable, Stopped, stop};
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::math::{exp, ln};

use super::beside::Named;
use super::mixture::{Evidence, Pooled, ln_mean_exp};
use super::null::p_value;
use super::scores::{UnitScores, of_unit};
use super::{RecurrenceOptions, UnitRecords, given};
use crate::answer::{LikelyUnit, RecurringCause};

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
    pub(super) units: &'o [UnitRecords<'o>],
    /// All effects, in falling order of their evidence.
    pub(super) tested: &'o [Tested],
    pub(super) options: &'o RecurrenceOptions,
}

impl Naming<'_> {
    /// Largest p-value of the `count`-th name.
    fn limit(&self, count: usize) -> f64 {
        self.options.false_discovery_rate * count as f64 / self.tested.len() as f64
    }

    /// The effects that recur.
    ///
    /// # Errors
    /// [`Stopped`].
    pub(super) fn discoveries(&self) -> Result<Vec<RecurringCause>, Stopped> {
        let first = self.limit(1);
        let Some(best) = self.tested.iter().find(|one| one.p_value <= first) else {
            return Ok(Vec::new());
        };
        let mut named = vec![best];
        while let Some(next) = self.next(&named) {
            stop::check()?;
            named.push(next);
        }
        let own = self.needed(&named);
        let described = own.iter().map(|one| {
            stop::check()?;
            Ok(self.describe(one, &own))
        });
        described.collect()
    }

    /// The effect with the most evidence beside those that are named, if it is enough.
    fn next<'t>(&'t self, named: &[&Tested]) -> Option<&'t Tested> {
        let limit = self.limit(named.len() + 1);
        let open = self
            .tested
            .iter()
            .filter(|one| one.p_value <= limit && named.iter().all(|other| other.id != one.id));
        let most = open
            .map(|one| (one, self.beside(one, named)))
            .max_by(|a, b| a.1.total_cmp(&b.1))?;
        (most.1 >= -ln(limit)).then_some(most.0)
    }

    /// The named effects without those that are not needed beside the others.
    fn needed<'t>(&self, named: &[&'t Tested]) -> Vec<&'t Tested> {
        let mut left = named.to_vec();
        for one in named {
            let others: Vec<&Tested> = left.iter().copied().filter(|o| o.id != one.id).collect();
            if !others.is_empty() && self.beside(one, &others) < ALTERNATIVE {
                left = others;
            }
        }
        left
    }

    /// Effects that leave no evidence for a named one, and have some themselves.
    fn alternatives(&self, named: &Tested, all: &[&Tested]) -> Vec<String> {
        let next = self.limit(all.len() + 1);
        let is_other = |one: &&Tested| all.iter().all(|other| other.id != one.id);
        let has_some = |one: &&Tested| {
            one.p_value <= next || named.evidence.ln_e - one.evidence.ln_e < ALTERNATIVE
        };
        let others = self.tested.iter().filter(is_other).filter(has_some);
        let explains = |one: &&Tested| self.beside(named, &[one]) < ALTERNATIVE;
        others.filter(explains).map(|one| one.id.clone()).collect()
    }

    /// Logarithm of the evidence of an effect beside others.
    fn beside(&self, one: &Tested, others: &[&Tested]) -> f64 {
        let evidences = others.iter().map(|other| &other.evidence);
        let random = Named::of(self.units.len(), evidences).ln_evidence(&one.evidence);
        if one.evidence.ln_common.is_none() {
            return random;
        }
        let common = self.pooled_beside(one, others);
        let common = common.map_or(f64::NEG_INFINITY, |pooled| pooled.ln_evidence());
        ln_mean_exp(&[random, common])
    }

    /// Scores of all units added, with the others in the model of each unit.
    fn pooled_beside(&self, one: &Tested, others: &[&Tested]) -> Option<Pooled> {
        if others.is_empty() {
            return Pooled::of(&scores(self.units, &one.id));
        }
        let mut ids: Vec<&str> = others.iter().map(|other| other.id.as_str()).collect();
        ids.push(&one.id);
        let scores: Vec<UnitScores> = self
            .units
            .iter()
            .map(|unit| {
                let tables = unit.tables.iter().map(|table| {
                    let first = given::given(table, ids[0], &ids[1..]);
                    (1..others.len()).fold(first, |left, place| {
                        given::given(&left, ids[place], &ids[place + 1..])
                    })
                });
                let tables: Vec<ScoreTable> = tables.collect();
                of_unit(&one.id, tables.iter())
            })
            .collect();
        Pooled::of(&scores)
    }

    fn describe(&self, tested: &Tested, all: &[&Tested]) -> RecurringCause {
        let (units, evidence) = (self.units, &tested.evidence);
        let others: Vec<&Tested> = all
            .iter()
            .copied()
            .filter(|other| other.id != tested.id)
            .collect();
        let (ln_e, p_value) = match others.is_empty() {
            true => (evidence.ln_e, tested.p_value),
            false => {
                let ln_e = self.beside(tested, &others);
                // P(E ≥ 1/α) ≤ α.
                (ln_e, exp(-ln_e).clamp(tested.p_value, 1.0))
            }
        };
        let (share, strength) = evidence.share_and_strength();
        let pooled = self.pooled_beside(tested, &others);
        let pooled = pooled.filter(|pooled| pooled.size.len() == 1);
        let likely = units.iter().enumerate().map(|(index, unit)| LikelyUnit {
            unit: unit.unit.to_owned(),
            probability: evidence.probability(index),
        });
        let mut likely: Vec<LikelyUnit> = likely.filter(|one| one.probability > LIKELY).collect();
        likely.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        let tables = units.iter().flat_map(|unit| &unit.tables);
        let mut effects = tables.flat_map(|table| &table.effects);
        let unit = effects.find(|effect| effect.id == tested.id);
        RecurringCause {
            effect: tested.id.clone(),
            ln_evidence: ln_e,
            p_value,
            by_e_value: exp(-ln_e) <= self.limit(all.len()),
            share,
            strength,
            is_common: evidence.is_common(),
            size: pooled.as_ref().map(|pooled| pooled.size[0]),
            size_sigma: pooled.map(|pooled| pooled.covariance[(0, 0)].sqrt()),
            unit: unit.map_or_else(String::new, |effect| effect.unit.clone()),
            units: likely,
            alternatives: self.alternatives(tested, all),
        }
    }
}
