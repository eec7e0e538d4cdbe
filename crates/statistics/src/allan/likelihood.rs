//! Likelihood of the ordinates of a record, given the parts of its noise and a filter.

use nalgebra::{DMatrix, DVector, SMatrix, SVector};

use super::ordinates::{Bin, RAMP, SHAPES};
use super::parts::{NoisePart, PARTS};
use crate::math::{exp, ln, pow, sin};

/// Terms of the filter: the densities are divided by 1 + a₁ u + a₂ u² + a₃ u³ with u = 4 sin²(π f), which is every
/// recursive filter of up to three poles, and near any other low-pass up to its corner.
pub(super) const TERMS: usize = 3;

/// Parameters: the variances of the parts, and the terms of the filter. None is negative.
pub(super) const PARAMETERS: usize = PARTS + TERMS;

/// Parameters of a law.
pub(super) type Law = [f64; PARAMETERS];

/// Variance of a ramp that may have any size, in those of a sample over the record.
const ANY_RAMP: f64 = 1e9;

/// u at a frequency.
pub(super) fn filter_argument(frequency: f64) -> f64 {
    4.0 * sin(core::f64::consts::PI * frequency).powi(2)
}

/// Factor by which the filter divides densities.
pub(super) fn attenuation(law: &Law, frequency: f64) -> f64 {
    let u = filter_argument(frequency);
    let terms = law[PARTS..].iter().rev();
    1.0 + terms.fold(0.0, |sum, term| u * (term + sum))
}

/// Density of a law at a bin, and its derivatives with respect to the logarithms of the parameters, over it.
fn density(bin: &Bin, law: &Law) -> (f64, SVector<f64, PARAMETERS>) {
    let mut slopes = SVector::<f64, PARAMETERS>::zeros();
    let mut sum = 0.0;
    for part in 0..PARTS {
        slopes[part] = law[part] * bin.density[part];
        sum += slopes[part];
    }
    slopes /= sum;
    let attenuation = attenuation(law, bin.frequency);
    let mut power = 1.0;
    for term in PARTS..PARAMETERS {
        power *= filter_argument(bin.frequency);
        slopes[term] = -law[term] * power / attenuation;
    }
    (sum / attenuation, slopes)
}

/// Density of the parts of a law at a frequency, in front of the filter.
pub(super) fn open_density(law: &Law, frequency: f64) -> f64 {
    let parts = law.iter().zip(NoisePart::ALL);
    parts
        .map(|(variance, part)| variance * part.density(frequency))
        .sum()
}

/// Density of a law at a frequency.
pub(super) fn density_at(law: &Law, frequency: f64) -> f64 {
    open_density(law, frequency) / attenuation(law, frequency)
}

/// Number of the parameters of a law that show in some bin: by more than a twentieth of its density.
pub(super) fn visible(bins: &[Bin], law: &Law) -> usize {
    let shows = |place: usize| {
        bins.iter()
            .any(|bin| density(bin, law).1[place].abs() > 0.05)
    };
    (0..PARAMETERS).filter(|place| shows(*place)).count()
}

/// Twice the negative logarithm of the likelihood of bins, but for a constant, with its slope and curvature (Fisher
/// information) for the logarithms of the parameters.
struct Deviance {
    value: f64,
    slope: SVector<f64, PARAMETERS>,
    curvature: SMatrix<f64, PARAMETERS, PARAMETERS>,
}

