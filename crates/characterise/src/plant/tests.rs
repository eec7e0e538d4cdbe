use gyrocal_diagnosis::cause::information;

use super::*;
use crate::population::scenario;

/// A record of a day is quick, and shows all there is to see.
fn short(number: u64) -> Scenario {
    Scenario {
        duration_s: 86_400.0,
        interval_s: 300.0,
        gaps_s: Vec::new(),
        ..scenario(number)
    }
}

/// The length of an effect by the diagnosis' own information, which is computed apart from this.
#[test]
fn an_effect_is_as_long_as_the_diagnosis_says() {
    let scenario = short(4);
    let clean = simulate(&scenario).unwrap();
    let fitted = fitted(&clean).unwrap();
    for id in [
        "gyro_x.g_y",
        "gyro_y.step",
        "gyro_z.warmup",
        "gyro_x.diurnal",
        "accel_x.temperature",
        "platform.knock",
        "platform.initial_attitude",
    ] {
        let effect = EFFECTS.iter().find(|effect| effect.id == id).unwrap();
        let mut draw = Draw::new(1, 2);
        let shape = shape(effect, &scenario, &mut draw);
        let planted = plant(&scenario, &[(effect, shape)], 8.0, 1.0, &mut draw)
            .unwrap()
            .unwrap();
        let sizes = DVector::from_column_slice(&planted[0].sizes);
        let information = information(&fitted, &clean.record, id, shape)
            .unwrap()
            .unwrap();
        let length = (&information * &sizes).dot(&sizes).sqrt();
        // Two orders of the same sums; what is projected out costs up to six digits.
        assert!((length - 8.0).abs() < 1e-6, "{id}: {length}");
        assert_eq!(planted[0].hidden().unwrap().id(), id);
    }
}

/// Of two effects that overlap, each is as long as asked for beside the other, so longer alone.
#[test]
fn of_two_effects_each_has_its_length_beside_the_other() {
    let scenario = short(4);
    let row = |id: &str| EFFECTS.iter().find(|effect| effect.id == id).unwrap();
    let pair = [(row("gyro_x.g_y"), None), (row("gyro_x.g_yz"), None)];
    let planted = plant(&scenario, &pair, 8.0, 1.0, &mut Draw::new(1, 2))
        .unwrap()
        .unwrap();
    let clean = simulate(&scenario).unwrap();
    let fitted = fitted(&clean).unwrap();
    let mut columns = Columns::default();
    let signatures: Vec<Signature> = pair
        .iter()
        .map(|(effect, _)| columns.signature(effect, &clean.record, None).unwrap())
        .collect();
    let bank = Bank::new(&fitted, &columns.further).unwrap();
    let cosine = bank.cosine(&signatures[0], &[1.0], &signatures[1]);
    for (planted, signature) in planted.iter().zip(&signatures) {
        let alone = bank.product(signature, signature)[(0, 0)].sqrt() * planted.sizes[0].abs();
        let expected = 8.0 / (1.0 - cosine * cosine).sqrt();
        assert!((alone - expected).abs() < 1e-6, "{alone}, {expected}");
    }
    // Nothing is planted where the two are nearer to each other than asked for.
    let refused = plant(&scenario, &pair, 8.0, 0.9 * cosine, &mut Draw::new(1, 2)).unwrap();
    assert_eq!(refused, None);
}
