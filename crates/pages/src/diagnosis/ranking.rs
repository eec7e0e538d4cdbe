//! Effects by test statistic.

use gyrocal_diagnosis::{DiagnosisResult, prose};
use gyrocal_report::page::{Bar, BarGroup, Bars, Item, Section, Tint};
use gyrocal_statistics::format;

use super::section as titled;
use crate::words::listed;

/// Number of effects shown that are neither reported nor alternatives.
const OTHERS: usize = 10;

/// `None` if nothing was searched.
fn ranking(result: &DiagnosisResult) -> Option<Bars> {
    let threshold = result.threshold.filter(|threshold| *threshold > 0.0)?;
    let first = result.ranking.first()?;
    let statistic = |effect: &str| {
        let ranked = result.ranking.iter().find(|ranked| ranked.effect == effect);
        ranked.map_or(f64::NAN, |ranked| ranked.statistic)
    };
    let bar = |effect: &str, tint: Tint, note: String| Bar {
        label: effect.to_owned(),
        value: statistic(effect),
        tint,
        note,
    };
    let mut groups = Vec::new();
    let mut shown: Vec<&str> = Vec::new();
    for finding in result.causes() {
        let note = format!("reported, {:.1} sigma", finding.z);
        let mut bars = vec![bar(&finding.effect, Tint::Extended, note)];
        let equal = finding.equivalents.iter().map(|equal| {
            let note = "exact equivalent".to_owned();
            bar(&equal.effect, Tint::Alternative, note)
        });
        bars.extend(equal);
        let others = finding.alternatives.iter();
        bars.extend(
            others.map(|other| bar(&other.effect, Tint::Alternative, prose::likelihood(other))),
        );
        shown.push(&finding.effect);
        shown.extend(finding.alternatives.iter().map(|one| &*one.effect));
        shown.extend(finding.equivalents.iter().map(|one| &*one.effect));
        groups.push(BarGroup {
            label: match bars.len() {
                1 => format!("{}, no alternatives", finding.effect),
                _ => format!("{} and its alternatives", finding.effect),
            },
            bars,
        });
    }
    let rest = result.ranking.iter();
    let rest: Vec<_> = rest.filter(|one| !shown.contains(&&*one.effect)).collect();
    let others = rest.iter().take(OTHERS);
    groups.push(BarGroup {
        label: "Not reported: excluded, or below the threshold".to_owned(),
        bars: others
            .map(|one| bar(&one.effect, Tint::Other, String::new()))
            .collect(),
    });
    let causes: Vec<&str> = result.causes().map(|cause| &*cause.effect).collect();
    Some(Bars {
        title: if causes.is_empty() {
            format!(
                "None of {} effects exceeds the threshold; the strongest is {}",
                result.ranking.len(),
                first.effect
            )
        } else {
            let count = result.ranking.len();
            format!("{} detected among {count} effects tested", listed(&causes))
        },
        quantity: "score statistic, first search (chi-square, penalised for search)".to_owned(),
        threshold: Some((
            threshold,
            format!(
                "detection threshold, false-alarm probability {} over all effects",
                format::percent(result.false_alarm_shares.search)
            ),
        )),
        groups,
        omitted: rest.get(OTHERS).map_or_else(String::new, |next| {
            format!(
                "{} more effects are not shown; the largest statistic among them is {:.1}.",
                rest.len() - OTHERS,
                next.statistic
            )
        }),
    })
}

pub(super) fn section(result: &DiagnosisResult) -> Option<Section> {
    let bars = ranking(result)?;
    Some(titled(
        "ranking",
        "Ranking",
        "Each effect of the catalogue was tested against the nominal model. An effect beyond the dashed \
         threshold is significant; those that resemble a stronger one are explained by it.",
        vec![Item::Bars(bars)],
    ))
}
