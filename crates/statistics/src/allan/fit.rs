//! Fit of the parts of a noise to the ordinates of a record.

use core::f64::consts::{LN_2, PI};

use serde::Serialize;

use super::held::released;
use super::likelihood::{
    Law, attenuation, best, density_at, interval, open_density, residuals, visible,
};
use super::octaves;
use super::ordinates::{Bin, bins};
use super::parts::{NoisePart, PARTS};
use super::tones::{self, Line, Tone};
use crate::error::StatisticsError;
use crate::math::{ln, pow, sin};
use crate::probability::{NORMAL_97_5, chi_square_tail, two_sided_p};

/// Probability that a noise of the parts, sinusoids and a filter is not taken for one.
const REJECTED: f64 = 0.01;

/// Gain of twice the log likelihood from which a filter is told: three terms take the place of quantisation.
const FILTERED: f64 = 9.0;

/// Fewest samples of a fit: as many as have five octaves of averaging times.
const FEWEST: usize = 48;

/// Fewest bins below the corner of a filter.
const FEWEST_BINS: usize = 20;

/// Factor of the density that a sinusoid is held against beyond the corner of a filter, where the density has no law.
const BEYOND: f64 = 10.0;

/// Power beyond the corner over that of the law without a filter, above which there is none: one pole leaves half or less
/// there.
const HIDDEN: f64 = 0.75;

/// Averaging time at which a frequency of one counts most in an Allan variance: the maximum of sin⁴(π x) / x².
const OF_FREQUENCY: f64 = 0.371;

/// Coefficient of a part.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Coefficient {
    /// The part.
    pub part: NoisePart,
    /// Its coefficient, in the unit of the rate and seconds; `None` if the record cannot tell it from
    /// something else.
    pub estimate: Option<f64>,
    /// Ends of its 95 % interval. The lower one is zero if the part is not visible.
    pub interval: Option<[f64; 2]>,
}

/// Fitted Allan deviation at one averaging time, for a plot.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FittedPoint {
    /// Averaging time \[s\].
    pub tau_s: f64,
    /// Deviation of parts and sinusoids behind the filter.
    pub deviation: f64,
    /// Deviation of each part without the filter, in the order of [`NoisePart::ALL`].
    pub parts: [f64; PARTS],
}

/// Parts of a noise with what else is in the record, and a test of fit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NoiseFit {
    /// Coefficients in the order of [`NoisePart::ALL`].
    pub coefficients: Vec<Coefficient>,
    /// Sinusoids, the largest first.
    pub tones: Vec<Tone>,
    /// Frequency at which a filter leaves half of the power \[Hz\], at most half the sampling rate; `None` without a
    /// filter, and where the noise is not explained. Behind one quantisation cannot be told, and what is above the frequency is not part of the test.
    pub filter_corner_hz: Option<f64>,
    /// Samples for each value of a sensor that has fewer than the log; `None` without repetitions.
    pub samples_per_value: Option<f64>,
    /// Sum of squares of the deviations of bins of ordinates, in their standard deviations.
    pub chi_square: f64,
    /// Probability of a larger one if the noise is as fitted. Below 1 % it is not, and no coefficient is given.
    pub p_value: f64,
    /// Octaves of averaging times, each with its ends \[s\], at which it is not.
    pub not_explained_s: Vec<[f64; 2]>,
    /// The fitted curve.
    pub curve: Vec<FittedPoint>,
}

impl NoiseFit {
    /// `true` if the parts, sinusoids and a filter describe the record; otherwise no coefficient is determined.
    #[must_use]
    pub fn is_described(&self) -> bool {
        self.p_value >= REJECTED
    }

    /// Coefficient of a part.
    #[must_use]
    pub fn coefficient(&self, part: NoisePart) -> Option<&Coefficient> {
        self.coefficients.iter().find(|other| other.part == part)
    }
}

