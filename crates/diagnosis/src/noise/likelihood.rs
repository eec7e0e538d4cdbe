//! Maximum-likelihood fit of the noise to the spectrum: variances, correlation, random walk.

use super::spectrum::Spectrum;

/// Number of parameters: three variance ratios, correlation, walk.
const PARAMETERS: usize = 5;
/// Index of the correlation.
pub(crate) const CORRELATION: usize = 3;
/// Index of the random walk's variance over the declared one.
pub(crate) const WALK: usize = 4;

/// Largest correlation of the fit.
const LARGEST_CORRELATION: f64 = 0.95;
/// Largest random walk of the fit, in declared variances.
const LARGEST_WALK: f64 = 1e6;
/// Excess power of a cosine over the fit, in standard deviations, beyond which it is a line and not
/// noise.
const LINE_SIGMAS: f64 = 5.5;

/// Parameters of the noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NoiseModel {
    /// Variances of x, y, z without quantisation over the declared one; correlation from row to row;
    /// variance of the random walk over the declared one.
    pub(crate) values: [f64; PARAMETERS],
    /// Variance that quantisation adds to each axis, in declared variances.
    pub(crate) quantisation: [f64; 3],
}

/// A fit of the noise model.
#[derive(Clone, Debug)]
pub(crate) struct NoiseFit {
    pub(crate) model: NoiseModel,
    pub(crate) log_likelihood: f64,
    /// Standard deviations; zero for fixed parameters.
    pub(crate) sigma: [f64; PARAMETERS],
}

/// Selected cosines.
pub(crate) struct Bins(Vec<[bool; 3]>);

impl NoiseModel {
    /// Noise as declared.
    pub(crate) fn declared(quantisation: [f64; 3]) -> Self {
        Self {
            values: [1.0, 1.0, 1.0, 0.0, 1.0],
            quantisation,
        }
    }

    /// Expected power in a cosine, and its derivatives by the parameters.
    fn power(&self, spectrum: &Spectrum, axis: usize, cosine: usize) -> (f64, [f64; PARAMETERS]) {
        let sums = &spectrum.axes[axis];
        let (ratio, correlation, walk) = (
            self.values[axis],
            self.values[CORRELATION],
            self.values[WALK],
        );
        let [coloured, slope] = spectrum.basis.coloured(cosine, correlation);
        let walk_power = sums.walk * spectrum.basis.walk(cosine);
        let white = (sums.seen + sums.scattered) * self.quantisation[axis];
        let of_ratio = sums.seen * coloured + sums.scattered;
        let mut derivatives = [0.0; PARAMETERS];
        derivatives[axis] = of_ratio;
        derivatives[CORRELATION] = sums.seen * ratio * slope;
        derivatives[WALK] = walk_power;
        (ratio * of_ratio + white + walk * walk_power, derivatives)
    }

    fn clamp(&mut self) {
        for ratio in &mut self.values[..3] {
            *ratio = ratio.max(1e-6);
        }
        let limit = LARGEST_CORRELATION;
        self.values[CORRELATION] = self.values[CORRELATION].clamp(-limit, limit);
        self.values[WALK] = self.values[WALK].clamp(0.0, LARGEST_WALK);
    }
}

impl Bins {
    /// All cosines.
    pub(crate) fn all(spectrum: &Spectrum) -> Self {
        Self(vec![[true; 3]; spectrum.basis.len()])
    }

    /// All cosines without lines: those whose power exceeds the fit.
    pub(crate) fn without_lines(spectrum: &Spectrum, model: &NoiseModel) -> Self {
        let usual = |axis: usize, cosine: usize| {
            let expected = model.power(spectrum, axis, cosine).0;
            let excess = spectrum.axes[axis].power[cosine] / expected - 1.0;
            excess < LINE_SIGMAS * (2.0 / spectrum.axes[axis].blocks as f64).sqrt()
        };
        let cosines = 0..spectrum.basis.len();
        Self(
            cosines
                .map(|cosine| core::array::from_fn(|axis| usual(axis, cosine)))
                .collect(),
        )
    }
}

