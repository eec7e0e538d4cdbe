//! Every effect of the catalogue against its equation, written out, and the table of effects.
//!
//! A new entry of the catalogue needs its equation here; until then the first test fails with its
//! id.

use std::cell::RefCell;
use std::collections::BTreeSet;

use gyrocal::Catalogue;
use gyrocal::Effect;
use gyrocal::effect::{Need, Role};
use gyrocal::generated::catalogue::CatalogueInputs;
use gyrocal::generated::{catalogue, platform};
use gyrocal_oracle::points::{Purpose, State, states};
use gyrocal_scalar::{Element, Model, RatesJacobian};

use crate::equations::{RAD_PER_S_IN_DEG_PER_H, Vector, apply, platform_c_chart, rate_matrix};

const STATES: usize = 1000;
const AXES: [&str; 3] = ["x", "y", "z"];
const PARAMETERS: usize = catalogue::PARAMETERS.len();

/// Values by their public ids, with a record of those used.
struct Named<'a> {
    elements: &'a [Element],
    values: &'a [f64],
    asked: RefCell<BTreeSet<String>>,
}

impl<'a> Named<'a> {
    fn new(elements: &'a [Element], values: &'a [f64]) -> Self {
        Self {
            elements,
            values,
            asked: RefCell::default(),
        }
    }

    fn get(&self, id: &str) -> f64 {
        self.asked.borrow_mut().insert(id.to_owned());
        let place = self.elements.iter().position(|element| element.id == id);
        self.values[place.unwrap_or_else(|| panic!("there is no `{id}`"))]
    }

