//! Batches and sites that differ from the rest of the fleet.
//!
//! For each coefficient and each group, the offset of its units is a column of the model of
//! [`crate::random_effects`], tested by Student's statistic. The smallest p-value of all groups and
//! coefficients is compared with what as many tests reach by chance; a group that differs stays in the model
//! of its coefficient, and the rest is tested again. Groups that consist of nearly the same units explain an
//! offset equally well: those within the 5 % point of χ²(1) of the best are told with it.

use gyrocal_statistics::{chi_square_equivalent, p_of_least, student_two_sided_p};

use crate::answer::{Group, GroupAlternative, GroupFinding, WithInterval};
use crate::level::Levels;

/// The 5 % point of chi-square with one degree of freedom.
const ALTERNATIVE: f64 = 3.84;

/// Fewest units of a group, and fewest outside of it.
const LEAST_UNITS: usize = 2;

/// A group with its units.
#[derive(Clone, Debug)]
pub(crate) struct Members {
    pub(crate) group: Group,
    /// Whether each unit of the fleet belongs to it.
    pub(crate) units: Vec<bool>,
}

impl Members {
    fn count(&self) -> usize {
        self.units.iter().filter(|unit| **unit).count()
    }

    fn shared(&self, other: &Self) -> usize {
        let both = self.units.iter().zip(&other.units);
        both.filter(|(one, other)| **one && **other).count()
    }

    /// Its column for the units that have an estimate; `None` if too few are in it or outside of it.
    fn column(&self, levels: &Levels) -> Option<Vec<f64>> {
        let inside = |place: &usize| f64::from(u8::from(self.units[*place]));
        let column: Vec<f64> = levels.places.iter().map(inside).collect();
        let count = column.iter().sum::<f64>() as usize;
        (count >= LEAST_UNITS && column.len() - count >= LEAST_UNITS).then_some(column)
    }
}

/// A coefficient of the fleet.
pub(crate) struct Tested<'a> {
    pub(crate) name: &'a str,
    pub(crate) unit: &'a str,
    pub(crate) levels: &'a Levels,
    /// Columns of the groups that differ.
    pub(crate) columns: Vec<Vec<f64>>,
}

/// The best group of a coefficient.
struct Best {
    coefficient: usize,
    group: usize,
    p_value: f64,
    offset: WithInterval,
    column: Vec<f64>,
    alternatives: Vec<usize>,
}

