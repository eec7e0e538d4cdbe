//! The JSON result of `gyrocal diagnose`.

use serde::{Deserialize, Serialize};

use crate::channel_report::{AllanReport, NormReport};
use crate::gain_report::GainReport;
use crate::manifest::Manifest;
use crate::report::NoiseReport;
use crate::residuals_report::ResidualsReport;

/// What `gyrocal diagnose` found in a record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DiagnosisReport {
    /// [`crate::SCHEMA_VERSION`] at the time of writing.
    pub schema_version: u32,
    /// Where the result comes from.
    pub manifest: Manifest,
    /// All in one word.
    pub verdict: DiagnosisVerdict,
    /// Probability of any finding on a record of the nominal model with the declared noise.
    pub false_alarm_probability: f64,
    /// What the norm of specific force says; `None` if there are too few complete rows.
    pub norm: Option<NormReport>,
    /// What the residuals of the nominal model show; it makes no finding.
    pub residuals: Option<ResidualsReport>,
    /// What is wrong: noise, then causes, each in falling strength, then the filter.
    pub findings: Vec<FindingReport>,
    /// What the extended model gains; `None` without a cause.
    pub gain: Option<GainReport>,
    /// What is left with all causes in the model.
    pub remainder: RemainderReport,
    /// Effects that this record does not tell apart.
    pub cannot_tell: Vec<CannotTellReport>,
    /// All effects of the first search, largest statistic first.
    pub ranking: Vec<RankedReport>,
    /// What the largest statistic of `ranking` had to exceed; `None` if nothing could be searched.
    pub threshold: Option<f64>,
    /// Noise over the declared one by maximum likelihood, with all causes in the model.
    pub noise: NoiseReport,
    /// How what is left averages out; `None` without a stretch of rows that is long enough.
    pub allan: Option<AllanReport>,
    /// Effects that were not looked for, and those that so short a record could not show.
    pub not_searched: Vec<NotSearchedReport>,
    /// What another filter makes of the record, if one was asked for.
    pub filter: Option<FilterReport>,
}

/// A diagnosis in one word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum DiagnosisVerdict {
    /// Nothing is wrong.
    Clean,
    /// Something is wrong, and it has a name; noise counts.
    EffectsFound,
    /// Something is wrong, and the catalogue does not hold it.
    Unexplained,
}

/// One effect that was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FindingReport {
    /// Id of the effect that is named; of exact equivalents the first of the catalogue.
    pub effect: String,
    /// Its parameters.
    pub parameters: Vec<ParameterReport>,
    /// Its statistic in standard deviations; negative where noise is smaller than declared.
    pub z: f64,
    /// Probability of as much by chance, the whole search included.
    pub p_value: f64,
    /// Probability that effect and rivals together hold the cause.
    pub coverage: f64,
    /// The rest of the named set, nearest first.
    pub rivals: Vec<RivalReport>,
    /// Effects that no record can tell from it.
    pub equivalents: Vec<EquivalentReport>,
    /// By how much blocks of the record are predicted better with it in the model than without,
    /// beside the other causes, in nats; `None` of what is no term of the model: noise, a filter.
    pub gain_nats: Option<f64>,
    /// Whether it is in the extended model: whether that is a gain. `None` as above.
    pub accepted: Option<bool>,
}

/// One parameter of an effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParameterReport {
    /// `size`, `onset_s`, `time_constant_h`, `sine`, `cosine`, `ratio`, `fraction`, ….
    pub name: String,
    /// The estimate, in `unit`.
    pub estimate: f64,
    /// Its standard deviation; `None` of onsets and time constants, which were searched for.
    pub sigma: Option<f64>,
    /// The unit; `1` of plain numbers.
    pub unit: String,
}

/// An effect that explains nearly as much as the one that is named.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RivalReport {
    /// Its id.
    pub effect: String,
    /// How much less likely it makes the record, as a difference of log-likelihoods; below zero
    /// for a richer effect of which the simpler one was named.
    pub log_likelihood_deficit: f64,
}

