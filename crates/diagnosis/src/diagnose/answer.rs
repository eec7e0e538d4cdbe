//! The answer, assembled from the outcomes of all tests.

use gyrocal::generated::MODEL_HASH;
use gyrocal_calibration::{FittedPlatform, NoiseEstimate, NoiseRatio, Run};
use gyrocal_hypothesis::Searched;
use gyrocal_record::{AXES, Manifest, Record, SetupProblem};
use gyrocal_statistics::{self as statistics, NoiseCourse};

use super::coefficients::coefficients;
use super::{DiagnoseOptions, findings};
use crate::distinguishability::{
    separate, set_ups_without_angles, tell_together, time_and_temperature,
};
use crate::filter_test::Tested;
use crate::magnitude_test;
use crate::noise::{NoiseAudit, NoiseFinding, gaps};
use crate::power::{needs_caveat, undetectable};
use crate::untested::{Tests, not_tested, untested};
use crate::validation::CrossValidated;
use gyrocal_answer::{
    AllanCourse, AllanPoint, AllanTest, Answer, Estimated, FalseAlarmShares, Finding, Gain, Gaps,
    MagnitudeTest, ModelNoise, NoiseAuditSummary, NoiseLevel, NotTested, NotTestedReason, Power,
    RankedEffect, RecordSummary, ResidualTest, Residuals, SCHEMA_VERSION, SetUps, SizesByRecord,
    Subject,
};

/// Outcomes of all tests of one diagnosis.
pub(super) struct Evidence<'e, 'a> {
    pub(super) run: &'e Run<'a>,
    pub(super) options: &'e DiagnoseOptions,
    pub(super) shares: FalseAlarmShares,
    pub(super) setup: Vec<SetupProblem>,
    pub(super) magnitude: Option<magnitude_test::MagnitudeTest>,
    pub(super) residuals: Residuals,
    pub(super) audit: &'e NoiseAudit,
    pub(super) gyro_noise: Vec<NoiseFinding>,
    pub(super) nominal: &'e FittedPlatform<'a>,
    pub(super) power: Vec<Power>,
    pub(super) searched: &'e Searched<FittedPlatform<'a>>,
    /// Sizes in each of several records, in the order of the findings of the search.
    pub(super) by_record: Vec<Option<SizesByRecord>>,
    pub(super) estimate: &'e NoiseEstimate,
    pub(super) remainder: ResidualTest,
    pub(super) allan: Option<statistics::AllanTest>,
    pub(super) validated: &'e CrossValidated<'a>,
    pub(super) gain: Option<Gain>,
    pub(super) filter: Option<Tested>,
}

impl Evidence<'_, '_> {
    /// The answer.
    pub(super) fn answer(self) -> Answer {
        let findings = self.findings();
        let verdict = Answer::judged(&findings, &self.remainder, !self.searched.is_cut);
        let ranking = &self.searched.ranking;
        let threshold = self.searched.threshold;
        Answer {
            schema_version: SCHEMA_VERSION,
            manifest: manifest(self.options.seed),
            record: record_summary(self.run.record),
            records: Vec::new(),
            subject: match self.nominal.is_strapdown() {
                true => Subject::Strapdown,
                false => Subject::Platform,
            },
            later_record: None,
            verdict,
            false_alarm_probability: self.options.false_alarm_probability,
            false_alarm_shares: Some(self.shares),
            norm: self.magnitude.as_ref().map(magnitude),
            set_ups: self.set_ups(),
            findings,
            coefficients: Some(coefficients(
                self.nominal,
                &self.searched.findings,
                self.validated,
            )),
            ranking: ranking
                .iter()
                .map(|ranked| RankedEffect {
                    effect: ranked.effect.to_owned(),
                    statistic: ranked.statistic,
                })
                .collect(),
            threshold: Some(threshold).filter(|threshold| threshold.is_finite()),
            noise: noise(self.estimate),
            undeclared_noise: Vec::new(),
            only_in_white_noise: Vec::new(),
            path: Vec::new(),
            model_noise: Some(model_noise(self.validated, self.nominal)),
            noise_audit: Some(audit(self.audit)),
            allan: self.allan.as_ref().map(allan),
            not_searched: self.not_tested(),
            search_complete: !self.searched.is_cut,
            power: self.power,
            setup: self.setup,
            residuals: Some(self.residuals),
            gain: self.gain,
            remainder: self.remainder,
            filter: self.filter.map(|filter| filter.test),
            open_loop: Vec::new(),
            horizon_s: None,
            still_inputs: Vec::new(),
            undetermined: Vec::new(),
            starts: None,
            next_runs: Vec::new(),
        }
    }

    /// Noise, then causes, then the filter.
    fn findings(&self) -> Vec<Finding> {
        let noise = self.audit.findings.iter().chain(&self.gyro_noise);
        let causes = self.searched.findings.iter().zip(&self.validated.decisions);
        let causes = causes
            .zip(&self.by_record)
            .map(|((finding, decision), by_record)| Finding {
                by_record: by_record.clone(),
                ..findings::of_cause(finding, decision)
            });
        let filter = self.filter.as_ref().and_then(|tested| tested.inconsistent);
        let mut all: Vec<Finding> = noise
            .map(findings::of_noise)
            .chain(causes)
            .chain(filter.map(findings::of_filter))
            .collect();
        let field_is_known = self.run.bench.magnetic_field_gauss.is_some();
        let searched: Vec<&str> = self.searched.ranking.iter().map(|r| r.effect).collect();
        for finding in &mut all {
            separate(finding, &searched, field_is_known);
        }
        let each = self.nominal.record_rows();
        if let Some(correlation) = time_and_temperature(self.run.record, &each) {
            tell_together(&mut all, correlation);
        }
        all
    }

