//! Open-loop residuals: innovations with the feedback of the filter undone.

use gyrocal_statistics::median_interval_s;

use crate::series::Innovations;

/// Measured specific force less a prediction without feedback of single samples, in declared
/// standard deviations: the accelerometer noise, plus a random walk from the gyro noise, plus a
/// smooth part. `NaN` where a component is missing.
///
/// An update changes the predicted output by (S − R) S⁻¹ e. The sum of the innovation and all
/// previous corrections is a residual in which the noise of a sample appears at that sample alone;
/// innovations have it in later rows too, with the opposite sign. Corrections are kept constant in
/// platform axes while the platform rotates: rotated with it they would vary, and those of the first
/// rows, with unknown drift, are large. The error of this, and the effect of updates on the drift,
/// are smooth once the filter has settled.
pub(crate) fn open_loop(innovations: &Innovations, accel_noise_g: &[f64; 3]) -> Vec<[f64; 3]> {
    let mut corrections_g = [0.0; 3];
    let rows = innovations.residual_g.iter();
    rows.zip(&innovations.weighted_per_g)
        .map(|(residual_g, weighted_per_g)| {
            core::array::from_fn(|axis| {
                let sigma = accel_noise_g[axis];
                if residual_g[axis].is_nan() {
                    return f64::NAN;
                }
                let open = residual_g[axis] + corrections_g[axis];
                corrections_g[axis] += residual_g[axis] - sigma * sigma * weighted_per_g[axis];
                open / sigma
            })
        })
        .collect()
}

/// Ranges of rows without a gap, with all intervals below 1.5 times their median.
pub(crate) fn runs(time_s: &[f64]) -> Vec<core::ops::Range<usize>> {
    let longest = 1.5 * median_interval_s(time_s);
    let mut runs = Vec::new();
    let mut start = 0;
    for row in 1..=time_s.len() {
        if row == time_s.len() || time_s[row] - time_s[row - 1] > longest {
            runs.push(start..row);
            start = row;
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outlier_stands_at_its_own_sample_alone() {
        // A filter of constant gain K on a constant: innovations fall off by 1 - K a row.
        let (sigma, gain) = (1e-5, 0.1);
        let innovation_variance = sigma * sigma / (1.0 - gain);
        let covariance = core::array::from_fn(|i| {
            core::array::from_fn(|j| if i == j { innovation_variance } else { 0.0 })
        });
        let mut innovations = Innovations::default();
        let mut estimate = 0.0;
        for row in 0..20 {
            let measured = if row == 5 { 8.0 * sigma } else { 0.0 };
            let residual = measured - estimate;
            estimate += gain * residual;
            let row = innovations.push(
                row as f64,
                [residual, 0.0, 0.0],
                &covariance,
                [0.0, 0.0, 1.0],
            );
            assert!(row.is_ok());
        }
        assert!((innovations.residual_g[6][0] / sigma + 0.8).abs() < 1e-12);
        for (row, open) in open_loop(&innovations, &[sigma; 3]).iter().enumerate() {
            let expected = if row == 5 { 8.0 } else { 0.0 };
            // Rounding alone.
            assert!((open[0] - expected).abs() < 1e-12, "row {row}: {}", open[0]);
        }
    }

    #[test]
    fn a_gap_begins_a_run() {
        let time_s = [0.0, 60.0, 121.0, 181.0, 400.0, 460.0, 520.0];
        assert_eq!(runs(&time_s), [0..4, 4..7]);
        assert!(runs(&[]).is_empty());
        assert_eq!(runs(&[5.0]).len(), 1);
    }
}
