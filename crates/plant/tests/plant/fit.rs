//! Fits of nominal models beside truth, textbook least squares, and each other.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use gyrocal_answer::{NullDirection, PlantFit};
use gyrocal_plant::{
    Fit, LoadedPlant, NamedRecord, PlantError, PlantRecord, compare, fit, simulate,
};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::plant::{Kind, Setting};
use nalgebra::{DMatrix, DVector};

use crate::{loaded, oscillator, record};

fn named(name: &str, record: PlantRecord) -> NamedRecord {
    NamedRecord {
        name: name.to_owned(),
        record,
    }
}

fn fitted(plant: &LoadedPlant, setting: &Setting) -> Fit {
    let record = named("record", record(plant, setting));
    fit(plant, record, None, 0, &mut |_, _| ()).unwrap()
}

/// The oscillator as it is declared, without a hidden effect.
fn clean(seed: u64) -> Setting {
    oscillator(seed, 800, 0.0)
}

static CLEAN: LazyLock<Fit> = LazyLock::new(|| fitted(&loaded(Kind::Duffing), &clean(11)));

/// Displacement of the oscillator at each row, by a Runge-Kutta rule of its own with ten steps between rows.
fn displacement(setting: &Setting, record: &PlantRecord, unknowns: &[f64]) -> DVector<f64> {
    const STEPS: usize = 10;
    let &[k, c, g, mut x, mut v] = unknowns else {
        panic!("{unknowns:?}")
    };
    let h = setting.kind.facts().step_s / STEPS as f64;
    let mut all = Vec::with_capacity(record.len());
    for row in 0..record.len() {
        all.push(x);
        let Some(next) = record.inputs.get(row + 1) else {
            break;
        };
        let here = record.inputs[row];
        for step in 0..STEPS {
            let rate = |share: f64, x: f64, v: f64| {
                let u = here + (next - here) * (step as f64 + share) / STEPS as f64;
                [v, g * u - k * x - c * v]
            };
            let [x1, v1] = rate(0.0, x, v);
            let [x2, v2] = rate(0.5, x + 0.5 * h * x1, v + 0.5 * h * v1);
            let [x3, v3] = rate(0.5, x + 0.5 * h * x2, v + 0.5 * h * v2);
            let [x4, v4] = rate(1.0, x + h * x3, v + h * v3);
            x += h * (x1 + 2.0 * x2 + 2.0 * x3 + x4) / 6.0;
            v += h * (v1 + 2.0 * v2 + 2.0 * v3 + v4) / 6.0;
        }
    }
    DVector::from_vec(all)
}

/// Least squares by Gauss-Newton steps with central differences: estimates, covariance, variance of the noise.
fn least_squares(
    setting: &Setting,
    record: &PlantRecord,
    start: Vec<f64>,
) -> (Vec<f64>, DMatrix<f64>, f64) {
    let measured = DVector::from_column_slice(&record.outputs);
    let mut at = start;
    let mut result = (DMatrix::zeros(0, 0), 0.0);
    for _ in 0..10 {
        let residuals = &measured - displacement(setting, record, &at);
        let columns = (0..at.len()).map(|place| {
            let moved = |by: f64| {
                let mut other = at.clone();
                other[place] += by;
                displacement(setting, record, &other)
            };
            (moved(1e-5) - moved(-1e-5)) / 2e-5
        });
        let jacobian = DMatrix::from_columns(&columns.collect::<Vec<_>>());
        let inverse = (jacobian.tr_mul(&jacobian)).try_inverse().unwrap();
        let change = &inverse * jacobian.tr_mul(&residuals);
        at.iter_mut()
            .zip(change.iter())
            .for_each(|(own, by)| *own += by);
        let freedom = (record.len() - at.len()) as f64;
        let variance = residuals.norm_squared() / freedom;
        result = (inverse * variance, variance);
    }
    (at, result.0, result.1)
}

