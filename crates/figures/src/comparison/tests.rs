use gyrocal_evaluation::{BaselineResult, BaselineScore, FindingScore, InjectedScore};

use super::*;

const COEFFICIENTS: CoefficientScore = CoefficientScore {
    covered: 9,
    largest_error: 1.5,
};

/// A record with a hidden `gyro_x.g_y`, the names of a set of the diagnosis, and those that `bic` selects.
fn score(own: &[&str], selected: &[&str], coefficients: CoefficientScore) -> RecordScore {
    let findings = own.split_first().map(|(first, others)| FindingScore {
        effect: (*first).to_owned(),
        z: 8.0,
        parameters: Vec::new(),
        alternatives: others
            .iter()
            .map(|other| ((*other).to_owned(), 1.0))
            .collect(),
        equivalents: Vec::new(),
        lacks_equivalents: false,
        none_of_these: None,
    });
    let names: Vec<String> = selected.iter().map(|name| (*name).to_owned()).collect();
    RecordScore {
        hidden: vec![InjectedScore {
            effect: "gyro_x.g_y".to_owned(),
            parameters: Vec::new(),
            strength: 8.0,
            in_set: true,
            first_cosine: 1.0,
            covered: None,
            onset_error: None,
            deficit: None,
        }],
        verdict: if own.is_empty() {
            "clean"
        } else {
            "effects-found"
        }
        .to_owned(),
        findings: findings.into_iter().collect(),
        noise: Vec::new(),
        unexplained: None,
        oracle_set_size: None,
        oracle_in_set: None,
        nearest: Vec::new(),
        coefficients: Some(coefficients),
        methods: vec![BaselineScore {
            method: "bic".to_owned(),
            result: BaselineResult {
                detected: !names.is_empty(),
                names,
            },
            first_cosine: 0.0,
            coefficients: Some(COEFFICIENTS),
        }],
    }
}

fn measured(figures: &[Figure], name: &str) -> String {
    let found = figures.iter().find(|figure| figure.name == name);
    found.map_or_else(
        || format!("no figure {name}"),
        |figure| figure.measured.clone(),
    )
}

#[test]
fn a_set_counts_by_its_members_and_its_first_name() {
    let records = [
        score(
            &["gyro_x.g_y"],
            &["gyro_y.ramp", "gyro_x.g_y"],
            COEFFICIENTS,
        ),
        score(
            &["gyro_y.ramp", "gyro_x.g_y"],
            &["gyro_y.ramp"],
            COEFFICIENTS,
        ),
        score(
            &[],
            &[],
            CoefficientScore {
                covered: 6,
                largest_error: 5.0,
            },
        ),
    ];
    let figures = of_method(Method::Own, &[], &records, "0..3");
    let of = |column: &str| measured(&figures, &format!("gyrocal: {column}"));
    assert!(of(DETECTED).starts_with("0.667 ("), "{}", of(DETECTED));
    assert!(of(FIRST).starts_with("0.333 ("), "{}", of(FIRST));
    assert!(of(NAMED).starts_with("0.667 ("), "{}", of(NAMED));
    assert_eq!(of(NAMES), "1.50 in 1.00 findings");
    assert!(of(COVERAGE).starts_with("0.889 ("), "{}", of(COVERAGE));
    assert!(of(FAR_OFF).starts_with("0.333 ("), "{}", of(FAR_OFF));
    assert_eq!(of(FALSE_ALARMS), "nothing to measure on");
    // Three records show nothing of the targets.
    assert!(figures.iter().all(|figure| figure.holds.is_none()));
    assert_eq!(figures.iter().filter(|figure| figure.too_few).count(), 4);

    let bic = Method::Baseline(BaselineMethod::Bic);
    let selected = of_method(bic, &records[2..], &records, "0..3");
    let of = |column: &str| measured(&selected, &format!("bic: {column}"));
    assert!(of(FIRST).starts_with("0.000 ("), "{}", of(FIRST));
    assert!(of(NAMED).starts_with("0.333 ("), "{}", of(NAMED));
    assert_eq!(of(NAMES), "1.50");
    assert!(
        of(FALSE_ALARMS).starts_with("0.000 ("),
        "{}",
        of(FALSE_ALARMS)
    );

    let all: Vec<Figure> = figures.into_iter().chain(selected).collect();
    let table = side_by_side(&all);
    let row = table.lines().find(|line| line.starts_with("| `bic` |"));
    assert!(row.is_some_and(|row| row.contains(" 1.50 |")), "{table}");
    // Tests were not applied here, and have no names anyway.
    assert!(table.contains("| `nis` | – |"), "{table}");
}
