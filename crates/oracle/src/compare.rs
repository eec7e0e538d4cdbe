//! Comparison of a matrix with a reference, and the name of its worst element.

use core::fmt;

use crate::program::Output;

/// Tolerance of a comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Error relative to the largest entry of the element's column. Columns differ in scale: those
    /// of the drift coefficients are 1e-4 of the others.
    pub relative: f64,
    /// Fraction of all compared elements that may exceed it within their rounding error (see
    /// [`crate::rounding`]).
    pub ill_conditioned_share: f64,
}

/// Collects comparisons of one output over many points.
#[derive(Clone, Debug)]
pub struct Comparison<'a> {
    function: &'a str,
    output: &'a Output,
    tolerance: Tolerance,
    summary: Summary,
}

/// Result of a comparison.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// Elements compared.
    pub elements: usize,
    /// Elements beyond the relative tolerance but within their rounding error.
    pub ill_conditioned: usize,
    /// The element with the largest error over its tolerance.
    pub worst: Option<Element>,
}

/// One element of a result with its expected value.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// Function that was compared.
    pub function: String,
    /// Its output.
    pub output: String,
    /// Name of the row.
    pub row: String,
    /// Name of the column; empty for a vector without column names.
    pub column: String,
    /// Number of the point.
    pub point: usize,
    /// The result.
    pub value: f64,
    /// The expected value.
    pub expected: f64,
    /// Error relative to the largest entry of the column.
    pub error: f64,
    /// Relative tolerance.
    pub allowed: f64,
}

/// Failure of a comparison.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Mismatch {
    /// An element is beyond its tolerance; this is the worst.
    #[error("{0}")]
    Element(Box<Element>),
    /// Too many elements are beyond the relative tolerance.
    #[error("{function}, {output}: {count} of {elements} elements are ill-conditioned")]
    IllConditioned {
        /// Function that was compared.
        function: String,
        /// Its output.
        output: String,
        /// Elements beyond the relative tolerance but within their rounding error.
        count: usize,
        /// Elements compared.
        elements: usize,
    },
    /// Nothing was compared.
    #[error("{function}, {output}: nothing was compared")]
    Nothing {
        /// Function that was to be compared.
        function: String,
        /// Its output.
        output: String,
    },
}

impl<'a> Comparison<'a> {
    /// A comparison of one output of a function.
    #[must_use]
    pub fn new(function: &'a str, output: &'a Output, tolerance: Tolerance) -> Self {
        Self {
            function,
            output,
            tolerance,
            summary: Summary::default(),
        }
    }

    /// Compares dense matrices, row by row, at one point.
    ///
    /// `rounding` bounds the difference of the two by rounding, element by element. A column of zeros
    /// must be equal where the bound is zero; a value that is not a number never agrees.
    ///
    /// # Panics
    /// If a matrix does not have the shape of the output.
    pub fn add(&mut self, point: usize, value: &[f64], expected: &[f64], rounding: &[f64]) {
        let (rows, columns) = (self.output.rows, self.output.columns);
        for matrix in [value, expected, rounding] {
            assert_eq!(
                matrix.len(),
                rows * columns,
                "shape of {}",
                self.output.name
            );
        }
        for column in 0..columns {
            let places = || (0..rows).map(|row| row * columns + column);
            let scale = places()
                .map(|place| expected[place].abs())
                .fold(0.0, f64::max);
            for place in places() {
                let difference = (value[place] - expected[place]).abs();
                if scale == 0.0 && difference > 0.0 && difference <= rounding[place] {
                    self.summary.elements += 1;
                    self.summary.ill_conditioned += 1;
                    continue;
                }
                let relative = if difference == 0.0 {
                    0.0
                } else {
                    difference / scale
                };
                let relative = if relative.is_nan() {
                    f64::INFINITY
                } else {
                    relative
                };
                let excuse = rounding[place] / scale;
                let excuse = if excuse.is_finite() { excuse } else { 0.0 };
                let allowed = self.tolerance.relative.max(excuse);
                self.summary.elements += 1;
                if relative > self.tolerance.relative && relative <= allowed {
                    self.summary.ill_conditioned += 1;
                }
                let nearness = relative / allowed;
                let worst = self.summary.worst.as_ref();
                if worst.is_none_or(|worst| nearness > worst.error / worst.allowed) {
                    self.summary.worst = Some(Element {
                        function: self.function.to_owned(),
                        output: self.output.name.clone(),
                        row: self.output.row_name(place / columns),
                        column: self.output.column_label(column),
                        point,
                        value: value[place],
                        expected: expected[place],
                        error: relative,
                        allowed,
                    });
                }
            }
        }
    }

    /// Ends the comparison.
    ///
    /// # Errors
    /// If an element is beyond its tolerance, if too many are beyond the relative tolerance, or if
    /// nothing was compared.
    pub fn finish(self) -> Result<Summary, Mismatch> {
        let (function, output) = (self.function.to_owned(), self.output.name.clone());
        let Summary {
            elements,
            ill_conditioned,
            ..
        } = self.summary;
        match &self.summary.worst {
            None => Err(Mismatch::Nothing { function, output }),
            Some(worst) if worst.error <= worst.allowed => {
                let limit = self.tolerance.ill_conditioned_share * elements as f64;
                if ill_conditioned as f64 <= limit {
                    Ok(self.summary)
                } else {
                    Err(Mismatch::IllConditioned {
                        function,
                        output,
                        count: ill_conditioned,
                        elements,
                    })
                }
            }
            Some(worst) => Err(Mismatch::Element(Box::new(worst.clone()))),
        }
    }
}