#[test]
fn estimates_sigmas_and_likelihood_are_those_of_least_squares() {
    let plant = loaded(Kind::Duffing);
    let setting = clean(11);
    let record = record(&plant, &setting);
    let truth = [&setting.parameters[..], &setting.initial[..]].concat();
    let (estimates, covariance, variance) = least_squares(&setting, &record, truth.clone());
    let answer = &CLEAN.answer;
    let nominal = &answer.coefficients.nominal;
    let names: Vec<&str> = nominal.iter().map(|one| one.name.as_str()).collect();
    assert_eq!(names, ["k", "c", "g", "initial x", "initial v"]);
    for (place, own) in nominal.iter().enumerate() {
        let sigma = covariance[(place, place)].sqrt();
        // The declared initial states have priors, which weigh as one more reading of some 1 m and 3 m/s.
        assert!(
            (own.estimate - estimates[place]).abs() < 0.02 * sigma,
            "{own:?} {}",
            estimates[place]
        );
        // The prior of the noise pulls its estimate by a thousandth.
        assert!((own.sigma / sigma - 1.0).abs() < 0.01, "{own:?} {sigma}");
        assert!((own.estimate - truth[place]).abs() < 4.0 * sigma, "{own:?}");
        for other in 0..place {
            let scale = sigma * covariance[(other, other)].sqrt();
            let expected = covariance[(place, other)] / scale;
            let found = answer.coefficients.covariance[place][other] / scale;
            assert!((found - expected).abs() < 0.02, "{names:?} {place} {other}");
        }
    }
    // The density of white residuals of the estimated variance.
    let values = record.len() as f64;
    let at: Vec<f64> = nominal.iter().map(|one| one.estimate).collect();
    let simulated = displacement(&setting, &record, &at);
    let measured = DVector::from_column_slice(&record.outputs);
    let squares = (&measured - simulated).norm_squared();
    let noise = (answer.noise[0].ratio * 0.01).powi(2);
    assert!((noise / variance - 1.0).abs() < 0.01, "{noise} {variance}");
    let expected = -0.5 * (squares / noise + values * (core::f64::consts::TAU * noise).ln());
    assert!(
        (answer.log_likelihood - expected).abs() < 1e-3,
        "{} {expected}",
        answer.log_likelihood
    );
    // Five estimates and a noise.
    assert_eq!((answer.values, answer.unknowns), (800, 6));
    assert!((answer.aic - (12.0 - 2.0 * expected)).abs() < 1e-2);
    assert!((answer.bic - (6.0 * values.ln() - 2.0 * expected)).abs() < 1e-2);
    let rms = (squares / values).sqrt();
    let [open_loop, one_step] = [answer.outputs[0].open_loop, answer.outputs[0].one_step];
    assert!(
        (open_loop.rms.unwrap() / rms - 1.0).abs() < 1e-4,
        "{open_loop:?} {rms}"
    );
    // Without noise of the rates nothing is learned from a reading.
    assert!(
        (one_step.rms.unwrap() / rms - 1.0).abs() < 1e-4,
        "{one_step:?} {rms}"
    );
    let spread = (measured.variance()).sqrt();
    let percent = 100.0 * (1.0 - rms / spread);
    assert!(
        (open_loop.fit_percent.unwrap() - percent).abs() < 0.01,
        "{open_loop:?} {percent}"
    );
}

#[test]
fn correlations_and_condition_number_are_those_of_the_covariance() {
    let answer = &CLEAN.answer;
    let all = &answer.coefficients;
    let count = all.nominal.len();
    let correlation = DMatrix::from_fn(count, count, |i, j| {
        all.covariance[i][j] / (all.nominal[i].sigma * all.nominal[j].sigma)
    });
    let eigenvalues = correlation.clone().symmetric_eigenvalues();
    let condition = eigenvalues.max() / eigenvalues.min();
    assert!((answer.condition.unwrap() / condition - 1.0).abs() < 1e-9);
    let places: BTreeMap<&str, usize> = all
        .nominal
        .iter()
        .map(|one| one.name.as_str())
        .zip(0..)
        .collect();
    // Ten pairs of five.
    assert_eq!(answer.correlations.len(), 10);
    for one in &answer.correlations {
        let [i, j] = [0, 1].map(|end| places[one.of[end].as_str()]);
        assert!(
            (one.coefficient - correlation[(i, j)]).abs() < 1e-12,
            "{one:?}"
        );
    }
    let sizes = answer.correlations.iter().map(|one| one.coefficient.abs());
    assert!(sizes.is_sorted_by(|a, b| a >= b));
}

/// A spring that softens leaves what is not white: standard deviations rest on the noise that explains it.
#[test]
fn what_is_not_white_widens_standard_deviations() {
    let plant = loaded(Kind::Duffing);
    let setting = oscillator(41, 800, -0.05);
    let answer = fitted(&plant, &setting).answer;
    assert!(!answer.undeclared_noise.is_empty(), "{answer:?}");
    let outputs = &answer.outputs[0];
    // One step ahead a filter knows more than a simulation.
    assert!(
        outputs.one_step.rms.unwrap() < 0.7 * outputs.open_loop.rms.unwrap(),
        "{outputs:?}"
    );
    for (own, white) in answer
        .coefficients
        .nominal
        .iter()
        .zip(&CLEAN.answer.coefficients.nominal)
    {
        assert!(own.sigma > 2.0 * white.sigma, "{own:?} {white:?}");
    }
}