    fn set_ups(&self) -> Option<SetUps> {
        let is_free = self.run.bench.initial_angles_deg.is_none() && !self.nominal.is_strapdown();
        is_free.then(set_ups_without_angles)
    }

    /// Effects that a short record could not show, then those that were not tested.
    fn not_tested(&self) -> Vec<NotTested> {
        let threshold = self.searched.threshold;
        let found = |effect: &str| self.searched.findings.iter().any(|f| f.effect == effect);
        let mut all: Vec<NotTested> = Vec::new();
        if needs_caveat(self.run.record) {
            let undetected = self.power.iter();
            let undetected =
                undetected.filter(|power| undetectable(power, threshold) && !found(&power.effect));
            all.extend(
                undetected.map(|power| not_tested(&power.effect, NotTestedReason::LowPower, None)),
            );
        }
        all.extend(untested(&Tests {
            ranking: &self.searched.ranking,
            unavailable: &self.searched.unavailable,
            audit: self.audit,
            filter: self.filter.is_some(),
        }));
        all
    }
}

/// Manifest of a result that no command made: without inputs and command line.
#[must_use]
pub fn manifest(seed: u64) -> Manifest {
    Manifest {
        program: "gyrocal".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        model_hash: MODEL_HASH.to_owned(),
        inputs: Vec::new(),
        seed,
        command: String::new(),
    }
}

/// Size of a record, and what is missing in it.
#[must_use]
pub fn record_summary(record: &Record) -> RecordSummary {
    RecordSummary {
        rows: record.len(),
        duration_s: record.duration_s(),
        gaps: gaps(record),
        averaged: None,
    }
}

/// Size of several records together.
#[must_use]
pub fn records_summary<'a>(records: impl IntoIterator<Item = &'a RecordSummary>) -> RecordSummary {
    let mut all = RecordSummary {
        rows: 0,
        duration_s: 0.0,
        gaps: Gaps::default(),
        averaged: None,
    };
    for own in records {
        all.gaps = both(&all.gaps, all.rows as f64, &own.gaps, own.rows as f64);
        all.rows += own.rows;
        all.duration_s += own.duration_s;
    }
    all
}

/// Gaps of two records, with as many rows.
pub(super) fn both(one: &Gaps, rows: f64, other: &Gaps, other_rows: f64) -> Gaps {
    let missing = rows * one.missing_values + other_rows * other.missing_values;
    Gaps {
        count: one.count + other.count,
        missing_s: one.missing_s + other.missing_s,
        longest_s: one.longest_s.max(other.longest_s),
        missing_values: missing / (rows + other_rows),
    }
}

fn magnitude(verdict: &magnitude_test::MagnitudeTest) -> MagnitudeTest {
    MagnitudeTest {
        accelerometers: verdict.accelerometers,
        p_value: verdict.p_value,
        mean_g: verdict.mean_g,
        mean_sigma_g: verdict.mean_sigma_g,
        description: verdict.description.clone(),
    }
}

fn noise(estimate: &NoiseEstimate) -> Vec<NoiseLevel> {
    let of = |sensor: &str, found: [NoiseRatio; 3]| {
        let each = AXES.iter().zip(found);
        let levels = each.map(|(axis, found)| NoiseLevel {
            channel: format!("{sensor}_{axis}"),
            ratio: found.ratio,
            interval: found.interval,
        });
        levels.collect::<Vec<_>>()
    };
    [of("accel", estimate.accel), of("gyro", estimate.gyro)].concat()
}

fn model_noise(validated: &CrossValidated<'_>, nominal: &FittedPlatform<'_>) -> ModelNoise {
    let fitted = validated.extended.as_ref().unwrap_or(nominal);
    let noise = fitted.noise_model();
    ModelNoise {
        accel_ratio: noise.accel_ratio,
        gyro_ratio: noise.gyro_ratio,
        gyro_walk_deg_per_h_per_sqrt_h: noise.gyro_walk_deg_per_h_per_sqrt_h,
    }
}

fn audit(audit: &NoiseAudit) -> NoiseAuditSummary {
    let estimated = |found: &crate::noise::Estimate| Estimated {
        estimate: found.estimate,
        sigma: found.sigma,
    };
    NoiseAuditSummary {
        accel_ratio: audit
            .accel_ratio
            .as_ref()
            .map(|ratios| ratios.each_ref().map(estimated)),
        correlation: audit.correlation.as_ref().map(estimated),
        quantisation_g: audit.quantisation_g,
        outliers: audit.outliers.len(),
    }
}

fn allan(test: &statistics::AllanTest) -> AllanTest {
    let [x, y, z] = &test.points;
    AllanTest {
        course: match test.course {
            NoiseCourse::White => AllanCourse::White,
            NoiseCourse::LargerWhite => AllanCourse::LargerWhite,
            NoiseCourse::Flicker => AllanCourse::Flicker,
            // A course that has no word of its own is at least not white.
            _ => AllanCourse::Slow,
        },
        p_value: test.p_value,
        rows: test.rows,
        points: x
            .iter()
            .zip(y.iter().zip(z))
            .map(|(x, (y, z))| AllanPoint {
                tau_s: x.tau_s,
                white: (x.averaging as f64).sqrt().recip(),
                deviation: [x.deviation, y.deviation, z.deviation],
                interval: [x.interval, y.interval, z.interval],
            })
            .collect(),
    }
}
