//! The signature of every effect of the catalogue against finite differences of the nonlinear
//! simulation, which is written independently; `cargo figures diagnosis --part ground` does the same
//! over more and longer records.

use gyrocal_testkit::signature_differences::compare;
use gyrocal_truth::{Population, Scenario, Temperature};

#[test]
fn every_signature_is_what_the_simulation_does() {
    let scenario = Scenario {
        duration_s: 86_400.0,
        interval_s: 120.0,
        temperature: Some(Temperature::default()),
        magnetic_field_gauss: Some([0.01, 0.2, -0.45]),
        ..Population::new(8).scenario(1)
    };
    let compared = compare(&scenario).unwrap();
    assert!(compared.len() > gyrocal::generated::catalogue::PARAMETERS.len());
    for one in compared {
        println!("{}: {:.1e} {:?}", one.name, one.error, one.projected);
        // What is asked for; drift that is taken in the middle of a step of 120 s, and terms of
        // second order in a misalignment, are some 1e-4.
        // The slope over 40 minutes takes a hundredth of waves of six hours. A hysteresis is known from row
        // to row, as the record has no gap.
        let allowed = if one.is_of_slope { 1e-2 } else { 1e-3 };
        assert!(one.error < allowed, "{one:?}");
    }
}