/// Fits the four parts, none of them negative, to samples of a rate, each the mean over `interval_s`, by the likelihood
/// of the squares of their cosine transform, together with sinusoids, a low-pass filter and a ramp of the rate of any
/// size. Values that are repeated are taken once. Each interval holds the values whose likelihood ratio is within the
/// 95 % limit of chi-square with one degree of freedom.
///
/// # Errors
///
/// [`StatisticsError::TooShort`] with fewer than 48 values, and for samples that are all equal;
/// [`StatisticsError::NotFinite`].
pub fn fit_noise(rate: &[f64], interval_s: f64) -> Result<NoiseFit, StatisticsError> {
    if let Some(row) = rate.iter().position(|value| !value.is_finite()) {
        return Err(StatisticsError::NotFinite { sample: row + 1 });
    }
    let held = released(rate);
    let (values, each) = held
        .as_ref()
        .map_or((rate, 1.0), |(values, each)| (values, *each));
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let largest = values
        .iter()
        .fold(0.0_f64, |most, value| most.max((value - mean).abs()));
    if values.len() < FEWEST || largest == 0.0 {
        return Err(StatisticsError::TooShort {
            test: "the fit of the parts of a noise",
            found: if largest == 0.0 { 1 } else { values.len() },
            expected: FEWEST,
        });
    }
    let scaled: Vec<f64> = values
        .iter()
        .map(|value| (value - mean) / largest)
        .collect();
    let mut found = Found::of(scaled);
    let units = Units {
        rate: largest,
        interval_s: interval_s * each,
    };
    found
        .lines
        .sort_by(|(one, _), (other, _)| other.amplitude().total_cmp(&one.amplitude()));
    let mut noise = found.told(&units);
    noise.samples_per_value = held.map(|(_, each)| each);
    Ok(noise)
}

/// Units of a fit in samples: that of the rate, and the time between values.
struct Units {
    rate: f64,
    interval_s: f64,
}

/// The law of the ordinates of values.
struct Fitted {
    bins: Vec<Bin>,
    /// Bins that the law describes: those below the corner of a filter.
    used: usize,
    law: Law,
    least: f64,
    /// Corner of the filter, in samples.
    corner: Option<f64>,
}

impl Fitted {
    fn of(values: &[f64]) -> Self {
        let bins = bins(values);
        Self::filtered(&bins).unwrap_or_else(|| {
            let (law, least) = best(&bins, false);
            let (used, corner) = (bins.len(), None);
            Self {
                bins,
                used,
                law,
                least,
                corner,
            }
        })
    }

    /// The law with a filter, if there is one.
    fn filtered(bins: &[Bin]) -> Option<Self> {
        const MOST_ITERATIONS: usize = 8;
        let below = |corner: f64| bins.partition_point(|bin| bin.frequency < corner);
        let mut used = bins.len();
        let (mut law, mut least) = best(bins, true);
        if best(bins, false).1 - least < FILTERED {
            return None;
        }
        let mut corner = corner(&law);
        for _ in 0..MOST_ITERATIONS {
            let next = below(corner).max(FEWEST_BINS).min(bins.len());
            if next >= used {
                break;
            }
            used = next;
            (law, least) = best(&bins[..used], true);
            corner = self::corner(&law);
        }
        // Beyond the corner, where the law is not fitted, there is less than without a filter.
        let [mut found, mut open] = [0.0; 2];
        for bin in &bins[used..] {
            found += bin.count * bin.power / open_density(&law, bin.frequency);
            open += bin.count;
        }
        let is_low = found <= HIDDEN * open;
        is_low.then(|| Self {
            bins: bins.to_vec(),
            used,
            law,
            least,
            corner: Some(corner),
        })
    }
}

