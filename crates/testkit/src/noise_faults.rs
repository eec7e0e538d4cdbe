//! Records with noise that is not as declared, and their innovations by the streaming filter.

use gyrocal::{Discretisation, FactorisedPlatformFilter, Innovation};
use gyrocal_calibration::{declared_attitude, filter_settings, run_factorised_filter};
use gyrocal_diagnosis::{DeclaredNoise, Innovations};
use gyrocal_record::{Bench, Record};
use gyrocal_truth::faults::noise::quantised;
use gyrocal_truth::{Hidden, Population, Term, simulate_with};

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
pub fn faulty_record(
    population: &Population,
    number: u64,
    fault: Fault,
    terms: &[Term],
) -> FaultyRecord {
    let scenario = population.scenario(number);
    let sigma = scenario.accel_noise_g;
    let mut simulated = scenario.clone();
    let hide = |id: &str, parameters: &[(&str, f64)]| vec![Hidden::new(id, parameters).unwrap()];
    simulated.hidden.extend(match fault {
        Fault::Quantised(step) => quantised(step * sigma).unwrap().to_vec(),
        Fault::Outliers(share, size) => {
            hide("accel.outliers", &[("fraction", share), ("size", size)])
        }
        Fault::Coloured(value) => hide("accel.coloured_noise", &[("correlation", value)]),
        Fault::None | Fault::Ratio(_) | Fault::GyroRatio(_) => Vec::new(),
    });
    match fault {
        Fault::Ratio(ratio) => simulated.accel_noise_g *= ratio,
        Fault::GyroRatio(ratio) => simulated.gyro_noise_deg_per_h *= ratio,
        _ => {}
    }
    let simulation = simulate_with(&simulated, terms).unwrap();
    let outliers = simulation.truth.outliers.iter().enumerate();
    let outliers = outliers.flat_map(|(row, which)| {
        let axes = (0..3).filter(|axis| which[*axis]);
        axes.map(move |axis| (row, axis))
    });
    let declared = DeclaredNoise {
        accel_g: [sigma; 3],
        gyro_deg_per_h: scenario.gyro_noise_deg_per_h,
    };
    FaultyRecord {
        innovations: innovations(&simulation.record, &scenario.bench()),
        outliers: outliers.collect(),
        record: simulation.record,
        declared,
        fault,
    }
}

/// Innovations of the streaming filter by what a bench description declares.
fn innovations(record: &Record, bench: &Bench) -> Innovations {
    let settings = filter_settings(bench, Discretisation::default());
    let attitude = declared_attitude(bench).unwrap();
    let mut innovations = Innovations::default();
    let mut push = |row: usize, filter: &FactorisedPlatformFilter<f64>, of: &Innovation<f64, 3>| {
        let residual = core::array::from_fn(|axis| match of.observed[axis] {
            true => of.residual[axis],
            false => f64::NAN,
        });
        let vertical = filter.platform_c_enu().map(|row| row[2]);
        let time_s = record.time_s[row];
        let pushed = innovations.push(time_s, residual, &of.covariance(), vertical);
        pushed.unwrap();
    };
    run_factorised_filter(record, &settings, &attitude, &mut push).unwrap();
    innovations
}