/// Maximises the likelihood over the free parameters, from an initial value.
///
/// The coefficients of a block are taken as independent and normal, which holds for white noise,
/// and for a random walk up to the degree of the polynomial.
pub(crate) fn fit(
    spectrum: &Spectrum,
    bins: &Bins,
    start: NoiseModel,
    free: [bool; PARAMETERS],
) -> NoiseFit {
    let mut model = start;
    let (mut log_likelihood, mut score, mut information) = evaluate(spectrum, bins, &model);
    for _ in 0..60 {
        let step = solve(&information, &score, &free);
        let mut length = 1.0;
        let mut moved = false;
        while length > 1e-4 {
            let mut trial = model;
            for (value, step) in trial.values.iter_mut().zip(&step) {
                *value += length * step;
            }
            trial.clamp();
            let found = evaluate(spectrum, bins, &trial);
            if found.0 > log_likelihood {
                moved = found.0 - log_likelihood > 1e-9;
                model = trial;
                (log_likelihood, score, information) = found;
                break;
            }
            length /= 2.0;
        }
        if !moved {
            break;
        }
    }
    NoiseFit {
        model,
        log_likelihood,
        sigma: sigmas(&information, &free),
    }
}

type Evaluation = (f64, [f64; PARAMETERS], [[f64; PARAMETERS]; PARAMETERS]);

/// Log-likelihood, its gradient and the Fisher information.
fn evaluate(spectrum: &Spectrum, bins: &Bins, model: &NoiseModel) -> Evaluation {
    let mut log_likelihood = 0.0;
    let mut score = [0.0; PARAMETERS];
    let mut information = [[0.0; PARAMETERS]; PARAMETERS];
    for (cosine, counts) in bins.0.iter().enumerate() {
        for axis in (0..3).filter(|axis| counts[*axis] && spectrum.axes[*axis].blocks > 0) {
            let sums = &spectrum.axes[axis];
            let half = 0.5 * sums.blocks as f64;
            let (expected, derivatives) = model.power(spectrum, axis, cosine);
            let over = sums.power[cosine] / expected;
            log_likelihood -= half * (expected.ln() + over);
            for i in 0..PARAMETERS {
                let relative = derivatives[i] / expected;
                score[i] += half * (over - 1.0) * relative;
                for j in 0..PARAMETERS {
                    information[i][j] += half * relative * derivatives[j] / expected;
                }
            }
        }
    }
    (log_likelihood, score, information)
}

/// J⁻¹ s over the free parameters; parameters without information are fixed.
fn solve(
    information: &[[f64; PARAMETERS]; PARAMETERS],
    right: &[f64; PARAMETERS],
    free: &[bool; PARAMETERS],
) -> [f64; PARAMETERS] {
    let free: Vec<usize> = (0..PARAMETERS)
        .filter(|i| free[*i] && information[*i][*i] > 0.0)
        .collect();
    let mut lower = [[0.0; PARAMETERS]; PARAMETERS];
    let mut solution = [0.0; PARAMETERS];
    let mut kept: Vec<usize> = Vec::new();
    for i in free {
        for j in &kept {
            let shared: f64 = kept
                .iter()
                .take_while(|l| *l < j)
                .map(|l| lower[i][*l] * lower[*j][*l])
                .sum();
            lower[i][*j] = (information[i][*j] - shared) / lower[*j][*j];
        }
        let own = information[i][i] - kept.iter().map(|l| lower[i][*l].powi(2)).sum::<f64>();
        if own > 1e-12 * information[i][i] {
            lower[i][i] = own.sqrt();
            let before: f64 = kept.iter().map(|l| lower[i][*l] * solution[*l]).sum();
            solution[i] = (right[i] - before) / lower[i][i];
            kept.push(i);
        }
    }
    for position in (0..kept.len()).rev() {
        let i = kept[position];
        let later: f64 = kept[position + 1..]
            .iter()
            .map(|l| lower[*l][i] * solution[*l])
            .sum();
        solution[i] = (solution[i] - later) / lower[i][i];
    }
    solution
}

fn sigmas(
    information: &[[f64; PARAMETERS]; PARAMETERS],
    free: &[bool; PARAMETERS],
) -> [f64; PARAMETERS] {
    core::array::from_fn(|i| {
        let mut unit = [0.0; PARAMETERS];
        unit[i] = 1.0;
        solve(information, &unit, free)[i].max(0.0).sqrt()
    })
}
