use super::{captured, checked, over, rules};

const PAGE: &str = "<article><h2>what it does</h2>
<p>open-loop error 35.5 → 17.7 µg with it in the model (noise 10); +69.4 nats on left-out blocks</p>
<p>gyro_y.g_z: +69.4 nats of predictive log score, better in 6 of 6 blocks</p>
<p>4321 rows over 3.00 days</p>
<table><caption>Drift coefficients</caption>
<thead><tr><th>coefficient</th><th>nominal model</th><th>extended model</th><th>change, σ of the nominal fit</th></tr></thead>
<tr><td>gyro_y.bias</td><td>−0.28690 ± 0.00010</td><td>−0.287069 ± 0.000053</td><td>−1.7</td></tr></table>
<table><caption>Changes</caption>
<thead><tr><th>coefficient</th><th>change</th><th>in σ of the nominal fit</th></tr></thead>
<tr><td>gyro_y.bias</td><td>−1.68e−4</td><td>−1.7</td></tr></table>
<table><caption>Tests</caption><thead><tr><th>model</th><th>test</th><th>found</th><th>p</th></tr></thead>
<tr><td>nominal</td><td>mean normalised innovation squared</td><td>3.106 (band 2.879 to 3.124), 12963 values in 4321 rows</td><td>0.005</td></tr>
<tr><td>with all causes</td><td>largest spectral line</td><td></td><td>0.37</td></tr>
<tr><td>with all causes</td><td>correlation over rows (Ljung-Box)</td><td>159 for 180 degrees of freedom</td><td>0.87</td></tr>
<tr><td>with all causes</td><td>all residual tests together</td><td></td><td>0.60</td></tr></table>
<table><caption>Findings</caption><thead><tr><th>effect</th><th>parameter</th><th>estimate</th><th>z</th></tr></thead>
<tr><td>gyro_y.g_z</td><td>size</td><td>0.001328 ± 0.000076</td><td>17.6</td></tr>
<tr><td>accel.outliers</td><td>fraction</td><td>0.0072 ± 0.0076</td><td>37.5</td></tr>
<tr><td></td><td>size</td><td>0.0026 ± 0.0016</td><td></td></tr></table></article>";

/// The rules that numbers of an edited page break.
fn broken(from: &str, to: &str) -> Vec<&'static str> {
    assert!(PAGE.contains(from), "{from}");
    let all = checked(&PAGE.replacen(from, to, 1));
    let wrong = all.iter().filter(|(_, check)| !check.holds());
    let mut rules: Vec<_> = wrong.map(|(rule, _)| *rule).collect();
    rules.dedup();
    rules
}

#[test]
fn numbers_are_recomputed_and_a_digit_that_is_changed_is_found() {
    assert_eq!(broken("", ""), [""; 0]);
    assert_eq!(checked(PAGE).len(), 10);
    let changes = "change of an estimate, and over the nominal sigma";
    for (from, to, rule) in [
        ("<td>−1.7</td></tr>", "<td>−3.0</td></tr>", changes),
        ("−1.68e−4", "−1.62e−4", changes),
        ("−0.287069", "−0.287169", changes),
        ("+69.4 nats on", "+69.5 nats on", "gain on left-out blocks"),
        (
            "3.124",
            "3.126",
            "p and band of the mean innovation squared",
        ),
        (
            "0.005",
            "0.006",
            "p and band of the mean innovation squared",
        ),
        (
            "in 4321",
            "in 4221",
            "p and band of the mean innovation squared",
        ),
        ("0.87", "0.85", "p of a correlation over rows"),
        ("0.60", "0.62", "p of all residual tests"),
        ("17.6</td>", "17.7</td>", "size over its sigma"),
    ] {
        assert_eq!(broken(from, to), [rule], "{from}");
    }
}

#[test]
fn a_span_holds_what_is_written_so() {
    let of = |text: &str| captured(text, "p #").unwrap()[0];
    assert_eq!(of("p < 1e-300")[0], f64::NEG_INFINITY);
    assert_eq!(of("p > 0.99")[1], f64::INFINITY);
    assert_eq!(of("p 0"), [0.0; 2]);
    let [low, high] = of("p 0.60");
    assert!((low - 0.595).abs() < 1e-9 && (high - 0.605).abs() < 1e-9);
    let product = over(&[Some([-1.0, 2.0]), Some([3.0, 4.0])], |x| x[0] * x[1]);
    assert_eq!(product, Some([-4.0, 8.0]));
    assert_eq!(captured("rms 34 µg, at 5", "# µg* at #"), None);
}

#[test]
fn rules_have_names_of_their_own() {
    let mut names: Vec<_> = rules().collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]));
}
