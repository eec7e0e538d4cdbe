//! Records with noise that is not as declared, and the innovations of the streaming filter.

use gyrocal::{Drift, FilterSettings, InitialAttitude, PlatformFilter, Site};
use gyrocal_diagnosis::{DeclaredNoise, Innovations};
use gyrocal_record::Record;
use gyrocal_statistics::deviates::Normals;
use gyrocal_truth::{Population, Scenario, Term, simulate_with};

/// What is wrong with the noise of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fault {
    /// Nothing.
    None,
    /// Values rounded to multiples of this many standard deviations.
    Quantised(f64),
    /// This fraction of the values is off by so many standard deviations, of either sign.
    Outliers(f64, f64),
    /// Correlation from one row to the next; the variance is as declared.
    Coloured(f64),
    /// Standard deviation over the declared one.
    Ratio(f64),
    /// That of the gyros.
    GyroRatio(f64),
}

/// A record and what the audit takes with it.
pub(crate) struct Case {
    pub(crate) record: Record,
    pub(crate) innovations: Innovations,
    pub(crate) declared: DeclaredNoise,
    /// What is wrong with it.
    #[allow(dead_code)] // the figures ask
    pub(crate) fault: Fault,
    /// Row and axis of true outliers.
    pub(crate) outliers: Vec<(usize, usize)>,
}

/// The record of a number of a population with a fault, and with hidden terms.
#[allow(clippy::collapsible_match)] // a guard that draws a random number hides it
pub(crate) fn case(population: &Population, number: u64, fault: Fault, terms: &[Term]) -> Case {
    let scenario = population.scenario(number);
    let sigma = scenario.accel_noise_g;
    let mut simulated = scenario.clone();
    match fault {
        Fault::Ratio(ratio) => simulated.accel_noise_g *= ratio,
        Fault::Coloured(_) => simulated.accel_noise_g = 0.0,
        Fault::GyroRatio(ratio) => simulated.gyro_noise_deg_per_h *= ratio,
        _ => {}
    }
    let mut record = simulate_with(&simulated, terms).unwrap().record;
    let mut normals = Normals::of_seed(scenario.seed ^ 0x5eed);
    let mut outliers = Vec::new();
    let mut held = [0.0; 3];
    for (row, sample) in record.accel_g.iter_mut().enumerate() {
        for axis in 0..3 {
            match fault {
                Fault::Quantised(step) => {
                    sample[axis] = (sample[axis] / (step * sigma)).round() * (step * sigma);
                }
                Fault::Outliers(fraction, size) => {
                    if normals.uniform() < fraction {
                        sample[axis] += if normals.uniform() < 0.5 { -size } else { size } * sigma;
                        outliers.push((row, axis));
                    }
                }
                Fault::Coloured(correlation) => {
                    let driving = if row == 0 {
                        1.0
                    } else {
                        (1.0 - correlation * correlation).sqrt()
                    };
                    held[axis] = correlation * held[axis] + driving * normals.normal();
                    sample[axis] += sigma * held[axis];
                }
                _ => {}
            }
        }
    }
    let declared = DeclaredNoise {
        accel_g: [sigma; 3],
        gyro_deg_per_h: scenario.gyro_noise_deg_per_h,
    };
    Case {
        innovations: innovations(&record, &scenario),
        record,
        declared,
        fault,
        outliers,
    }
}

/// The innovations of the streaming filter with what the bench file of a scenario declares.
pub(crate) fn innovations(record: &Record, scenario: &Scenario) -> Innovations {
    let attitude = InitialAttitude::Angles {
        angles_rad: scenario.declared_angles_deg().map(f64::to_radians),
        sigma_rad: scenario.initial_angles_sigma_deg.map(f64::to_radians),
    };
    let settings = FilterSettings {
        drift_sigma: Drift::from_array([1.0; 9]),
        accel_noise_g: scenario.accel_noise_g,
        drift_noise_deg_per_h: scenario.gyro_noise_deg_per_h,
        ..FilterSettings::at_site(Site::at_latitude_deg(scenario.latitude_deg))
    };
    let mut filter = PlatformFilter::<f64>::new(&settings, &attitude).unwrap();
    let mut innovations = Innovations::default();
    let mut before_s = record.time_s[0];
    for (time_s, sample) in record.time_s.iter().zip(&record.accel_g) {
        let innovation = if *time_s > before_s {
            filter.step(time_s - before_s, sample).unwrap()
        } else {
            filter.update(sample).unwrap()
        };
        before_s = *time_s;
        let vertical = filter.platform_c_enu().map(|row| row[2]);
        let residual = core::array::from_fn(|axis| {
            if innovation.observed[axis] {
                innovation.residual[axis]
            } else {
                f64::NAN
            }
        });
        innovations
            .push(*time_s, residual, &innovation.covariance(), vertical)
            .unwrap();
    }
    innovations
}
