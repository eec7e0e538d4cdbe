//! Scales of axes, their ticks and labels.

use crate::number::{readable_unit, short, superscript, with_unit};
use crate::span::Span;

/// One axis: its span, ticks and title.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    span: Span,
    logarithmic: bool,
    /// Values of labelled ticks, and their labels.
    pub ticks: Vec<(f64, String)>,
    /// Values of ticks without labels.
    pub minor: Vec<f64>,
    /// Quantity and unit.
    pub title: String,
}

impl Axis {
    /// A linear scale with about as many ticks as asked; labels of small or large numbers are in
    /// a power of 1000 of the unit.
    pub(crate) fn linear(span: Span, quantity: &str, unit: &str, ticks: usize) -> Self {
        let (factor, unit) = readable_unit(unit, span.largest());
        let (lo, hi) = (span.lo * factor, span.hi * factor);
        let step = step((hi - lo) / ticks.max(1) as f64);
        let decimals = decimals(step);
        let (first, last) = ((lo / step).ceil() as i64, (hi / step).floor() as i64);
        let tick = |multiple: i64| {
            let value = multiple as f64 * step;
            (value / factor, label(value, decimals))
        };
        Self {
            ticks: (first..=last).map(tick).collect(),
            title: with_unit(quantity, &unit),
            ..Self::bare(span)
        }
    }

    /// A logarithmic scale; the span must be positive.
    pub(crate) fn logarithmic(span: Span, quantity: &str, unit: &str, ticks: usize) -> Self {
        let (from, to) = (span.lo.log10(), span.hi.log10());
        let decades = (from.ceil() as i32)..=(to.floor() as i32);
        let every = (decades.clone().count() / ticks.max(1) + 1) as i32;
        let plain = from.ceil() >= -2.0 && to.floor() <= 3.0;
        let power = |exponent: i32| 10f64.powi(exponent);
        let mut labelled: Vec<(f64, String)> = decades
            .clone()
            .filter(|exponent| exponent.rem_euclid(every) == 0)
            .map(|exponent| (power(exponent), power_label(exponent, plain)))
            .collect();
        let within = |value: &f64| (span.lo..=span.hi).contains(value);
        let mut minor: Vec<f64> = ((from.floor() as i32)..=(to.ceil() as i32))
            .flat_map(|exponent| (1..10).map(move |digit| f64::from(digit) * power(exponent)))
            .filter(within)
            .collect();
        if decades.count() > 10 {
            minor.clear();
        }
        if labelled.len() < 2 {
            // Less than two decades: label multiples of powers of ten.
            labelled = minor
                .iter()
                .filter(|&&value| {
                    let digit = (value / 10f64.powf(value.log10().floor())).round() as i32;
                    matches!(digit, 1 | 2 | 5 | 10)
                })
                .map(|&value| (value, short(value, 1)))
                .collect();
        }
        Self {
            logarithmic: true,
            ticks: labelled,
            minor,
            title: with_unit(quantity, unit),
            ..Self::bare(span)
        }
    }

    /// A linear scale without ticks and title.
    pub(crate) fn bare(span: Span) -> Self {
        Self {
            span,
            logarithmic: false,
            ticks: Vec::new(),
            minor: Vec::new(),
            title: String::new(),
        }
    }

    /// Position of a value: 0 at the start of the axis, 1 at its end. Not a number if the value
    /// is not one, or has no logarithm.
    pub(crate) fn at(&self, value: f64) -> f64 {
        let Span { lo, hi } = self.span;
        match self.logarithmic {
            true if value > 0.0 => (value / lo).ln() / (hi / lo).ln(),
            true => f64::NAN,
            false => (value - lo) / (hi - lo),
        }
    }
}

/// The smallest round step that is not below the least.
fn step(least: f64) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0]
        .into_iter()
        .map(|kind| kind * power)
        .find(|step| *step >= least * (1.0 - 1e-9))
        .unwrap_or(10.0 * power)
}

/// Number of decimals that a step needs.
fn decimals(step: f64) -> usize {
    (-(step.log10() + 1e-9).floor()).clamp(0.0, 15.0) as usize
}

fn label(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    // Rounding can leave a zero with a sign.
    if text
        .trim_start_matches('-')
        .chars()
        .all(|c| c == '0' || c == '.')
    {
        return "0".to_owned();
    }
    text.replace('-', "−")
}

/// `0.01` where all labels are short that way, `10⁻²` otherwise.
fn power_label(exponent: i32, plain: bool) -> String {
    match exponent {
        0 => "1".to_owned(),
        _ if plain => format!("{:.*}", -exponent.min(0) as usize, 10f64.powi(exponent)),
        _ => format!("10{}", superscript(exponent)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<&str> {
        axis.ticks.iter().map(|(_, label)| label.as_str()).collect()
    }

    #[test]
    fn ticks_are_round() {
        let axis = Axis::linear(Span::new(-0.31, 0.42), "drift", "deg/h", 4);
        assert_eq!(labels(&axis), ["−0.2", "0", "0.2", "0.4"]);
        let micro = Axis::linear(Span::symmetric(3.1e-5), "residual", "g", 4);
        assert_eq!(labels(&micro), ["−20", "0", "20"]);
        assert_eq!(micro.title, "residual [µg]");
    }

    #[test]
    fn powers_of_ten_or_their_multiples() {
        let wide = Axis::logarithmic(Span::new(1e-4, 300.0), "power", "g²", 4);
        assert_eq!(labels(&wide), ["10⁻⁴", "10⁻²", "1", "10²"]);
        let plain = Axis::logarithmic(Span::new(0.07, 720.0), "f", "", 8);
        assert_eq!(labels(&plain), ["0.1", "1", "10", "100"]);
        let narrow = Axis::logarithmic(Span::new(1.5, 60.0), "power", "g²", 4);
        assert_eq!(labels(&narrow), ["2", "5", "10", "20", "50"]);
    }

    #[test]
    fn a_single_value_has_a_scale() {
        for value in [0.0, 3.0, -1e-9] {
            let span = Span::new(value, value).padded(0.05);
            assert!(span.lo < value && value < span.hi, "{span:?}");
            assert!(Axis::linear(span, "", "", 4).ticks.len() >= 2);
        }
    }
}
