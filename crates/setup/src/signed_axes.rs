//! The 48 ways to exchange and negate three axes.

use gyrocal_record::AXES;

use crate::vector::Vector;

/// Axes that are columns of a record, exchanged and with signs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SignedAxes {
    /// For each axis that was meant, the column that holds it.
    columns: [usize; 3],
    /// For each axis that was meant, whether the column holds its negative.
    negated: [bool; 3],
}

/// All orders of three columns: even permutations first.
const ORDERS: [[usize; 3]; 6] = [
    [0, 1, 2],
    [1, 2, 0],
    [2, 0, 1],
    [1, 0, 2],
    [0, 2, 1],
    [2, 1, 0],
];

impl SignedAxes {
    /// The axes as the columns say.
    pub const AS_GIVEN: Self = Self {
        columns: [0, 1, 2],
        negated: [false; 3],
    };

    /// All 48.
    pub fn all() -> impl Iterator<Item = Self> {
        ORDERS.into_iter().flat_map(|columns| {
            (0..8_u8).map(move |bits| Self {
                columns,
                negated: [bits & 1 != 0, bits & 2 != 0, bits & 4 != 0],
            })
        })
    }

    /// The components of a vector along the axes that were meant.
    #[must_use]
    pub fn apply(self, row: Vector) -> Vector {
        core::array::from_fn(|axis| {
            let value = row[self.columns[axis]];
            if self.negated[axis] { -value } else { value }
        })
    }

    /// -1 if the axes are mirrored, 1 if not.
    #[must_use]
    pub fn determinant(self) -> f64 {
        let odd_order = ORDERS[3..].contains(&self.columns);
        let odd_signs = self.negated.iter().filter(|negated| **negated).count() % 2 == 1;
        if odd_order == odd_signs { 1.0 } else { -1.0 }
    }

    /// Number of mistakes that make them: a negation is one, of all three axes together as well; an
    /// exchange of two is one, a cyclic one two.
    pub(crate) fn mistakes(self) -> usize {
        let signs = match self.negated.iter().filter(|negated| **negated).count() {
            3 => 1,
            count => count,
        };
        let order = match ORDERS.iter().position(|order| *order == self.columns) {
            Some(0) => 0,
            Some(1 | 2) => 2,
            _ => 1,
        };
        signs + order
    }

    /// In words: `x is column y negated, y is column x`.
    #[must_use]
    pub fn describe(self) -> String {
        if self.columns == [0, 1, 2] {
            let negated: Vec<&str> = (0..3)
                .filter(|axis| self.negated[*axis])
                .map(|axis| AXES[axis])
                .collect();
            return match negated[..] {
                [] => "the axes as given".to_owned(),
                [one] => format!("axis {one} negated"),
                [one, two] => format!("axes {one} and {two} negated"),
                _ => "all axes negated".to_owned(),
            };
        }
        let fixed = (0..3).find(|axis| self.columns[*axis] == *axis);
        if let (Some(fixed), [false, false, false]) = (fixed, self.negated) {
            let others: Vec<&str> = (0..3)
                .filter(|axis| *axis != fixed)
                .map(|axis| AXES[axis])
                .collect();
            return format!("axes {} and {} exchanged", others[0], others[1]);
        }
        let parts: Vec<String> = (0..3)
            .map(|axis| {
                let sign = if self.negated[axis] { "-" } else { "" };
                format!("{} = {sign}{}", AXES[axis], AXES[self.columns[axis]])
            })
            .collect();
        format!("columns exchanged, {}", parts.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{cross, dot};

    #[test]
    fn the_determinant_is_that_of_the_matrix() {
        assert_eq!(SignedAxes::all().count(), 48);
        for axes in SignedAxes::all() {
            let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            let columns = [x, y, z].map(|unit| axes.apply(unit));
            let triple = dot(cross(columns[0], columns[1]), columns[2]);
            assert_eq!(triple, axes.determinant(), "{axes:?}");
        }
    }

    #[test]
    fn simple_mistakes_have_simple_words() {
        let of_one = |axes: &SignedAxes| axes.mistakes() == 1;
        let words: Vec<String> = SignedAxes::all()
            .filter(of_one)
            .map(SignedAxes::describe)
            .collect();
        assert_eq!(words.len(), 7);
        assert!(words.contains(&"axes x and y exchanged".to_owned()));
        assert!(words.contains(&"all axes negated".to_owned()));
        assert_eq!(SignedAxes::AS_GIVEN.describe(), "the axes as given");
    }
}