/// An effect that no record can tell from the one that is named.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EquivalentReport {
    /// Its id.
    pub effect: String,
    /// What its parameters would have to be.
    pub parameters: Vec<ParameterReport>,
}

/// What is left with all causes in the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RemainderReport {
    /// Whether it is noise.
    pub verdict: RemainderVerdict,
    /// Probability of as much structure in white innovations.
    pub p_value: f64,
    /// Channel, period and size of what there is, or what could not be tested; empty if it is
    /// noise.
    pub description: String,
}

/// Whether what is left is noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum RemainderVerdict {
    /// It is white.
    White,
    /// Nothing stands out, but the record is too short for some of the tests.
    NotTested,
    /// It has structure that no effect of the catalogue explains.
    Unexplained,
}

/// Effects that a record does not tell apart.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CannotTellReport {
    /// Their ids, the named one first.
    pub members: Vec<String>,
    /// Why.
    pub why: String,
    /// What would separate them.
    pub would_separate: String,
}

/// An effect of the first search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RankedReport {
    /// Its id.
    pub effect: String,
    /// Its largest statistic (chi-square) less what searching alone reaches.
    pub statistic: f64,
}

/// An effect that was not looked for, or could not be seen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NotSearchedReport {
    /// Its id.
    pub effect: String,
    /// Why not.
    pub why: String,
}