fn deviance(bins: &[Bin], law: &Law) -> Deviance {
    let mut slope = SVector::<f64, PARAMETERS>::zeros();
    let mut curvature = SMatrix::<f64, PARAMETERS, PARAMETERS>::zeros();
    let mut sum = 0.0;
    // Of each shape the sums of its square and of its product with the ordinates over the density, and their slopes.
    let mut shapes = [[0.0; 2]; SHAPES];
    let mut shape_slopes = [[SVector::<f64, PARAMETERS>::zeros(); 2]; SHAPES];
    for bin in bins {
        let (density, along) = density(bin, law);
        sum += bin.count * (ln(density) + bin.power / density);
        for (shape, of_bin) in bin.shapes.iter().enumerate() {
            for (which, own) in of_bin.iter().enumerate() {
                shapes[shape][which] += own / density;
                shape_slopes[shape][which] -= own / density * along;
            }
        }
        slope += bin.count * (1.0 - bin.power / density) * along;
        curvature += bin.count * along * along.transpose();
    }
    for (shape, [square, product]) in shapes.into_iter().enumerate() {
        // The errors at both ends add or subtract.
        let (variance, of_quantisation) = match shape {
            RAMP => (ANY_RAMP, 0.0),
            _ => (2.0 * law[0], 1.0),
        };
        if variance == 0.0 {
            continue;
        }
        let whole = 1.0 + variance * square;
        sum += ln(whole) - variance * product * product / whole;
        let [square_slope, product_slope] = shape_slopes[shape];
        let mut whole_slope = variance * square_slope;
        whole_slope[0] += of_quantisation * variance * square;
        let mut gain = 2.0 * variance * product * product_slope;
        gain[0] += of_quantisation * variance * product * product;
        slope += whole_slope / whole - gain / whole
            + variance * product * product / (whole * whole) * whole_slope;
    }
    Deviance {
        value: sum,
        slope,
        curvature,
    }
}

/// The law of least deviance near a law, and its deviance; parameters that are zero or not `free` stay.
pub(super) fn minimise(bins: &[Bin], start: &Law, free: &[bool; PARAMETERS]) -> (Law, f64) {
    const MOST_ITERATIONS: usize = 100;
    /// Most change of the logarithm of a parameter in one step.
    const LONGEST: f64 = 3.0;
    /// Change of the deviance below which the search ends.
    const CHANGE: f64 = 1e-5;
    let places: Vec<usize> = (0..PARAMETERS)
        .filter(|place| free[*place] && start[*place] > 0.0)
        .collect();
    let mut law = *start;
    let mut damping = 1e-3;
    let mut least = deviance(bins, &law);
    for _ in 0..MOST_ITERATIONS {
        let matrix = DMatrix::from_fn(places.len(), places.len(), |i, j| {
            let own = least.curvature[(places[i], places[j])];
            // A part that shows nowhere has no information, and stays small.
            if i == j {
                own * (1.0 + damping) + 1e-9
            } else {
                own
            }
        });
        let right = DVector::from_fn(places.len(), |i, _| -least.slope[places[i]]);
        let Some(factor) = matrix.cholesky() else {
            break;
        };
        let step = factor.solve(&right);
        let mut next = law;
        for (place, change) in places.iter().zip(step.iter()) {
            next[*place] *= exp(change.clamp(-LONGEST, LONGEST));
        }
        let found = deviance(bins, &next);
        if found.value <= least.value {
            let change = least.value - found.value;
            (law, least) = (next, found);
            damping = (0.3 * damping).max(1e-6);
            if change < CHANGE {
                break;
            }
        } else {
            damping *= 10.0;
            if damping > 1e8 {
                break;
            }
        }
    }
    (law, least.value)
}

/// Laws from which a search begins: each part as large as it may be anywhere, and the same with little of one.
pub(super) fn starts(bins: &[Bin], filtered: bool) -> Vec<Law> {
    const FEW: f64 = 1e-3;
    // Means of a few bins: a single ordinate may be anything.
    const TOGETHER: usize = 6;
    let mut most = [f64::INFINITY; PARTS];
    for several in bins.chunks(TOGETHER) {
        let count: f64 = several.iter().map(|bin| bin.count).sum();
        let mean = |of: &dyn Fn(&Bin) -> f64| {
            several.iter().map(|bin| bin.count * of(bin)).sum::<f64>() / count
        };
        let power = mean(&|bin| bin.power);
        for (part, most) in most.iter_mut().enumerate() {
            *most = most.min(power / mean(&|bin| bin.density[part]));
        }
    }
    let mut first: Law = [0.0; PARAMETERS];
    for part in 0..PARTS {
        first[part] = 0.5 * most[part];
    }
    if filtered {
        // No error of the angle passes a filter; its corner is where the density is half of that of low frequencies.
        first[0] = 0.0;
        let middle = &bins[bins.len() / 2..];
        let level = middle.iter().map(|bin| bin.power).fold(0.0, f64::max);
        let corner = bins.iter().rev().find(|bin| bin.power > 0.5 * level);
        let u = corner.map_or(1.0, |bin| filter_argument(bin.frequency));
        first[NoisePart::RandomWalk as usize] = level;
        first[PARTS..].copy_from_slice(&[0.5 / u, 0.3 / (u * u), 0.2 / u.powi(3)]);
    }
    let with_few = |part: NoisePart| {
        let mut law = first;
        law[part as usize] *= FEW;
        law
    };
    let bias_instability = with_few(NoisePart::BiasInstability);
    vec![first, bias_instability, with_few(NoisePart::RateRandomWalk)]
}

