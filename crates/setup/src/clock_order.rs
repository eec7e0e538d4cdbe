//! Order of the times.

use gyrocal_record::{ClockFault, Record, UNNAMED};

use crate::finding::SetupFinding;
use crate::kind::SetupKind;
use crate::text::row;

/// Times that do not rise, and columns of other lengths than the times.
pub(crate) fn find(record: &Record) -> Vec<SetupFinding> {
    let mut findings = Vec::new();
    let lengths = [
        record.accel_g.len(),
        record.temperature_c.as_ref().map_or(record.len(), Vec::len),
    ];
    if lengths.iter().any(|length| *length != record.len()) {
        let description = "The columns of the record differ in length. Give one value of each for \
                           every row."
            .to_owned();
        let evidence = format!(
            "{} times, {} samples, {} temperatures",
            record.len(),
            lengths[0],
            lengths[1]
        );
        findings.push(SetupFinding::new(SetupKind::Missing, description, evidence).stopping());
    }
    let is_wrong = |at: usize| {
        let [before_s, time_s] = [record.time_s[at - 1], record.time_s[at]];
        // Not finite is wrong as well.
        !(time_s > before_s && time_s.is_finite())
    };
    let mut wrong: Vec<usize> = (1..record.len()).filter(|at| is_wrong(*at)).collect();
    if record
        .time_s
        .first()
        .is_some_and(|first| !first.is_finite())
    {
        wrong.insert(0, 0);
    }
    if let (Some(first), Some(last)) = (wrong.first(), wrong.last()) {
        let fault = ClockFault::of(&record.time_s, UNNAMED);
        let (found, advice) = fault.map_or_else(
            || {
                (
                    "a time that is not finite".to_owned(),
                    "give every row a time".to_owned(),
                )
            },
            |fault| (fault.found, fault.advice),
        );
        let advice = advice[..1].to_uppercase() + &advice[1..];
        let description = format!("Time does not rise at row {}. {advice}.", row(*first));
        let evidence = format!("found {found}");
        findings.push(
            SetupFinding::new(SetupKind::Clock, description, evidence)
                .stopping()
                .at(*first..last + 1),
        );
    }
    findings
}
