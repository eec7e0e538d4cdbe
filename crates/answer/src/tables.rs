//! Findings and coefficients of a diagnosis as tables.

use gyrocal_record::ResultTable;

use crate::{Answer, CoefficientEstimate, Finding, Parameter};

impl Answer {
    /// The findings, one row for each parameter.
    #[must_use]
    pub fn finding_table(&self) -> ResultTable {
        let all: Vec<(&Finding, &Parameter)> = self
            .findings
            .iter()
            .flat_map(|finding| finding.parameters.iter().map(move |one| (finding, one)))
            .collect();
        let each = || all.iter();
        let names = |finding: &Finding| {
            let all = finding.alternatives.iter().map(|other| &*other.effect);
            let all: Vec<&str> = all.collect();
            (!all.is_empty()).then(|| all.join(" "))
        };
        ResultTable::default()
            .texts("effect", each().map(|(finding, _)| Some(&*finding.effect)))
            .texts("name", each().map(|(finding, _)| Some(&*finding.name)))
            .texts("parameter", each().map(|(_, one)| Some(&*one.name)))
            .numbers("estimate", each().map(|(_, one)| Some(one.estimate)))
            .numbers("sigma", each().map(|(_, one)| one.sigma))
            .texts("unit", each().map(|(_, one)| Some(&*one.unit)))
            .numbers("z", each().map(|(finding, _)| Some(finding.z)))
            .numbers("p_value", each().map(|(finding, _)| finding.p_value))
            .texts("may_also_be", each().map(|(finding, _)| names(finding)))
            .numbers("gain_nats", each().map(|(finding, _)| finding.gain_nats))
            .texts(
                "accepted",
                each().map(|(finding, _)| finding.accepted.map(|is| is.to_string())),
            )
    }

    /// The drift coefficients of the nominal and of the extended model, one a row; none without a fit.
    #[must_use]
    pub fn coefficient_table(&self) -> ResultTable {
        let all: Vec<(&str, &CoefficientEstimate)> = self
            .coefficients
            .iter()
            .flat_map(|both| {
                let nominal = both.nominal.iter().map(|one| ("nominal", one));
                let extended = both.extended.iter().flatten();
                nominal.chain(extended.map(|one| ("extended", one)))
            })
            .collect();
        let each = || all.iter();
        ResultTable::default()
            .texts("model", each().map(|(model, _)| Some(*model)))
            .texts("name", each().map(|(_, one)| Some(&*one.name)))
            .numbers("estimate", each().map(|(_, one)| Some(one.estimate)))
            .numbers("sigma", each().map(|(_, one)| Some(one.sigma)))
            .texts("unit", each().map(|(_, one)| Some(&*one.unit)))
    }
}