#[test]
fn a_gauge_is_held_and_does_not_count() {
    let plant = loaded(Kind::Tanks);
    let answer = fitted(&plant, &Setting::random(Kind::Tanks, 3, 300)).answer;
    let held = answer.undetermined[0].held.clone().unwrap();
    let parameters = plant.description().parameters.len() + plant.description().states.len();
    // A noise, and all but the held one.
    assert_eq!(answer.unknowns, parameters);
    assert!(
        answer
            .correlations
            .iter()
            .all(|one| !one.of.contains(&held))
    );
}

#[test]
fn first_rows_do_not_count_and_begin_the_later_record() {
    let plant = loaded(Kind::Duffing);
    let first = record(&plant, &clean(11));
    let mut later = record(&plant, &clean(12));
    let run = |first: &PlantRecord, later: &PlantRecord, rows| {
        let (first, later) = (named("first", first.clone()), named("later", later.clone()));
        fit(&plant, first, Some(later), rows, &mut |_, _| ())
    };
    let error = |answer: &PlantFit| {
        answer.later.clone().unwrap().outputs[0]
            .open_loop
            .rms
            .unwrap()
    };
    let whole = run(&first, &later, 0).unwrap().answer;
    // What 40 rows tell of the initial states, and the noise of 0.01 m.
    let begun = run(&first, &later, 40).unwrap().answer;
    for answer in [&whole, &begun] {
        assert!((0.0095..0.012).contains(&error(answer)), "{answer:?}");
    }
    assert_eq!(whole.log_likelihood, begun.log_likelihood);
    // Readings after the first rows do not move a simulation: shifted by a metre, it is off by a metre.
    later.outputs[40..]
        .iter_mut()
        .for_each(|value| *value += 1.0);
    let shifted = error(&run(&first, &later, 40).unwrap().answer);
    assert!((shifted - 1.0).abs() < 0.01, "{shifted}");
    // Errors of the first rows alone are not seen.
    let spoiled = run(&first, &later, 800).err().unwrap().to_string();
    assert!(
        spoiled.contains("first: the first 800 of its 800 rows"),
        "{spoiled}"
    );
    later.outputs[..40].fill(f64::NAN);
    let blind = run(&first, &later, 40).err().unwrap().to_string();
    assert!(
        blind.contains("later: its first 40 rows, which are to be free"),
        "{blind}"
    );
}

#[test]
fn of_two_models_the_true_one_has_the_least_criteria() {
    let [plant, other] = [Kind::Duffing, Kind::Servo].map(loaded);
    let without_damping = {
        let path = crate::example(Kind::Duffing, "plant.json");
        let text = std::fs::read_to_string(path).unwrap();
        let mut program: serde_json::Value = serde_json::from_str(&text).unwrap();
        let tables = program["tables"].as_array_mut().unwrap();
        let parameters = tables
            .iter_mut()
            .find(|table| table["name"] == "plant_parameters");
        // A damping that is known to be the declared one, 0.3 instead of 0.27.
        let row = &mut parameters.unwrap()["rows"][1];
        let last = row.as_array_mut().unwrap();
        assert_eq!(last[0], "c", "{last:?}");
        let place = last.iter().position(|one| one == 0.0).unwrap();
        last[place] = serde_json::Value::from(1e-6);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plant.json");
        std::fs::write(&path, program.to_string()).unwrap();
        LoadedPlant::read(&path).unwrap()
    };
    let setting = clean(13);
    let read = |description: &gyrocal_plant::description::Description| {
        assert_eq!(description.name, "Duffing");
        Ok((named("record", record(&plant, &setting)), None))
    };
    let plants = [
        ("free".to_owned(), plant.clone()),
        ("fixed".to_owned(), without_damping),
    ];
    let compared = compare(&plants, read, 0, &mut |_, _| ()).unwrap();
    let [free, fixed] = &compared.models[..] else {
        panic!("{compared:?}")
    };
    assert_eq!(free.fit.values, fixed.fit.values);
    assert!(free.fit.bic + 20.0 < fixed.fit.bic, "{compared:?}");
    let held_out = |one: &PlantFit| one.outputs[0].left_out_rms.unwrap();
    assert!(held_out(&free.fit) < held_out(&fixed.fit), "{compared:?}");

    let mut shares = Vec::new();
    let plants = [
        ("free".to_owned(), plant.clone()),
        ("servo".to_owned(), other),
    ];
    let refused = compare(&plants, read, 0, &mut |_, share| shares.push(share));
    let refused = refused.err().map(|error: PlantError| error.to_string());
    assert!(
        refused
            .as_ref()
            .is_some_and(|words| words.starts_with("servo: it has the inputs")),
        "{refused:?}"
    );
    assert!(shares.is_empty());
    let alone = compare(&plants[..1], read, 0, &mut |_, _| ())
        .err()
        .unwrap();
    assert!(
        alone
            .to_string()
            .contains("free: one plant cannot be compared"),
        "{alone}"
    );
}

