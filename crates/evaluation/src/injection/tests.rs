use gyrocal_calibration::rows;
use gyrocal_hypothesis::{FittedModel, information};

use super::*;
use crate::scenario::tests::short;

/// The strength of an effect by the information of the diagnosis, which is computed independently.
#[test]
fn the_strength_agrees_with_the_information_of_the_diagnosis() {
    let scenario = short(4);
    let clean = simulate(&scenario).unwrap();
    let fitted = nominal_fit(&clean).unwrap();
    let rows = rows(&clean.record, fitted.covariates());
    for id in [
        "gyro_x.g_y",
        "gyro_y.step",
        "gyro_z.warmup",
        "gyro_x.diurnal",
        "accel_x.temperature",
        "gyro_y.temperature_square",
        "gyro_z.temperature_rate",
        "accel_y.temperature_hysteresis",
        "platform.knock",
        "platform.initial_attitude",
    ] {
        let effect = EFFECTS.iter().find(|effect| effect.id == id).unwrap();
        let mut random = Draw::new(1, 2);
        let shape = draw_shape(effect, &scenario, &mut random);
        let injected = inject(&scenario, &[(effect, shape)], 8.0, 1.0, &mut random)
            .unwrap()
            .unwrap();
        let sizes = DVector::from_column_slice(&injected[0].sizes);
        let information = information(&fitted, &rows, effect, shape).unwrap().unwrap();
        let length = (&information * &sizes).dot(&sizes).sqrt();
        // Two orders of the same sums; what is projected out costs up to six digits.
        assert!((length - 8.0).abs() < 1e-6, "{id}: {length}");
        assert_eq!(injected[0].to_hidden().unwrap().id(), id);
    }
}

/// Of two overlapping effects, each has the requested strength given the other, and so a larger one
/// alone.
#[test]
fn each_of_two_effects_has_its_strength_given_the_other() {
    let scenario = short(4);
    let row = |id: &str| EFFECTS.iter().find(|effect| effect.id == id).unwrap();
    let pair = [(row("gyro_x.g_y"), None), (row("gyro_x.g_yz"), None)];
    let injected = inject(&scenario, &pair, 8.0, 1.0, &mut Draw::new(1, 2))
        .unwrap()
        .unwrap();
    let clean = simulate(&scenario).unwrap();
    let fitted = nominal_fit(&clean).unwrap();
    let mut columns = SignatureColumns::default();
    let signatures: Vec<Signature> = pair
        .iter()
        .map(|(effect, _)| columns.signature(effect, &clean.record, None).unwrap())
        .collect();
    let scores = ProjectedScores::new(&fitted, &columns.further).unwrap();
    let cosine = scores.cosine(&signatures[0], &[1.0], &signatures[1]);
    for (injected, signature) in injected.iter().zip(&signatures) {
        let alone = scores.product(signature, signature)[(0, 0)].sqrt() * injected.sizes[0].abs();
        let expected = 8.0 / (1.0 - cosine * cosine).sqrt();
        assert!((alone - expected).abs() < 1e-6, "{alone}, {expected}");
    }
    // Nothing is injected if the cosine between the two exceeds the limit.
    let refused = inject(&scenario, &pair, 8.0, 0.9 * cosine, &mut Draw::new(1, 2)).unwrap();
    assert_eq!(refused, None);
}
