use gyrocal_estimation::Precision;
use gyrocal_scalar::{Model, RatesJacobian};
use gyrocal_watch::Course;

use super::effects::{Channel, EffectCourse, WatchedEffect};
use crate::anchor::Chart;
use crate::chart_vectors::ChartInputs;
use crate::generated::catalogue::{Catalogue, CatalogueInputs, OUTPUTS, RATES};
use crate::generated::platform::Platform;
use crate::rotation::{rotate, turned_by};

/// Parameters of the catalogue's model, and those of them that enter the output.
const PARAMETERS: usize = Catalogue::PARAMETERS;
const OF_OUTPUT: usize = 37;
/// Points of Gauss's rule with two points, in a block of one: 1/2 ∓ √3 / 6.
const POINTS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// Courses of effects over the block to come, foretold from where the platform stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Courses<T, const E: usize>(pub [Course<T>; E]);

impl<T: Precision, const E: usize> Courses<T, E> {
    /// For a platform in a chart whose origin is its attitude, with the given coefficients.
    ///
    /// A course is the line through the values of the catalogue's model at the two points of Gauss's
    /// rule, at the attitudes that the platform has then at its present rate: the best line for any
    /// parabola. Samples to come are not needed, which the bound on false alarms rests on.
    #[must_use]
    pub fn ahead(
        effects: &[WatchedEffect; E],
        chart: &Chart<T>,
        drift: &[T; Platform::PARAMETERS],
        block_s: T,
    ) -> Self {
        let value = |point: f64| Self::values(effects, chart, drift, T::from_f64(point) * block_s);
        let [first, second] = POINTS;
        Self::through(effects, &[value(first), value(second)], block_s)
    }

    /// Time in a block to the first or the second value of [`Self::through`].
    #[must_use]
    pub fn time_s(second: bool, block_s: T) -> T {
        T::from_f64(POINTS[usize::from(second)]) * block_s
    }

    /// Values of the effects in their channels, some time ahead.
    #[must_use]
    pub fn values(
        effects: &[WatchedEffect; E],
        chart: &Chart<T>,
        drift: &[T; Platform::PARAMETERS],
        time_s: T,
    ) -> [T; E] {
        let rates = Platform.rates(&[T::ZERO; 3], drift, chart.inputs());
        let turn = turned_by(&rates.map(|rate| rate * time_s));
        let [north, up] = &chart.orientation().map(|vector| rotate(&turn, &vector));
        let mut inputs = <CatalogueInputs<T> as ChartInputs<T>>::unset();
        inputs.set_from_chart(&chart.vectors_along(north, up));
        let mut values = [T::ZERO; E];
        at(effects, &inputs, drift, &mut values);
        values
    }

    /// The lines through two values.
    #[must_use]
    pub fn through(effects: &[WatchedEffect; E], values: &[[T; E]; 2], block_s: T) -> Self {
        let days = block_s * T::from_f64(1.0 / 86_400.0);
        let mut courses = [Course {
            start: T::ZERO,
            change: days,
        }; E];
        let [early, late] = values;
        let [first, second] = POINTS;
        let apart = T::from_f64(1.0 / (second - first));
        for (i, effect) in effects.iter().enumerate() {
            if effect.course != EffectCourse::SinceOnset {
                let change = (late[i] - early[i]) * apart;
                courses[i] = Course {
                    start: early[i] - change * T::from_f64(first),
                    change,
                };
            }
        }
        Self(courses)
    }
}

/// Values of the effects in their channels, per unit of size.
#[inline(never)]
fn at<T: Precision, const E: usize>(
    effects: &[WatchedEffect; E],
    inputs: &CatalogueInputs<T>,
    drift: &[T; Platform::PARAMETERS],
    values: &mut [T; E],
) {
    let mut parameters = [T::ZERO; PARAMETERS];
    for (place, value) in parameters.iter_mut().zip(drift) {
        *place = *value;
    }
    let mut rates = [T::ZERO; 3 * PARAMETERS];
    let mut jacobian = RatesJacobian {
        moving: [[T::ZERO; 3]; 3],
        noise: [[T::ZERO; 3]; 3],
        parameters: &mut rates,
    };
    let _ = Catalogue.rates_jacobian_at_origin(&parameters, inputs, &mut jacobian);
    let mut moving = [[T::ZERO; 3]; 3];
    let mut outputs = [T::ZERO; 3 * OF_OUTPUT];
    let _ = Catalogue.output_jacobian_at_origin(&parameters, inputs, &mut moving, &mut outputs);
    for (value, effect) in values.iter_mut().zip(effects) {
        *value = match (effect.channel, effect.course) {
            (_, EffectCourse::Constant | EffectCourse::SinceOnset) => T::from_f64(1.0),
            (Channel::Rate(rate), EffectCourse::Parameter(index)) => {
                let constant = RATES.get(rate).map_or(0, |channel| channel.constant);
                let of = |index: usize| rates.get(rate * PARAMETERS + index).copied();
                match (of(index), of(constant)) {
                    (Some(size), Some(unit)) => size / unit,
                    _ => T::ZERO,
                }
            }
            (Channel::Output(output), EffectCourse::Parameter(index)) => {
                let constant = OUTPUTS.get(output).map_or(0, |channel| channel.constant);
                let of = |index: usize| outputs.get(output * OF_OUTPUT + index).copied();
                match (of(index), of(constant)) {
                    (Some(size), Some(unit)) => size / unit,
                    _ => T::ZERO,
                }
            }
        };
    }
}
