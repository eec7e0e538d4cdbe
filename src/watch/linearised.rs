#![expect(
    clippy::needless_range_loop,
    reason = "loops over several matrices by one index read like the equations"
)]

use gyrocal_estimation::{Factors, Innovation, Precision};
use gyrocal_scalar::Model;
use gyrocal_watch::Observed;

use crate::filter::PlatformFilter;
use crate::generated::platform::Platform;

const N: usize = Platform::STATES;

/// A step of the filter, linearised: what errors of its state go through.
#[derive(Clone, Copy, Debug)]
pub struct Linearised<T> {
    /// Moving rows of Φ, in the chart after the step.
    pub transition: [[T; N]; 3],
    /// Jacobian and gain of the sample, whitened.
    pub observed: Observed<T, 3, 3, N>,
    /// The whitened innovation, as the filter has taken it.
    pub innovation: [T; 3],
}

impl<T: Precision> Linearised<T> {
    /// Nothing.
    #[must_use]
    pub const fn unset() -> Self {
        Self {
            transition: [[T::ZERO; N]; 3],
            observed: Observed {
                output: [[T::ZERO; 3]; 3],
                whitening: [[T::ZERO; 3]; 3],
                gain: [[T::ZERO; N]; 3],
            },
            innovation: [T::ZERO; 3],
        }
    }

    /// After a prediction.
    #[inline]
    pub(crate) fn predicted(&mut self, filter: &PlatformFilter<T, Factors>) {
        let kernel = filter.kernel();
        let mut plain = [[T::ZERO; N]; 3];
        let columns = kernel.view().transition.chunks_exact(Platform::PARAMETERS);
        let moving = kernel.moving_transition();
        for ((row, moving), columns) in plain.iter_mut().zip(moving).zip(columns) {
            for (place, value) in row.iter_mut().zip(moving.iter().chain(columns)) {
                *place = *value;
            }
        }
        self.transition = plain;
        if let Some(map) = kernel.chart_map() {
            for i in 0..3 {
                for j in 0..N {
                    let mut sum = map[i][0] * plain[0][j];
                    for l in 1..3 {
                        sum = map[i][l].mul_add(plain[l][j], sum);
                    }
                    self.transition[i][j] = sum;
                }
            }
        }
        self.before_update(filter);
    }

    /// Jacobian of the outputs, before the update, which moves the chart.
    #[inline]
    pub(crate) fn before_update(&mut self, filter: &PlatformFilter<T, Factors>) {
        // The model writes structural nonzeros only.
        self.observed.output = [[T::ZERO; 3]; 3];
        let _ = Platform.output_jacobian_at_origin(
            &[T::ZERO; Platform::PARAMETERS],
            filter.kernel().inputs().inputs(),
            &mut self.observed.output,
            &mut [],
        );
    }

    /// After the update that followed, or none.
    #[inline]
    pub(crate) fn updated(
        &mut self,
        filter: &PlatformFilter<T, Factors>,
        innovation: &Innovation<T, 3>,
    ) {
        let whitening = innovation.whitening();
        let jacobian = self.observed.output;
        for k in 0..3 {
            for j in 0..3 {
                let mut sum = whitening[k][0] * jacobian[0][j];
                for l in 1..3 {
                    sum = whitening[k][l].mul_add(jacobian[l][j], sum);
                }
                self.observed.output[k][j] = sum;
            }
        }
        let rows = filter.kernel().view().gain.chunks_exact(N);
        for (k, row) in rows.take(3).enumerate() {
            // The filter's gain is that of each output given the ones before it, over its variance;
            // the last element of a row of the whitening is one over the root of it.
            let root = whitening[k][k];
            for j in 0..N {
                self.observed.gain[k][j] = row[j] * root;
            }
        }
        self.observed.whitening = whitening;
        self.innovation = innovation.standardised();
    }

    /// After a sample that was seen but not taken: it corrects nothing, and is clipped in any case.
    #[cold]
    pub(crate) fn not_taken(
        &mut self,
        filter: &PlatformFilter<T, Factors>,
        innovation: &Innovation<T, 3>,
        clip: T,
    ) {
        self.updated(filter, innovation);
        self.innovation = self.innovation.map(|element| element.max(-clip).min(clip));
        self.observed.gain = [[T::ZERO; N]; 3];
    }
}
