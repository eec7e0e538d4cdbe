//! Intervals of onsets and time constants from their profile likelihood.
//!
//! The interval holds the shapes whose statistic is less than c below the largest. For a quadratic
//! likelihood c is 3.84, the 95 % point of χ²(1); an onset in a drift with white noise is a change
//! point, whose likelihood is a random walk on both sides of it, and c is larger (Hinkley, Biometrika
//! 57, 1, 1970). Both follow from the same draws: with the estimated effect in the data, the scores at
//! all shapes are jointly normal, and c is the 95 % quantile of the largest statistic less that at
//! the true shape. The noise that all statistics are over was estimated with ν degrees of freedom: the
//! largest statistic less that at the true shape is over χ²(ν)/ν too, and c of a quadratic likelihood is
//! the square of Student's deviate.

use gyrocal_statistics::{chi_square_quantile, student_quantile};
use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::context::SearchContext;
use crate::hypothesis::Hypothesis;
use crate::model::FittedModel;
use crate::null_distribution::GaussianDraws;
use crate::shape::{ShapeProfile, ShapeScale};
use gyrocal_inference::Column;

/// Coverage of the intervals.
const COVERAGE: f64 = 0.95;

/// Deviance beyond which no shape is looked at: its likelihood is below 1e-6, and c of a change point is 28
/// with the three degrees of freedom that a platform tells at least.
const FARTHEST: f64 = 30.0;

/// Smallest distance of a shape from the estimate, over the whole scale.
const NEAREST: f64 = 1e-6;

/// Distances from the estimate, each twice the one before: the last is beyond the scale.
const DISTANCES: i32 = 20;

/// Points between the two shapes where the deviance is [`FARTHEST`].
const POINTS: usize = 81;

/// 95 % point of χ²(1), of a quadratic likelihood in known noise.
const QUADRATIC: f64 = 3.84;

/// Degrees of freedom beyond which noise counts as known: c is then within 0.1 %.
const MANY: f64 = 1e4;

/// Quantiles that stand for the distribution of χ²(ν)/ν. With 64, c of a quadratic likelihood is within
/// 1 % of its value at three degrees of freedom.
const NOISE_QUANTILES: usize = 64;

/// Halvings of the bracket of c: it is then known to a part in 10⁹.
const HALVINGS: usize = 40;

/// Ratio of the two halves of an interval above which no standard deviation describes it.
const SYMMETRIC: f64 = 1.5;

/// Uncertainty of a shape and of the sizes with the shape unknown.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ShapeInterval {
    /// The pieces of the interval, rising.
    pub(crate) pieces: Vec<[f64; 2]>,
    /// Standard deviation of the shape, where one piece is symmetric about the estimate.
    pub(crate) sigma: Option<f64>,
    /// Standard deviation of each size: over the shapes by their likelihood, in the unit of the
    /// columns.
    pub(crate) size_sigmas: Vec<f64>,
}

/// The interval of the shape of an effect in a fit whose noise has these degrees of freedom; `absent` and
/// `free` as of [`ShapeProfile::new`].
pub(crate) fn shape_interval<F: FittedModel>(
    fitted: &F,
    context: &SearchContext<'_>,
    (hypothesis, estimate, degrees): (&Hypothesis, f64, f64),
    (absent, free): (&[usize], &[Column]),
    draws: &mut GaussianDraws,
) -> Result<Option<ShapeInterval>, F::Error> {
    let Some(scale) = ShapeScale::of(hypothesis, &context.rows) else {
        return Ok(None);
    };
    let around = |places: Vec<f64>| {
        let shapes = places.iter().map(|place| scale.shape(*place)).collect();
        ShapeProfile::new(fitted, context, hypothesis, shapes, (absent, free))
    };
    let centre = scale.place(estimate);
    let length = scale.ends[1] - scale.ends[0];
    let distances: Vec<f64> = (0..=DISTANCES)
        .map(|power| NEAREST * length * f64::from(power).exp2())
        .collect();
    let mut places = vec![centre];
    places.extend(distances.iter().map(|distance| centre - distance));
    places.extend(distances.iter().map(|distance| centre + distance));
    let statistics = around(places)?.statistics();
    let far = |side: usize| {
        let own = &statistics[1 + side * distances.len()..][..distances.len()];
        let beyond = own
            .iter()
            .position(|other| statistics[0] - other > FARTHEST);
        beyond.map_or(length, |index| distances[index])
    };
    let (low, high) = (
        (centre - far(0)).max(scale.ends[0]),
        (centre + far(1)).min(scale.ends[1]),
    );
    let mut places: Vec<f64> = (0..POINTS)
        .map(|index| low + (high - low) * index as f64 / (POINTS - 1) as f64)
        .collect();
    let at = places.partition_point(|place| *place < centre);
    places.insert(at, centre);
    let profile = around(places.clone())?;
    Ok(interval(&profile, (&places, &scale), degrees, draws))
}