/// What another filter makes of the record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FilterReport {
    /// Which filter: `euler` is that of the paper.
    pub name: String,
    /// Its mean normalised innovation squared of a row; `None` if it stopped.
    pub nis_mean: Option<f64>,
    /// The interval that holds the mean of a filter that fits, lower end first.
    pub nis_band: [f64; 2],
    /// The mean of the filter of this program on the same record.
    pub reference_nis_mean: f64,
    /// Where and why it stopped, if it did.
    pub stopped: Option<String>,
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::channel_report::{AllanCourse, AllanPointReport};
    use crate::gain_report::{CompensationReport, FreeRunReport, ShiftReport, ValidationReport};
    use crate::manifest::Input;
    use crate::report::{NoiseRatioReport, SCHEMA_VERSION};
    use crate::residuals_report::AgainstReport;

    fn report() -> DiagnosisReport {
        let size = ParameterReport {
            name: "size".to_owned(),
            estimate: 0.1 + 0.2,
            sigma: Some(1.0 / 3.0),
            unit: "deg/h/g".to_owned(),
        };
        let onset = ParameterReport {
            name: "onset_s".to_owned(),
            estimate: 86_400.0,
            sigma: None,
            unit: "s".to_owned(),
        };
        let ratio = NoiseRatioReport {
            ratio: 1.01,
            interval: [0.99, 1.03],
        };
        DiagnosisReport {
            schema_version: SCHEMA_VERSION,
            manifest: Manifest {
                program: "gyrocal".to_owned(),
                version: "0.1.0".to_owned(),
                model_hash: "00".to_owned(),
                inputs: vec![Input {
                    path: "r.csv".to_owned(),
                    sha256: "11".to_owned(),
                }],
                seed: 0,
                command: "gyrocal diagnose r.csv --bench b.toml".to_owned(),
            },
            verdict: DiagnosisVerdict::EffectsFound,
            false_alarm_probability: 0.01,
            norm: Some(NormReport {
                accelerometers: true,
                p_value: 1e-9,
                mean_g: 3e-6,
                mean_sigma_g: 1e-7,
                description: "it is above gravity".to_owned(),
            }),
            residuals: Some(ResidualsReport {
                nis: None,
                autocorrelation: None,
                lines: None,
                free_run_rms_g: [1e-5, 2e-5, 3e-5],
                against: vec![AgainstReport {
                    abscissa: "time_s".to_owned(),
                    p_value: [0.5, 0.1, 1e-3],
                    at: [0, 1, 2].map(|_| vec![0.0, 60.0]),
                    mean: [0, 1, 2].map(|_| vec![-0.1, 0.1]),
                }],
            }),
            findings: vec![FindingReport {
                effect: "gyro_y.g_xx".to_owned(),
                parameters: vec![size.clone(), onset],
                z: 18.9,
                p_value: 5e-324,
                coverage: 0.95,
                rivals: vec![RivalReport {
                    effect: "gyro_y.g_yz".to_owned(),
                    log_likelihood_deficit: 3.6,
                }],
                equivalents: vec![EquivalentReport {
                    effect: "gyro_y.g_zz".to_owned(),
                    parameters: vec![size],
                }],
                gain_nats: Some(41.2),
                accepted: Some(true),
            }],
            gain: Some(GainReport {
                effects: vec!["gyro_y.g_xx".to_owned()],
                cross_validated_log_score_nats: 41.2,
                block_log_score_nats: vec![40.0, 1.2],
                free_run_rms_g: FreeRunReport {
                    before: 3.1e-4,
                    after: 1.2e-5,
                    noise: 1e-5,
                },
                coefficient_shift: vec![ShiftReport {
                    coefficient: "gyro_y.bias".to_owned(),
                    shift: -0.0034,
                    interval: [-0.0036, -0.0032],
                    in_sigmas: -19.0,
                    in_sigmas_interval: [-20.1, -17.9],
                    unit: "deg/h".to_owned(),
                }],
                validation: Some(ValidationReport {
                    log_score_nats: 7.5,
                    compensation: CompensationReport {
                        starts: 9,
                        after_h: 24.0,
                        nominal_arcmin: 3.1,
                        extended_arcmin: 0.2,
                        expected_arcmin: 0.15,
                    },
                }),
            }),
            remainder: RemainderReport {
                verdict: RemainderVerdict::White,
                p_value: 0.4,
                description: String::new(),
            },
            cannot_tell: vec![CannotTellReport {
                members: vec!["gyro_y.g_xx".to_owned(), "gyro_y.g_zz".to_owned()],
                why: "the same samples".to_owned(),
                would_separate: "a centrifuge".to_owned(),
            }],
            ranking: vec![RankedReport {
                effect: "gyro_y.g_xx".to_owned(),
                statistic: 357.2,
            }],
            threshold: Some(14.2),
            noise: NoiseReport {
                accel: [ratio; 3],
                gyro: [ratio; 3],
            },
            allan: Some(AllanReport {
                course: AllanCourse::LargerWhite,
                p_value: 1e-4,
                rows: 128,
                points: vec![AllanPointReport {
                    tau_s: 60.0,
                    white: 1.0,
                    deviation: [1.2; 3],
                    interval: [[1.1, 1.3]; 3],
                }],
            }),
            not_searched: vec![NotSearchedReport {
                effect: "gyro_x.magnetic".to_owned(),
                why: "only if asked for".to_owned(),
            }],
            filter: Some(FilterReport {
                name: "euler".to_owned(),
                nis_mean: None,
                nis_band: [2.9, 3.1],
                reference_nis_mean: 3.0,
                stopped: Some("at row 7".to_owned()),
            }),
        }
    }

    #[test]
    fn a_report_is_read_as_it_was_written() {
        let text = serde_json::to_string(&report()).unwrap();
        assert_eq!(
            serde_json::from_str::<DiagnosisReport>(&text).unwrap(),
            report()
        );
    }

    #[test]
    fn words_are_those_of_the_contract() {
        let value = serde_json::to_value(report()).unwrap();
        assert_eq!(value["verdict"], "effects-found");
        assert_eq!(value["remainder"]["verdict"], "white");
        assert_eq!(value["allan"]["course"], "larger-white");
        let untested = serde_json::to_value(RemainderVerdict::NotTested).unwrap();
        assert_eq!(untested, "not-tested");
        assert_eq!(
            value["findings"][0]["parameters"][1]["sigma"],
            serde_json::Value::Null
        );
        assert_eq!(value["gain"]["free_run_rms_g"]["noise"], 1e-5);
        let words = [
            serde_json::to_value(DiagnosisVerdict::Clean).unwrap(),
            serde_json::to_value(DiagnosisVerdict::Unexplained).unwrap(),
            serde_json::to_value(RemainderVerdict::Unexplained).unwrap(),
        ];
        assert_eq!(words, ["clean", "unexplained", "unexplained"]);
    }
}