/// Frequency at which a filter leaves half of the power, in samples.
fn corner(law: &Law) -> f64 {
    const HALVINGS: usize = 40;
    let (mut low, mut high) = (0.0, 0.5);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if attenuation(law, middle) < 2.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// What is in a record, in samples.
struct Found {
    samples: usize,
    fitted: Fitted,
    /// Sinusoids, and the density of the noise about each.
    lines: Vec<(Line, f64)>,
}

impl Found {
    fn of(mut values: Vec<f64>) -> Self {
        let samples = values.len();
        let mut fitted = Fitted::of(&values);
        let mut lines = Vec::new();
        while lines.len() < tones::MOST {
            let density = |frequency: f64| density_at(&fitted.law, frequency);
            let Some((line, level)) = tones::largest(&values, density) else {
                break;
            };
            let mut without = values.clone();
            line.take_off(&mut without);
            let next = Fitted::of(&without);
            let mut density = density_at(&next.law, line.frequency).max(level);
            if next.corner.is_some_and(|corner| line.frequency > corner) {
                density *= BEYOND;
            }
            if !line.is_told(samples, density) {
                break;
            }
            (values, fitted) = (without, next);
            lines.push((line, density));
        }
        Self {
            samples,
            fitted,
            lines,
        }
    }

    fn told(&self, units: &Units) -> NoiseFit {
        let Fitted {
            bins,
            used,
            law,
            least,
            corner,
        } = &self.fitted;
        let bins = &bins[..*used];
        let residuals = residuals(bins, law);
        let chi_square = residuals.iter().map(|residual| residual * residual).sum();
        let free = (bins.len() - visible(bins, law)) as f64;
        let p_value = chi_square_tail(chi_square, free).unwrap_or(0.0);
        let is_described = p_value >= REJECTED;
        let coefficient = |part: NoisePart| {
            let place = part as usize;
            let told = is_described && (corner.is_none() || part != NoisePart::Quantisation);
            let unit = units.rate * part.time_factor(units.interval_s);
            let of = |variance: f64| unit * variance.sqrt();
            let limit = NORMAL_97_5 * NORMAL_97_5;
            Coefficient {
                part,
                estimate: told.then(|| of(law[place])),
                interval: told.then(|| interval(bins, (law, *least), place, limit).map(of)),
            }
        };
        let tone = |(line, density): &(Line, f64)| {
            line.tone(self.samples, *density, units.interval_s)
                .scaled(units.rate)
        };
        NoiseFit {
            coefficients: NoisePart::ALL.into_iter().map(coefficient).collect(),
            tones: self.lines.iter().map(tone).collect(),
            filter_corner_hz: corner
                .filter(|_| is_described)
                .map(|corner| corner / units.interval_s),
            samples_per_value: None,
            chi_square,
            p_value,
            not_explained_s: match is_described {
                true => Vec::new(),
                false => not_explained(bins, &residuals, units.interval_s),
            },
            curve: self.curve(units),
        }
    }

    fn curve(&self, units: &Units) -> Vec<FittedPoint> {
        let point = |averaging: usize| {
            let (m, tau) = (averaging as f64, averaging as f64);
            let law = &self.fitted.law;
            let parts: [f64; PARTS] =
                core::array::from_fn(|part| law[part] * NoisePart::ALL[part].variance(m));
            let lines = self.lines.iter().map(|(line, _)| {
                let x = PI * line.frequency * tau;
                (line.amplitude() * sin(x).powi(2) / x).powi(2)
            });
            // What the filter takes, over bins that hold many periods of the transfer function or little of one.
            let taken = self.fitted.bins.iter().map(|bin| {
                let width = bin.count / (2 * self.samples) as f64;
                let x = PI * bin.frequency;
                let fourth = match m * width > 1.0 {
                    true => 0.375,
                    false => sin(m * x).powi(4),
                };
                let open: f64 = (0..PARTS).map(|part| law[part] * bin.density[part]).sum();
                let passed = 1.0 / attenuation(law, bin.frequency);
                4.0 * width * open * (1.0 - passed) * fourth / (m * sin(x)).powi(2)
            });
            let whole = parts.iter().sum::<f64>() + lines.sum::<f64>() - taken.sum::<f64>();
            FittedPoint {
                tau_s: m * units.interval_s,
                deviation: units.rate * whole.max(0.0).sqrt(),
                parts: parts.map(|variance| units.rate * variance.sqrt()),
            }
        };
        octaves(self.samples).into_iter().map(point).collect()
    }
}

/// Octaves of averaging times whose bins are far from the law; the farthest if none is far alone.
fn not_explained(bins: &[Bin], residuals: &[f64], interval_s: f64) -> Vec<[f64; 2]> {
    let octave = |bin: &Bin| (ln(0.5 / bin.frequency) / LN_2).floor() as i32;
    let mut found: Vec<(i32, f64)> = Vec::new();
    let mut from = 0;
    while from < bins.len() {
        let own = octave(&bins[from]);
        let to = from
            + bins[from..]
                .iter()
                .take_while(|bin| octave(bin) == own)
                .count();
        let (mut squares, mut sum, mut weight) = (0.0, 0.0, 0.0);
        for (bin, residual) in bins[from..to].iter().zip(&residuals[from..to]) {
            squares += residual * residual;
            sum += residual * bin.count.sqrt();
            weight += bin.count;
        }
        let scattered = chi_square_tail(squares, (to - from) as f64).unwrap_or(1.0);
        found.push((own, scattered.min(two_sided_p(sum / weight.sqrt()))));
        from = to;
    }
    found.sort_by(|one, other| one.1.total_cmp(&other.1));
    let each = REJECTED / found.len() as f64;
    let far = found.iter().filter(|(_, p)| *p < each).count().max(1);
    let mut octaves: Vec<i32> = found[..far].iter().map(|(octave, _)| *octave).collect();
    octaves.sort_unstable();
    let from_s = |octave: i32| 2.0 * OF_FREQUENCY * interval_s * pow(2.0, f64::from(octave));
    octaves
        .into_iter()
        .map(|octave| [from_s(octave), from_s(octave + 1)])
        .collect()
}