/// Standard deviations of a simulation are those of simulations with parameters that are drawn from the covariance.
#[test]
fn bands_of_a_simulation_are_those_of_drawn_parameters() {
    const DRAWS: usize = 400;
    let plant = loaded(Kind::Duffing);
    let setting = clean(14);
    let run = record(&plant, &setting);
    let simulated = simulate(&plant, named("run", run.clone()), Some(&CLEAN.answer)).unwrap();
    let all = &CLEAN.answer.coefficients;
    let count = all.nominal.len();
    let mean: Vec<f64> = all.nominal.iter().map(|one| one.estimate).collect();
    // The own simulator of this file, at the estimates.
    let own = displacement(&setting, &run, &mean);
    let output = &simulated.outputs[0];
    assert_eq!((output.id.as_str(), output.values.len()), ("y", 800));
    for (row, value) in output.values.iter().enumerate() {
        assert!(
            (value - own[row]).abs() < 1e-4,
            "{row} {value} {}",
            own[row]
        );
    }
    let covariance = DMatrix::from_fn(count, count, |i, j| all.covariance[i][j]);
    let factor = covariance.cholesky().unwrap().unpack();
    let mut draw = Draw::new(1, 1);
    let mut squares = DVector::zeros(run.len());
    for _ in 0..DRAWS {
        let normal = DVector::from_fn(count, |_, _| draw.normal());
        let moved = &factor * normal + DVector::from_column_slice(&mean);
        let off = displacement(&setting, &run, moved.as_slice()) - &own;
        squares += off.component_mul(&off);
    }
    for row in (0..run.len()).step_by(37) {
        let drawn = (squares[row] / DRAWS as f64).sqrt();
        // Five standard deviations of what 400 draws tell: 0.035 of it.
        assert!(
            (output.sigmas[row] / drawn - 1.0).abs() < 0.18,
            "{row} {} {drawn}",
            output.sigmas[row]
        );
    }
    // The output is the displacement.
    assert_eq!(output.sigmas, simulated.states[0].sigmas);
    let declared = simulate(&plant, named("run", run.clone()), None).unwrap();
    // The declared standard deviations of the initial states.
    assert_eq!(
        [0, 1].map(|state| declared.states[state].sigmas[0]),
        [1.0, 3.0]
    );
    let other = PlantFit {
        coefficients: gyrocal_answer::Coefficients {
            nominal: Vec::new(),
            covariance: Vec::new(),
            ..all.clone()
        },
        ..CLEAN.answer.clone()
    };
    let refused = |fit: &PlantFit| {
        let simulated = simulate(&plant, named("run", run.clone()), Some(fit));
        simulated.unwrap_err().to_string()
    };
    let without = refused(&other);
    assert!(
        without.contains("it has no estimate of initial x"),
        "{without}"
    );
    let of_another = PlantFit {
        plant: "Pendulum".to_owned(),
        ..CLEAN.answer.clone()
    };
    let of_another = refused(&of_another);
    assert!(
        of_another.contains("it is no fit of Duffing"),
        "{of_another}"
    );
    // A held parameter has no standard deviation of its own, which is told.
    let direction = |is_gauge: bool, held: &str| NullDirection {
        is_gauge,
        parts: Vec::new(),
        held: Some(held.to_owned()),
    };
    let held = PlantFit {
        undetermined: vec![direction(false, "g"), direction(true, "k")],
        ..CLEAN.answer.clone()
    };
    let simulated = simulate(&plant, named("run", run.clone()), Some(&held)).unwrap();
    assert_eq!(simulated.held, ["g"]);
}
