//! Derivatives by sixth-order central differences.
//!
//! f'(x) = [45 (f(x+h) − f(x−h)) − 9 (f(x+2h) − f(x−2h)) + (f(x+3h) − f(x−3h))] / 60h,
//! with the error −h⁶ f⁽⁷⁾/140 (Fornberg, Mathematics of Computation 51, 1988, table 1).
//!
//! A good step balances this error and the rounding of f. With rounding 1e-16 |f| and a
//! function whose nearest singularity is the distance d away, so that f⁽⁷⁾ ~ 7! f'/d⁶ and
//! |f| ~ d |f'|, the two relative errors of f' are 36 (h/d)⁶ and 2e-16 d/h: both are below
//! 1e-10 for h/d between 2e-6 and 1e-2. The upper end is best, since entries of a column that are
//! small against f have the second error only.

/// Weights of f(x + kh) − f(x − kh), k = 1, 2, 3, times 60.
const WEIGHTS: [f64; 3] = [45.0, -9.0, 1.0];

/// Error of the derivative from one unit of error in f, times the step.
pub const AMPLIFICATION: f64 = 2.0 * (45.0 + 9.0 + 1.0) / 60.0;

/// Jacobian of `function` with respect to the inputs whose places are `by`, row by row;
/// `steps` has the step of each of those inputs, in its own unit.
///
/// # Panics
/// If `by` and `steps` differ in length, or `by` has a place that `point` does not have.
#[must_use]
pub fn jacobian(
    function: impl Fn(&[f64]) -> Vec<f64>,
    point: &[f64],
    by: &[usize],
    steps: &[f64],
) -> Vec<f64> {
    assert_eq!(by.len(), steps.len(), "a step for each input");
    let columns: Vec<Vec<f64>> = by
        .iter()
        .zip(steps)
        .map(|(&place, &step)| column(&function, &mut point.to_vec(), place, step))
        .collect();
    let rows = columns.first().map_or(0, Vec::len);
    (0..rows)
        .flat_map(|row| columns.iter().map(move |column| column[row]))
        .collect()
}

/// Bound of the error of such a Jacobian, row by row, from errors `value_errors` of the values (one
/// per row). The truncation error of the formula is not included.
#[must_use]
pub fn rounding(value_errors: &[f64], steps: &[f64]) -> Vec<f64> {
    value_errors
        .iter()
        .flat_map(|error| steps.iter().map(move |step| AMPLIFICATION * error / step))
        .collect()
}

fn column(
    function: &impl Fn(&[f64]) -> Vec<f64>,
    point: &mut [f64],
    place: usize,
    step: f64,
) -> Vec<f64> {
    let centre = point[place];
    let mut sum: Vec<f64> = Vec::new();
    for (multiple, weight) in (1..).map(f64::from).zip(WEIGHTS) {
        point[place] = centre + multiple * step;
        let above = function(point);
        point[place] = centre - multiple * step;
        let below = function(point);
        sum.resize(above.len(), 0.0);
        for ((sum, above), below) in sum.iter_mut().zip(above).zip(below) {
            *sum += weight * (above - below);
        }
    }
    sum.iter().map(|sum| sum / (60.0 * step)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_up_to_the_sixth_degree_are_exact_and_the_seventh_is_not() {
        let powers = |x: &[f64]| (0..=7).map(|degree| x[0].powi(degree)).collect();
        // At 0 with step 1 all terms are integers: the weights must give exact answers.
        let derivatives = jacobian(powers, &[0.0], &[0], &[1.0]);
        assert_eq!(derivatives[..7], [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        // −h⁶ f⁽⁷⁾/140 with f⁽⁷⁾ = 5040 is what is missing.
        assert_eq!(derivatives[7], 36.0);
    }

    #[test]
    fn a_pole_at_the_distance_of_a_hundred_steps_costs_no_more_than_its_estimate() {
        let (distance, step) = (0.17, 0.17 / 100.0);
        let derivative = jacobian(|x| vec![1.0 / x[0]], &[distance], &[0], &[step])[0];
        let error = (derivative * -distance * distance - 1.0).abs();
        // 36 (h/d)⁶ of the module's documentation, and a fifth for the next order.
        assert!(error <= 1.2 * 36e-12, "{error:e}");
        assert!(
            error >= 0.8 * 36e-12,
            "{error:e}: the order is not what it should be"
        );
    }

    #[test]
    fn rows_are_outputs_and_columns_are_places() {
        let function = |x: &[f64]| vec![x[0] * x[1] * x[2], x[2] * x[2]];
        let jacobian = jacobian(function, &[2.0, 3.0, 5.0], &[2, 0], &[0.5, 0.25]);
        assert_eq!(jacobian, [6.0, 15.0, 10.0, 0.0]);
        let bound = rounding(&[60.0, 120.0], &[1.0, 10.0]);
        assert_eq!(bound, [110.0, 11.0, 220.0, 22.0]);
    }
}
