//! Values that a logger repeats until the sensor has the next.

/// Longest repetition that is sought, in samples.
const LONGEST: usize = 64;

/// Share of the changes that must be in step: a replaced sample is out of it.
const IN_STEP: f64 = 0.99;

/// Samples for each value above which values are held, where hardly any two are equal by chance.
const HELD: f64 = 1.25;

/// The values one by one, and the samples for each of them; `None` if none are held.
pub(super) fn released(values: &[f64]) -> Option<(Vec<f64>, f64)> {
    let changes: Vec<usize> = (1..values.len())
        .filter(|place| values[*place] != values[place - 1])
        .collect();
    let total = changes.len() as f64;
    let each = values.len() as f64 / (total + 1.0);
    // Equal steps, whose values may be equal by chance.
    let in_step = |length: usize| {
        let mut found = vec![0_usize; length];
        changes.iter().for_each(|place| found[place % length] += 1);
        let (residue, most) = found.iter().enumerate().max_by_key(|(_, count)| **count)?;
        (*most as f64 >= IN_STEP * total).then_some(residue)
    };
    let longest = LONGEST.min(each as usize);
    for length in (2..=longest).rev() {
        if let Some(residue) = in_step(length) {
            let one = values.iter().skip(residue).step_by(length);
            return Some((one.copied().collect(), length as f64));
        }
    }
    let mut one: Vec<f64> = values.first().copied().into_iter().collect();
    one.extend(changes.iter().map(|place| values[*place]));
    let mut sorted = one.clone();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    (each > HELD && 2 * sorted.len() > one.len()).then_some((one, each))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deviates::Normals;

    #[test]
    fn held_values_are_told_from_equal_ones() {
        let mut normals = Normals::of_seed(1);
        let values: Vec<f64> = (0..1000).map(|_| normals.normal()).collect();
        assert_eq!(released(&values), None);
        let coarse: Vec<f64> = values.iter().map(|value| (0.5 * value).round()).collect();
        assert_eq!(released(&coarse), None);
        for of in [&values, &coarse] {
            let held: Vec<f64> = (0..4000).map(|row| of[row / 4]).collect();
            let (found, each) = released(&held).unwrap();
            assert_eq!((found.len(), each), (1000, 4.0));
        }
        // A sensor of 40 Hz in a log of 100 Hz.
        let held: Vec<f64> = (0..2500).map(|row| values[row * 2 / 5]).collect();
        let (found, each) = released(&held).unwrap();
        assert_eq!((found.len(), each), (1000, 2.5));
    }
}