/// The groups that differ, the most certain first; their columns are added to those of the coefficients.
pub(crate) fn differing(
    coefficients: &mut [Tested<'_>],
    groups: &[Members],
    probability: f64,
) -> Vec<GroupFinding> {
    let mut found = Vec::new();
    let mut best: Vec<Option<Best>> = (0..coefficients.len())
        .map(|index| best_of(coefficients, index, groups))
        .collect();
    let tests: usize = coefficients
        .iter()
        .map(|one| {
            groups
                .iter()
                .filter(|group| group.column(one.levels).is_some())
                .count()
        })
        .sum();
    loop {
        let least = best.iter().flatten();
        let Some(least) = least.min_by(|a, b| a.p_value.total_cmp(&b.p_value)) else {
            return found;
        };
        let p_value = p_of_least(least.p_value, tests as f64);
        if p_value > probability {
            return found;
        }
        let own = &groups[least.group];
        let coefficient = least.coefficient;
        found.push(GroupFinding {
            group: own.group.clone(),
            units: own.count(),
            coefficient: coefficients[coefficient].name.to_owned(),
            unit: coefficients[coefficient].unit.to_owned(),
            offset: least.offset,
            p_value,
            alternatives: least
                .alternatives
                .iter()
                .map(|other| GroupAlternative {
                    group: groups[*other].group.clone(),
                    units: groups[*other].count(),
                    shared: own.shared(&groups[*other]),
                })
                .collect(),
        });
        let column = least.column.clone();
        coefficients[coefficient].columns.push(column);
        best[coefficient] = best_of(coefficients, coefficient, groups);
    }
}

/// The group with the smallest p-value, and those that explain as much.
fn best_of(coefficients: &[Tested<'_>], coefficient: usize, groups: &[Members]) -> Option<Best> {
    let own = &coefficients[coefficient];
    let mut tested: Vec<(usize, f64, WithInterval, Vec<f64>)> = Vec::new();
    for (index, group) in groups.iter().enumerate() {
        let Some(column) = group.column(own.levels) else {
            continue;
        };
        let mut columns = own.columns.clone();
        columns.push(column.clone());
        let place = columns.len();
        // Columns that depend on those in the model have no fit.
        let Some(fit) = own.levels.units(columns).fit() else {
            continue;
        };
        let p_value = student_two_sided_p(fit.t(place), fit.degrees_of_freedom);
        if let (Some(p_value), Some(interval)) =
            (p_value.filter(|p| p.is_finite()), fit.interval(place))
        {
            let estimate = fit.beta[place];
            tested.push((index, p_value, WithInterval { estimate, interval }, column));
        }
    }
    tested.sort_by(|a, b| a.1.total_cmp(&b.1));
    let (group, p_value, offset, column) = tested.first().cloned()?;
    let equivalent =
        |p: f64| chi_square_equivalent(gyrocal_statistics::math::ln(p.max(f64::MIN_POSITIVE)));
    let near = |p: f64| equivalent(p_value) - equivalent(p) < ALTERNATIVE;
    Some(Best {
        coefficient,
        group,
        p_value,
        offset,
        column,
        alternatives: tested[1..]
            .iter()
            .filter(|one| near(one.1))
            .map(|one| one.0)
            .collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answer::GroupKind;
    use crate::course::Estimate;

    fn members(
        kind: GroupKind,
        name: &str,
        count: usize,
        is_in: impl Fn(usize) -> bool,
    ) -> Members {
        Members {
            group: Group {
                kind,
                name: name.to_owned(),
            },
            units: (0..count).map(is_in).collect(),
        }
    }

    /// Levels that cycle through −1, 0 and 1, and 10 higher in the first `raised`.
    fn levels(count: usize, raised: usize) -> Levels {
        let estimate = |place: usize| Estimate {
            value: (place % 3) as f64 - 1.0 + if place < raised { 10.0 } else { 0.0 },
            variance: 1e-4,
        };
        Levels::of(
            &(0..count)
                .map(|place| Some(estimate(place)))
                .collect::<Vec<_>>(),
        )
    }

    #[test]
    fn a_batch_that_differs_is_told_with_the_site_that_it_went_to() {
        let levels = levels(60, 12);
        let groups = [
            members(GroupKind::Batch, "B1", 60, |place| place < 12),
            members(GroupKind::Batch, "B2", 60, |place| {
                (12..30).contains(&place)
            }),
            members(GroupKind::Site, "north", 60, |place| place < 12),
            members(GroupKind::Site, "south", 60, |place| {
                place % 2 == 0 && place >= 12
            }),
        ];
        let mut tested = [Tested {
            name: "gyro_x.bias",
            unit: "deg/h",
            levels: &levels,
            columns: Vec::new(),
        }];
        let found = differing(&mut tested, &groups, 0.01);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].group.name.as_str(), found[0].units), ("B1", 12));
        assert!((found[0].offset.estimate - 10.0).abs() < 0.5);
        let other = &found[0].alternatives[..];
        assert_eq!(other.len(), 1);
        assert_eq!(
            (other[0].group.name.as_str(), other[0].shared),
            ("north", 12)
        );
        // The mean is that of the units outside.
        let mean = levels.mean_and_spread(tested[0].columns.clone()).mean;
        assert!(mean.is_some_and(|mean| mean.estimate.abs() < 0.1));
    }

    #[test]
    fn nothing_differs_in_a_fleet_of_one_kind() {
        let levels = levels(60, 0);
        let groups = [members(GroupKind::Batch, "B1", 60, |place| place < 12)];
        let mut tested = [Tested {
            name: "gyro_x.bias",
            unit: "deg/h",
            levels: &levels,
            columns: Vec::new(),
        }];
        assert!(differing(&mut tested, &groups, 0.01).is_empty());
    }
}
