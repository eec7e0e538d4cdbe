//! Answers as files: each is written, held against its schema, read back, and given to what takes one; and none calls
//! settled what is not.

use gyrocal_answer::{Answer, Subject, Verdict, read_text, write_text};
use gyrocal_fleet::{FleetRecord, RecordName};
use gyrocal_pages::of_result;
use gyrocal_record::SourceText;
use gyrocal_testkit::contracts::{schema_of, violations};
use gyrocal_testkit::run;
use serde::{Deserialize, Serialize};

use crate::before::gyrocal;
use crate::harness::Error;

/// What is wrong with an answer as a file, and whether it has names that are not settled.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Checked {
    /// Refusals and differences.
    pub(crate) faults: Vec<String>,
    /// Whether its search was cut, or what its names leave is not white.
    pub(crate) is_open: bool,
    /// Places that call it settled all the same.
    pub(crate) settled: Vec<String>,
}

impl Checked {
    pub(crate) fn of(answer: &Answer) -> Result<Self, Error> {
        let is_open = answer.verdict != Verdict::Setup
            && (!answer.search_complete || !answer.findings.is_empty() && answer.is_unexplained());
        let faults = match write_text(answer) {
            Ok(text) => faults(answer, &text)?,
            Err(error) => vec![error.to_string()],
        };
        let settled = if is_open { settled(answer) } else { Vec::new() };
        Ok(Self {
            faults,
            is_open,
            settled,
        })
    }
}

/// What does not take the text of an answer.
fn faults(answer: &Answer, text: &str) -> Result<Vec<String>, Error> {
    let mut faults = Vec::new();
    let schema = schema_of("diagnose").unwrap_or_default();
    let found = violations(&schema, text);
    if !found.is_empty() {
        faults.push(format!("schema: {found}"));
    }
    match read_text(&SourceText::new(text, "answer.json")?) {
        Ok(read) if read == *answer => (),
        Ok(_) => faults.push("reads back as another answer".to_owned()),
        Err(error) => faults.push(format!("read back: {error}")),
    }
    let folder = tempfile::tempdir()?;
    std::fs::write(folder.path().join("answer.json"), text)?;
    let mut refused = |arguments: &[&str], may_say: &str| -> Result<(), Error> {
        let outcome = run(gyrocal(folder.path())?.args(arguments));
        let said = outcome.stderr.split_whitespace();
        let said = said.collect::<Vec<_>>().join(" ");
        if outcome.code != Some(0) && (may_say.is_empty() || !said.contains(may_say)) {
            faults.push(format!("{}: {said}", arguments.join(" ")));
        }
        Ok(())
    };
    let is_plant = matches!(answer.subject, Subject::Plant(_));
    let may_say = match is_plant {
        true => "an answer on the plant",
        false => "expected an effect of the extended model",
    };
    refused(&["report", "answer.json", "--out", "page.html"], "")?;
    refused(&["extend", "answer.json", "--out", "e.model.toml"], may_say)?;
    if let Err(error) = FleetRecord::read(RecordName::default(), text, None)
        && !is_plant
    {
        faults.push(format!("fleet: {error}"));
    }
    Ok(faults)
}

/// What is said of names that are settled alone: that others are excluded, or were all tested.
const CLAIMS: [&str; 7] = [
    "are excluded",
    "or below the threshold",
    "no alternatives",
    "nothing else of the catalogue",
    "ts set has no other effect",
    "very effect",
    "No alternative of the catalogue",
];

/// Places that call an answer settled.
fn settled(answer: &Answer) -> Vec<String> {
    let mut places = Vec::new();
    if answer.verdict != Verdict::NotSettled {
        places.push("verdict".to_owned());
    }
    let page = of_result(answer);
    let first = page.first.headline();
    if !first.to_lowercase().contains("not settled") {
        places.push(format!("first screen: {first}"));
    }
    let mut said = format!("{page:?}");
    if matches!(answer.subject, Subject::Plant(_)) {
        said += &gyrocal_words::plant::all(answer).join(" ");
    }
    let claims = CLAIMS.iter().filter(|claim| said.contains(**claim));
    places.extend(claims.map(|claim| format!("\"{claim}\"")));
    places
}