impl fmt::Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}[{}", self.function, self.output, self.row)?;
        if !self.column.is_empty() {
            write!(f, ", {}", self.column)?;
        }
        write!(
            f,
            "] at point {}: {:e}, expected {:e}; error {:.2e} of the largest in the column, \
             {:.2e} allowed",
            self.point, self.value, self.expected, self.error, self.allowed
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STRICT: Tolerance = Tolerance {
        relative: 1e-13,
        ill_conditioned_share: 0.0,
    };

    fn output() -> Output {
        Output {
            name: "rate_d_state".into(),
            rows: 2,
            columns: 2,
            row_names: vec!["rate_x".into(), "rate_y".into()],
            column_names: vec!["angle".into(), "drift".into()],
            nonzeros: vec![(0, 0), (1, 0), (0, 1), (1, 1)],
        }
    }

    fn compare(value: &[f64; 4], rounding: f64, tolerance: Tolerance) -> Result<Summary, Mismatch> {
        let output = output();
        let mut comparison = Comparison::new("rates", &output, tolerance);
        let expected = [1.0, 1e-4, 0.5, 2e-5];
        comparison.add(0, &expected, &expected, &[0.0; 4]);
        comparison.add(1, value, &expected, &[rounding; 4]);
        comparison.finish()
    }

    #[test]
    fn an_error_in_a_small_column_is_seen_and_named() {
        // 1e-16 absolute: nothing beside 1, but 1e-12 of the largest in its own column.
        let Err(Mismatch::Element(worst)) = compare(&[1.0, 1e-4, 0.5, 2e-5 + 1e-16], 0.0, STRICT)
        else {
            panic!("not seen");
        };
        assert_eq!(
            (worst.row.as_str(), worst.column.as_str()),
            ("rate_y", "drift")
        );
        assert_eq!((worst.point, worst.expected), (1, 2e-5));
        assert!((worst.error - 1e-12).abs() < 1e-15);
        let message = worst.to_string();
        assert!(
            message.starts_with("rates, rate_d_state[rate_y, drift] at point 1"),
            "{message}"
        );
    }

    #[test]
    fn small_entries_are_measured_by_the_largest_of_their_column() {
        // 2e-14 on an entry of 1e-4 whose column has 1e-4: too much; on 0.5 beside 1: fine.
        assert!(compare(&[1.0, 1e-4 + 2e-14, 0.5, 2e-5], 0.0, STRICT).is_err());
        assert!(compare(&[1.0, 1e-4, 0.5 + 2e-14, 2e-5], 0.0, STRICT).is_ok());
    }

    #[test]
    fn rounding_excuses_a_declared_share_of_elements() {
        let value = [1.0, 1e-4, 0.5, 2e-5 + 1e-16];
        assert!(
            compare(
                &value,
                0.5e-16,
                Tolerance {
                    ill_conditioned_share: 1.0,
                    ..STRICT
                }
            )
            .is_err()
        );
        let eighth = Tolerance {
            ill_conditioned_share: 0.125,
            ..STRICT
        };
        assert_eq!(compare(&value, 2e-16, eighth).unwrap().ill_conditioned, 1);
        let less = Tolerance {
            ill_conditioned_share: 0.12,
            ..STRICT
        };
        assert!(matches!(
            compare(&value, 2e-16, less),
            Err(Mismatch::IllConditioned {
                count: 1,
                elements: 8,
                ..
            })
        ));
    }

    #[test]
    fn what_is_not_a_number_agrees_with_nothing() {
        for bad in [f64::NAN, f64::INFINITY] {
            let generous = Tolerance {
                relative: 1e9,
                ill_conditioned_share: 1.0,
            };
            for rounding in [1.0, f64::NAN, f64::INFINITY] {
                assert!(compare(&[1.0, 1e-4, bad, 2e-5], rounding, generous).is_err());
            }
        }
        let output = output();
        let mut comparison = Comparison::new("rates", &output, STRICT);
        comparison.add(0, &[f64::NAN; 4], &[f64::NAN; 4], &[0.0; 4]);
        assert!(comparison.finish().is_err());
    }

    #[test]
    fn a_column_of_zeros_must_be_met_exactly() {
        let output = output();
        for (value, agrees) in [(0.0, true), (1e-300, false)] {
            let mut comparison = Comparison::new("rates", &output, STRICT);
            comparison.add(0, &[1.0, value, 1.0, 0.0], &[1.0, 0.0, 1.0, 0.0], &[1.0; 4]);
            assert_eq!(comparison.finish().is_ok(), agrees);
        }
        assert!(matches!(
            Comparison::new("rates", &output, STRICT).finish(),
            Err(Mismatch::Nothing { .. })
        ));
    }
}
