//! What people meet.

use super::part;
use crate::harness::sources::{COMMAND, of};
use crate::harness::topic::{Part, Topic};
use crate::{before, facts, field, fleet, house, report};

pub(super) const DOORS: Topic = Topic {
    name: "doors",
    about: "What people meet: report, Python, fleets; the structure of the tree, its build and its gate.",
    parts: &[
        part(
            "structure",
            "Structure of the tree, cost of a build and of the gate.",
            of(COMMAND, &["crates", "codegen", "src"]),
            house::figures,
        ),
        part(
            "answers",
            "Answers as files: written, held against their schema, read back, given to every command.",
            of(
                COMMAND,
                &[
                    "crates/evaluation",
                    "crates/figures/src/answers.rs",
                    "crates/figures/src/field.rs",
                ],
            ),
            field::of_answers,
        ),
        part(
            "before",
            "Results of 40 records, every key, against those of an earlier build.",
            of(COMMAND, &["crates/figures/src/before", "tests/data/before"]),
            before::figures,
        ),
        part(
            "facts",
            "What screens and pages of 200 answers show, against what an earlier build showed.",
            of(
                COMMAND,
                &[
                    "crates/figures/src/before",
                    "crates/figures/src/facts",
                    "crates/figures/src/facts.rs",
                    "crates/evaluation",
                    "crates/truth",
                    "tests/data/before",
                    "tests/data/facts",
                ],
            ),
            facts::figures,
        ),
        part(
            "numbers",
            "Numbers of pages that follow from others on them, recomputed from the HTML alone.",
            of(
                COMMAND,
                &[
                    "crates/figures/src/before",
                    "crates/figures/src/facts",
                    "crates/figures/src/facts.rs",
                    "crates/evaluation",
                    "crates/truth",
                    "tests/data/before",
                    "tests/data/facts",
                ],
            ),
            facts::numbers::figures,
        ),
        Part {
            small: false,
            ..part(
                "report",
                "The report: its files, in a browser; pictures of it.",
                of(
                    COMMAND,
                    &["crates/figures/src/report.rs", "crates/figures/src/report"],
                ),
                report::figures,
            )
        },
        Part {
            small: false,
            ..part(
                "fleet",
                "The Python package: its wheel, a first diagnosis with it, fleets of records.",
                of(
                    &["crates/python", "crates/fleet", "crates/evaluation"],
                    &["crates/figures/src/fleet.rs", "crates/figures/src/fleet"],
                ),
                fleet::figures,
            )
        },
    ],
};