fn interval(
    profile: &ShapeProfile,
    (places, scale): (&[f64], &ShapeScale),
    degrees: f64,
    draws: &mut GaussianDraws,
) -> Option<ShapeInterval> {
    let statistics = profile.statistics();
    let (best, largest) = statistics
        .iter()
        .copied()
        .enumerate()
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    let quadratic = student_quantile(0.5 * (1.0 + COVERAGE), degrees).map(|t| t.powi(2));
    let quadratic = quadratic.unwrap_or(QUADRATIC);
    // Less than that of a quadratic likelihood is an error of the draws, or of a shape that no record tells.
    let limit = losses(profile, best, draws)
        .and_then(|losses| limit(&losses, degrees))
        .map_or(quadratic, |drawn| drawn.max(quadratic));
    let deviance: Vec<f64> = statistics.iter().map(|other| largest - other).collect();
    let pieces = pieces(places, &deviance, limit);
    let sigma = match pieces.as_slice() {
        [[low, high]] if *low > scale.ends[0] && *high < scale.ends[1] => {
            let ends = [*low, places[best], *high].map(|place| scale.shape(place));
            let halves = [ends[1] - ends[0], ends[2] - ends[1]];
            let ratio = f64::max(halves[0] / halves[1], halves[1] / halves[0]);
            // Of a quadratic likelihood the limit is the square of the deviate.
            (ratio < SYMMETRIC).then(|| 0.5 * (ends[2] - ends[0]) / limit.sqrt())
        }
        _ => None,
    };
    Some(ShapeInterval {
        pieces: pieces
            .into_iter()
            .map(|piece| piece.map(|place| scale.shape(place)))
            .collect(),
        sigma,
        size_sigmas: size_sigmas(profile, &deviance),
    })
}

/// Draws of the largest statistic less that at the true shape, if that is the best one, rising; `None` of an
/// effect with several sizes.
fn losses(profile: &ShapeProfile, best: usize, draws: &mut GaussianDraws) -> Option<Vec<f64>> {
    let mut columns = Vec::with_capacity(profile.columns.len());
    let mut place = None;
    for (index, own) in profile.columns.iter().enumerate() {
        match own.as_slice() {
            // A shape of which nothing can be seen, such as an onset at the end, is no rival.
            [] => {}
            [column] if !profile.bank.visible(*column) => {}
            [column] => {
                if index == best {
                    place = Some(columns.len());
                }
                columns.push(*column);
            }
            _ => return None,
        }
    }
    let best = place?;
    let (information, score) = profile.bank.part(&columns);
    let scale = information.diagonal().map(|own| own.sqrt().recip());
    if !scale.iter().all(|scale| scale.is_finite()) {
        return None;
    }
    let count = columns.len();
    let correlation = DMatrix::from_fn(count, count, |i, j| {
        information[(i, j)] * scale[i] * scale[j]
    });
    let strength = score[best] * scale[best];
    let mean: DVector<f64> = correlation.column(best) * strength;
    let eigen = SymmetricEigen::new(correlation);
    let mut factor = eigen.eigenvectors;
    for (mut vector, value) in factor.column_iter_mut().zip(eigen.eigenvalues.iter()) {
        vector *= value.max(0.0).sqrt();
    }
    let scores = draws.normal(count) * factor.transpose();
    let mut losses: Vec<f64> = scores
        .row_iter()
        .map(|row| {
            let statistic = |index: usize| (row[index] + mean[index]).powi(2);
            let largest = (0..count).map(statistic).fold(0.0, f64::max);
            largest - statistic(best)
        })
        .collect();
    losses.sort_unstable_by(f64::total_cmp);
    Some(losses)
}