    /// Ids that were not used.
    fn forgotten(&self) -> Vec<&str> {
        let asked = self.asked.borrow();
        let ids = self.elements.iter().map(|element| element.id);
        ids.filter(|id| !asked.contains(*id)).collect()
    }
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The equations: inertial rate minus Earth rate in platform axes, deg/h, and outputs of the
/// accelerometers.
fn by_hand(state: &State, p: &Named<'_>, shapes: &Named<'_>) -> [Vector; 2] {
    let [time_s, interval_s, kelvin, kelvin_per_h, hysteresis] = state.conditions;
    let (sine, cosine) = p.get("site.latitude").to_radians().sin_cos();
    let turned = cross(&state.east_0, &state.omega_0);
    let earth_rate: Vector = core::array::from_fn(|i| {
        (1.0 + p.get("site.earth_rate")) * (cosine * state.omega_0[i] + sine * turned[i])
    });
    let c = platform_c_chart(&state.theta);
    let gravity = 1.0 + p.get("site.gravity");
    let a = apply(&c, &state.f_0.map(|component| gravity * component));
    let field = apply(&c, &state.field_0);
    let days = time_s / 86_400.0;
    let drift: Vector = core::array::from_fn(|i| {
        let of = |name: &str| p.get(&format!("gyro_{}.{name}", AXES[i]));
        let shape = |name: &str| shapes.get(&format!("gyro_{}.{name}", AXES[i]));
        let mut drift = of("bias") + of("ramp") * days;
        drift += of("temperature") * kelvin + of("temperature_square") * kelvin * kelvin;
        drift += of("temperature_rate") * kelvin_per_h;
        drift += of("temperature_hysteresis") * hysteresis;
        for j in 0..3 {
            drift += of(&format!("g_{}", AXES[j])) * a[j];
            for k in j..3 {
                drift += of(&format!("g_{}{}", AXES[j], AXES[k])) * a[j] * a[k];
            }
        }
        drift += of(&format!("g_{0}{0}{0}", AXES[i])) * a[i].powi(3);
        // Mean over the step of a constant that begins at the onset.
        let end_s = time_s + 0.5 * interval_s;
        let after_s = (end_s - shape("step.onset_s")).max(0.0).min(interval_s);
        drift += of("step") * after_s / interval_s;
        drift += of("warmup") / (time_s / 3600.0 / shape("warmup.time_constant_h")).exp();
        let phase = core::f64::consts::TAU * days;
        drift += of("diurnal.sine") * phase.sin() + of("diurnal.cosine") * phase.cos();
        drift + of("magnetic") * field[i]
    });
    let sidereal = apply(&c, &earth_rate);
    let rates = core::array::from_fn(|i| {
        let others = (0..3)
            .filter(|&j| j != i)
            .map(|j| p.get(&format!("gyro_{}{}.axis_misalignment", AXES[i], AXES[j])) * drift[j]);
        let inertial = drift[i] - others.sum::<f64>();
        (inertial - RAD_PER_S_IN_DEG_PER_H * sidereal[i]) * (1.0 - p.get("clock.rate"))
    });
    let reading = core::array::from_fn(|i| {
        let of = |name: &str| p.get(&format!("accel_{}.{name}", AXES[i]));
        let others = (0..3).filter(|&j| j != i).map(|j| {
            let pair = [AXES[i.min(j)], AXES[i.max(j)]].concat();
            p.get(&format!("accel_{pair}.nonorthogonality")) * a[j]
        });
        a[i] + of("bias")
            + of("scale") * a[i]
            + of("quadratic") * a[i] * a[i]
            + of("temperature") * kelvin
            + of("temperature_square") * kelvin * kelvin
            + of("temperature_rate") * kelvin_per_h
            + of("temperature_hysteresis") * hysteresis
            + of("ramp") * days
            + others.sum::<f64>()
    });
    [rates, reading]
}

fn shape_values(state: &State) -> Vec<f64> {
    state.shapes(&catalogue::SHAPES.map(|shape| shape.name.to_owned()))
}

#[test]
fn the_catalogue_says_what_its_equations_say() {
    for (point, state) in states(Purpose::Equations, STATES).iter().enumerate() {
        let parameters: [f64; PARAMETERS] = state.parameters(PARAMETERS).try_into().unwrap();
        let shapes = shape_values(state);
        let named = Named::new(&catalogue::PARAMETERS, &parameters);
        let named_shapes = Named::new(&catalogue::SHAPES, &shapes);
        let [rates, reading] = by_hand(state, &named, &named_shapes);
        assert_eq!(named.forgotten(), [""; 0], "write out the new effects here");
        assert_eq!(named_shapes.forgotten(), [""; 0]);
        let theta_dot = catalogue::dynamics(
            &state.theta,
            &parameters,
            &state.omega_0,
            &state.f_0,
            &state.east_0,
            &state.field_0,
            &state.conditions,
            &shapes.try_into().unwrap(),
        );
        // Equation (5): no matrix is inverted here.
        let relative = apply(&rate_matrix(&state.theta), &theta_dot);
        let read =
            catalogue::accelerometers(&state.theta, &parameters, &state.f_0, &state.conditions);
        // Sixty terms of up to 5 deg/h each, 6 times as large where cos theta_y is 1/6 and cancels
        // again, some roundings of 1.1e-16 in each.
        let allowed = 4e-12;
        for i in 0..3 {
            let error = (RAD_PER_S_IN_DEG_PER_H * relative[i] - rates[i]).abs();
            assert!(error <= allowed, "{point}: {error:e}");
            // A dozen terms, the largest 0.5 g/K times 5 K.
            assert!(
                (read[i] - reading[i]).abs() <= 1e-14,
                "{point}: {} {}",
                read[i],
                reading[i]
            );
        }
    }
}

#[test]
fn a_wrong_entry_would_show_in_that_comparison() {
    let states = states(Purpose::Equations, 20);
    for place in 0..PARAMETERS {
        let shows = states.iter().any(|state| {
            let mut parameters = state.parameters(PARAMETERS);
            let shapes = shape_values(state);
            let evaluate = |parameters: &[f64]| {
                by_hand(
                    state,
                    &Named::new(&catalogue::PARAMETERS, parameters),
                    &Named::new(&catalogue::SHAPES, &shapes),
                )
            };
            let right = evaluate(&parameters);
            parameters[place] *= 1.0 + 1e-6;
            let wrong = evaluate(&parameters);
            let pairs = right.as_flattened().iter().zip(wrong.as_flattened());
            // Beyond the tolerances above, with rates of some 100 deg/h.
            pairs
                .into_iter()
                .any(|(right, wrong)| (right - wrong).abs() > 1e-11)
        });
        assert!(shows, "{} does not show", catalogue::PARAMETERS[place].id);
    }
}

#[test]
fn without_effects_the_catalogue_is_the_nominal_platform() {
    for (point, state) in states(Purpose::Equations, STATES).iter().enumerate() {
        let mut parameters = [0.0; PARAMETERS];
        parameters[..9].copy_from_slice(&state.drift);
        let rates = catalogue::dynamics(
            &state.theta,
            &parameters,
            &state.omega_0,
            &state.f_0,
            &state.east_0,
            &state.field_0,
            &state.conditions,
            &shape_values(state).try_into().unwrap(),
        );
        let nominal = platform::dynamics(&state.theta, &state.drift, &state.omega_0, &state.f_0);
        let scale = nominal
            .iter()
            .fold(1e-4, |largest: f64, rate| largest.max(rate.abs()));
        let read =
            catalogue::accelerometers(&state.theta, &parameters, &state.f_0, &state.conditions);
        let force = platform::specific_force(&state.theta, &state.f_0);
        for i in 0..3 {
            // Additions of zeros and products with one do not round; sums come in another order.
            assert!((rates[i] - nominal[i]).abs() <= 4e-15 * scale, "{point}");
            assert!((read[i] - force[i]).abs() <= 5e-16, "{point}");
        }
    }
}

/// A weight is what the exact Jacobian says: the derivative by the parameter is the weight times the
/// derivative by the constant of the channel.
#[test]
fn weights_are_ratios_of_derivatives() {
    let mut compared = 0;
    for state in &states(Purpose::Equations, 100) {
        let parameters: [f64; PARAMETERS] = state.parameters(PARAMETERS).try_into().unwrap();
        let shapes = shape_values(state).try_into().unwrap();
        let inputs = CatalogueInputs {
            omega_0: state.omega_0,
            f_0: state.f_0,
            east_0: state.east_0,
            field_0: state.field_0,
            conditions: state.conditions,
            shapes,
        };
        let mut columns = [0.0; 3 * PARAMETERS];
        let mut jacobian = RatesJacobian {
            moving: [[0.0; 3]; 3],
            noise: [[0.0; 3]; 3],
            parameters: &mut columns,
        };
        Catalogue.rates_jacobian(&state.theta, &parameters, &inputs, &mut jacobian);
        let weights = catalogue::weights(&state.f_0, &state.conditions, &shapes);
        for effect in &catalogue::EFFECTS {
            let Some(rate) = effect.rate() else { continue };
            let constant = catalogue::RATES[rate].constant;
            for parameter in effect.parameters {
                let (Role::Parameter(index), Some(weight)) = (parameter.role, parameter.weight)
                else {
                    continue;
                };
                for row in 0..3 {
                    let by_constant = columns[row * PARAMETERS + constant];
                    let expected = weights[weight] * by_constant;
                    let found = columns[row * PARAMETERS + index];
                    // Products in another order: some roundings of a Jacobian that stays below 1e-4.
                    let allowed = 1e-14 * weights[weight].abs().max(1.0) * 1e-4;
                    assert!((found - expected).abs() <= allowed, "{}", effect.id);
                    compared += 1;
                }
            }
        }
    }
    // Ramp, step, warm-up, four of temperature and two of the diurnal wave, of three gyros in three rates.
    assert_eq!(compared, 100 * 9 * 3 * 3);
}

#[test]
#[expect(clippy::cognitive_complexity, reason = "one table, looked at once")]
fn the_table_of_effects_is_complete_and_names_what_is_there() {
    let ids: Vec<&str> = catalogue::EFFECTS.iter().map(|effect| effect.id).collect();
    let parameters = catalogue::EFFECTS.iter();
    let mut parameters: Vec<usize> = parameters.flat_map(Effect::model_parameters).collect();
    parameters.sort_unstable();
    let all: Vec<usize> = (0..catalogue::PARAMETERS.len()).collect();
    assert_eq!(parameters, all, "each parameter belongs to one effect");
    for effect in &catalogue::EFFECTS {
        for parameter in effect.parameters {
            // The id of a parameter of the model begins with that of its effect, and its unit is
            // the effect's.
            let element = match parameter.role {
                Role::Parameter(index) => catalogue::PARAMETERS[index],
                Role::Onset(Some(index)) | Role::TimeConstant(index) => catalogue::SHAPES[index],
                _ => {
                    assert!(!effect.has_term(), "{}", effect.id);
                    continue;
                }
            };
            assert!(
                effect.has_term() && element.id.starts_with(effect.id),
                "{}",
                effect.id
            );
            assert_eq!(element.unit, parameter.unit, "{}", element.id);
        }
        if !effect.equivalents.is_empty() {
            let equivalence = effect.equivalence;
            assert!(!equivalence.reason.is_empty() && !equivalence.experiment.is_empty());
        }
        for other in effect
            .equivalents
            .iter()
            .chain(effect.near_twins)
            .chain(effect.nested)
        {
            assert!(ids.contains(other), "{}: {other}", effect.id);
        }
        for equivalent in effect.equivalents {
            let other = ids.iter().position(|id| id == equivalent).unwrap();
            let back = catalogue::EFFECTS[other].equivalents;
            assert!(back.contains(&effect.id), "{}: {equivalent}", effect.id);
        }
    }
    for id in [
        "gyro_x.random_walk",
        "accel.outliers",
        "platform.knock",
        "platform.initial_attitude",
        "filter.discretisation",
    ] {
        assert!(ids.contains(&id), "{id}");
    }
    let needs = |id: &str| catalogue::EFFECTS[ids.iter().position(|x| *x == id).unwrap()].needs;
    for name in ["", "_square", "_rate", "_hysteresis"] {
        for id in ["gyro_y", "accel_z"].map(|channel| format!("{channel}.temperature{name}")) {
            assert_eq!(needs(&id), [Need::Column("temperature_c")], "{id}");
        }
    }
    assert_eq!(
        needs("gyro_z.magnetic"),
        [Need::Key("magnetic_field_gauss")]
    );
    assert_eq!(needs("gyro_z.ramp"), []);
}
