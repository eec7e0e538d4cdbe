//! Records with noise that is not as declared, and their innovations by the streaming filter.

use gyrocal::{Drift, FilterSettings, InitialAttitude, PlatformFilter, Site};
use gyrocal_diagnosis::{DeclaredNoise, Innovations};
use gyrocal_record::Record;
use gyrocal_statistics::deviates::Normals;
use gyrocal_truth::{Population, Scenario, Term, simulate_with};

/// Fault of the noise of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// No fault.
    None,
    /// Values rounded to multiples of this many standard deviations.
    Quantised(f64),
    /// The first is the fraction of outliers, the second their size in standard deviations, of
    /// either sign.
    Outliers(f64, f64),
    /// Correlation from one row to the next; the variance is as declared.
    Coloured(f64),
    /// Standard deviation over the declared one.
    Ratio(f64),
    /// Standard deviation of the gyro noise over the declared one.
    GyroRatio(f64),
}

/// A record with the inputs of the noise audit.
pub struct FaultyRecord {
    /// The record.
    pub record: Record,
    /// Innovations of the streaming filter with the declared noise.
    pub innovations: Innovations,
    /// The declared noise.
    pub declared: DeclaredNoise,
    /// The fault.
    pub fault: Fault,
    /// Row and axis of each true outlier.
    pub outliers: Vec<(usize, usize)>,
}

/// Record `number` of a population, with a fault and with hidden terms.
#[expect(
    clippy::collapsible_match,
    reason = "a guard that draws a random number hides it"
)]
pub fn faulty_record(
    population: &Population,
    number: u64,
    fault: Fault,
    terms: &[Term],
) -> FaultyRecord {
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
    FaultyRecord {
        innovations: innovations(&record, &scenario),
        record,
        declared,
        fault,
        outliers,
    }
}

/// Innovations of the streaming filter with the declarations of a scenario.
fn innovations(record: &Record, scenario: &Scenario) -> Innovations {
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