/// The 95 % quantile of rising losses over χ²(ν)/ν.
fn limit(losses: &[f64], degrees: f64) -> Option<f64> {
    let index = (COVERAGE * losses.len() as f64) as usize;
    let known = losses.get(index).copied()?;
    if degrees > MANY {
        return Some(known);
    }
    let quantile = |index: usize| {
        let probability = (index as f64 + 0.5) / NOISE_QUANTILES as f64;
        Some(chi_square_quantile(probability, degrees)? / degrees)
    };
    let noise: Option<Vec<f64>> = (0..NOISE_QUANTILES).map(quantile).collect();
    let noise = noise?;
    let below = |limit: f64| {
        let counts = noise
            .iter()
            .map(|noise| losses.partition_point(|loss| *loss <= limit * noise));
        counts.sum::<usize>() as f64 / (noise.len() * losses.len()) as f64
    };
    let (mut low, mut high) = (0.0, losses.last()? / noise.first()?);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if below(middle) < COVERAGE {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(high)
}

/// Stretches of places whose deviance is below a limit, ends interpolated.
fn pieces(places: &[f64], deviance: &[f64], limit: f64) -> Vec<[f64; 2]> {
    let crossing = |inside: usize, outside: usize| {
        let share = (limit - deviance[inside]) / (deviance[outside] - deviance[inside]);
        places[inside] + share.clamp(0.0, 1.0) * (places[outside] - places[inside])
    };
    let mut pieces: Vec<[f64; 2]> = Vec::new();
    let mut begin: Option<f64> = None;
    for (index, deviance) in deviance.iter().enumerate() {
        let inside = *deviance <= limit;
        match (begin, inside) {
            (None, true) => {
                begin = Some(if index == 0 {
                    places[0]
                } else {
                    crossing(index, index - 1)
                });
            }
            (Some(from), false) => {
                pieces.push([from, crossing(index - 1, index)]);
                begin = None;
            }
            _ => {}
        }
    }
    if let (Some(from), Some(last)) = (begin, places.last()) {
        pieces.push([from, *last]);
    }
    pieces
}

/// Standard deviations of the sizes: their variance at each shape and the scatter of their estimates,
/// weighted by the likelihood of the shape.
fn size_sigmas(profile: &ShapeProfile, deviance: &[f64]) -> Vec<f64> {
    let mut total = 0.0;
    let mut sums: Vec<[f64; 3]> = Vec::new();
    for (columns, deviance) in profile.columns.iter().zip(deviance) {
        let Some(joint) = profile.bank.joint(columns) else {
            continue;
        };
        let weight = gyrocal_statistics::math::exp(-0.5 * deviance);
        total += weight;
        sums.resize(columns.len(), [0.0; 3]);
        for (size, sum) in sums.iter_mut().enumerate() {
            let estimate = joint.estimate[size];
            sum[0] += weight * joint.covariance[(size, size)];
            sum[1] += weight * estimate;
            sum[2] += weight * estimate * estimate;
        }
    }
    sums.into_iter()
        .map(|[variance, first, second]| {
            let mean = first / total;
            (variance / total + (second / total - mean * mean).max(0.0)).sqrt()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use gyrocal_statistics::{chi_square_quantile, student_quantile};

    use super::{limit, pieces};

    #[test]
    fn losses_of_a_quadratic_likelihood_have_the_square_of_a_deviate_for_their_limit() {
        let count = 4096;
        let quantile = |index: usize| {
            let probability = (index as f64 + 0.5) / f64::from(count);
            chi_square_quantile(probability, 1.0).unwrap_or(f64::NAN)
        };
        let losses: Vec<f64> = (0..count as usize).map(quantile).collect();
        for degrees in [3.0, 5.0, 12.0, 80.0, f64::INFINITY] {
            let found = limit(&losses, degrees).unwrap_or(f64::NAN);
            let expected = match degrees {
                f64::INFINITY => chi_square_quantile(0.95, 1.0),
                degrees => student_quantile(0.975, degrees).map(|t| t * t),
            };
            // The quantiles of the noise are 64: see `NOISE_QUANTILES`.
            let ratio = found / expected.unwrap_or(f64::NAN);
            assert!((ratio - 1.0).abs() < 0.01, "{degrees}: {ratio}");
        }
    }

    #[test]
    fn losses_of_a_change_point_have_the_limit_of_its_distribution() {
        // Beside a change point the likelihood falls as a random walk on both sides: the loss stays below c
        // with the probability (1 − exp(−c/2))² in known noise (Hinkley 1970), and with the mean of that
        // over χ²(ν)/ν in estimated noise.
        let count = 4096;
        let losses: Vec<f64> = (0..count)
            .map(|index| {
                let probability = (f64::from(index) + 0.5) / f64::from(count);
                -2.0 * (1.0 - probability.sqrt()).ln()
            })
            .collect();
        let below = |limit: f64, degrees: f64| {
            let tail = |times: f64| (1.0 + times * limit / degrees).powf(-0.5 * degrees);
            1.0 - 2.0 * tail(1.0) + tail(2.0)
        };
        for degrees in [3.0, 8.0, 40.0] {
            let found = below(limit(&losses, degrees).unwrap_or(f64::NAN), degrees);
            // 64 quantiles of the noise, as above: 1 % of c is some 0.1 % of the probability.
            assert!((found - 0.95).abs() < 0.002, "{degrees}: {found}");
        }
        let known = limit(&losses, f64::INFINITY).unwrap_or(f64::NAN);
        assert!((known - 7.35).abs() < 0.02, "{known}");
    }

    #[test]
    fn a_likelihood_with_two_maxima_has_an_interval_in_two_pieces() {
        let places = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        let deviance = [8.0, 0.0, 8.0, 2.0, 2.0, 3.0];
        assert_eq!(
            pieces(&places, &deviance, 4.0),
            [[0.5, 1.5], [2.0 + 4.0 / 6.0, 5.0]]
        );
        assert_eq!(pieces(&places, &deviance, 10.0), [[0.0, 5.0]]);
    }
}
