//! Functions called by the printing program of `slow/compiled.rs`.

use gyrocal_scalar::{Model, RatesJacobian};

pub(crate) fn print(values: &[f64]) {
    let values: Vec<String> = values.iter().map(|value| format!("{value:e}")).collect();
    println!("{}", values.join(" "));
}

/// Rates of a model with their Jacobians, then outputs with theirs, one after another.
pub(crate) type Results = Vec<Vec<f64>>;

/// The buffers of a caller.
pub(crate) struct Buffers<const M: usize, const Y: usize> {
    moving: [[f64; M]; M],
    noise: [[f64; M]; M],
    parameters: Vec<f64>,
    y_moving: [[f64; M]; Y],
    y_parameters: Vec<f64>,
}

impl<const M: usize, const Y: usize> Buffers<M, Y> {
    pub(crate) fn zeroed<A: Model<f64, M, Y>>(model: &A) -> Self {
        Self {
            moving: [[0.0; M]; M],
            noise: [[0.0; M]; M],
            parameters: vec![0.0; M * model.parameters()],
            y_moving: [[0.0; M]; Y],
            y_parameters: vec![0.0; Y * model.output_parameters()],
        }
    }

    /// Calls the full form, or the form at the origin if there are no moving states.
    pub(crate) fn call<A: Model<f64, M, Y>>(
        &mut self,
        model: &A,
        moving: Option<&[f64; M]>,
        parameters: &[f64],
        inputs: &A::Inputs,
    ) -> Results {
        let mut jacobian = RatesJacobian {
            moving: self.moving,
            noise: self.noise,
            parameters: &mut self.parameters,
        };
        let (d_y, d_y_parameters) = (&mut self.y_moving, &mut self.y_parameters);
        let (value, y) = match moving {
            Some(moving) => (
                model.rates_jacobian(moving, parameters, inputs, &mut jacobian),
                model.output_jacobian(moving, parameters, inputs, d_y, d_y_parameters),
            ),
            None => (
                model.rates_jacobian_at_origin(parameters, inputs, &mut jacobian),
                model.output_jacobian_at_origin(parameters, inputs, d_y, d_y_parameters),
            ),
        };
        (self.moving, self.noise) = (jacobian.moving, jacobian.noise);
        vec![
            value.to_vec(),
            self.moving.concat(),
            self.noise.concat(),
            self.parameters.clone(),
            y.to_vec(),
            self.y_moving.concat(),
            self.y_parameters.clone(),
        ]
    }
}

/// Prints the results of a model for buffers of the right length, zeroed before.
pub(crate) fn model<A: Model<f64, M, Y>, const M: usize, const Y: usize>(
    model: &A,
    moving: &[f64; M],
    parameters: &[f64],
    inputs: &A::Inputs,
) {
    let mut buffers = Buffers::zeroed(model);
    let full = buffers.call(model, Some(moving), parameters, inputs);
    assert_eq!(full[0].len(), model.rates(moving, parameters, inputs).len());
    assert_eq!(full[4], model.output(moving, parameters, inputs));
    print(&full.concat());

    // The buffers keep what the full form wrote at `moving`.
    let found = buffers.call(model, None, parameters, inputs);
    let expected = Buffers::zeroed(model).call(model, Some(&[0.0; M]), parameters, inputs);
    for (part, (found, expected)) in found.iter().zip(&expected).enumerate() {
        // Both forms sum the same few terms, in another order: some roundings of the largest.
        let scale = expected
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() <= 1e-15 * scale,
                "part {part} at the origin: found {found:e}, the full form gives {expected:e}"
            );
        }
    }
}

pub(crate) fn panics(function: impl FnOnce() + std::panic::UnwindSafe) -> String {
    let payload = std::panic::catch_unwind(function).expect_err("a panic");
    payload
        .downcast::<String>()
        .map(|text| *text)
        .unwrap_or_default()
}
