//! The magnitude channel, which sees accelerometers whatever the attitude.

use gyrocal_diagnosis::magnitude_channel;
use gyrocal_record::Record;
use gyrocal_statistics::deviates::Normals;

#[test]
fn the_norm_sees_accelerometers_whatever_the_attitude() {
    let (sigma_g, bias_g) = (1e-5, 2e-6);
    let record = |bias_g: f64, scale: f64| {
        let mut normals = Normals::of_seed(3);
        let accel_g = (0..5000).map(|_| {
            let direction: [f64; 3] = core::array::from_fn(|_| normals.normal());
            let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
            core::array::from_fn(|axis| {
                let error =
                    sigma_g * scale * normals.normal() + if axis == 0 { bias_g } else { 0.0 };
                direction[axis] / length + error
            })
        });
        Record {
            time_s: (0..5000).map(|k| 60.0 * f64::from(k)).collect(),
            accel_g: accel_g.collect(),
            temperature_c: None,
        }
    };
    let clean = magnitude_channel(&record(0.0, 1.0), &[sigma_g; 3], 1.0, 10).unwrap();
    // One seed: probabilities of ordinary size.
    assert!(clean.mean_p_value > 1e-3 && clean.variance_p_value > 1e-3);
    assert!(clean.on_component.iter().all(|on| on.p_value > 1e-3));
    // |E|² has twice the noise of a component, along specific force.
    assert!((clean.sigma_g2[7] / (2.0 * sigma_g) - 1.0).abs() < 1e-4);
    let biased = magnitude_channel(&record(bias_g, 1.0), &[sigma_g; 3], 1.0, 10).unwrap();
    // 2 b a_x: 0.2 sigma a_x, so 0.2 sqrt(5000 / 3) = 8 sigmas, on x and on x alone.
    assert!(biased.on_component[0].p_value < 1e-6);
    assert!(biased.on_component[1].p_value > 1e-3 && biased.on_component[2].p_value > 1e-3);
    let noisy = magnitude_channel(&record(0.0, 1.2), &[sigma_g; 3], 1.0, 10).unwrap();
    // 5000 values: the variance 1.44 is known to 2 %.
    assert!((noisy.variance_ratio - 1.44).abs() < 0.12 && noisy.variance_p_value < 1e-9);
}
