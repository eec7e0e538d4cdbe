//! The eight topics: which part measures what.

mod doors;

use crate::error::Error;
use crate::figure::Figure;
use crate::harness::Context;
use crate::harness::sources::{CALIBRATION, DIAGNOSIS, FILTER, INSTRUMENTS, PLANTS, Sources, of};
use crate::harness::topic::{Part, Topic};
use crate::{
    any_plant, calibration, catalogue, comparison, diagnosis_ground, dialects, embedded, field,
    gain, generator, kernel, logs, measured, naming, paper, plant_peers, real_plants, records,
    truth, watch,
};

/// All topics.
pub(crate) const TOPICS: [Topic; 8] = [
    Topic {
        name: "kernel",
        about: "The filter's kernel and generated code: speed, scaling, rounding, instructions, other generators.",
        parts: &[
            Part {
                small: false,
                introduction: |_| kernel::INTRODUCTION.to_owned(),
                ..part(
                    "filter",
                    "The structured kernel: rounding errors, instructions, speed, scaling.",
                    of(
                        FILTER,
                        &[
                            "crates/figures/src/kernel.rs",
                            "crates/figures/src/kernel",
                            "crates/figures/examples",
                            "examples/step_times.rs",
                        ],
                    ),
                    kernel::figures,
                )
            },
            Part {
                small: false,
                introduction: |_| generator::INTRODUCTION.to_owned(),
                ..part(
                    "generator",
                    "The generator of Rust against others: speed, instructions, operations, random graphs; derivation and builds.",
                    of(
                        FILTER,
                        &[
                            "crates/figures/src/generator.rs",
                            "crates/figures/src/generator",
                        ],
                    ),
                    generator::figures,
                )
            },
        ],
    },
    Topic {
        name: "calibration",
        about: "From symbols to nine drift coefficients: consistency, cost, budget, the paper.",
        parts: &[
            part(
                "estimator",
                "The estimators over a population: consistency, coverage, a second attitude, cost.",
                of(
                    CALIBRATION,
                    &[
                        "crates/figures/src/calibration.rs",
                        "crates/figures/src/calibration",
                    ],
                ),
                calibration::figures,
            ),
            part(
                "budget",
                "The uncertainty budget against simulated and calibrated runs.",
                of(CALIBRATION, &["crates/figures/src/calibration"]),
                calibration::budget::figures,
            ),
            part(
                "paper",
                "The paper, reproduced and corrected: docs/paper.md, its pictures, its filter beside others.",
                of(
                    CALIBRATION,
                    &["crates/figures/src/paper.rs", "crates/figures/src/paper"],
                ),
                paper::figures,
            ),
        ],
    },
    Topic {
        name: "diagnosis",
        about: "Truth of the diagnosis: clean records, causes, noise, effects outside of the catalogue, set-up, hostile records.",
        parts: &[
            diagnosed(
                "ground",
                "The noise audit, and signatures against the simulation.",
                diagnosis_ground::figures,
            ),
            diagnosed(
                "naming",
                "Cells of `gyrocal characterise`: detection, names, sets, false alarms.",
                naming::figures,
            ),
            Part {
                introduction: comparison::side_by_side,
                ..diagnosed(
                    "comparison",
                    "The diagnosis beside the usual tests and selection methods, on the same records.",
                    comparison::figures,
                )
            },
            diagnosed(
                "gain",
                "Gain of extended models: in cross-validation, in the coefficients.",
                gain::figures,
            ),
            hidden(
                "setup",
                "Gross errors of the set-up.",
                truth::setup::figures,
            ),
            hidden(
                "hostile",
                "Work on records that no model fits.",
                truth::hostile::figures,
            ),
            hidden(
                "shapes",
                "Onsets and time constants.",
                truth::shapes::figures,
            ),
            hidden(
                "causes",
                "One cause of the catalogue in noise that is misdeclared in half of the records.",
                truth::causes::figures,
            ),
            hidden(
                "walks",
                "Random walks of the gyros.",
                truth::noise::of_walks,
            ),
            hidden("flicker", "Flicker of the gyros.", truth::noise::of_flicker),
            hidden(
                "clean",
                "Noise other than declared, without a cause.",
                truth::noise::of_clean,
            ),
            hidden(
                "together",
                "A cause of the catalogue beside random walks.",
                truth::together::figures,
            ),
            hidden(
                "outside",
                "Causes outside of the catalogue.",
                truth::outside::figures,
            ),
            diagnosed(
                "field",
                "Records that a user could have: wrong numbers in bench files, and kinds of records.",
                field::of_records,
            ),
            part(
                "catalogue",
                "The catalogue of effects: docs/catalogue.md and a picture of each signature.",
                of(
                    DIAGNOSIS,
                    &[
                        "crates/figures/src/catalogue.rs",
                        "crates/figures/src/catalogue",
                    ],
                ),
                |to| catalogue::figures(to.write),
            ),
        ],
    },
    Topic {
        name: "records",
        about: "Several records of one platform: together, planned, and predicted.",
        parts: &[
            diagnosed(
                "several",
                "Several records of one platform, diagnosed together.",
                records::several::figures,
            ),
            diagnosed(
                "planning",
                "Planned runs, made: predicted against actual sigmas and confidence sets.",
                records::planning::figures,
            ),
            diagnosed(
                "later",
                "A second record, predicted by the extended model of a first.",
                records::later::figures,
            ),
        ],
    },
    Topic {
        name: "instruments",
        about: "Instrument tests on simulated logs and on recordings of real gyros.",
        parts: &[
            part(
                "logs",
                "Instrument tests on simulated logs: noise, positions, stops, rates.",
                of(
                    INSTRUMENTS,
                    &["crates/figures/src/logs.rs", "crates/figures/src/logs"],
                ),
                logs::figures,
            ),
            part(
                "dialects",
                "Dialects of files, listed and drawn: read as they are, or by the map that is proposed.",
                dialects::SOURCES,
                dialects::figures,
            ),
            part(
                "measured",
                "Two recordings of real gyros: docs/measured-data.md.",
                of(
                    INSTRUMENTS,
                    &[
                        "crates/figures/src/measured.rs",
                        "crates/figures/src/measured",
                    ],
                ),
                measured::figures,
            ),
        ],
    },
    Topic {
        name: "plants",
        about: "Diagnosis of any plant: simulated plants with hidden effects, other tools.",
        parts: &[
            part(
                "simulated",
                "Five simulated plants with hidden effects: alarms, sets, gain, starts, time.",
                of(
                    PLANTS,
                    &[
                        "crates/figures/src/any_plant.rs",
                        "crates/figures/src/any_plant",
                    ],
                ),
                any_plant::figures,
            ),
            part(
                "field",
                "Kinds of records of a servo that a user could have.",
                of(
                    PLANTS,
                    &[
                        "crates/figures/src/any_plant.rs",
                        "crates/figures/src/field.rs",
                        "examples/servo",
                    ],
                ),
                field::of_plants,
            ),
            Part {
                small: false,
                ..part(
                    "real",
                    "Records of real plants: what is named, and the error on a later record.",
                    of(
                        PLANTS,
                        &[
                            "crates/figures/src/real_plants.rs",
                            "tests/data/measured/quarter_drone",
                            "tests/data/measured/buck_converter",
                        ],
                    ),
                    real_plants::figures,
                )
            },
            Part {
                small: false,
                ..part(
                    "peers",
                    "The diagnosis of a plant beside sparse and symbolic regression from PyPI.",
                    of(
                        PLANTS,
                        &[
                            "crates/figures/src/any_plant.rs",
                            "crates/figures/src/any_plant",
                            "crates/figures/src/plant_peers.rs",
                            "crates/figures/src/plant_peers",
                        ],
                    ),
                    plant_peers::figures,
                )
            },
        ],
    },
    doors::DOORS,
    Topic {
        name: "embedded",
        about: "The filter and the watch in a controller.",
        parts: &[
            Part {
                small: false,
                ..part(
                    "controller",
                    "The filter on an emulated Cortex-M4F, single precision, C.",
                    of(
                        &["", "crates/c-api", "tests/firmware"],
                        &[
                            "crates/figures/src/embedded.rs",
                            "crates/figures/src/embedded",
                        ],
                    ),
                    embedded::figures,
                )
            },
            part(
                "watch",
                "The watch beside the filter: false alarms, delays, jumps, sets in simulated platform-years.",
                watch::SOURCES,
                watch::figures,
            ),
        ],
    },
];

const fn part(
    name: &'static str,
    about: &'static str,
    sources: Sources,
    figures: fn(&Context) -> Result<Vec<Figure>, Error>,
) -> Part {
    Part {
        name,
        about,
        small: true,
        sources,
        figures,
        introduction: |_| String::new(),
    }
}

/// A part that measures diagnoses of simulated records of the platform.
const fn diagnosed(
    name: &'static str,
    about: &'static str,
    figures: fn(&Context) -> Result<Vec<Figure>, Error>,
) -> Part {
    part(name, about, of(DIAGNOSIS, &["crates/figures/src"]), figures)
}

/// A part that measures diagnoses of records whose noise, set-up or causes are other than declared.
const fn hidden(
    name: &'static str,
    about: &'static str,
    figures: fn(&Context) -> Result<Vec<Figure>, Error>,
) -> Part {
    let files = &["crates/figures/src/truth.rs", "crates/figures/src/truth"];
    part(name, about, of(DIAGNOSIS, files), figures)
}
