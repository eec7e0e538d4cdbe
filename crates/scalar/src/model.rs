use crate::Scalar;

/// Name, public id, unit and meaning of one scalar of a model's state or input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Element {
    /// Name of the field in generated structs.
    pub name: &'static str,
    /// Public id, such as `gyro_x.bias`; the name where the model gives none.
    pub id: &'static str,
    /// Unit, such as `deg/h`.
    pub unit: &'static str,
    /// Meaning in a few words.
    pub doc: &'static str,
}

/// Derivatives of the rates of the moving states.
///
/// A model writes structural nonzeros only; whoever passes this in has zeroed the rest.
#[derive(Debug)]
pub struct RatesJacobian<'a, T, const M: usize> {
    /// With respect to the moving states: `moving[i][j]` = d rate i / d state j.
    pub moving: [[T; M]; M],
    /// With respect to the noise inputs, padded with zero columns to `M`.
    pub noise: [[T; M]; M],
    /// With respect to the parameters, row-major: rate i, parameter j at `i * parameters + j`.
    pub parameters: &'a mut [T],
}

/// A continuous model with `M` moving states, some constant parameters and `Y` outputs:
/// d moving / dt = rates(moving, parameters, inputs) + noise, output = output(…).
///
/// Implementations are generated; the filters know nothing of a model but this.
pub trait Model<T: Scalar, const M: usize, const Y: usize> {
    /// Inputs of rates and outputs besides the state, held over a step.
    type Inputs: Copy;

    /// Number of constant parameters.
    fn parameters(&self) -> usize;

    /// Number of leading parameters up to the last one that enters the output.
    fn output_parameters(&self) -> usize;

    /// For each noise input the parameter that enters the rates in exactly the same way, if
    /// there is one for every input: the filter then needs no noise sensitivities of its own.
    fn noise_parameters(&self) -> Option<[usize; M]>;

    /// Rates of the moving states.
    ///
    /// # Panics
    /// If `parameters` has not the length [`Self::parameters`].
    fn rates(&self, moving: &[T; M], parameters: &[T], inputs: &Self::Inputs) -> [T; M];

    /// Rates of the moving states and their exact derivatives: every structural nonzero is
    /// written at every call, nothing else is touched.
    ///
    /// # Panics
    /// If `parameters` or `jacobian.parameters` has not the right length.
    fn rates_jacobian(
        &self,
        moving: &[T; M],
        parameters: &[T],
        inputs: &Self::Inputs,
        jacobian: &mut RatesJacobian<'_, T, M>,
    ) -> [T; M];

    /// [`Self::rates_jacobian`] with all moving states zero. Generated models may have a shorter
    /// form of it; a filter whose chart moves with the estimate starts every step there. What the
    /// full form writes is written here too, zero where it vanishes.
    ///
    /// # Panics
    /// As [`Self::rates_jacobian`].
    #[inline(always)]
    fn rates_jacobian_at_origin(
        &self,
        parameters: &[T],
        inputs: &Self::Inputs,
        jacobian: &mut RatesJacobian<'_, T, M>,
    ) -> [T; M] {
        self.rates_jacobian(&[T::from_f64(0.0); M], parameters, inputs, jacobian)
    }

    /// Whether the derivative of moving state `i`'s rate with respect to parameter `j` is other
    /// than structurally zero in [`Self::rates_jacobian_at_origin`].
    #[inline(always)]
    fn enters_at_origin(&self, i: usize, j: usize) -> bool {
        let _ = (i, j);
        true
    }

    /// Whether the derivative of moving state `i`'s rate with respect to moving state `j` is other
    /// than structurally zero in [`Self::rates_jacobian_at_origin`].
    #[inline(always)]
    fn moves_at_origin(&self, i: usize, j: usize) -> bool {
        let _ = (i, j);
        true
    }

    /// Whether the derivative of output `k` with respect to moving state `j` is other than
    /// structurally zero in [`Self::output_jacobian_at_origin`].
    #[inline(always)]
    fn shows_at_origin(&self, k: usize, j: usize) -> bool {
        let _ = (k, j);
        true
    }

    /// Outputs: what the sensors would read without noise.
    ///
    /// # Panics
    /// If `parameters` has not the length [`Self::parameters`].
    fn output(&self, moving: &[T; M], parameters: &[T], inputs: &Self::Inputs) -> [T; Y];

    /// Outputs and their exact derivatives: `d_moving[i][j]`, and `d_parameters` row-major
    /// with [`Self::output_parameters`] columns. Every structural nonzero is written at every
    /// call, nothing else is touched.
    ///
    /// # Panics
    /// If `parameters` or `d_parameters` has not the right length.
    fn output_jacobian(
        &self,
        moving: &[T; M],
        parameters: &[T],
        inputs: &Self::Inputs,
        d_moving: &mut [[T; M]; Y],
        d_parameters: &mut [T],
    ) -> [T; Y];

    /// [`Self::output_jacobian`] with all moving states zero.
    ///
    /// # Panics
    /// As [`Self::output_jacobian`].
    #[inline(always)]
    fn output_jacobian_at_origin(
        &self,
        parameters: &[T],
        inputs: &Self::Inputs,
        d_moving: &mut [[T; M]; Y],
        d_parameters: &mut [T],
    ) -> [T; Y] {
        self.output_jacobian(
            &[T::from_f64(0.0); M],
            parameters,
            inputs,
            d_moving,
            d_parameters,
        )
    }
}

/// Inputs of a generated model by the names of their groups, for code that sets the groups that it
/// knows and no others.
pub trait NamedInputs<T>: Copy {
    /// Inputs that are all of one value.
    #[must_use]
    fn filled(value: T) -> Self;

    /// The numbers of a group; `None` if the model takes no group of this name.
    fn group_mut(&mut self, name: &str) -> Option<&mut [T]>;
}

/// A model whose moving states are coordinates in a chart that can be moved.
///
/// The defaults are those of a flat state space: no chart, corrections are added.
pub trait Recentre<T: Scalar, const M: usize, const Y: usize>: Model<T, M, Y> {
    /// Whether there is a chart: after [`Self::recentre`] and [`Self::correct`] the moving
    /// states are then zero.
    fn has_chart(&self) -> bool {
        false
    }

    /// Moves the origin of the chart to `moving`: `moving` becomes zero, `inputs` are carried
    /// along. Returns the derivative of the error at the new origin with respect to the error
    /// of the old coordinates, or `None` if the state space is flat and nothing moved.
    fn recentre(&self, moving: &mut [T; M], inputs: &mut Self::Inputs) -> Option<[[T; M]; M]> {
        let _ = (moving, inputs);
        None
    }

    /// Whether element (`i`, `j`) of the result of [`Self::recentre`] can differ from that of a
    /// unit matrix.
    #[inline(always)]
    fn maps(&self, i: usize, j: usize) -> bool {
        let _ = (i, j);
        true
    }

    /// Applies a correction, expressed as the error at the origin of the chart, when the
    /// moving states are at the origin; a flat model adds it to the moving states.
    fn correct(&self, moving: &mut [T; M], inputs: &mut Self::Inputs, correction: &[T; M]) {
        let _ = inputs;
        for (state, change) in moving.iter_mut().zip(correction) {
            *state = *state + *change;
        }
    }
}