/// The best law from every start.
pub(super) fn best(bins: &[Bin], filtered: bool) -> (Law, f64) {
    let laws = starts(bins, filtered);
    let found = laws
        .iter()
        .map(|start| minimise(bins, start, &[true; PARAMETERS]));
    found
        .min_by(|one, other| one.1.total_cmp(&other.1))
        .unwrap_or(([0.0; PARAMETERS], f64::INFINITY))
}

/// Interval of one parameter by the profile of the deviance: the values whose deviance is within `limit` of the least.
/// The lower end is zero for a parameter that is not visible.
pub(super) fn interval(
    bins: &[Bin],
    (law, least): (&Law, f64),
    place: usize,
    limit: f64,
) -> [f64; 2] {
    const HALVINGS: usize = 12;
    const DOUBLINGS: usize = 60;
    let all = starts(bins, law[PARTS..].iter().any(|term| *term > 0.0));
    // Parts that the best law has lost may come back where this one is held away from it.
    let mut warm = *law;
    for (own, start) in warm.iter_mut().zip(&all[0]) {
        *own = own.max(1e-3 * start);
    }
    let is_out = |value: f64| {
        let mut free = [true; PARAMETERS];
        free[place] = false;
        let held = |start: &Law| {
            let mut start = *start;
            start[place] = value;
            minimise(bins, &start, &free).1 - least
        };
        held(&warm) > limit && all.iter().all(|start| held(start) > limit)
    };
    let bisected = |mut inside: f64, mut outside: f64| {
        for _ in 0..HALVINGS {
            let middle = (inside * outside).sqrt();
            if is_out(middle) {
                outside = middle;
            } else {
                inside = middle;
            }
        }
        (inside * outside).sqrt()
    };
    // Below a thousandth of what could be anywhere it is not visible.
    let smallest = 1e-3 * all[0][place];
    let mut inside = law[place].max(smallest);
    let low = match law[place] > smallest && is_out(0.0) {
        false => 0.0,
        true => {
            let mut outside = 0.5 * inside;
            while outside > smallest && !is_out(outside) {
                inside = outside;
                outside *= 0.5;
            }
            bisected(inside, outside)
        }
    };
    inside = law[place].max(smallest);
    let mut outside = 2.0 * inside;
    for _ in 0..DOUBLINGS {
        if is_out(outside) {
            break;
        }
        inside = outside;
        outside *= 2.0;
    }
    [low, bisected(inside, outside)]
}

/// Deviations of the bins from a law in standard deviations: the cube root of a mean of squares is nearly normal (E. B.
/// Wilson and M. M. Hilferty, Proceedings of the National Academy of Sciences 17, 1931). The ramp is taken off as fitted.
pub(super) fn residuals(bins: &[Bin], law: &Law) -> Vec<f64> {
    let [mut square, mut product] = [0.0; 2];
    for bin in bins {
        let density = density(bin, law).0;
        square += bin.shapes[RAMP][0] / density;
        product += bin.shapes[RAMP][1] / density;
    }
    let ramp = product / square;
    let residual = |bin: &Bin| {
        let [square, product] = bin.shapes[RAMP];
        let ends = 2.0 * law[0] * (bin.shapes[0][0] + bin.shapes[1][0]) / bin.count;
        let power = bin.power + ramp * (ramp * square - 2.0 * product) / bin.count;
        let ratio = power.max(0.0) / (density(bin, law).0 + ends);
        let ninth = 2.0 / (9.0 * bin.count);
        (pow(ratio, 1.0 / 3.0) - 1.0 + ninth) / ninth.sqrt()
    };
    bins.iter().map(residual).collect()
}
